// The command converge: a scene at several tolerances, steps or orders.
#include "app/base/folder_lock.h"
#include "app/base/interrupt.h"
#include "app/base/message.h"
#include "app/base/printable.h"
#include "app/base/result_files.h"
#include "app/base/version.h"
#include "app/commands/commands.h"
#include "app/converge/study.h"
#include "app/export/simulation.h"
#include "app/scene/scene_file.h"
#include "app/scene/scene_text.h"

#include "sim/core/derived.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>

namespace app {

namespace fs = std::filesystem;

namespace {

/// What is to be done, known before any of it is.
struct Plan {
  const VariationRow& what;
  Settings scene;
  std::optional<double> own;
  std::vector<AskedResult> asked;
  std::vector<StudyRun> runs;
  render::FigureParameters figure;
};

/// The scene with one value; a complaint about it names the option that it comes from.
Settings scene_with(const Options& options, const VariationRow& what, double value, const std::string& more = {}) {
  std::vector<std::string> changes = options.set;
  const std::string change = fmt::format("{}={}", what.key, value_text(value));
  changes.push_back(change);
  if (!more.empty()) changes.push_back(more);
  try {
    return read_scene(options.inputs.front(), changes);
  } catch (const std::runtime_error& error) {
    std::string text = error.what();
    const std::string from = fmt::format("--set {}", change);
    if (text.starts_with(from)) text = fmt::format("--values {}{}", value_text(value), text.substr(from.size()));
    throw std::runtime_error(text);
  }
}

/// How the figure looks: the keys of the scene's first [figure] that are no matter of its kind.
render::FigureParameters look_of(const Settings& scene) {
  render::FigureParameters look;
  if (scene.figures.empty()) return look;
  const render::FigureParameters& first = scene.figures.front();
  look.size = first.size;
  look.unit = first.unit;
  look.theme = first.theme;
  look.font_size = first.font_size;
  look.dots_per_inch = first.dots_per_inch;
  return look;
}

fs::path trajectory_name(const VariationRow& what, double value) {
  return fmt::format("{}-{}.h5", what.name, value_text(value));
}

Plan plan_of(const Options& options, const fs::path& folder) {
  Settings scene = read_scene(options.inputs.front(), options.set);
  const VariationRow& what = options.vary.empty() ? natural_variation(scene.scene) : find_variation(options.vary);
  std::string why;
  const std::optional<double> own = what.own(scene.scene, why);
  if (!own && (options.values.empty() || what.name != "order"))
    throw std::runtime_error(
        fmt::format("--vary {} is nothing for '{}': {}", what.name, options.inputs.front().string(), why));
  const std::vector<double> values =
      options.values.empty() ? what.around(*own) : read_variation_values(what, options.values);
  Plan plan{what, std::move(scene), own, {}, {}, {}};
  plan.figure = look_of(plan.scene);
  plan.asked =
      options.quantities.empty() ? usual_results(plan.scene.scene) : read_results(options.quantities, plan.scene.scene);
  std::vector<double> intervals;
  for (const double value : values) {
    StudyRun& run = plan.runs.emplace_back();
    run.value = value;
    run.settings = scene_with(options, what, value);
    run.file = folder / trajectory_name(what, value);
    if (run.settings.scene.time.save_every) intervals.push_back(*run.settings.scene.time.save_every);
  }
  // Fixed steps end at saved states, which would shorten a step that does not fit between them.
  if (what.name == "step" && intervals.size() == values.size()) {
    const std::optional<double> common = common_save_interval(values, intervals);
    for (StudyRun& run : plan.runs)
      run.settings = scene_with(options, what, run.value,
                                fmt::format("time.save_every={}", value_text(common.value_or(run.value))));
  }
  return plan;
}

void print_plan(const Plan& plan) {
  for (const StudyRun& run : plan.runs)
    fmt::print("# {} {}: {}\n", plan.what.key, value_text(run.value), printable(run.file.string()));
  std::string names;
  for (const AskedResult& asked : plan.asked) names += (names.empty() ? "" : ", ") + asked.name;
  fmt::print("# results: {}\n{}", names, write_scene(plan.scene));
}

/// Makes the trajectory, or what is missing of it.
SimulationReport simulate_run(StudyRun& run, const Options& options, const ProgressSpan& span) {
  Options alone = options;
  alone.steps.reset();
  bool kept = fs::exists(run.file);
  if (kept && options.force) try {
      check_further(run.settings, run.file);
    } catch (const std::exception&) {
      kept = false;
    }
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  SimulationReport report = kept ? simulate_further(run.settings, run.file, alone, {}, span)
                                 : simulate_new(run.settings, run.file, alone, {}, span);
  if (!report.already_finished)
    run.seconds = {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                   static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC};
  return report;
}

/// The command that makes the same files, for the page.
std::string command_text(const Options& options, const VariationRow& what, const std::vector<StudyRun>& runs) {
  std::string text =
      fmt::format("tanktread converge {} --vary {} --values ", options.inputs.front().string(), what.name);
  for (std::size_t k = 0; k < runs.size(); ++k)
    text += fmt::format("{}{}", k > 0 ? "," : "", value_text(runs[k].value));
  if (!options.quantities.empty()) text += " --quantities " + options.quantities;
  for (const std::string& change : options.set) text += fmt::format(" --set '{}'", change);
  return text;
}

std::string shown(const Study& study) {
  std::string text;
  for (const TextTable& table : tables_of(study, true)) text += plain_text(table) + "\n";
  for (const std::string& line : study.findings) text += line + "\n";
  return text;
}

}  // namespace

int converge(const Options& options) {
  const fs::path folder =
      options.output.empty() ? fs::path("converge") / options.inputs.front().stem() : options.output;
  Plan plan = plan_of(options, folder);
  if (options.dry_run) {
    print_plan(plan);
    return 0;
  }
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw std::runtime_error(fmt::format("'{}' is not a folder", folder.string()));
  const fs::path stem = folder / plan.what.name, page = stem.string() + ".md";
  ResultFiles files(options.inputs, options.force);
  for (const char* extension : render::figure_extensions) files.require_inside(stem.string() + extension);
  files.require_inside(page);
  for (const StudyRun& run : plan.runs)  // before hours of work
    if (fs::exists(run.file) && !options.force) check_further(run.settings, run.file);

  const FolderLock lock(folder);
  double done = 0, all = 0;
  for (const StudyRun& run : plan.runs) all += plan.what.effort(run.value);
  bool stopped = false;
  std::vector<StudyRun> finished;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    StudyRun& run = plan.runs[k];
    const double share = plan.what.effort(run.value) / all;
    const ProgressSpan span{
        .what = fmt::format("{} {}, run {} of {}", plan.what.symbol, value_text(run.value), k + 1, plan.runs.size()),
        .first = done,
        .share = share,
        .name = fmt::format("{} {}", plan.what.symbol, value_text(run.value))};
    const SimulationReport report = simulate_run(run, options, span);
    done += share;
    if (report.interrupted) {
      tell(
          fmt::format("interrupted; {} of {} runs are in '{}', the next is there to time {:.6g}; the same command "
                      "continues",
                      k, plan.runs.size(), folder.string(), report.time));
      return interrupted_status;
    }
    if (report.stopped.empty()) {
      finished.push_back(std::move(run));
      continue;
    }
    stopped = true;
    tell(fmt::format("the run with {} = {} stopped and is left out: {}", plan.what.key, value_text(run.value),
                     report.stopped));
  }
  if (finished.size() < 2)
    throw std::runtime_error(
        fmt::format("{} of {} runs reached the end, too few to compare", finished.size(), plan.runs.size()));
  const std::string command = command_text(options, plan.what, finished);
  const Study study = study_of(plan.what, plan.scene, plan.own, std::move(finished), plan.asked);
  stop_if_interrupted();
  if (!options.quiet) fmt::print("{}\n", shown(study));
  std::vector<fs::path> written;
  const render::Figure figure = figure_of(study, plan.figure);
  if (figure.drawing.paint) {
    written = render::write_figure(figure, stem,
                                   {{"Software", "tanktread " + version()},
                                    {"tanktread:command", command},
                                    {"tanktread:scene", write_scene(study.scene.scene)}},
                                   files.writer_inside());
  } else {
    written = {stem.string() + ".csv"};
    files.writer_inside()(written.back(), csv_of(study));
  }
  written.push_back(page);
  const std::string picture = figure.drawing.paint ? fmt::format("{}.png", plan.what.name) : std::string();
  files.writer_inside()(page, page_of(study, command, picture));
  files.settle();
  if (!options.quiet)
    for (const fs::path& file : written) fmt::print("{}\n", printable(file.string()));
  return stopped ? 1 : 0;
}

}  // namespace app
