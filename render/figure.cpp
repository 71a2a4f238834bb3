#include "figure.h"

#include "figure_kinds.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace render {

const std::vector<FigureRow>& figures() {
  static const std::vector<FigureRow> rows{
      {"cross-sections", "sections with the plane y = const through each centroid, one panel an instant", false,
       draw_cross_sections},
      {"overlay", "the same sections over each other in one panel, coloured by time", false, draw_overlay},
      {"inclination", "angle between the flow and the longest axis in the shear plane against time", true, draw_inclination},
      {"time-series", "diagnostics against time", true, draw_time_series},
  };
  return rows;
}

const FigureRow& find_figure(std::string_view name) {
  if (const FigureRow* row = sim::find_row(figures(), name)) return *row;
  throw std::invalid_argument("unknown figure '" + std::string(name) + "'" +
                              sim::suggestion(name, sim::row_names(figures())));
}

std::vector<std::size_t> chosen_states(const std::vector<double>& state_times, const FigureParameters& parameters) {
  std::vector<std::size_t> chosen;
  const std::size_t count = state_times.size();
  if (count == 0) return chosen;
  if (!parameters.times.empty()) {
    for (const double time : parameters.times) {
      const auto nearest = std::min_element(state_times.begin(), state_times.end(),
                                            [&](double a, double b) { return std::abs(a - time) < std::abs(b - time); });
      chosen.push_back(static_cast<std::size_t>(nearest - state_times.begin()));
    }
    return chosen;
  }
  const std::size_t panels = std::clamp<std::size_t>(static_cast<std::size_t>(std::max(parameters.panels, 1)), 1, count);
  for (std::size_t k = 0; k < panels; ++k) {
    const double place = panels == 1 ? 0 : static_cast<double>(k * (count - 1)) / static_cast<double>(panels - 1);
    chosen.push_back(static_cast<std::size_t>(std::lround(place)));
  }
  return chosen;
}

std::vector<std::filesystem::path> write_figure(const Figure& figure, const std::filesystem::path& stem) {
  const auto with = [&](const char* extension) { return std::filesystem::path(stem.string() + extension); };
  const std::vector<std::filesystem::path> paths{with(".png"), with(".svg"), with(".pdf"), with(".csv")};
  write_drawing_png(paths[0], figure.drawing);
  write_drawing_svg(paths[1], figure.drawing);
  write_drawing_pdf(paths[2], figure.drawing);
  write_text(paths[3], figure.csv);
  return paths;
}

}  // namespace render
