// Runs a simulation into a trajectory file, with progress on the terminal and a tidy end on Ctrl-C.
#pragma once

#include "options.h"
#include "settings.h"

namespace app {

struct SimulationReport {
  std::int64_t states = 0;     ///< in the file now
  double time = 0;             ///< of the last of them
  bool already_finished = false;
  bool interrupted = false;
  std::string stopped;         ///< why the simulation ended before its time; empty: it did not
};

/// A new file; one that exists is replaced.
SimulationReport simulate_new(const Settings&, const std::filesystem::path& trajectory, const Options&);
/// Continues a file. A file of another scene is refused.
SimulationReport simulate_further(const Settings&, const std::filesystem::path& trajectory, const Options&);

}  // namespace app
