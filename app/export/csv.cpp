#include "app/export/csv.h"

#include "app/figures/motions.h"
#include "app/figures/samples.h"

#include "sim/measures/diagnostics.h"
#include "sim/membrane/cell.h"

#include <fmt/format.h>

#include <stdexcept>

namespace app {

std::vector<CsvColumn> csv_columns() {
  std::vector<CsvColumn> columns{{"step", "number of the step that ended here"},
                                 {"time", "time of the state"},
                                 {"vesicle", "number of the vesicle, from 0"}};
  visit(sim::VesicleMeasures{}, [&](const char* name, const char* meaning, double) {
    columns.push_back({name, meaning});
  });
  visit(sim::FlowMeasures{}, [&](const char* name, const char* meaning, double) {
    columns.push_back({name, meaning});
  });
  columns.push_back(
      {"frequency",
       "angular frequency of the membrane round the section with the shear plane, relative to the turning "
       "shape, rad/time"});
  return columns;
}

std::vector<CsvColumn> motion_columns() {
  std::vector<CsvColumn> columns{{"vesicle", "number of the vesicle, from 0"},
                                 {"motion", "tank-treading, swinging, tumbling or untold"}};
  visit(VesicleMotion{}, [&](const char* name, const char* meaning, double) { columns.push_back({name, meaning}); });
  return columns;
}

std::vector<CsvColumn> suspension_columns() {
  std::vector<CsvColumn> columns{{"step", "number of the step that ended here"}, {"time", "time of the state"}};
  visit(sim::SuspensionMeasures{}, [&](const char* name, const char* meaning, double) {
    columns.push_back({name, meaning});
  });
  return columns;
}

std::vector<CsvColumn> pair_columns() {
  return {{"from", "distance of two centres at which the bin begins"},
          {"to", "... and ends; up to half of the cell's shortest side"},
          {"pairs", "number of pairs in the bin over that of points at random, images included"}};
}

namespace {

std::string header_row(const std::vector<CsvColumn>& columns) {
  std::string text;
  for (const CsvColumn& column : columns) text += (text.empty() ? "" : ",") + column.name;
  return text + '\n';
}

/// Measures of the vesicles in the first state, if there is any to write.
std::vector<sim::VesicleMeasures> first_measures(sim::Plans& plans, const sim::TrajectoryReader& trajectory, bool any) {
  std::vector<sim::VesicleMeasures> initial;
  if (any)
    for (const sim::VesicleState& v : trajectory.state(0).vesicles) initial.push_back(sim::measure(plans, v, 1, 1));
  return initial;
}

}  // namespace

std::string suspension_csv(const sim::TrajectoryReader& trajectory, const sim::Scene& scene, std::int64_t first,
                           std::int64_t end) {
  std::string text = header_row(suspension_columns());
  sim::Plans plans;
  const std::vector<sim::VesicleMeasures> initial = first_measures(plans, trajectory, first < end);
  for (std::int64_t k = first; k < end; ++k) {
    const sim::State state = trajectory.state(k);
    std::vector<VesicleSample> samples = samples_of(plans, state, initial);
    add_flow(plans, scene, state, Needs::forces, samples);
    text += fmt::format("{},{}", state.step, state.time);
    visit(whole_of(scene, samples, initial, Needs::forces),
          [&](const char*, const char*, double value) { text += fmt::format(",{}", value); });
    text += '\n';
  }
  return text;
}

std::string pairs_csv(const sim::TrajectoryReader& trajectory, const sim::Scene& scene, std::int64_t first,
                      std::int64_t end) {
  if (!scene.cell.size)
    throw std::invalid_argument("--pairs needs a scene with a periodic [cell]: elsewhere no density is known");
  constexpr int bins = 40;
  sim::PairDistribution pairs(*scene.cell.size, bins);
  sim::Plans plans;
  for (std::int64_t k = first; k < end; ++k) {
    const sim::State state = trajectory.state(k);
    std::vector<sim::Vec3> centres;
    for (const sim::VesicleState& v : state.vesicles) centres.push_back(sim::measure(plans, v, 1, 1).center);
    pairs.add(centres, *sim::cell_at(scene, state.time));
  }
  std::string text = header_row(pair_columns());
  for (const auto& row : pairs.rows()) text += fmt::format("{},{},{}\n", row.from, row.to, row.share);
  return text;
}

std::string motion_csv(const sim::TrajectoryReader& trajectory, const sim::Scene& scene) {
  std::string text = header_row(motion_columns());
  const std::vector<VesicleMotion> motions = motions_with_means(trajectory, scene);
  for (std::size_t v = 0; v < motions.size(); ++v) {
    text += fmt::format("{},{}", v, name_of(motions[v].motion));
    visit(motions[v], [&](const char*, const char*, double value) { text += fmt::format(",{}", value); });
    text += '\n';
  }
  return text;
}

std::string csv_text(const sim::TrajectoryReader& trajectory, const sim::Scene& scene, std::int64_t first,
                     std::int64_t end) {
  std::string text = header_row(csv_columns());
  sim::Plans plans;
  const std::vector<sim::VesicleMeasures> initial = first_measures(plans, trajectory, first < end);
  for (std::int64_t k = first; k < end; ++k) {
    const sim::State state = trajectory.state(k);
    std::vector<VesicleSample> samples;
    for (std::size_t v = 0; v < state.vesicles.size(); ++v)
      samples.push_back({sim::measure(plans, state.vesicles[v], initial[v].area, initial[v].volume)});
    add_flow(plans, scene, state, Needs::forces, samples);
    for (std::size_t v = 0; v < samples.size(); ++v) {
      text += fmt::format("{},{},{}", state.step, state.time, v);
      const auto add = [&](const char*, const char*, double value) { text += fmt::format(",{}", value); };
      visit(static_cast<const sim::VesicleMeasures&>(samples[v]), add);
      visit(samples[v].flow, add);
      add("", "", samples[v].frequency);
      text += '\n';
    }
  }
  return text;
}

}  // namespace app
