#include "render/overlay/colour_bar.h"

#include "render/core/places.h"
#include "render/core/style.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace render {
BarSizes bar_sizes(int picture_height) {
  const OverlaySizes sizes = overlay_sizes(picture_height);
  return {.width = std::round(std::max(22 * sizes.unit, 6.0)),
          .text = sizes.small,
          .tick = std::max(7 * sizes.unit, 3.0),
          .gap = std::max(6 * sizes.unit, 2.5)};
}

std::vector<double> bar_ticks(double low, double high) {
  std::vector<double> ticks;
  if (!(high > low)) return {low};
  const double rough = (high - low) / 5, power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.5, 2.0, 1.0})
    if (factor * power >= rough * (1 - 1e-9)) step = factor * power;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
    if (k + 1 == k || (!ticks.empty() && !(k * step > ticks.back()))) break;  // finer than double precision
    ticks.push_back(k == 0 ? 0 : k * step);
  }
  return ticks;
}

void draw_colour_bar(Image& image, const Font& font, const Inks& inks, const Legend& legend, const Box& bar,
                     bool sign_dots) {
  const BarSizes s = bar_sizes(image.height);
  const double margin = std::min(overlay_sizes(image.height).margin, image.width / 12.0);
  const double point = 0.9 * bar.width();  // of the ends
  const double label = bar.top - (legend.above ? point : 0) - 0.8 * s.text;
  const int from = static_cast<int>(0.5 * image.width);
  draw_on(
      image,
      {from, static_cast<int>(label - 1.6 * s.text), image.width - from,
       static_cast<int>(bar.height() + 2 * point + 5 * s.text)},
      [&](cairo_t* cairo) {
        // Row by row in whole pixels: the colour of a row is that of its value.
        cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE);
        for (int row = 0; row < static_cast<int>(bar.height()); ++row) {
          set_colour(cairo, mapped(legend.colours, 1 - (row + 0.5) / bar.height()));
          cairo_rectangle(cairo, bar.left, bar.top + row, bar.width(), 1);
          cairo_fill(cairo);
        }
        cairo_set_antialias(cairo, CAIRO_ANTIALIAS_DEFAULT);
        const double middle = bar.left + bar.width() / 2, bottom = bar.bottom;
        const auto end = [&](double y, double tip, double share) {
          set_colour(cairo, mapped(legend.colours, share));
          cairo_move_to(cairo, bar.left, y);
          cairo_line_to(cairo, middle, tip);
          cairo_line_to(cairo, bar.left + bar.width(), y);
          cairo_close_path(cairo);
          cairo_fill(cairo);
        };
        if (legend.above) end(bar.top, bar.top - point, 1);
        if (legend.below) end(bottom, bottom + point, 0);
        if (sign_dots) {
          const double spacing = bar.width() / std::max(1.0, std::round(bar.width() / sign_dot_spacing(image.height)));
          for (double y = bar.top + bar.height() / 2 + spacing / 2; y < bottom; y += spacing)
            for (double x = bar.left + spacing / 2; x < bar.left + bar.width(); x += spacing) {
              const double share = (bottom - y) / bar.height(), shown = std::min((0.5 - share) / SignDots::full, 1.0);
              set_colour(cairo, sign_dot_colour(mapped(legend.colours, share)));
              cairo_arc(cairo, x, y, SignDots::radius * spacing * shown, 0, 2 * std::numbers::pi);
              cairo_fill(cairo);
            }
        }
        set_colour(cairo, inks.text);
        cairo_set_line_width(cairo, std::max(1.5 * image.height / 1080.0, 0.8));
        cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
        cairo_move_to(cairo, bar.left, bottom);
        cairo_line_to(cairo, bar.left, bar.top);
        cairo_line_to(cairo, middle, legend.above ? bar.top - point : bar.top);
        cairo_line_to(cairo, bar.left + bar.width(), bar.top);
        cairo_line_to(cairo, bar.left + bar.width(), bottom);
        cairo_line_to(cairo, middle, legend.below ? bottom + point : bottom);
        cairo_close_path(cairo);
        cairo_stroke(cairo);
        const std::vector<double> ticks = bar_ticks(legend.low, legend.high);
        const std::vector<std::string> texts = number_texts(ticks);
        for (std::size_t k = 0; k < ticks.size(); ++k) {
          const double value = ticks[k];
          const double y = bottom - (value - legend.low) / (legend.high - legend.low) * bar.height();
          set_colour(cairo, inks.text);
          cairo_move_to(cairo, bar.left + bar.width(), y);
          cairo_line_to(cairo, bar.left + bar.width() + s.tick, y);
          cairo_stroke(cairo);
          draw_text_on_picture(cairo, font, inks.rim, s.text, bar.left + bar.width() + s.tick + s.gap,
                               y + 0.36 * s.text, texts[k]);
        }
        // centred above the bar as far as the edge of the picture allows
        const double width = text_width(cairo, font, 1.1 * s.text, legend.label);
        const double x = std::min(middle - width / 2, image.width - margin - width);
        draw_text_on_picture(cairo, font, inks.rim, 1.1 * s.text, x, label, legend.label);
      });
}

}  // namespace render
