#include "app/base/child.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>

extern char** environ;

namespace app {

namespace {

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> all;
  for (std::string& word : words) all.push_back(word.data());
  all.push_back(nullptr);
  return all;
}

/// In the child, between fork and exec: nothing but system calls.
[[noreturn]] void become(const ChildProgram& program, char* const* words, char** variables, int trouble, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, program.last_signal);
  if (::getppid() != parent) ::_exit(127);
  if (!program.takes_ctrl_c) ::setpgid(0, 0);
  for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ}) std::signal(number, SIG_DFL);
  if (program.input >= 0) ::dup2(program.input, STDIN_FILENO);
  if (program.errors >= 0) ::dup2(program.errors, STDERR_FILENO);
  environ = variables;
  ::execvp(program.file.c_str(), words);
  const int reason = errno;
  [[maybe_unused]] const ssize_t told = ::write(trouble, &reason, sizeof reason);
  ::_exit(127);
}

}  // namespace

pid_t start_child(ChildProgram program) {
  std::vector<char*> words = pointers(program.words), variables = pointers(program.environment);
  int trouble[2];  // a line that closes when the program has been started
  if (::pipe2(trouble, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category());
  const pid_t parent = ::getpid(), child = ::fork();
  if (child == 0)
    become(program, words.data(), program.environment.empty() ? environ : variables.data(), trouble[1], parent);
  int reason = child < 0 ? errno : 0;
  ::close(trouble[1]);
  if (child > 0) {
    ssize_t heard = 0;
    do heard = ::read(trouble[0], &reason, sizeof reason);
    while (heard < 0 && errno == EINTR);
    if (heard > 0) wait_for_child(child);
  }
  ::close(trouble[0]);
  if (reason != 0) throw std::system_error(reason, std::generic_category());
  return child;
}

int wait_for_child(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

Children::~Children() {
  stop();
  for (const pid_t child : running_) wait_for_child(child);
}

void Children::stop() {
  if (!stopped_)
    for (const pid_t child : running_) ::kill(child, SIGTERM);
  stopped_ = true;
}

bool Children::collect() {
  bool good = true;
  std::erase_if(running_, [&](pid_t child) {
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) != child) return false;
    good = good && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return true;
  });
  return good;
}

}  // namespace app
