// A study as a figure: errors against what is varied.
#include "app/converge/study.h"

#include "render/figures/panel_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace app {

namespace {

/// Rows with one label share a panel: vesicles, components of a position.
struct Group {
  std::string label;
  std::vector<const StudyRow*> rows;
};

/// Those with two errors at least.
std::vector<Group> groups_of(const Study& study) {
  std::vector<Group> groups;
  for (const StudyRow& row : study.rows) {
    std::size_t drawn = 0;
    for (std::size_t k = 0; k < study.runs.size(); ++k)
      drawn += row.convergence.known(k) && row.convergence.errors[k] > 0 ? 1 : 0;
    if (drawn < 2) continue;
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.label == row.result.label; });
    if (group == groups.end()) group = groups.insert(groups.end(), {row.result.label, {}});
    group->rows.push_back(&row);
  }
  return groups;
}

/// What tells a row from the others of its panel: "vesicle 1, x_{c}".
std::string distinction(const std::string& name) {
  std::string text;
  if (name.starts_with("vesicle.")) text = "vesicle " + name.substr(8, name.find('.', 8) - 8);
  if (const std::size_t space = name.find(' '); space != std::string::npos)
    text += (text.empty() ? "" : ", ") + name.substr(space + 1);
  if (const std::size_t colon = name.find(':'); colon != std::string::npos)
    text += (text.empty() ? "" : ", ") + name.substr(colon + 1, name.find(' ', colon) - colon - 1);
  return text;
}

std::string legend_of(const Study& study, const StudyRow& row, bool alone) {
  const std::string which = alone ? std::string() : distinction(row.result.name);
  std::string text;
  if (row.convergence.order) {
    const double q = *row.convergence.order;
    text = study.what.falls ? fmt::format("observed order {:.2f}", q) : fmt::format("÷ {:.2f} a degree", std::exp(q));
  } else {
    text = text_of(row.convergence.verdict);
  }
  return which.empty() ? text : fmt::format("{}: {}", which, text);
}

/// A line of the order of theory through the first point of the curve.
render::Curve guide(const Study& study, const render::Curve& curve, double order) {
  render::Curve line;
  line.part = fmt::format("order {:g} of theory", order);
  line.csv_name = line.part;
  line.dash = 1;
  line.colour = curve.colour;
  const double h0 = study.what.smallness(curve.x.front());
  for (const StudyRun& run : study.runs) {
    line.x.push_back(run.value);
    line.y.push_back(curve.y.front() * std::pow(study.what.smallness(run.value) / h0, order));
  }
  return line;
}

/// All values with a margin, in the coordinates of the axis.
render::Range window_of(std::vector<double> varied, bool logarithmic) {
  if (logarithmic)
    for (double& value : varied) value = std::log10(value);
  const auto [low, high] = std::minmax_element(varied.begin(), varied.end());
  const double margin = 0.08 * (*high - *low);
  // On a logarithmic axis down to a decade, so that there is a number.
  double left = *low - margin, right = *high + margin;
  if (logarithmic && std::floor(right) < std::ceil(left)) left = std::floor(left);
  return {left, right};
}

}  // namespace

render::Figure figure_of(const Study& study, const render::FigureParameters& parameters) {
  const std::optional<double> expected = study.what.expected(study.scene.scene);
  render::FigureInput input;
  input.parameters = parameters;
  std::vector<double> varied;
  for (const StudyRun& run : study.runs) varied.push_back(run.value);
  const render::Range window = window_of(varied, study.what.falls);
  constexpr std::array full{render::Marker::dot, render::Marker::square, render::Marker::triangle,
                            render::Marker::diamond};
  std::vector<render::Plot> plots;
  std::size_t colours = 0;
  for (const Group& group : groups_of(study)) {
    render::Plot plot;
    plot.x = {.label = std::string(study.what.symbol),
              .scale = study.what.falls ? render::Scale::logarithmic : render::Scale::linear,
              .grid = true};
    plot.y = {.label = "error of " + group.label, .scale = render::Scale::logarithmic, .grid = true};
    plot.x_range = window;
    for (const StudyRow* row : group.rows) {
      const Convergence& c = row->convergence;
      render::Curve curve;
      curve.part = legend_of(study, *row, group.rows.size() == 1);
      curve.csv_name = row->result.name;
      curve.colour = colours++;  // one colour one result, over all panels
      curve.line = c.limit.has_value();
      curve.marker = c.limit ? full[plot.curves.size() % full.size()] : render::Marker::ring;
      for (std::size_t k = 0; k < study.runs.size(); ++k) {
        if (!c.known(k) || !(c.errors[k] > 0)) continue;
        curve.x.push_back(study.runs[k].value);
        curve.y.push_back(c.errors[k]);
      }
      plot.curves.push_back(std::move(curve));
    }
    if (expected) plot.curves.push_back(guide(study, plot.curves.front(), *expected));
    plots.push_back(std::move(plot));
  }
  if (plots.empty()) return {};
  input.parameters.columns = plots.size() == 1 ? 1 : 2;
  return render::arranged(input, plots, false, csv_of(study));
}

}  // namespace app
