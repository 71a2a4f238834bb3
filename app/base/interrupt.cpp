#include "app/base/interrupt.h"

#include <csignal>

namespace app {

namespace {

volatile std::sig_atomic_t signalled = 0;  // a signal handler can reach nothing else

extern "C" void take_note(int number) {
  signalled = 1;
  std::signal(number, SIG_DFL);
}

}  // namespace

void watch_signals() {
  std::signal(SIGINT, take_note);
  std::signal(SIGTERM, take_note);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return signalled != 0; }

void stop_if_interrupted() {
  if (interrupted()) throw Interrupted{};
}

}  // namespace app
