#include "text.h"

#include "assets.h"

#include <cairo-ft.h>
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace render {
namespace {

struct FreeTypeFace {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  ~FreeTypeFace() {
    if (face) FT_Done_Face(face);
    if (library) FT_Done_FreeType(library);
  }
};

struct Run {
  std::string text;
  int level = 0;  // -1 lowered, 0, +1 raised
};

std::vector<Run> runs_of(std::string_view text) {
  std::vector<Run> runs{{}};
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool mark = (text[i] == '_' || text[i] == '^') && i + 1 < text.size() && text[i + 1] == '{';
    const std::size_t end = mark ? text.find('}', i) : std::string_view::npos;
    if (end == std::string_view::npos) {
      runs.back().text += text[i];
      continue;
    }
    runs.push_back({std::string(text.substr(i + 2, end - i - 2)), text[i] == '_' ? -1 : 1});
    runs.push_back({});
    i = end;
  }
  return runs;
}

constexpr double small = 0.72, lowered = 0.20, raised = 0.38;  // of the em

void set_font(cairo_t* cairo, const Font& font, double size) {
  cairo_set_font_face(cairo, font.face());
  cairo_set_font_size(cairo, size);
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(cairo, options);
  cairo_font_options_destroy(options);
}

double advance(cairo_t* cairo, const std::string& text) {
  cairo_text_extents_t extents;
  cairo_text_extents(cairo, text.c_str(), &extents);
  return extents.x_advance;
}

}  // namespace

Font::Font() {
  auto owner = std::make_unique<FreeTypeFace>();
  const std::span<const unsigned char> file = asset("DejaVuSans.ttf");
  if (FT_Init_FreeType(&owner->library) != 0 ||
      FT_New_Memory_Face(owner->library, file.data(), static_cast<FT_Long>(file.size()), 0, &owner->face) != 0)
    throw std::runtime_error("FreeType cannot use the embedded font DejaVu Sans");
  cairo_font_face_t* face = cairo_ft_font_face_create_for_ft_face(owner->face, FT_LOAD_NO_HINTING);
  // Cairo keeps scaled fonts in a cache of its own: the FreeType face must live as long as Cairo's, not as this object.
  static const cairo_user_data_key_t key{};
  const auto destroy = [](void* p) { delete static_cast<FreeTypeFace*>(p); };
  if (cairo_font_face_set_user_data(face, &key, owner.get(), destroy) != CAIRO_STATUS_SUCCESS) {
    cairo_font_face_destroy(face);
    throw std::runtime_error("Cairo cannot use the embedded font DejaVu Sans");
  }
  owner.release();
  face_ = std::shared_ptr<cairo_font_face_t>(face, cairo_font_face_destroy);
}

double text_width(cairo_t* cairo, const Font& font, double size, std::string_view text) {
  double width = 0;
  for (const Run& run : runs_of(text)) {
    set_font(cairo, font, run.level == 0 ? size : small * size);
    width += advance(cairo, run.text);
  }
  return width;
}

namespace {

// The outlines of all letters as the current path; the advance width.
double text_path(cairo_t* cairo, const Font& font, double size, double x, double y, std::string_view text, Align align) {
  const double width = text_width(cairo, font, size, text);
  double pen = align == Align::left ? x : align == Align::centre ? x - width / 2 : x - width;
  cairo_new_path(cairo);
  for (const Run& run : runs_of(text)) {
    set_font(cairo, font, run.level == 0 ? size : small * size);
    cairo_move_to(cairo, pen, y + (run.level < 0 ? lowered : run.level > 0 ? -raised : 0) * size);
    cairo_text_path(cairo, run.text.c_str());
    pen += advance(cairo, run.text);
  }
  return width;
}

}  // namespace

double draw_text(cairo_t* cairo, const Font& font, double size, double x, double y, std::string_view text, Align align) {
  const double width = text_path(cairo, font, size, x, y, text, align);
  cairo_fill(cairo);
  return width;
}

double draw_text_on_picture(cairo_t* cairo, const Font& font, double size, double x, double y, std::string_view text,
                            Align align) {
  const double width = text_path(cairo, font, size, x, y, text, align);
  cairo_save(cairo);
  cairo_set_source_rgba(cairo, 1, 1, 1, 0.5);
  cairo_set_line_width(cairo, 0.28 * size);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke_preserve(cairo);
  cairo_restore(cairo);
  cairo_fill(cairo);
  return width;
}

std::string number_text(double value) {
  if (value == 0) return "0";
  const std::string sign = value < 0 ? "−" : "";
  const double magnitude = std::abs(value);
  if (magnitude >= 1e-3 && magnitude < 1e5) return sign + fmt::format("{:.6g}", magnitude);
  const int exponent = static_cast<int>(std::floor(std::log10(magnitude) + 1e-12));
  const double mantissa = magnitude / std::pow(10.0, exponent);
  const std::string power = fmt::format("10^{{{}{}}}", exponent < 0 ? "−" : "", std::abs(exponent));
  return sign + (std::abs(mantissa - 1) < 1e-9 ? power : fmt::format("{:.4g}·", mantissa) + power);
}

}  // namespace render
