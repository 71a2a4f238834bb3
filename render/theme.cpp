#include "theme.h"

#include <stdexcept>

namespace render {

const std::vector<Theme>& themes() {
  static const std::vector<Theme> rows{
      {.name = "paper", .meaning = "for print: white, fine lines, text of 9 pt, 180 mm wide"},
      {.name = "slides",
       .meaning = "for a talk: white, heavy lines, large text, a page of 16:9",
       .text = 18,
       .label = 21,
       .line = 1.6,
       .stroke = 3.2,
       .tick = 9,
       .width = 960,
       .height = 540},
      {.name = "dark",
       .meaning = "for a talk in a dark room: light ink on a dark ground, a page of 16:9",
       .text = 18,
       .label = 21,
       .line = 1.6,
       .stroke = 3.2,
       .tick = 9,
       .width = 960,
       .height = 540,
       .ground = {0.09, 0.10, 0.13},
       .ink = {0.93, 0.94, 0.96},
       .soft = {0.62, 0.65, 0.70},
       .faint = {0.20, 0.22, 0.26}},
  };
  return rows;
}

Theme find_theme(std::string_view name, double font_size) {
  const Theme* row = sim::find_row(themes(), name);
  if (!row)
    throw std::invalid_argument("unknown theme '" + std::string(name) + "'" + sim::suggestion(name, sim::row_names(themes())));
  Theme theme = *row;
  if (font_size > 0) {
    const double factor = font_size / theme.text;
    for (double* size : {&theme.text, &theme.label, &theme.line, &theme.stroke, &theme.tick}) *size *= factor;
  }
  return theme;
}

}  // namespace render
