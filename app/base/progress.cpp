#include "app/base/progress.h"

#include "app/base/message.h"

#include <fmt/format.h>

#include <unistd.h>

#include <cmath>

namespace app {

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)),
      visible_(!quiet && isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
  if (drawn_) tell_raw("\r\033[K");
  drawn_ = false;
}

void Progress::show(double share, std::string_view detail) {
  if (!visible_) return;
  const auto now = std::chrono::steady_clock::now();
  if (first_share_ < 0) first_share_ = share;
  if (drawn_ && share < 1 && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double done = share - first_share_;
  const std::string left =
      done > 0 && elapsed > 1 ? fmt::format(", {} left", duration_text(elapsed / done * (1 - share))) : std::string();
  tell_raw(fmt::format("\r\033[K{}: {}, {:.0f} %{}", what_, detail, 100 * share, left));
  drawn_ = true;
}

std::string duration_text(double seconds) {
  const auto s = std::llround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace app
