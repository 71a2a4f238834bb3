#include "app/sweep/table.h"

#include "app/base/interrupt.h"
#include "app/base/printable.h"
#include "app/base/progress.h"
#include "app/figures/motions.h"

#include "sim/measures/statement.h"
#include "sim/trajectory/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

using Kind = RunOutcome::Kind;

const std::vector<std::string>& statement_names() {
  static const std::vector<std::string> names{"steps",         "rejected",   "iterations",  "error_steps",
                                              "error_degrees", "area_error", "volume_error"};
  return names;
}

std::vector<double> statement_of(const std::vector<sim::StepRecord>& steps) {
  const sim::ErrorStatement e = sim::stated_errors(steps);
  double rejected = 0, iterations = 0;
  for (const sim::StepRecord& step : steps) {
    rejected += step.retries;
    iterations += step.iterations;
  }
  const auto count = static_cast<double>(steps.size());
  return {count, rejected, steps.empty() ? 0 : iterations / count, e.time, e.degrees, e.area, e.volume};
}

/// Values of results in one run; NaN for a vesicle that it lacks.
std::vector<std::pair<std::string, double>> results_of(const FigureSource& source,
                                                       const std::vector<AskedResult>& asked) {
  std::vector<std::pair<std::string, double>> named;
  for (const ResultValues& result : values_of({source}, asked))
    if (!result.from_last_run) named.emplace_back(without_braces(result.name), result.values.front());
  return named;
}

std::string exact(double value) { return std::isnan(value) ? "nan" : fmt::format("{}", value); }

std::string few_digits(double value) {
  if (std::isnan(value)) return "-";
  if (value != 0 && (std::abs(value) < 1e-3 || std::abs(value) >= 1e6)) return scientific(value);
  return fmt::format("{:.5g}", value);
}

std::string_view word_of(Kind kind) {
  switch (kind) {
    case Kind::finished:
      return "finished";
    case Kind::stopped:
      return "stopped";
    case Kind::missing:
      return "missing";
  }
  return {};
}

}  // namespace

SweepTable table_of(const std::vector<SweepAxis>& axes, const std::vector<SweepRun>& runs,
                    const std::vector<RunOutcome>& outcomes, const std::vector<AskedResult>& asked, bool quiet) {
  SweepTable table;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    table.axes.push_back(axes[a].key);
    table.short_axes.push_back(short_name(axes, a));
  }
  visit(VesicleMotion{}, [&](const char* name, const char*, double) { table.measures.emplace_back(name); });
  table.measures.insert(table.measures.end(), statement_names().begin(), statement_names().end());
  Progress progress("measuring", quiet);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    stop_if_interrupted();
    progress.show(static_cast<double>(r) / static_cast<double>(runs.size()), runs[r].point.name);
    const SweepRun& run = runs[r];
    SweepRow row;
    row.values = run.point.values;
    row.outcome = outcomes[r];
    if (row.outcome.kind == Kind::missing) {
      row.measures.assign(table.measures.size(), std::nan(""));
      table.rows.push_back(std::move(row));
      continue;
    }
    const sim::TrajectoryReader file(run.trajectory);
    const std::vector<VesicleMotion> motions = motions_with_means(file, run.settings.scene);
    const std::vector<double> statement = statement_of(file.steps());
    const auto results = asked.empty() ? std::vector<std::pair<std::string, double>>{}
                                       : results_of({file, run.settings, {}, run.trajectory.string()}, asked);
    row.vesicles = static_cast<int>(motions.size());
    for (std::size_t v = 0; v < motions.size(); ++v) {
      row.vesicle = static_cast<int>(v);
      const bool told = motions[v].motion != sim::AxisMotion::untold;
      row.motion = told ? std::string(sim::name_of(motions[v].motion)) : "untold";
      if (!told && table.why_untold.empty()) table.why_untold = motions[v].why;
      row.measures.clear();
      visit(motions[v], [&](const char*, const char*, double value) { row.measures.push_back(value); });
      row.measures.insert(row.measures.end(), statement.begin(), statement.end());
      row.asked.assign(table.asked.size(), std::nan(""));
      // Results of another vesicle are in its own row.
      const std::string own = fmt::format("vesicle.{}.", v);
      for (const auto& [name, value] : results) {
        if (name.starts_with("vesicle.") && !name.starts_with(own)) continue;
        const std::string column = name.starts_with(own) ? name.substr(own.size()) : name;
        auto at = std::find(table.asked.begin(), table.asked.end(), column);
        if (at == table.asked.end()) at = table.asked.insert(at, column);
        const auto k = static_cast<std::size_t>(at - table.asked.begin());
        if (row.asked.size() <= k) row.asked.resize(k + 1, std::nan(""));
        row.asked[k] = value;
      }
      table.rows.push_back(row);
    }
  }
  for (SweepRow& row : table.rows) row.asked.resize(table.asked.size(), std::nan(""));
  return table;
}

TextTable full_table(const SweepTable& table) {
  TextTable text;
  text.columns = table.axes;
  text.columns.insert(text.columns.end(), {"vesicle", "state", "time", "motion"});
  text.columns.insert(text.columns.end(), table.measures.begin(), table.measures.end());
  text.columns.insert(text.columns.end(), table.asked.begin(), table.asked.end());
  text.columns.emplace_back("reason");
  for (const SweepRow& row : table.rows) {
    std::vector<std::string> cells = row.values;
    cells.insert(cells.end(), {fmt::format("{}", row.vesicle), std::string(word_of(row.outcome.kind)),
                               exact(row.outcome.time), row.motion});
    for (const double value : row.measures) cells.push_back(exact(value));
    for (const double value : row.asked) cells.push_back(exact(value));
    cells.push_back(printable(row.outcome.reason));
    text.rows.push_back(std::move(cells));
  }
  return text;
}

TextTable short_table(const SweepTable& table) {
  constexpr std::string_view wanted[] = {"period", "angle_mean", "frequency", "intrinsic_viscosity", "error_steps"};
  std::vector<std::size_t> columns;
  for (std::size_t k = 0; k < table.measures.size(); ++k)
    if (std::find(std::begin(wanted), std::end(wanted), table.measures[k]) != std::end(wanted) &&
        std::any_of(table.rows.begin(), table.rows.end(),
                    [k](const SweepRow& row) { return std::isfinite(row.measures[k]); }))
      columns.push_back(k);
  const bool several =
      std::any_of(table.rows.begin(), table.rows.end(), [](const SweepRow& row) { return row.vesicles > 1; });
  TextTable text;
  text.columns = table.short_axes;
  if (several) text.columns.emplace_back("vesicle");
  text.columns.emplace_back("motion");
  for (const std::size_t k : columns) text.columns.push_back(table.measures[k]);
  text.columns.insert(text.columns.end(), table.asked.begin(), table.asked.end());
  for (const SweepRow& row : table.rows) {
    std::vector<std::string> cells = row.values;
    if (several) cells.push_back(fmt::format("{}", row.vesicle));
    if (row.outcome.kind == Kind::finished)
      cells.push_back(row.motion);
    else if (row.outcome.kind == Kind::stopped)
      cells.push_back(fmt::format("{}, stopped at {:.4g}", row.motion, row.outcome.time));
    else
      cells.emplace_back("not made");
    for (const std::size_t k : columns) cells.push_back(few_digits(row.measures[k]));
    for (const double value : row.asked) cells.push_back(few_digits(value));
    text.rows.push_back(std::move(cells));
  }
  return text;
}

}  // namespace app
