// Text for pictures and figures: the embedded DejaVu Sans. On pixels it is drawn as paths, so that it looks the same
// everywhere; in PDF and SVG it stays text, which can be searched and edited.
#pragma once

#include "render/core/palette.h"

#include <cairo.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace render {

enum class Align { left, centre, right };

/// One text of a page whose texts are stored separately from its drawing.
struct PageText {
  std::string text;  ///< with `_{...}` and `^{...}`
  double size = 0, x = 0, y = 0;
  Align align = Align::left;
  cairo_matrix_t place{};  ///< of these coordinates on the page
  double red = 0, green = 0, blue = 0, alpha = 1;
};

/// The Cairo font, and how draw_text() uses it; a value, cheap to copy.
class Font {
 public:
  enum class Use {
    paths,   ///< outlines
    glyphs,  ///< letters of the embedded font, for PDF
    kept     ///< nothing is drawn: the texts are stored for texts()
  };
  explicit Font(Use use = Use::paths);  ///< throws std::runtime_error when FreeType cannot read the embedded file
  cairo_font_face_t* face() const { return face_.get(); }
  Use use() const { return use_; }
  void keep(PageText text) const { kept_->push_back(std::move(text)); }
  const std::vector<PageText>& texts() const { return *kept_; }

 private:
  std::shared_ptr<cairo_font_face_t> face_;
  Use use_;
  std::shared_ptr<std::vector<PageText>> kept_ = std::make_shared<std::vector<PageText>>();
};

/// The pieces of a text with `_{...}` and `^{...}`.
struct TextRun {
  std::string text;
  int level = 0;  ///< -1 lowered, 0, +1 raised
  /// Relative to the height of the text.
  double size() const { return level == 0 ? 1 : 0.72; }
  double shift() const { return level < 0 ? -0.20 : level > 0 ? 0.38 : 0; }  ///< upward
};
std::vector<TextRun> text_runs(std::string_view text);

/// Fills `text` with its baseline at y in the current source colour. UTF-8; `_{...}` is a subscript, `^{...}` a
/// superscript. Returns the advance width. size: of the em square, in user units.
double draw_text(cairo_t* cairo, const Font& font, double size, double x, double y, std::string_view text,
                 Align align = Align::left);
/// The same with a soft rim, for text that may lie on a vesicle.
double draw_text_on_picture(cairo_t* cairo, const Font& font, const Colour& rim, double size, double x, double y,
                            std::string_view text, Align align = Align::left);
double text_width(cairo_t* cairo, const Font& font, double size, std::string_view text);

/// Shortest conventional decimal form: "0.5", "-1", "10^{-3}", with a true minus sign; at most `digits` digits.
std::string number_text(double value, int digits = 6);
/// The numbers of an axis: the same number of digits for all, enough to distinguish neighbours, and one power of ten
/// where that is shorter.
std::vector<std::string> number_texts(const std::vector<double>& values);

}  // namespace render
