#include "app/sweep/runs.h"

#include "app/base/child.h"
#include "app/base/interrupt.h"
#include "app/base/progress.h"
#include "app/export/simulation.h"

#include "sim/trajectory/trajectory.h"

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace app {

namespace {

std::vector<std::string> words_of(const Options& options, const std::filesystem::path& folder, std::size_t run,
                                  std::size_t runs) {
  std::vector<std::string> words{"tanktread", "sweep", "-q", "-j", "1"};
  words.insert(words.end(), {"-o", folder.string(), "--shard", fmt::format("{}/{}", run, runs)});
  for (const std::string& axis : options.axes) words.insert(words.end(), {"--vary", axis});
  for (const std::string& change : options.set) words.insert(words.end(), {"--set", change});
  if (options.force) words.emplace_back("--force");
  words.emplace_back("--");  // a name may begin with a dash
  words.push_back(options.inputs.front().string());
  return words;
}

}  // namespace

RunOutcome outcome_of(const SweepRun& run) {
  RunOutcome outcome;
  if (!std::filesystem::exists(run.trajectory)) return outcome;
  try {
    check_further(run.settings, run.trajectory);
  } catch (const std::runtime_error& error) {
    outcome.reason = error.what();
    return outcome;
  }
  const sim::TrajectoryReader file(run.trajectory);
  if (file.count() == 0) return outcome;
  outcome.time = file.time(file.count() - 1);
  if (outcome.time >= run.settings.scene.time.end * (1 - 1e-12)) {
    outcome.kind = RunOutcome::Kind::finished;
    return outcome;
  }
  constexpr std::string_view stopped = "stopped at ";
  for (const std::string& note : file.notes())
    if (note.starts_with(stopped)) {
      outcome.kind = RunOutcome::Kind::stopped;
      outcome.reason = note.substr(stopped.size());
    }
  return outcome;
}

bool simulate_in_processes(const Options& options, const std::filesystem::path& folder,
                           const std::vector<SweepRun>& runs) {
  Children children;
  Progress progress("sweeping", options.quiet);
  std::size_t next = 0;
  while (next < runs.size() || children.running() > 0) {
    if (interrupted()) {
      children.stop();
      next = runs.size();
    }
    while (next < runs.size() && children.running() < static_cast<std::size_t>(options.jobs)) {
      if (outcome_of(runs[next]).kind != RunOutcome::Kind::finished) try {
          children.add(start_child({.file = "/proc/self/exe",
                                    .words = words_of(options, folder, next, runs.size()),
                                    .environment = {},
                                    .input = -1,
                                    .takes_ctrl_c = true,
                                    .last_signal = SIGTERM}));
        } catch (const std::system_error& error) {
          throw std::runtime_error(fmt::format("cannot start a process for a run: {}", error.code().message()));
        }
      ++next;
    }
    children.collect();  // how each ended is read from its trajectory
    const std::size_t done = next - children.running();
    progress.show(static_cast<double>(done) / static_cast<double>(runs.size()),
                  fmt::format("{} of {} runs, {} at work", done, runs.size(), children.running()));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return !interrupted();
}

}  // namespace app
