// A drawing in points, rendered to PNG, SVG and PDF by the same function.
#pragma once

#include "render/core/palette.h"
#include "render/image/image.h"
#include "render/image/text.h"

#include <filesystem>
#include <functional>
#include <vector>

namespace render {

/// 72 points per inch; y points downward.
struct Drawing {
  double width = 0, height = 0;
  std::function<void(cairo_t*, const Font&)> paint;
  Colour ground = white;
  double dots_per_inch = 300;  ///< of the PNG
};

/// Each throws std::runtime_error with path and reason. The same drawing gives the same bytes: no dates or host
/// names. The PNG records its dots per inch; the PDF embeds the glyphs it uses; the SVG names the font and draws its
/// text above everything else.
void write_drawing_png(const std::filesystem::path& path, const Drawing& drawing, const PngText& text = {},
                       const sim::FileWriter& write = sim::write_file);
void write_drawing_svg(const std::filesystem::path& path, const Drawing& drawing,
                       const sim::FileWriter& write = sim::write_file);
void write_drawing_pdf(const std::filesystem::path& path, const Drawing& drawing,
                       const sim::FileWriter& write = sim::write_file);

}  // namespace render
