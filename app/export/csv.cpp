#include "app/export/csv.h"

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
  return columns;
}

std::string csv_text(const sim::TrajectoryReader& trajectory, std::int64_t first, std::int64_t end) {
  std::string text;
  for (const CsvColumn& column : csv_columns()) text += (text.empty() ? "" : ",") + column.name;
  text += '\n';
  sim::Plans plans;
  std::vector<sim::VesicleMeasures> initial;
  if (first < end)
    for (const sim::VesicleState& v : trajectory.state(0).vesicles) initial.push_back(sim::measure(plans, v, 1, 1));
  for (std::int64_t k = first; k < end; ++k) {
    const sim::State state = trajectory.state(k);
    for (std::size_t v = 0; v < state.vesicles.size(); ++v) {
      const sim::VesicleMeasures m = sim::measure(plans, state.vesicles[v], initial[v].area, initial[v].volume);
      text += fmt::format("{},{},{}", state.step, state.time, v);
      visit(m, [&](const char*, const char*, double value) { text += fmt::format(",{}", value); });
      text += '\n';
    }
  }
  return text;
}

}  // namespace app
