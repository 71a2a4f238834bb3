#include "render/figures/theme.h"

#include "render/core/ground.h"

#include <array>
#include <stdexcept>

namespace render {

namespace {

/// Ink that is read on that ground, and lines that are seen.
Theme with_ground(Theme theme, const Colour& ground) {
  const Theme light;
  theme.ground = ground;
  theme.transparent = false;
  if (theme.is_dark()) {
    theme.ink = {0.93, 0.94, 0.96};
    theme.soft = {0.62, 0.65, 0.70};
  } else {
    theme.ink = light.ink;
    theme.soft = light.soft;
  }
  const auto towards_ink = [&](double from, double to) { return from + 0.11 * (to - from); };
  theme.faint = ground == white ? light.faint
                                : Colour{towards_ink(ground.r, theme.ink.r), towards_ink(ground.g, theme.ink.g),
                                         towards_ink(ground.b, theme.ink.b)};
  return theme;
}

std::vector<Theme> rows() {
  const Theme slides{.name = "slides",
                     .meaning = "for a talk: white, heavy lines, large text, a page of 16:9",
                     .text = 18,
                     .label = 21,
                     .line = 1.6,
                     .stroke = 3.2,
                     .tick = 9,
                     .width = 960,
                     .height = 540};
  Theme dark = with_ground(slides, ground_of("dark").mean());
  dark.name = "dark";
  dark.meaning = "for a talk in a dark room: light ink on a dark ground, a page of 16:9";
  return {{.name = "paper", .meaning = "for print: white, fine lines, text of 9 pt, 180 mm wide"}, slides, dark};
}

}  // namespace

const std::vector<Theme>& themes() {
  static const std::vector<Theme> table = rows();
  return table;
}

Theme find_theme(std::string_view name, double font_size) {
  const Theme* row = sim::find_row(themes(), name);
  if (!row)
    throw std::invalid_argument("unknown theme '" + std::string(name) + "'" +
                                sim::suggestion(name, sim::row_names(themes())));
  Theme theme = *row;
  return font_size > 0 ? scaled(theme, font_size / theme.text) : theme;
}

Theme scaled(Theme theme, double factor) {
  for (double* size : {&theme.text, &theme.label, &theme.line, &theme.stroke, &theme.tick}) *size *= factor;
  return theme;
}

Theme on_ground_named(Theme theme, std::string_view ground) {
  if (ground == "theme") return theme;
  const Ground named = ground_of(ground, {"theme"});
  if (!named.transparent) return with_ground(theme, named.mean());
  theme.transparent = true;  // the ink is that of the theme
  return theme;
}

Colour on_ground(const Theme& theme, const Colour& c) {
  if (!theme.is_dark()) return c;
  if (c == Colour{}) return theme.ink;
  const auto lighter = [](double v) { return 0.70 * v + 0.30; };
  return {lighter(c.r), lighter(c.g), lighter(c.b)};
}

Colour vesicle_colour(const Theme& theme, std::size_t vesicle) {
  constexpr std::array<std::size_t, 7> hues{1, 0, 4, 2, 3, 6, 5};  // coral, sky, amber, green, lilac, slate...
  return curve_colour(theme, hues[vesicle % hues.size()]);
}

Colour curve_colour(const Theme& theme, std::size_t curve) { return on_ground(theme, render::curve_colour(curve)); }

}  // namespace render
