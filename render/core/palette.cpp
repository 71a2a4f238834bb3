#include "render/core/palette.h"

#include "sim/core/catalogue.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string>

namespace render {

Colour parse_colour(std::string_view text) {
  for (const ColourRow& row : body_colours())
    if (row.name == text) return row.colour;
  unsigned code = 0;
  if (text.size() == 7 && text[0] == '#')
    if (const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, code, 16);
        error == std::errc() && end == text.data() + 7)
      return {(code >> 16) / 255.0, (code >> 8 & 255) / 255.0, (code & 255) / 255.0};
  throw std::invalid_argument("'" + std::string(text) + "' is no known colour" +
                              sim::suggestion(text, sim::row_names(body_colours())) + ", and not #rrggbb");
}

Colour between(std::span<const Colour> stops, double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const double f = place - static_cast<double>(i);
  const auto mix = [&](double a, double b) { return a + f * (b - a); };
  return {mix(stops[i].r, stops[i + 1].r), mix(stops[i].g, stops[i + 1].g), mix(stops[i].b, stops[i + 1].b)};
}

}  // namespace render
