// Text for pictures and figures: the embedded DejaVu Sans, drawn as paths so that it looks the same everywhere.
#pragma once

#include <cairo.h>

#include <memory>
#include <string>
#include <string_view>

namespace render {

/// The font as Cairo sees it; a value, cheap to copy.
class Font {
 public:
  Font();  ///< throws std::runtime_error when FreeType refuses the embedded file
  cairo_font_face_t* face() const { return face_.get(); }

 private:
  std::shared_ptr<cairo_font_face_t> face_;
};

enum class Align { left, centre, right };

/// Fills `text` with its baseline at y in the current source colour. UTF-8; `_{...}` lowers, `^{...}` raises.
/// Returns the advance width. size: of the em square, in user units.
double draw_text(cairo_t* cairo, const Font& font, double size, double x, double y, std::string_view text,
                 Align align = Align::left);
/// The same with a soft white rim, for text that may stand on a vesicle.
double draw_text_on_picture(cairo_t* cairo, const Font& font, double size, double x, double y, std::string_view text,
                            Align align = Align::left);
double text_width(cairo_t* cairo, const Font& font, double size, std::string_view text);

/// Shortest decimal form that a reader expects on an axis: "0.5", "-1", "10^{-3}", with a true minus sign.
std::string number_text(double value);

}  // namespace render
