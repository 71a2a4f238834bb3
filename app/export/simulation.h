// Runs a simulation into a trajectory file, with progress on the terminal and a clean stop on Ctrl-C.
#pragma once

#include "app/base/options.h"
#include "app/scene/settings.h"

#include "sim/core/ranks.h"

#include <filesystem>
#include <functional>
#include <string>

namespace app {

struct SimulationReport {
  std::int64_t states = 0;  ///< in the file
  double time = 0;          ///< of the last state
  bool already_finished = false;
  bool interrupted = false;
  std::string stopped;  ///< why the simulation stopped early; empty: it did not
};

/// One simulation of several in the line of progress, and which part of the whole it is.
struct ProgressSpan {
  std::string what = "simulating";
  double first = 0, share = 1;
  std::string name = {};  ///< before its warnings; empty: it is the only one
};

/// A new file; an existing trajectory is replaced. `ready` is called when the scene can be simulated, before anything
/// is replaced.
SimulationReport simulate_new(const Settings&, const std::filesystem::path& trajectory, const Options&,
                              const std::function<void()>& ready = {}, const ProgressSpan& = {},
                              const sim::Ranks& = sim::alone);
/// Checks that the file can be continued with these settings: the same scene, except for time.end and
/// time.save_every, and not past its end. Throws std::runtime_error that names the keys that differ.
void check_further(const Settings&, const std::filesystem::path& trajectory);
/// Continues a file, also to a later end or with other save times from there on, after calling `ready`; does nothing
/// when it is finished. Files of other scenes are refused.
SimulationReport simulate_further(const Settings&, const std::filesystem::path& trajectory, const Options&,
                                  const std::function<void()>& ready = {}, const ProgressSpan& = {},
                                  const sim::Ranks& = sim::alone);
/// What the ranks after the first do while it does one of the above: they wait for what it reads, take their part of
/// the work, and touch no file.
void simulate_along(const Options&, const sim::Ranks&);

}  // namespace app
