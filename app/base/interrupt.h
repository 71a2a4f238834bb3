// Ctrl-C and SIGTERM request a stop: the current step or frame is finished and saved. A second Ctrl-C ends at once.
#pragma once

#include <filesystem>

namespace app {

/// Exit status after an interruption.
inline constexpr int interrupted_status = 130;

/// From now on SIGINT and SIGTERM set a flag, and a closed pipe or a file size limit is a write error instead of a
/// fatal signal.
void watch_signals();
bool interrupted();

/// Thrown to abort long computations without partial results: nothing is kept.
struct Interrupted {
  std::filesystem::path simulated;  ///< the trajectory so far; empty: none
};
/// Throws Interrupted.
void stop_if_interrupted();

}  // namespace app
