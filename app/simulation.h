// Runs a simulation into a trajectory file, with progress on the terminal and a tidy end on Ctrl-C.
#pragma once

#include "options.h"
#include "settings.h"

#include <filesystem>
#include <functional>
#include <string>

namespace app {

struct SimulationReport {
  std::int64_t states = 0;     ///< in the file now
  double time = 0;             ///< of the last of them
  bool already_finished = false;
  bool interrupted = false;
  std::string stopped;         ///< why the simulation ended before its time; empty: it did not
};

/// A new file; a trajectory that exists is replaced. `ready` is called when the scene can be simulated, before anything is
/// replaced.
SimulationReport simulate_new(const Settings&, const std::filesystem::path& trajectory, const Options&,
                              const std::function<void()>& ready = {});
/// Continues a file, after `ready`; not when there is nothing left to do. A file of another scene is refused.
SimulationReport simulate_further(const Settings&, const std::filesystem::path& trajectory, const Options&,
                                  const std::function<void()>& ready = {});

}  // namespace app
