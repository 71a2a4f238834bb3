#include "app/export/csv.h"

#include "app/figures/motions.h"
#include "app/figures/samples.h"

#include "sim/measures/diagnostics.h"

#include <fmt/format.h>

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

namespace {

std::string header_row(const std::vector<CsvColumn>& columns) {
  std::string text;
  for (const CsvColumn& column : columns) text += (text.empty() ? "" : ",") + column.name;
  return text + '\n';
}

}  // namespace

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
  std::vector<sim::VesicleMeasures> initial;
  if (first < end)
    for (const sim::VesicleState& v : trajectory.state(0).vesicles) initial.push_back(sim::measure(plans, v, 1, 1));
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
