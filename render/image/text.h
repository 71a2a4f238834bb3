// Text for pictures and figures: the embedded DejaVu Sans and Serif, and fonts of the system for letters that these
// lack. On pixels it is drawn as paths, so that it looks the same everywhere; in PDF and SVG it stays text, which can
// be searched and edited.
#pragma once

#include "render/core/palette.h"

#include <cairo.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace render {

enum class Align { left, centre, right };
enum class FontFamily { sans, serif };

/// One text of a page whose texts are stored separately from its drawing.
struct PageText {
  std::string text;  ///< with `_{...}` and `^{...}`
  double size = 0, x = 0, y = 0;
  Align align = Align::left;
  cairo_matrix_t place{};  ///< of these coordinates on the page
  double red = 0, green = 0, blue = 0, alpha = 1;
};

struct FontFaces;  // upright, italic, and those of the system that were needed

/// The Cairo fonts, and how draw_text() uses them; a value, cheap to copy.
class Font {
 public:
  enum class Use {
    paths,   ///< outlines
    glyphs,  ///< letters of the fonts, for PDF
    kept     ///< nothing is drawn: the texts are stored for texts()
  };
  /// italics: variables are set in italics. Throws std::runtime_error when FreeType cannot read the embedded files.
  explicit Font(Use use = Use::paths, FontFamily family = FontFamily::sans, bool italics = false);
  Use use() const { return use_; }
  bool italics() const { return italics_; }
  FontFaces& faces() const { return *faces_; }
  void keep(PageText text) const { kept_->push_back(std::move(text)); }
  const std::vector<PageText>& texts() const { return *kept_; }
  /// Letters of the texts so far for which no font was found, each once.
  std::string missing() const;

 private:
  std::shared_ptr<FontFaces> faces_;
  Use use_;
  bool italics_;
  std::shared_ptr<std::vector<PageText>> kept_ = std::make_shared<std::vector<PageText>>();
};

/// Of what is written into pictures: sans, variables in italics.
inline Font caption_font() { return Font(Font::Use::paths, FontFamily::sans, true); }

/// The pieces of a text with `_{...}` and `^{...}`.
struct TextRun {
  std::string text;
  int level = 0;        ///< -1 lowered, 0, +1 raised
  bool italic = false;  ///< a variable: single letters beside signs of mathematics, Greek ones but π, and their indices
  /// Relative to the height of the text.
  double size() const { return level == 0 ? 1 : 0.72; }
  double shift() const { return level < 0 ? -0.20 : level > 0 ? 0.38 : 0; }  ///< upward
};
std::vector<TextRun> text_runs(std::string_view text);

/// The rectangle that the ink of a text covers, in user units, y downward; empty where there is none.
struct TextBox {
  double left = 0, top = 0, right = 0, bottom = 0;
};
TextBox text_box(cairo_t* cairo, const Font& font, double size, double x, double y, std::string_view text,
                 Align align = Align::left);

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
