// Ctrl-C and SIGTERM ask for an end: the step or frame under way is finished and saved. A second Ctrl-C ends at once.
#pragma once

#include <filesystem>

namespace app {

/// Exit status after an interruption.
inline constexpr int interrupted_status = 130;

/// From here on SIGINT and SIGTERM set a flag, and a closed pipe or a file that may not grow is a write error
/// rather than the end.
void watch_signals();
bool interrupted();

/// What takes long and leaves nothing half done ends by this: nothing of it is kept.
struct Interrupted {
  std::filesystem::path simulated;  ///< a trajectory as far as it went; empty: none
};
/// Throws Interrupted.
void stop_if_interrupted();

}  // namespace app
