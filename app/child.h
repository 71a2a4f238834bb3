// Other programs, started without a shell. They do not outlive this process.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace app {

struct ChildProgram {
  std::string file;                      ///< a path, or a name to be looked for along PATH
  std::vector<std::string> words;        ///< from the program's own name on
  std::vector<std::string> environment;  ///< NAME=VALUE; empty: that of this process
  int input = -1;                        ///< a descriptor that becomes its standard input; -1: that of this process
  bool takes_ctrl_c = true;              ///< false: what is typed on the terminal is for us alone
  int last_signal;                       ///< what it gets when this process dies
};

/// Starts it. Throws std::system_error with errno's value when that fails; then there is no child.
pid_t start_child(ChildProgram);

/// Waits for its end; the status is as waitpid() gives it.
int wait_for_child(pid_t);

}  // namespace app
