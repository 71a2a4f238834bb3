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
/// May the file be continued with these settings: is it of this scene, but for time.end and time.save_every, and not beyond
/// its end? Throws std::runtime_error that names the keys that differ.
void check_further(const Settings&, const std::filesystem::path& trajectory);
/// Continues a file, also to a later end or with other times to save from now on, after `ready`; not when there is nothing left
/// to do. Others are refused.
SimulationReport simulate_further(const Settings&, const std::filesystem::path& trajectory, const Options&,
                                  const std::function<void()>& ready = {});

}  // namespace app
