#include "overlay.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace render {
namespace {

struct Rectangle {
  int x, y, width, height;
};

Rectangle clipped(Rectangle r, const Image& image) {
  const int x0 = std::clamp(r.x, 0, image.width), y0 = std::clamp(r.y, 0, image.height);
  const int x1 = std::clamp(r.x + r.width, 0, image.width), y1 = std::clamp(r.y + r.height, 0, image.height);
  return {x0, y0, x1 - x0, y1 - y0};
}

// Cairo draws on a copy of the rectangle: its pixels have another layout than the picture's.
void draw_on(Image& image, Rectangle where, const std::function<void(cairo_t*)>& paint) {
  const Rectangle r = clipped(where, image);
  if (r.width <= 0 || r.height <= 0) return;
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, r.width, r.height);
  if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) {
    cairo_surface_destroy(surface);
    throw std::runtime_error("Cairo cannot make a surface for captions");
  }
  unsigned char* data = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  const auto pixel = [&](int x, int y) {
    return reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride) + x;
  };
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      const std::uint8_t* p = image.at(r.x + x, r.y + y);
      *pixel(x, y) = static_cast<std::uint32_t>(p[0]) << 16 | static_cast<std::uint32_t>(p[1]) << 8 | p[2];
    }
  cairo_surface_mark_dirty(surface);
  cairo_t* cairo = cairo_create(surface);
  cairo_translate(cairo, -r.x, -r.y);
  paint(cairo);
  const cairo_status_t status = cairo_status(cairo);
  cairo_destroy(cairo);
  cairo_surface_flush(surface);
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      const std::uint32_t v = *pixel(x, y);
      std::uint8_t* p = image.at(r.x + x, r.y + y);
      p[0] = static_cast<std::uint8_t>(v >> 16);
      p[1] = static_cast<std::uint8_t>(v >> 8);
      p[2] = static_cast<std::uint8_t>(v);
    }
  cairo_surface_destroy(surface);
  if (status != CAIRO_STATUS_SUCCESS) throw std::runtime_error(std::string("Cairo: ") + cairo_status_to_string(status));
}

void set_colour(cairo_t* cairo, const Colour& c) { cairo_set_source_rgb(cairo, c.r, c.g, c.b); }

}  // namespace

void draw_captions(Image& image, const Font& font, const Frame& frame) {
  const ViewParameters& view = frame.view;
  const Captions& captions = frame.captions;
  const bool time = view.time_stamp && !captions.time.empty();
  const bool parameters = view.caption && !captions.parameters.empty();
  const double unit = std::max(image.height, 0) / 1080.0;  // sizes below are px at 1080
  const double margin = 44 * unit, large = std::max(29 * unit, 9.0), small = std::max(21 * unit, 7.5);
  if (time || parameters) {
    const double height = margin + 1.2 * large + 1.6 * small;
    draw_on(image, {0, 0, image.width, static_cast<int>(std::ceil(height))}, [&](cairo_t* cairo) {
      double y = margin + 0.76 * large;
      if (time) {
        set_colour(cairo, ink);
        draw_text(cairo, font, large, margin, y, captions.time);
        y += 0.35 * large + small;
      }
      if (parameters) {
        set_colour(cairo, soft_ink);
        draw_text(cairo, font, small, margin, y, captions.parameters);
      }
    });
  }
  if (view.scale_bar && captions.scale_length > 0) {
    const double length = captions.scale_length / frame.camera.half_width * image.width / 2;
    const double thickness = std::max(4 * unit, 1.5);
    const double baseline = image.height - margin;
    if (length > 2 * thickness && length < 0.6 * image.width)
      draw_on(image,
              {0, static_cast<int>(baseline - 2.2 * small), image.width, static_cast<int>(std::ceil(2.2 * small + margin))},
              [&](cairo_t* cairo) {
                set_colour(cairo, ink);
                cairo_rectangle(cairo, margin, baseline - thickness, length, thickness);
                cairo_fill(cairo);
                draw_text(cairo, font, small, margin + length / 2, baseline - thickness - 0.5 * small, captions.scale,
                          Align::centre);
              });
  }
}

}  // namespace render
