#include "app/converge/study.h"

#include "app/base/printable.h"
#include "app/base/version.h"

#include "sim/core/derived.h"
#include "sim/measures/statement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

bool orders_follow(const sim::Scene& scene) {
  return std::any_of(scene.vesicles.begin(), scene.vesicles.end(),
                     [&](const sim::VesicleParameters& v) { return sim::order_follows(scene.time, v); });
}

void read_steps(StudyRun& run, const std::vector<sim::StepRecord>& steps) {
  const sim::ErrorStatement e = sim::stated_errors(steps);
  run.stated = e.time + (orders_follow(run.settings.scene) ? e.degrees : 0);
  run.residual = e.solve;
  run.steps = static_cast<std::int64_t>(steps.size());
  run.rejected = run.iterations = 0;
  for (const sim::StepRecord& step : steps) {
    run.rejected += step.retries;
    run.iterations += step.iterations;
  }
  if (!steps.empty()) run.iterations /= static_cast<double>(steps.size());
}

constexpr double rounding = 1e-13;

/// What the linear solves of a run and rounding leave in a number of that size.
double noise_of(double size, const StudyRun& run) { return size * std::max(run.residual, rounding); }

double size_of(const ResultValues& result) {
  double size = result.scaled ? 1 : 0;
  for (const double v : result.values)
    if (std::isfinite(v)) size = std::max(size, std::abs(v));
  return size;
}

/// A usual result that says nothing: it is in no run, or is zero but for the noise of each.
bool says_nothing(const ResultValues& result, const std::vector<StudyRun>& runs) {
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (std::isfinite(result.values[k]) &&
        std::abs(result.values[k]) > (result.from_last_run ? 0 : noise_of(size_of(result), runs[k])))
      return false;
  return true;
}

void add_findings(Study& study, const std::vector<std::string>& programs) {
  const StudyRun& last = study.runs.back();
  const Convergence& shapes = study.shapes;
  const std::size_t judged = study.own.value_or(study.runs.size() - 1);
  if (const double found = shapes.errors[judged]; std::isfinite(found)) {
    const std::string off = !shapes.limit          ? fmt::format("some {}", scientific(found))
                            : shapes.known(judged) ? scientific(found)
                                                   : fmt::format("less than {}", scientific(shapes.uncertainty));
    study.findings.push_back(fmt::format("At {} {}{}, the final shapes are off by {} R0; it states {}.",
                                         study.what.symbol, value_text(study.runs[judged].value),
                                         study.own ? ", the scene's own" : "", off,
                                         scientific(study.runs[judged].stated)));
  }
  if (study.what.name == "order") {
    if (last.stated > study.shapes.errors[study.runs.size() - 2])
      study.findings.push_back(
          fmt::format("The time steps of each run state errors of {} R0, more than the orders differ by: smaller "
                      "ones tell the errors of the orders better.",
                      scientific(last.stated)));
  } else if (orders_follow(study.scene.scene)) {
    study.findings.emplace_back(
        "These are errors of the time steps and of the orders, which follow the tolerance, too.");
  } else {
    const sim::Scene& scene = study.scene.scene;
    int least = scene.vesicles.front().order, most = least;
    for (const sim::VesicleParameters& v : scene.vesicles) {
      least = std::min(least, v.order);
      most = std::max(most, v.order);
    }
    study.findings.push_back(
        fmt::format("These are errors of the time steps: all runs have order {}{}, whose error "
                    "--vary order tells.",
                    least, least == most ? "" : fmt::format(" to {}", most)));
  }
  for (std::size_t k = 0; k < programs.size(); ++k)
    if (programs[k] != version())
      study.findings.push_back(fmt::format("'{}' was made by tanktread {}.", study.runs[k].file.filename().string(),
                                           printable(programs[k])));
}

}  // namespace

Study study_of(const VariationRow& what, const Settings& scene, std::optional<double> own, std::vector<StudyRun> runs,
               const std::vector<AskedResult>& asked) {
  Study study{
      .what = what, .scene = scene, .own = {}, .runs = std::move(runs), .rows = {}, .shapes = {}, .findings = {}};
  std::vector<sim::TrajectoryReader> trajectories;
  std::vector<FigureSource> sources;
  std::vector<double> smallness;
  std::vector<std::string> programs;
  trajectories.reserve(study.runs.size());
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    StudyRun& run = study.runs[k];
    const sim::TrajectoryReader& trajectory = trajectories.emplace_back(run.file);
    read_steps(run, trajectory.steps());
    sources.push_back({trajectory, run.settings, {}, run.file.string()});
    smallness.push_back(what.smallness(run.value));
    programs.push_back(trajectory.header().program);
    if (own && run.value == *own) study.own = k;
  }
  const std::optional<double> expected = what.expected(scene.scene);
  for (ResultValues& result : values_of(sources, asked)) {
    if (result.usual && says_nothing(result, study.runs)) continue;
    const double noise = noise_of(size_of(result), study.runs.back());
    Convergence c = convergence_of(smallness, result.values, noise, expected);
    study.rows.push_back({std::move(result), std::move(c)});
  }
  std::vector<double> apart;
  for (const FigureSource& source : sources)
    apart.push_back(&source == &sources.back() ? 0 : shape_distance_of(source, sources.back()));
  study.shapes = convergence_of(smallness, apart, noise_of(1, study.runs.back()), expected);
  add_findings(study, programs);
  return study;
}

}  // namespace app
