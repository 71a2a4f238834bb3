#include "reproduce_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

namespace app {

namespace {

constexpr double tick = 4.5, small_tick = 2.5;  // pt

/// Decades to write at: at most eight.
int decade_stride(const render::Range& range) { return std::max(1, static_cast<int>(std::ceil(range.size() / 8 - 1e-9))); }

template <class Mark>
void each_decade(const render::Range& range, Mark&& mark) {
  const int first = static_cast<int>(std::floor(range.low)), last = static_cast<int>(std::ceil(range.high));
  for (int decade = first; decade <= last; ++decade) mark(decade);
}

bool within(const render::Range& range, double v) { return v >= range.low - 1e-9 && v <= range.high + 1e-9; }

std::string power_text(int decade) { return fmt::format("10^{{{}{}}}", decade < 0 ? "−" : "", std::abs(decade)); }

void log_ticks(cairo_t* cairo, const render::Font& font, const render::Panel& p, bool horizontal, double& widest) {
  const render::Range& range = horizontal ? p.x : p.y;
  const int stride = decade_stride(range);
  const auto mark = [&](double v, double length) {
    if (!within(range, v)) return;
    if (horizontal) {
      cairo_move_to(cairo, p.page_x(v), p.top + p.height);
      cairo_rel_line_to(cairo, 0, -length);
    } else {
      cairo_move_to(cairo, p.left, p.page_y(v));
      cairo_rel_line_to(cairo, length, 0);
    }
    cairo_stroke(cairo);
  };
  each_decade(range, [&](int decade) {
    mark(decade, tick);
    if (stride == 1)
      for (int k = 2; k < 10; ++k) mark(decade + std::log10(k), small_tick);
    if (decade % stride != 0 || !within(range, decade)) return;
    if (horizontal)
      draw_text(cairo, font, render::tick_text, p.page_x(decade), p.top + p.height + 6 + render::tick_text,
                power_text(decade), render::Align::centre);
    else
      widest = std::max(widest, draw_text(cairo, font, render::tick_text, p.left - 5,
                                          p.page_y(decade) + 0.36 * render::tick_text, power_text(decade),
                                          render::Align::right));
  });
}

}  // namespace

void draw_log_axes(cairo_t* cairo, const render::Font& font, const render::Panel& panel, const render::AxisLabels& labels,
                   bool log_x, bool log_y) {
  cairo_set_source_rgb(cairo, 0.10, 0.10, 0.12);
  cairo_set_line_width(cairo, 0.9);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_BUTT);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_MITER);
  cairo_rectangle(cairo, panel.left, panel.top, panel.width, panel.height);
  cairo_stroke(cairo);
  double widest = 0;
  if (log_x) log_ticks(cairo, font, panel, true, widest);
  else
    for (const double v : render::tick_values(panel.x, labels.x_ticks)) {
      cairo_move_to(cairo, panel.page_x(v), panel.top + panel.height);
      cairo_rel_line_to(cairo, 0, -tick);
      cairo_stroke(cairo);
      draw_text(cairo, font, render::tick_text, panel.page_x(v), panel.top + panel.height + 4 + render::tick_text,
                render::number_text(v), render::Align::centre);
    }
  if (log_y) log_ticks(cairo, font, panel, false, widest);
  else
    for (const double v : render::tick_values(panel.y, labels.y_ticks)) {
      cairo_move_to(cairo, panel.left, panel.page_y(v));
      cairo_rel_line_to(cairo, tick, 0);
      cairo_stroke(cairo);
      widest = std::max(widest, draw_text(cairo, font, render::tick_text, panel.left - 5,
                                          panel.page_y(v) + 0.36 * render::tick_text, render::number_text(v),
                                          render::Align::right));
    }
  if (!labels.x.empty())
    draw_text(cairo, font, render::label_text, panel.left + panel.width / 2,
              panel.top + panel.height + 11 + render::tick_text + render::label_text, labels.x, render::Align::centre);
  if (labels.y.empty()) return;
  cairo_save(cairo);
  cairo_translate(cairo, panel.left - 12 - widest, panel.top + panel.height / 2);
  cairo_rotate(cairo, -std::numbers::pi / 2);
  draw_text(cairo, font, render::label_text, 0, 0, labels.y, render::Align::centre);
  cairo_restore(cairo);
}

void draw_dots(cairo_t* cairo, const render::Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
               const render::Colour& colour, double radius) {
  cairo_set_source_rgb(cairo, colour.r, colour.g, colour.b);
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!std::isfinite(x[k]) || !std::isfinite(y[k])) continue;
    cairo_new_path(cairo);
    cairo_arc(cairo, panel.page_x(x[k]), panel.page_y(y[k]), radius, 0, 2 * std::numbers::pi);
    cairo_fill(cairo);
  }
}

render::Range decades(const std::vector<double>& values) {
  double low = 1e300, high = 0;
  for (const double v : values)
    if (v > 0 && std::isfinite(v)) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  if (high == 0) return {0, 1};
  const render::Range range{std::floor(std::log10(low) + 1e-9), std::ceil(std::log10(high) - 1e-9)};
  return {range.low, std::max(range.high, range.low + 1)};
}

std::vector<double> logarithms(const std::vector<double>& values) {
  std::vector<double> logs;
  for (const double v : values) logs.push_back(v > 0 ? std::log10(v) : std::nan(""));
  return logs;
}

void draw_picture(cairo_t* cairo, const render::Image& image, double left, double top, double width, double height) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height);
  unsigned char* data = cairo_image_surface_get_data(surface);
  if (data == nullptr) {
    cairo_surface_destroy(surface);
    throw std::bad_alloc();
  }
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* c = image.at(x, y);
      const std::uint32_t v = static_cast<std::uint32_t>(c[0]) << 16 | static_cast<std::uint32_t>(c[1]) << 8 | c[2];
      std::memcpy(data + static_cast<std::ptrdiff_t>(y) * stride + 4 * static_cast<std::ptrdiff_t>(x), &v, sizeof v);
    }
  cairo_surface_mark_dirty(surface);
  cairo_save(cairo);
  cairo_translate(cairo, left, top);
  cairo_scale(cairo, width / image.width, height / image.height);
  cairo_set_source_surface(cairo, surface, 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo), CAIRO_FILTER_GOOD);
  cairo_rectangle(cairo, 0, 0, image.width, image.height);
  cairo_fill(cairo);
  cairo_restore(cairo);
  cairo_surface_destroy(surface);
}

}  // namespace app
