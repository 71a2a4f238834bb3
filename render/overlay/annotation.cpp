#include "render/overlay/annotation.h"

#include "render/core/places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace render {
namespace {

struct AnnotationSizes {
  double unit, margin, text, line;  // px
};
AnnotationSizes annotation_sizes(const Image& image) {
  const OverlaySizes sizes = overlay_sizes(image.height);
  return {.unit = sizes.unit, .margin = sizes.margin, .text = sizes.small, .line = std::max(2.2 * sizes.unit, 1.0)};
}

void arrow(cairo_t* cairo, glm::dvec2 tail, glm::dvec2 tip, double line) {
  const double length = glm::length(tip - tail), head = std::min(5.5 * line, 0.6 * length);
  if (length < 1.2 * line) return;
  const glm::dvec2 along = (tip - tail) / length, across(-along.y, along.x), neck = tip - head * along;
  cairo_set_line_width(cairo, line);
  cairo_move_to(cairo, tail.x, tail.y);
  cairo_line_to(cairo, neck.x, neck.y);
  cairo_stroke(cairo);
  cairo_move_to(cairo, tip.x, tip.y);
  cairo_line_to(cairo, neck.x + 0.42 * head * across.x, neck.y + 0.42 * head * across.y);
  cairo_line_to(cairo, neck.x - 0.42 * head * across.x, neck.y - 0.42 * head * across.y);
  cairo_close_path(cairo);
  cairo_fill(cairo);
}

// Toward the viewer: a dot in a ring; away from him: a cross in a ring.
void seen_end_on(cairo_t* cairo, glm::dvec2 at, bool toward, double line) {
  const double r = 3.4 * line;
  cairo_set_line_width(cairo, 0.8 * line);
  cairo_arc(cairo, at.x, at.y, r, 0, 2 * std::numbers::pi);
  cairo_stroke(cairo);
  if (toward) {
    cairo_arc(cairo, at.x, at.y, 1.3 * line, 0, 2 * std::numbers::pi);
    cairo_fill(cairo);
    return;
  }
  const double d = r / std::numbers::sqrt2;
  for (const double sign : {-1.0, 1.0}) {
    cairo_move_to(cairo, at.x - d, at.y - sign * d);
    cairo_line_to(cairo, at.x + d, at.y + sign * d);
    cairo_stroke(cairo);
  }
}

}  // namespace

void draw_triad(Image& image, const Font& font, const Inks& inks, const Camera& camera, const Box& box, double length) {
  const AnnotationSizes s = annotation_sizes(image);
  const double room = box.width() / 2;
  const glm::dvec2 origin((box.left + box.right) / 2, (box.top + box.bottom) / 2);
  const glm::dmat3 turn(camera.view);
  draw_on(image,
          {static_cast<int>(origin.x - room), static_cast<int>(origin.y - room), static_cast<int>(2.6 * room),
           static_cast<int>(2.6 * room)},
          [&](cairo_t* cairo) {
            constexpr std::array<const char*, 3> names{"x", "y", "z"};
            std::array<int, 3> order{0, 1, 2};  // the farthest first
            std::sort(order.begin(), order.end(), [&](int a, int b) { return turn[a].z < turn[b].z; });
            set_colour(cairo, inks.text);
            for (const int axis : order) {
              const glm::dvec2 direction(turn[axis].x, -turn[axis].y);
              const double seen = glm::length(direction);
              if (seen < 0.12) {
                seen_end_on(cairo, origin, turn[axis].z > 0, s.line);
                draw_text_on_picture(cairo, font, inks.rim, s.text, origin.x - 0.55 * s.text, origin.y + 0.85 * s.text,
                                     names[static_cast<std::size_t>(axis)], Align::right);
                continue;
              }
              const glm::dvec2 tip = origin + length * direction;
              const glm::dvec2 name = tip + 0.72 * s.text * direction / seen;
              arrow(cairo, origin, tip, s.line);
              draw_text_on_picture(cairo, font, inks.rim, s.text, name.x, name.y + 0.30 * s.text,
                                   names[static_cast<std::size_t>(axis)], Align::centre);
            }
          });
}

void draw_flow_profile(Image& image, const Font& font, const Inks& inks, const FlowProfile& whole, double reach) {
  FlowProfile profile = whole;
  std::erase_if(profile.points, [&](const glm::dvec2& p) { return std::abs(p.x) > reach * (1 + 1e-9); });
  const AnnotationSizes s = annotation_sizes(image);
  double fastest = profile.reference_speed;
  for (const glm::dvec2& p : profile.points) fastest = std::max(fastest, std::abs(p.y));
  if (fastest <= 0 || profile.points.size() < 2) return;
  double least = 0, most = 0;
  for (const glm::dvec2& p : profile.points) {
    least = std::min(least, p.y / fastest);
    most = std::max(most, p.y / fastest);
  }
  const double width = profile_width * image.width, scale = width / std::max(most - least, 0.5);
  const double axis = std::min(s.margin, image.width / 12.0) - scale * least;
  const auto place = [&](const glm::dvec2& p) {
    return glm::dvec2(axis + scale * p.y / fastest, image.height * (0.5 - 0.5 * p.x));
  };
  const double top = place(profile.points.back()).y, bottom = place(profile.points.front()).y;
  draw_on(image,
          {0, static_cast<int>(top - 2.2 * s.text), static_cast<int>(2.4 * s.margin + 2 * width),
           static_cast<int>(bottom - top + 4 * s.text)},
          [&](cairo_t* cairo) {
            const auto lines = [&](const Colour& soft, const Colour& strong, double wider) {
              set_colour(cairo, soft);
              cairo_set_line_width(cairo, 0.6 * s.line + wider);
              cairo_move_to(cairo, axis, top);
              cairo_line_to(cairo, axis, bottom);
              cairo_stroke(cairo);
              for (std::size_t k = 0; k < profile.points.size(); ++k) {
                const glm::dvec2 tip = place(profile.points[k]);
                if (k % 4 == 0) arrow(cairo, {axis, tip.y}, tip, 0.8 * s.line + wider);
              }
              set_colour(cairo, strong);
              cairo_set_line_width(cairo, s.line + wider);
              cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
              for (const glm::dvec2& p : profile.points) cairo_line_to(cairo, place(p).x, place(p).y);
              cairo_stroke(cairo);
            };
            if (inks.rimmed) lines(inks.rim, inks.rim, 1.2 * s.line);
            lines(inks.soft, inks.text, 0);
            draw_text_on_picture(cairo, font, inks.rim, s.text, axis, top - 0.7 * s.text, "u_{∞}", Align::centre);
          });
}

void draw_inset(Image& image, const Font& font, const Inks& inks, const Inset& inset, const Box& box) {
  const AnnotationSizes s = annotation_sizes(image);
  const double left = box.left, top = box.top, width = box.width(), height = box.height();
  const double scale = 0.5 * height / inset.half_height;
  const glm::dvec2 middle(left + 0.5 * width, top + 0.5 * height);
  const auto place = [&](const glm::dvec2& p) {
    const glm::dvec2 d = p - inset.centre;
    return middle + scale * glm::dvec2(d.x, -d.y);
  };
  draw_on(image,
          {static_cast<int>(left - 4), static_cast<int>(top - 4), static_cast<int>(width + 9),
           static_cast<int>(height + 9)},
          [&](cairo_t* cairo) {
            cairo_rectangle(cairo, left, top, width, height);
            set_colour(cairo, inks.paper);
            cairo_fill_preserve(cairo);
            cairo_save(cairo);
            cairo_clip(cairo);
            for (const Inset::Curve& curve : inset.curves) {
              for (const glm::dvec2& p : curve.points) cairo_line_to(cairo, place(p).x, place(p).y);
              cairo_close_path(cairo);
              cairo_set_source_rgba(cairo, curve.colour.r, curve.colour.g, curve.colour.b, 0.45);
              cairo_fill_preserve(cairo);
              cairo_set_source_rgb(cairo, 0.45 * curve.colour.r, 0.45 * curve.colour.g, 0.45 * curve.colour.b);
              cairo_set_line_width(cairo, s.line);
              cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
              cairo_stroke(cairo);
            }
            cairo_restore(cairo);
            cairo_rectangle(cairo, left, top, width, height);
            set_colour(cairo, inks.soft);
            cairo_set_line_width(cairo, 0.6 * s.line);
            cairo_stroke(cairo);
            // its axes, in the lower left corner of the box
            const glm::dvec2 origin(left + 0.5 * s.text, top + height - 0.5 * s.text);
            const double length = 1.5 * s.text, name = 0.8 * s.text;
            arrow(cairo, origin, origin + glm::dvec2(length, 0), 0.6 * s.line);
            arrow(cairo, origin, origin - glm::dvec2(0, length), 0.6 * s.line);
            draw_text_on_picture(cairo, font, inks.rim, name, origin.x + length + 0.3 * name, origin.y + 0.25 * name,
                                 "x");
            draw_text_on_picture(cairo, font, inks.rim, name, origin.x, origin.y - length - 0.35 * name, "z",
                                 Align::centre);
          });
}

}  // namespace render
