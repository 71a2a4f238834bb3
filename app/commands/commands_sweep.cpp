// The command sweep: a scene with all combinations of the values of some keys.
#include "app/base/folder_lock.h"
#include "app/base/interrupt.h"
#include "app/base/message.h"
#include "app/base/printable.h"
#include "app/base/result_files.h"
#include "app/base/version.h"
#include "app/commands/commands.h"
#include "app/export/simulation.h"
#include "app/figures/figures.h"
#include "app/scene/scene_file.h"
#include "app/scene/scene_text.h"
#include "app/sweep/table.h"
#include "app/tables/results.h"

#include "sim/core/derived.h"
#include "sim/membrane/flows.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <variant>

namespace app {

namespace fs = std::filesystem;

namespace {

/// What is to be done, known before any of it is.
struct Sweep {
  Settings scene;
  std::vector<SweepAxis> axes;
  std::vector<SweepRun> runs;
  std::vector<AskedResult> asked;
};

/// The scene at a point, perhaps of a run that is continued; a complaint about it names the option that it comes from.
Settings scene_at(const Options& options, const std::vector<SweepAxis>& axes, const SweepPoint& point,
                  const fs::path& trajectory) {
  std::vector<std::string> changes = options.set;
  const std::vector<std::string> own = changes_at(axes, point);
  changes.insert(changes.end(), own.begin(), own.end());
  try {
    return read_scene(options.inputs.front(), changes, trajectory);
  } catch (const std::runtime_error& error) {
    std::string text = error.what();
    for (const std::string& change : own)
      if (const std::string from = fmt::format("--set {}", change); text.starts_with(from))
        text = fmt::format("--vary {}{}", change, text.substr(from.size()));
    throw std::runtime_error(text);
  }
}

/// Keys of which one overrides another, or one value written in two ways, would make one scene twice.
void check_distinct(const Options& options, const Sweep& sweep) {
  for (const SweepAxis& axis : sweep.axes)
    for (const std::string& change : options.set)
      if (change.substr(0, change.find('=')) == axis.key)
        throw std::runtime_error(fmt::format("--set {} and --vary {} are the same key", change, axis.key));
  std::map<std::string, const SweepPoint*> scenes;
  for (const SweepRun& run : sweep.runs)
    if (const auto [other, fresh] = scenes.try_emplace(write_scene(run.settings), &run.point); !fresh)
      throw std::runtime_error(
          fmt::format("the runs {} and {} have one scene: a value is there twice, or one key overrides another",
                      other->second->name, run.point.name));
}

/// Results that compare runs with the most accurate of them, which a sweep does not have, are refused.
std::vector<AskedResult> asked_of(const Options& options, const sim::Scene& scene) {
  std::vector<AskedResult> asked = read_results(options.quantities, scene);
  for (const AskedResult& one : asked)
    if (const ResultRow* row = sim::find_row(results(), one.name))
      if (std::holds_alternative<OfMembranes>(row->source))
        throw std::runtime_error(
            fmt::format("--quantities {}: a distance from a more accurate run, which is for converge", one.name));
  return asked;
}

Sweep sweep_of(const Options& options, const fs::path& folder) {
  std::vector<SweepAxis> axes;
  for (const std::string& text : options.axes) axes.push_back(read_axis(text));
  std::vector<SweepPoint> points = points_of(axes);
  const auto trajectory_of = [&](const SweepPoint& point) { return folder / point.name / "trajectory.h5"; };
  Sweep sweep{read_scene(options.inputs.front(), options.set, trajectory_of(points.front())), std::move(axes), {}, {}};
  if (!options.quantities.empty()) sweep.asked = asked_of(options, sweep.scene.scene);
  for (SweepPoint& point : points) {
    stop_if_interrupted();
    const fs::path trajectory = trajectory_of(point);
    Settings settings = scene_at(options, sweep.axes, point, trajectory);
    sweep.runs.push_back({std::move(point), std::move(settings), trajectory});
  }
  check_distinct(options, sweep);
  return sweep;
}

void print_plan(const Sweep& sweep) {
  for (const SweepRun& run : sweep.runs) {
    std::string changes;
    for (const std::string& change : changes_at(sweep.axes, run.point))
      changes += (changes.empty() ? "" : ", ") + change;
    fmt::print("# {}: {}\n", printable(run.trajectory.string()), printable(changes));
  }
  fmt::print("# {} runs\n{}", sweep.runs.size(), write_scene(sweep.scene));
}

/// Makes the trajectory, or what is missing of it. False: interrupted.
bool simulate_run(const SweepRun& run, const Options& options, const ProgressSpan& span) {
  Options alone = options;
  alone.steps.reset();
  const FolderLock lock(run.trajectory.parent_path());
  bool kept = fs::exists(run.trajectory);
  if (kept && options.force) try {
      check_further(run.settings, run.trajectory);
    } catch (const std::exception&) {
      kept = false;
    }
  const SimulationReport report = kept ? simulate_further(run.settings, run.trajectory, alone, {}, span)
                                       : simulate_new(run.settings, run.trajectory, alone, {}, span);
  return !report.interrupted;
}

/// Why runs could not be made, by their names.
using Failures = std::map<std::string, std::string>;

/// The runs of this shard, one after the other; those that cannot be made are told and left out. False: interrupted.
bool simulate_here(const Sweep& sweep, const Options& options, Failures& failures) {
  std::vector<const SweepRun*> mine;
  for (std::size_t k = 0; k < sweep.runs.size(); ++k)
    if (k % static_cast<std::size_t>(options.shards) == static_cast<std::size_t>(options.shard))
      mine.push_back(&sweep.runs[k]);
  for (std::size_t k = 0; k < mine.size(); ++k) {
    const std::string& name = mine[k]->point.name;
    const ProgressSpan span{.what = fmt::format("{}, run {} of {}", name, k + 1, mine.size()),
                            .first = static_cast<double>(k) / static_cast<double>(mine.size()),
                            .share = 1.0 / static_cast<double>(mine.size()),
                            .name = name};
    try {
      if (interrupted() || !simulate_run(*mine[k], options, span)) return false;
    } catch (const std::exception& error) {
      failures.emplace(name, error.what());
      tell(fmt::format("{}: {}", name, error.what()));
    }
  }
  return true;
}

/// All runs, by processes; what they left is tried once more here, to know why. False: interrupted.
bool simulate_side_by_side(const Sweep& sweep, const Options& options, const fs::path& folder, Failures& failures) {
  if (!simulate_in_processes(options, folder, sweep.runs)) return false;
  Options alone = options;
  alone.quiet = true;
  for (const SweepRun& run : sweep.runs) try {
      if (outcome_of(run).kind == RunOutcome::Kind::missing && !simulate_run(run, alone, {})) return false;
    } catch (const std::exception& error) {
      failures.emplace(run.point.name, error.what());
    }
  return true;
}

std::vector<RunOutcome> outcomes_of(const Sweep& sweep, const Failures& failures) {
  std::vector<RunOutcome> outcomes;
  for (const SweepRun& run : sweep.runs) {
    RunOutcome& outcome = outcomes.emplace_back(outcome_of(run));
    const auto failure = failures.find(run.point.name);
    if (outcome.kind == RunOutcome::Kind::missing && failure != failures.end()) outcome.reason = failure->second;
  }
  return outcomes;
}

/// What an earlier sweep left beside its runs.
void remove_outdated(const fs::path& folder, bool diagram_only) {
  if (!fs::is_directory(folder)) return;
  OwnedFiles files(folder);
  for (const char* extension : render::figure_extensions) files.remove(fmt::format("phase-diagram{}", extension));
  if (diagram_only) return;
  for (const char* name : {"sweep.csv", "sweep.md"}) files.remove(name);
}

/// The folders of runs, before any of them is made: links are not followed out of the folder.
void check_folders(const Sweep& sweep, const fs::path& folder, const Options& options) {
  const OwnedFiles files(folder);
  for (const SweepRun& run : sweep.runs) {
    files.require_folder(run.point.name);
    if (fs::is_symlink(run.trajectory))
      throw std::runtime_error(fmt::format("'{}' is a link, and links are not followed out of a folder of results",
                                           run.trajectory.string()));
    if (fs::exists(run.trajectory) && !options.force) check_further(run.settings, run.trajectory);
  }
}

std::string command_text(const Options& options) {
  std::string text = fmt::format("tanktread sweep {}", options.inputs.front().string());
  for (const std::string& axis : options.axes) text += fmt::format(" --vary '{}'", axis);
  if (!options.quantities.empty()) text += " --quantities " + options.quantities;
  for (const std::string& change : options.set) text += fmt::format(" --set '{}'", change);
  return text;
}

/// Two keys with numbers, in a flow that tells motions apart.
bool has_phase_diagram(const Sweep& sweep) {
  constexpr std::size_t most_open_files = 400;
  if (sweep.axes.size() != 2 || sweep.runs.size() > most_open_files) return false;
  return std::all_of(sweep.axes.begin(), sweep.axes.end(),
                     [](const SweepAxis& axis) { return numbers_of(axis).size() > 1; }) &&
         std::all_of(sweep.runs.begin(), sweep.runs.end(),
                     [](const SweepRun& run) { return sim::steady_shear_rate(run.settings.scene.flows).has_value(); });
}

/// Of the runs that have states of their scene.
std::vector<fs::path> draw_phase_diagram(const Sweep& sweep, const std::vector<RunOutcome>& outcomes,
                                         const fs::path& stem, ResultFiles& files, const Options& options) {
  std::vector<sim::TrajectoryReader> trajectories;
  trajectories.reserve(sweep.runs.size());
  std::vector<FigureSource> sources;
  for (std::size_t k = 0; k < sweep.runs.size(); ++k)
    if (const SweepRun& run = sweep.runs[k]; outcomes[k].kind != RunOutcome::Kind::missing)
      sources.push_back(
          {trajectories.emplace_back(run.trajectory), run.settings, run.point.name, run.trajectory.string()});
  render::FigureParameters figure = sweep.scene.figures.empty() ? render::FigureParameters{} : sweep.scene.figures[0];
  figure.kind = "phase-diagram";
  figure.axes.clear();
  for (const SweepAxis& axis : sweep.axes) {  // of the first vesicle, whatever its number is called
    std::string key = axis.key;
    if (const std::size_t at = key.find(".0."); at != std::string::npos) key.erase(at, 2);
    figure.axes.push_back(key);
  }
  try {
    return draw_figure(sources, figure, stem, files.writer_inside(), options);
  } catch (const std::invalid_argument& error) {
    tell(fmt::format("there is no phase diagram: {}", error.what()));
    return {};
  }
}

std::string page_of(const Sweep& sweep, const SweepTable& table, const std::string& command, bool diagram) {
  std::string page = fmt::format("# Sweep of {}\n\nMade by `{}` with tanktread {}.\n\n",
                                 printable(sweep.scene.scene.title), printable(command), version());
  if (diagram) page += "![Motions over the two keys](phase-diagram.png)\n\n";
  page += markdown_text(short_table(table)) + "\nAll columns are in `sweep.csv`, each trajectory in its folder.\n";
  for (const SweepRow& row : table.rows)
    if (row.vesicle == 0 && row.outcome.kind != RunOutcome::Kind::finished) {
      std::string where;
      for (std::size_t a = 0; a < row.values.size(); ++a)
        where += fmt::format("{}{} = {}", a > 0 ? ", " : "", table.axes[a], row.values[a]);
      page += fmt::format("\n{}: {}{}\n", printable(where),
                          row.outcome.kind == RunOutcome::Kind::stopped ? "stopped at " : "",
                          printable(row.outcome.reason));
    }
  return page;
}

/// Tells of runs that did not reach the end; the status of the command.
int told_outcomes(const Sweep& sweep, const std::vector<RunOutcome>& outcomes) {
  constexpr std::size_t most_told = 8;
  std::size_t stopped = 0, missing = 0;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    missing += outcomes[k].kind == RunOutcome::Kind::missing;
    if (outcomes[k].kind == RunOutcome::Kind::stopped && ++stopped <= most_told)
      tell(fmt::format("{} stopped at {}", sweep.runs[k].point.name, outcomes[k].reason));
  }
  if (stopped > most_told) tell(fmt::format("... and {} more stopped", stopped - most_told));
  if (missing > 0) tell(fmt::format("{} of {} runs could not be made", missing, outcomes.size()));
  return stopped + missing > 0 ? 1 : 0;
}

}  // namespace

int sweep(const Options& options) {
  const fs::path folder = options.output.empty() ? fs::path("sweep") / options.inputs.front().stem() : options.output;
  const Sweep sweep = sweep_of(options, folder);
  if (options.dry_run) {
    print_plan(sweep);
    return 0;
  }
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw std::runtime_error(fmt::format("'{}' is not a folder", folder.string()));
  const fs::path table_file = folder / "sweep.csv", page = folder / "sweep.md", diagram = folder / "phase-diagram";
  ResultFiles files(options.inputs, options.force);
  files.require_inside(table_file);
  files.require_inside(page);
  const bool with_diagram = has_phase_diagram(sweep);
  if (with_diagram)
    for (const char* extension : render::figure_extensions) files.require_inside(diagram.string() + extension);
  check_folders(sweep, folder, options);  // before hours of work

  const bool side_by_side = options.jobs > 1 && options.shards == 1 && sweep.runs.size() > 1;
  std::optional<FolderLock> lock;  // processes take their own
  if (!side_by_side) lock.emplace(folder, options.shard, options.shards);
  const bool complete = std::all_of(sweep.runs.begin(), sweep.runs.end(), [](const SweepRun& run) {
    return outcome_of(run).kind == RunOutcome::Kind::finished;
  });
  if (!complete && options.shard == 0) remove_outdated(folder, false);
  Failures failures;
  const bool through =
      side_by_side ? simulate_side_by_side(sweep, options, folder, failures) : simulate_here(sweep, options, failures);
  if (!through) {
    if (options.shards == 1 || !options.quiet) tell("interrupted; the same command continues");
    return interrupted_status;
  }
  if (options.shards > 1) {
    if (!options.quiet)
      fmt::print("shard {}/{} is done; when all are, the same command without --shard writes the table\n",
                 options.shard, options.shards);
    return failures.empty() ? 0 : 1;
  }
  if (!lock) lock.emplace(folder);
  const std::vector<RunOutcome> outcomes = outcomes_of(sweep, failures);
  const int status = told_outcomes(sweep, outcomes);
  const SweepTable table = table_of(sweep.axes, sweep.runs, outcomes, sweep.asked, options.quiet);
  remove_outdated(folder, true);
  std::vector<fs::path> written;
  if (with_diagram) written = draw_phase_diagram(sweep, outcomes, diagram, files, options);
  files.writer_inside()(table_file, csv_text(full_table(table)));
  files.writer_inside()(page, page_of(sweep, table, command_text(options), !written.empty()));
  files.settle();
  written.insert(written.end(), {table_file, page});
  if (!options.quiet) {
    fmt::print("{}\n", plain_text(short_table(table)));
    if (!table.why_untold.empty()) fmt::print("untold: {}\n\n", table.why_untold);
    for (const fs::path& file : written) fmt::print("{}\n", printable(file.string()));
  }
  return status;
}

}  // namespace app
