#include "render/figures/plot_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

namespace render {

namespace {

void clip_to(cairo_t* cairo, const Panel& p) {
  cairo_rectangle(cairo, p.left, p.top, p.width, p.height);
  cairo_clip(cairo);
}

}  // namespace

/// In units of the width of the line: on, off, on, off; the first is of a theory or a second quantity.
void set_dash(cairo_t* cairo, int dash, double width) {
  if (dash <= 0) return;
  constexpr double patterns[dash_count][4] = {
      {4, 2.6, 4, 2.6}, {1.2, 1.9, 1.2, 1.9}, {7, 2.2, 1.2, 2.2}, {9, 3, 9, 3}, {4, 2, 1.2, 2}};
  double lengths[4];
  for (int k = 0; k < 4; ++k) lengths[k] = width * patterns[(dash - 1) % dash_count][k];
  cairo_set_dash(cairo, lengths, 4, 0);
}

void draw_polyline(const Pen& pen, const Panel& p, const std::vector<double>& x, const std::vector<double>& y,
                   const Stroke& stroke) {
  cairo_t* cairo = pen.cairo;
  cairo_save(cairo);
  clip_to(cairo, p);
  cairo_new_path(cairo);
  bool down = false;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
      down = false;
      continue;
    }
    (down ? cairo_line_to : cairo_move_to)(cairo, p.page_x(x[i]), p.page_y(y[i]));
    down = true;
  }
  set_colour(pen, stroke.colour, stroke.opacity);
  const double width = stroke.width * pen.theme.stroke;
  cairo_set_line_width(cairo, width);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cairo, stroke.dash > 0 ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
  set_dash(cairo, stroke.dash, width);
  cairo_stroke(cairo);
  cairo_restore(cairo);
}

void draw_band(const Pen& pen, const Panel& p, const std::vector<double>& x, const std::vector<double>& y,
               const std::vector<double>& error, const Colour& colour) {
  constexpr double tint = 0.25;
  cairo_t* cairo = pen.cairo;
  const std::size_t n = std::min({x.size(), y.size(), error.size()});
  cairo_save(cairo);
  clip_to(cairo, p);
  cairo_new_path(cairo);
  for (std::size_t i = 0; i < n; ++i) cairo_line_to(cairo, p.page_x(x[i]), p.page_y(y[i] + error[i]));
  for (std::size_t i = n; i-- > 0;) cairo_line_to(cairo, p.page_x(x[i]), p.page_y(y[i] - error[i]));
  cairo_close_path(cairo);
  set_colour(pen, colour, tint);
  cairo_fill(cairo);
  cairo_restore(cairo);
}

void draw_closed_curve(const Pen& pen, const Panel& p, const ClosedCurve& curve, const Eigen::Vector2d& shift,
                       const Stroke& stroke, double fill_opacity) {
  cairo_t* cairo = pen.cairo;
  cairo_save(cairo);
  clip_to(cairo, p);
  cairo_new_path(cairo);
  const auto x = [&](const Eigen::Vector2d& v) { return p.page_x(v.x() + shift.x()); };
  const auto y = [&](const Eigen::Vector2d& v) { return p.page_y(v.y() + shift.y()); };
  bool first = true;
  for (const CubicPiece& c : cubic_pieces(curve)) {
    if (first) cairo_move_to(cairo, x(c.p0), y(c.p0));
    first = false;
    cairo_curve_to(cairo, x(c.p1), y(c.p1), x(c.p2), y(c.p2), x(c.p3), y(c.p3));
  }
  cairo_close_path(cairo);
  if (fill_opacity > 0) {
    set_colour(pen, stroke.colour, fill_opacity);
    cairo_fill_preserve(cairo);
  }
  set_colour(pen, stroke.colour, stroke.opacity);
  cairo_set_line_width(cairo, stroke.width * pen.theme.stroke);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(cairo);
  cairo_restore(cairo);
}

namespace {

void marker_path(cairo_t* cairo, Marker marker, double x, double y, double r) {
  cairo_new_path(cairo);
  const auto polygon = [&](std::initializer_list<std::array<double, 2>> corners) {
    for (const auto& c : corners) cairo_line_to(cairo, x + r * c[0], y + r * c[1]);
    cairo_close_path(cairo);
  };
  switch (marker) {
    case Marker::dot:
    case Marker::ring:
      cairo_arc(cairo, x, y, r, 0, 2 * std::numbers::pi);
      break;
    case Marker::square:
      polygon({{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}});
      break;
    case Marker::diamond:
      polygon({{0, -1.25}, {1.25, 0}, {0, 1.25}, {-1.25, 0}});
      break;
    case Marker::triangle:
      polygon({{0, -1.25}, {1.1, 0.75}, {-1.1, 0.75}});
      break;
  }
}

}  // namespace

void draw_marker(const Pen& pen, Marker marker, double x, double y, const Colour& colour, double radius) {
  const double r = radius * pen.theme.stroke;
  marker_path(pen.cairo, marker, x, y, r);
  set_colour(pen, marker == Marker::ring ? pen.theme.ground : colour);
  cairo_fill_preserve(pen.cairo);
  set_colour(pen, colour);
  cairo_set_line_width(pen.cairo, 0.8 * pen.theme.stroke);
  if (marker == Marker::ring) cairo_stroke(pen.cairo);
  cairo_new_path(pen.cairo);
}

void draw_markers(const Pen& pen, const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                  Marker marker, const Colour& colour, double radius, const std::vector<double>& error) {
  for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k) {
    if (!std::isfinite(x[k]) || !std::isfinite(y[k])) continue;
    if (k < error.size() && error[k] > 0) {
      const double low = panel.page_y(y[k] - error[k]), high = panel.page_y(y[k] + error[k]), at = panel.page_x(x[k]);
      const double cap = radius * pen.theme.stroke;
      set_colour(pen, colour);
      cairo_set_line_width(pen.cairo, pen.theme.line);
      cairo_new_path(pen.cairo);
      cairo_move_to(pen.cairo, at, low);
      cairo_line_to(pen.cairo, at, high);
      for (const double end : {low, high}) {
        cairo_move_to(pen.cairo, at - cap, end);
        cairo_rel_line_to(pen.cairo, 2 * cap, 0);
      }
      cairo_stroke(pen.cairo);
    }
    draw_marker(pen, marker, panel.page_x(x[k]), panel.page_y(y[k]), colour, radius);
  }
}

std::vector<Eigen::Vector2d> marks_along(const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                                         double spacing, double phase) {
  std::vector<Eigen::Vector2d> marks;
  // Along the axis where the curve has one value a place, or noise would get a mark each; else along the curve.
  bool onward = true;
  for (std::size_t i = 1; i < x.size(); ++i) onward = onward && !(x[i] < x[i - 1]);
  double next = phase * spacing, at = 0;
  for (std::size_t i = 1; i < std::min(x.size(), y.size()); ++i) {
    const double x0 = panel.page_x(x[i - 1]), y0 = panel.page_y(y[i - 1]), x1 = panel.page_x(x[i]),
                 y1 = panel.page_y(y[i]);
    if (!std::isfinite(x0) || !std::isfinite(y0) || !std::isfinite(x1) || !std::isfinite(y1)) {
      if (onward && std::isfinite(x0) && std::isfinite(x1)) at += x1 - x0;
      next = std::max(next, at);
      continue;
    }
    const double length = onward ? x1 - x0 : std::hypot(x1 - x0, y1 - y0);
    for (; length > 0 && next <= at + length; next += spacing) {
      const double share = (next - at) / length;
      marks.emplace_back(x0 + share * (x1 - x0), y0 + share * (y1 - y0));
    }
    at += length;
  }
  // A short curve is marked at its end.
  for (std::size_t i = std::min(x.size(), y.size()); marks.empty() && i-- > 0;)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) marks.emplace_back(panel.page_x(x[i]), panel.page_y(y[i]));
  return marks;
}

void draw_markers_along(const Pen& pen, const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                        Marker marker, const Colour& colour, double spacing, double phase) {
  for (const Eigen::Vector2d& at : marks_along(panel, x, y, spacing, phase))
    draw_marker(pen, marker, at.x(), at.y(), colour, 1.6);
}

std::vector<ArrowHead> arrow_heads(const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                                   double size, const std::vector<Eigen::Vector2d>& taken) {
  constexpr double step = 0.1, clear = 1.1, two = 12;  // lengths of a head
  // Points of the curve at equal distances; a gap is no part of it.
  std::vector<Eigen::Vector2d> points;
  double rest = 0;
  for (std::size_t i = 1; i < std::min(x.size(), y.size()); ++i) {
    const Eigen::Vector2d from(panel.page_x(x[i - 1]), panel.page_y(y[i - 1])),
        to(panel.page_x(x[i]), panel.page_y(y[i]));
    if (!from.allFinite() || !to.allFinite()) continue;
    const double length = (to - from).norm();
    double at = rest;
    for (; at < length; at += step * size) points.emplace_back(from + at / length * (to - from));
    rest = at - length;
  }
  // What a periodic motion draws again and again is told by its first round.
  const double round = 2 * (panel.width + panel.height);
  const auto last =
      static_cast<std::ptrdiff_t>(std::min<double>(static_cast<double>(points.size()), round / (step * size)));
  const auto half = static_cast<std::ptrdiff_t>(0.5 / step);
  std::vector<ArrowHead> heads;
  const auto add = [&](double share) {
    const auto wanted = static_cast<std::ptrdiff_t>(share * static_cast<double>(last));
    for (std::ptrdiff_t k = 0; k < last; ++k)  // the nearest place that is free, before or behind
      for (const std::ptrdiff_t middle : {wanted + k, wanted - k}) {
        if (middle < half || middle + half >= last) continue;
        const Eigen::Vector2d &at = points[static_cast<std::size_t>(middle)],
                              &tail = points[static_cast<std::size_t>(middle - half)],
                              &tip = points[static_cast<std::size_t>(middle + half)];
        const auto aside = [&](const Eigen::Vector2d& p) { return (p - at).norm() >= clear * size; };
        const bool straight = (tip - tail).norm() > 0.8 * size;
        const bool apart = std::all_of(heads.begin(), heads.end(),
                                       [&](const ArrowHead& h) { return (h.tip - tip).norm() > 2 * size; });
        if (!straight || !apart || !std::all_of(taken.begin(), taken.end(), aside)) continue;
        const Eigen::Vector2d along = (tip - tail).normalized();
        heads.push_back({at + 0.5 * size * along, along});
        return;
      }
  };
  if (last <= 2 * half) return heads;
  const bool long_enough = static_cast<double>(last) * step > two;
  add(long_enough ? 0.3 : 0.55);
  if (long_enough) add(0.75);
  return heads;
}

void draw_arrow_heads(const Pen& pen, const Panel& panel, const std::vector<ArrowHead>& heads, double size,
                      const Colour& colour) {
  cairo_t* cairo = pen.cairo;
  cairo_save(cairo);
  clip_to(cairo, panel);
  set_colour(pen, colour);
  for (const ArrowHead& head : heads) {
    const Eigen::Vector2d aside(-head.along.y(), head.along.x()), back = head.tip - size * head.along;
    cairo_new_path(cairo);
    cairo_move_to(cairo, head.tip.x(), head.tip.y());
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(back + 0.45 * size * aside), Eigen::Vector2d(back + 0.25 * size * head.along),
          Eigen::Vector2d(back - 0.45 * size * aside)})
      cairo_line_to(cairo, corner.x(), corner.y());
    cairo_close_path(cairo);
    cairo_fill(cairo);
  }
  cairo_restore(cairo);
}

void draw_picture(cairo_t* cairo, const Image& image, double left, double top, double width, double height,
                  bool smooth) {
  const bool has_alpha = image.channels == 4;
  cairo_surface_t* surface =
      cairo_image_surface_create(has_alpha ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24, image.width, image.height);
  unsigned char* data = cairo_image_surface_get_data(surface);
  if (data == nullptr) {
    cairo_surface_destroy(surface);
    throw std::bad_alloc();
  }
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* c = image.at(x, y);
      const std::uint32_t alpha = has_alpha ? c[3] : 255;
      const auto times = [&](std::uint32_t part) { return (part * alpha + 127) / 255; };  // as Cairo stores it
      const std::uint32_t v = alpha << 24 | times(c[0]) << 16 | times(c[1]) << 8 | times(c[2]);
      std::memcpy(data + static_cast<std::ptrdiff_t>(y) * stride + 4 * static_cast<std::ptrdiff_t>(x), &v, sizeof v);
    }
  cairo_surface_mark_dirty(surface);
  cairo_save(cairo);
  cairo_translate(cairo, left, top);
  cairo_scale(cairo, width / image.width, height / image.height);
  cairo_set_source_surface(cairo, surface, 0, 0);
  // or the edges fade into the ground
  if (!has_alpha) cairo_pattern_set_extend(cairo_get_source(cairo), CAIRO_EXTEND_PAD);
  cairo_pattern_set_filter(cairo_get_source(cairo), smooth ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST);
  cairo_rectangle(cairo, 0, 0, image.width, image.height);
  cairo_fill(cairo);
  cairo_restore(cairo);
  cairo_surface_destroy(surface);
}

}  // namespace render
