// The runs of a sweep: what each has come to, by its trajectory alone, and many of them at once.
#pragma once

#include "app/base/options.h"
#include "app/scene/settings.h"
#include "app/sweep/grid.h"

#include <optional>

namespace app {

struct SweepRun {
  SweepPoint point;
  Settings settings;
  std::filesystem::path trajectory;  ///< FOLDER/NAME/trajectory.h5
};

struct RunOutcome {
  enum class Kind { finished, stopped, missing } kind = Kind::missing;
  double time = 0;     ///< of the last state
  std::string reason;  ///< why it stopped, or why it has no states
};
/// A trajectory of another scene is none.
RunOutcome outcome_of(const SweepRun&);

/// This program once a run, the command line of `options` with --shard, options.jobs at a time. False: interrupted.
/// What a run says of errors goes to standard error.
bool simulate_in_processes(const Options&, const std::filesystem::path& folder, const std::vector<SweepRun>&);

}  // namespace app
