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
  bool transparent = false;    ///< there is no ground
  FontFamily family = FontFamily::sans;
  bool outlines = false;                 ///< PDF and SVG hold the outlines of their text
  std::string title = {}, subject = {};  ///< stored in all three; empty: not
};

/// A text of a drawing and the rectangle of its ink, pt. A turned text's contains it.
struct PlacedText {
  PageText text;
  TextBox box;
};
/// All texts in the order in which they are drawn.
std::vector<PlacedText> texts_of(const Drawing& drawing);
/// Letters for which neither the program nor the system has a font, each once; they are drawn as empty boxes.
std::string missing_letters(const Drawing& drawing);

/// Each throws std::runtime_error with path and reason. The same drawing gives the same bytes: no dates or host
/// names. The PNG records its dots per inch; the PDF embeds the glyphs it uses; the SVG names the font and draws its
/// text above everything else. A font of the system, for letters that the program's lack, makes them depend on it.
void write_drawing_png(const std::filesystem::path& path, const Drawing& drawing, const PngText& text = {},
                       const sim::FileWriter& write = sim::write_file);
void write_drawing_svg(const std::filesystem::path& path, const Drawing& drawing,
                       const sim::FileWriter& write = sim::write_file);
void write_drawing_pdf(const std::filesystem::path& path, const Drawing& drawing,
                       const sim::FileWriter& write = sim::write_file);

}  // namespace render
