#include "render/figures/figure.h"

#include "render/figures/figure_kinds.h"

#include "sim/core/digits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace render {

const std::vector<FigureRow>& figures() {
  static const std::vector<FigureRow> rows{
      {"cross-sections", "sections with a plane, one panel an instant", FigureNeeds::instants, draw_cross_sections},
      {"overlay", "the same sections over each other in one panel, coloured by time", FigureNeeds::instants,
       draw_overlay},
      {"snapshots", "a sheet of pictures at one scale, one panel an instant", FigureNeeds::stills, draw_snapshots},
      {"streamlines", "streamlines in a plane, of the whole flow, over its speed there (the part along the plane)",
       FigureNeeds::flow, draw_streamlines},
      {"inclination",
       "angle between the flow and the longest axis in the shear plane against time, continued over ±90°",
       FigureNeeds::series, draw_time_series},
      {"time-series", "chosen quantities against time, one panel each", FigureNeeds::series, draw_time_series},
      {"phase", "one quantity against another in the course of time", FigureNeeds::plots, draw_plots},
      {"spectra", "position and mean curvature, degree by degree", FigureNeeds::plots, draw_plots},
      {"tank-treading",
       "angle and frequency of tank-treading against reduced volume, one trajectory a point, beside the literature",
       FigureNeeds::plots, draw_plots},
      {"pair-distribution",
       "how many pairs of vesicles of a periodic cell are at each distance, over those of points at random, mean over "
       "a "
       "time",
       FigureNeeds::plots, draw_plots},
      {"phase-diagram",
       "motion of vesicles over two parameters in which their scenes differ, with their sections in the course of it",
       FigureNeeds::diagram, draw_phase_diagram},
  };
  return rows;
}

const FigureRow& find_figure(std::string_view name) {
  if (const FigureRow* row = sim::find_row(figures(), name)) return *row;
  throw std::invalid_argument("unknown figure '" + std::string(name) + "'" +
                              sim::suggestion(name, sim::row_names(figures())));
}

double dots_per_inch(const FigureParameters& p) { return p.dots_per_inch.value_or(p.unit == "px" ? 200 : 300); }

Page page_of(const FigureParameters& p) {
  Page page{find_theme(p.theme), 0, 0};
  const double points = p.unit == "px" ? 72 / dots_per_inch(p) : 72 / 25.4;
  if (p.size.size() > 2) throw std::invalid_argument("a figure's size is a width, or a width and a height");
  if (!p.size.empty()) page.width = p.size[0] * points;
  if (p.size.size() == 2) page.height = p.size[1] * points;
  if (p.size.empty()) page.height = page.theme.height;
  // A slide is shown as large as the screen whatever its size: its text goes with the page. Print has text of one size,
  // but for pages too narrow for it.
  double font_size = p.font_size;
  if (font_size == 0 && page.width > 0)
    font_size = page.theme.height > 0 ? page.theme.text * page.width / page.theme.width
                                      : std::min(page.theme.text, page.width / 24);
  page.theme = on_ground_named(find_theme(p.theme, font_size), p.ground);
  page.theme.family = p.font == "serif" ? FontFamily::serif : FontFamily::sans;
  return page;
}

Drawing drawing_on(const Theme& theme, const FigureParameters& p, double width, double height,
                   std::function<void(cairo_t*, const Font&)> paint) {
  Drawing drawing;
  drawing.width = width;
  drawing.height = height;
  drawing.paint = std::move(paint);
  drawing.ground = theme.ground;
  drawing.dots_per_inch = dots_per_inch(p);
  drawing.transparent = theme.transparent;
  drawing.family = theme.family;
  drawing.outlines = p.text == "paths";
  return drawing;
}

Marker group_marker(std::size_t group) {
  constexpr std::array markers{Marker::dot, Marker::square, Marker::triangle, Marker::diamond, Marker::ring};
  return markers[group % markers.size()];
}

std::vector<double> chosen_times(const std::vector<double>& state_times, const FigureParameters& parameters) {
  const std::size_t count = state_times.size();
  if (count == 0) return {};
  for (const double time : parameters.times) {
    const double end = state_times.back();
    if (time >= 0 && time <= end * (1 + 1e-9)) continue;
    const auto [last, wanted] = sim::told_apart(end, time, 6);
    throw std::invalid_argument(
        fmt::format("the trajectory goes from t = 0 to t = {}; there is no t = {} for figure.times", last, wanted));
  }
  if (!parameters.times.empty()) return parameters.times;
  std::vector<double> chosen;
  const std::size_t panels =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::max(parameters.panels, 1)), 1, count);
  for (std::size_t k = 0; k < panels; ++k) {
    const double place = panels == 1 ? 0 : static_cast<double>(k * (count - 1)) / static_cast<double>(panels - 1);
    chosen.push_back(state_times[static_cast<std::size_t>(std::lround(place))]);
  }
  return chosen;
}

CutPlane plane_of(const FigureParameters& p, const sim::Vec3& centroid) {
  if (!p.plane_point.empty() && p.plane_point.size() != 3)
    throw std::invalid_argument("a figure's plane_point is a list of three numbers, or empty");
  if (!(p.plane_normal.norm() > 0)) throw std::invalid_argument("a figure's plane_normal must not vanish");
  CutPlane plane;
  plane.origin = p.plane_point.empty() ? centroid : sim::Vec3(p.plane_point[0], p.plane_point[1], p.plane_point[2]);
  plane.normal = p.plane_normal.normalized();
  const sim::Vec3 along = std::abs(plane.normal.x()) > 0.9 ? sim::Vec3::UnitY() : sim::Vec3::UnitX();
  plane.right = (along - along.dot(plane.normal) * plane.normal).normalized();
  plane.up = plane.right.cross(plane.normal);
  Eigen::Index largest = 0;
  plane.up.cwiseAbs().maxCoeff(&largest);
  if (plane.up[largest] < 0) plane.up = -plane.up;
  return plane;
}

std::pair<std::string, std::string> axis_names(const CutPlane& plane) {
  const auto name = [](const sim::Vec3& v, const char* oblique) -> std::string {
    constexpr std::array<const char*, 3> names{"x", "y", "z"};
    for (std::size_t k = 0; k < 3; ++k)
      if (v[static_cast<Eigen::Index>(k)] > 1 - 1e-9) return names[k];
    return oblique;
  };
  return {name(plane.right, "ξ"), name(plane.up, "η")};
}

std::string time_text(const FigureInput& input, double time) {
  if (time == 0) return fmt::format("{} = 0", input.time_symbol);
  // Four digits, two after the point for numbers above 1; more where instants lie closer.
  const double size = std::floor(std::log10(std::abs(time)));
  double place = std::abs(time) < 1 ? size - 3 : std::max(size - 9, -2.0);
  std::vector<double> times;
  for (const sim::State& state : input.states) times.push_back(input.time_factor * state.time);
  std::sort(times.begin(), times.end());
  for (std::size_t k = 1; k < times.size(); ++k)
    if (times[k] > times[k - 1]) place = std::min(place, std::floor(std::log10(times[k] - times[k - 1])) - 1);
  place = std::max(place, size - 11);  // beyond it rounding errors of sums of steps
  const double unit = std::pow(10.0, std::abs(place));
  const double shown = place < 0 ? std::round(time * unit) / unit : std::round(time / unit) * unit;
  return fmt::format("{} = {}", input.time_symbol, number_text(shown, 12));
}

std::string letter(std::size_t k) {
  std::string name = k < 26 ? std::string() : letter(k / 26 - 1);
  name.push_back(static_cast<char>('a' + k % 26));
  return name;
}

Colour colour_of_time(double t) {
  constexpr std::array<Colour, 4> stops{
      {{0.10, 0.17, 0.42}, {0.00, 0.45, 0.62}, {0.20, 0.66, 0.45}, {0.93, 0.62, 0.13}}};
  return between(stops, t);
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::filesystem::path> write_figure(const Figure& figure, const std::filesystem::path& stem,
                                                const PngText& text, const sim::FileWriter& write) {
  std::vector<std::filesystem::path> paths;
  for (const char* extension : figure_extensions) paths.emplace_back(stem.string() + extension);
  write_drawing_png(paths[0], figure.drawing, text, write);
  write_drawing_svg(paths[1], figure.drawing, write);
  write_drawing_pdf(paths[2], figure.drawing, write);
  write(paths[3], figure.csv);
  return paths;
}

}  // namespace render
