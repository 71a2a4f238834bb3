#include "render/core/style.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace render {

const std::vector<StyleRow>& styles() {
  static const std::vector<StyleRow> rows{
      {"opaque", "solid membranes with grid lines and tracer dots", "", true, true, true, false, false, false, true},
      {"plain", "solid membranes, tracer dots, no lines", "", false, true, true, false, false, false, true},
      {"checker", "patches two spacings of the grid wide", "CHECKER", false, false, true, false, false, false, true},
      {"meridian", "grid lines with one meridian and the equator in red", "MARKS", true, false, true, false, false,
       false, true},
      {"outline", "white membranes with lines and contours only, for print", "FLAT", true, true, false},
      {"ghost", "see-through membranes, lines of the far side visible", "GHOST", true, true, true, true},
      {"field", "a scalar on the membrane, to be read off a colour bar", "FIELD", true, false, true, false, true},
      {"cutaway", "a plane opens the membranes, their section is drawn as a line", "CUTAWAY", true, true, true, false,
       false, true},
  };
  return rows;
}

const StyleRow& find_style(std::string_view name) {
  if (const StyleRow* row = sim::find_row(styles(), name)) return *row;
  throw std::invalid_argument("unknown style '" + std::string(name) + "'" +
                              sim::suggestion(name, sim::row_names(styles())));
}

Colour sign_dot_colour(const Colour& c) {
  const bool light = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b > 0.33;
  const auto channel = [&](double v) { return light ? 0.35 * v : v + 0.6 * (1 - v); };
  return {channel(c.r), channel(c.g), channel(c.b)};
}

double sign_dot_spacing(int height) { return std::max(SignDots::spacing * height / 1080, SignDots::least); }

std::string body_defines(const StyleRow& style, const ViewParameters& view, bool grid, bool sparse, bool tracers,
                         bool sign_dots, bool occluded) {
  std::string text;
  std::istringstream words{std::string(style.defines)};
  for (std::string word; words >> word;) text += "#define " + word + "\n";
  const bool checker = style.defines.find("CHECKER") != std::string_view::npos;
  int parallels = view.grid_parallels, meridians = view.grid_meridians;
  if (checker) {  // patches two spacings wide, an even number round the axis so that the colours alternate
    parallels = std::max(3, parallels / 2);
    meridians = std::max(4, meridians / 4 * 2);
  }
  const bool lines = style.grid && view.line_width > 0 && grid;
  if (lines) text += "#define GRID\n";
  if (lines && sparse) text += "#define SPARSE\n";
  if ((lines || checker) && parallels > 0) text += fmt::format("#define PARALLELS {}\n", parallels);
  if ((lines || checker) && meridians > 0) {
    const int middle = meridians % 2 == 0 ? 2 : 1;
    const int cap = meridians % 4 == 0 ? meridians / 4 : middle;
    const double spacing = parallels > 0 ? std::numbers::pi / (parallels + 1) : std::numbers::pi / 12;
    text += fmt::format("#define MERIDIANS {}\n#define CAP_STEP {}\n#define MIDDLE_STEP {}\n", meridians,
                        std::max(cap, middle), middle);
    text += fmt::format("#define CAP_THETA {:.9f}\n#define MIDDLE_THETA {:.9f}\n", spacing, 2 * spacing);
  }
  if (style.field && sign_dots)
    text += fmt::format("#define SIGN_DOTS\n#define DOT_RADIUS {}\n#define DOT_FULL {}\n", SignDots::radius,
                        SignDots::full);
  if (occluded) text += "#define OCCLUDED\n";
  if (view.outline_width > 0) text += "#define CONTOUR\n";
  if (style.tracers && view.tracers && tracers) text += "#define TRACERS\n";
  return text;
}

}  // namespace render
