#include "render/image/picture_canvas.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace render {
namespace {

Rectangle clipped(Rectangle r, const Image& image) {
  const int x0 = std::clamp(r.x, 0, image.width), y0 = std::clamp(r.y, 0, image.height);
  const int x1 = std::clamp(r.x + r.width, 0, image.width), y1 = std::clamp(r.y + r.height, 0, image.height);
  return {x0, y0, x1 - x0, y1 - y0};
}

std::uint32_t to_cairo(const std::uint8_t* p, bool has_alpha) {
  const std::uint32_t alpha = has_alpha ? p[3] : 255;
  const auto times = [&](std::uint32_t v) { return (v * alpha + 127) / 255; };
  return alpha << 24 | times(p[0]) << 16 | times(p[1]) << 8 | times(p[2]);
}

void from_cairo(std::uint32_t v, std::uint8_t* p, bool has_alpha) {
  const std::uint32_t alpha = has_alpha ? v >> 24 : 255;
  const auto over = [&](std::uint32_t c) {
    return static_cast<std::uint8_t>(alpha == 0 ? 0 : std::min((c * 255 + alpha / 2) / alpha, 255U));
  };
  p[0] = over(v >> 16 & 255);
  p[1] = over(v >> 8 & 255);
  p[2] = over(v & 255);
  if (has_alpha) p[3] = static_cast<std::uint8_t>(alpha);
}

}  // namespace

// Cairo draws on a copy of the rectangle: its pixels have another layout than the picture's, and are premultiplied.
void draw_on(Image& image, Rectangle where, const std::function<void(cairo_t*)>& paint) {
  const Rectangle r = clipped(where, image);
  if (r.width <= 0 || r.height <= 0) return;
  const bool has_alpha = image.channels == 4;
  cairo_surface_t* surface =
      cairo_image_surface_create(has_alpha ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24, r.width, r.height);
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
    for (int x = 0; x < r.width; ++x) *pixel(x, y) = to_cairo(image.at(r.x + x, r.y + y), has_alpha);
  cairo_surface_mark_dirty(surface);
  cairo_t* cairo = cairo_create(surface);
  cairo_translate(cairo, -r.x, -r.y);
  paint(cairo);
  const cairo_status_t status = cairo_status(cairo);
  cairo_destroy(cairo);
  cairo_surface_flush(surface);
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      std::uint8_t* p = image.at(r.x + x, r.y + y);
      // what nothing was drawn on keeps its bytes: premultiplying loses some of them
      if (const std::uint32_t v = *pixel(x, y); v != to_cairo(p, has_alpha)) from_cairo(v, p, has_alpha);
    }
  cairo_surface_destroy(surface);
  if (status != CAIRO_STATUS_SUCCESS) throw std::runtime_error(std::string("Cairo: ") + cairo_status_to_string(status));
}

}  // namespace render
