// Child processes, started without a shell. They do not outlive this process.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace app {

struct ChildProgram {
  std::string file;                      ///< a path, or a name to look up in PATH
  std::vector<std::string> words;        ///< arguments, starting with the program's name
  std::vector<std::string> environment;  ///< NAME=VALUE; empty: that of this process
  int input = -1;                        ///< a descriptor that becomes its standard input; -1: that of this process
  int errors = -1;                       ///< one that becomes its standard error; -1: that of this process
  bool takes_ctrl_c = true;              ///< false: Ctrl-C on the terminal reaches only this process
  int last_signal;                       ///< signal it receives when this process dies
};

/// Starts it. Throws std::system_error with errno's value on failure; then there is no child.
pid_t start_child(ChildProgram);

/// Waits for its end and returns the status of waitpid().
int wait_for_child(pid_t);

/// Child processes at work. None is left when they go out of scope: they finish what is under way, and are waited for.
class Children {
 public:
  Children() = default;
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;
  ~Children();
  void add(pid_t child) { running_.push_back(child); }
  std::size_t running() const { return running_.size(); }
  /// Asks them for an end, once.
  void stop();
  /// Forgets those that have ended; false: one of them failed.
  bool collect();

 private:
  std::vector<pid_t> running_;
  bool stopped_ = false;
};

}  // namespace app
