#include "render/image/text.h"

#include "render/core/assets.h"

#include <cairo-ft.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
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

}  // namespace

std::vector<TextRun> text_runs(std::string_view text) {
  std::vector<TextRun> runs{{}};
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

namespace {

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

Font::Font(Use use) : use_(use) {
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
  static_cast<void>(owner.release());  // Cairo deletes it
  face_ = std::shared_ptr<cairo_font_face_t>(face, cairo_font_face_destroy);
}

double text_width(cairo_t* cairo, const Font& font, double size, std::string_view text) {
  double width = 0;
  for (const TextRun& run : text_runs(text)) {
    set_font(cairo, font, run.size() * size);
    width += advance(cairo, run.text);
  }
  return width;
}

namespace {

// The outlines of all letters as the current path, or the letters themselves; the advance width.
double set_text(cairo_t* cairo, const Font& font, double size, double x, double y, std::string_view text, Align align) {
  const double width = text_width(cairo, font, size, text);
  double pen = align == Align::left ? x : align == Align::centre ? x - width / 2 : x - width;
  cairo_new_path(cairo);
  for (const TextRun& run : text_runs(text)) {
    set_font(cairo, font, run.size() * size);
    cairo_move_to(cairo, pen, y - run.shift() * size);
    font.use() == Font::Use::glyphs ? cairo_show_text(cairo, run.text.c_str())
                                    : cairo_text_path(cairo, run.text.c_str());
    pen += advance(cairo, run.text);
  }
  return width;
}

}  // namespace

double draw_text(cairo_t* cairo, const Font& font, double size, double x, double y, std::string_view text,
                 Align align) {
  if (font.use() == Font::Use::kept) {
    PageText kept{std::string(text), size, x, y, align};
    cairo_get_matrix(cairo, &kept.place);
    cairo_pattern_get_rgba(cairo_get_source(cairo), &kept.red, &kept.green, &kept.blue, &kept.alpha);
    font.keep(std::move(kept));
    return text_width(cairo, font, size, text);
  }
  const double width = set_text(cairo, font, size, x, y, text, align);
  if (font.use() == Font::Use::paths) cairo_fill(cairo);
  return width;
}

double draw_text_on_picture(cairo_t* cairo, const Font& font, const Colour& rim, double size, double x, double y,
                            std::string_view text, Align align) {
  const double width = set_text(cairo, font, size, x, y, text, align);
  cairo_save(cairo);
  cairo_set_source_rgba(cairo, rim.r, rim.g, rim.b, 0.5);
  cairo_set_line_width(cairo, 0.28 * size);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke_preserve(cairo);
  cairo_restore(cairo);
  cairo_fill(cairo);
  return width;
}

namespace {

std::string power_text(int exponent) { return fmt::format("10^{{{}{}}}", exponent < 0 ? "−" : "", std::abs(exponent)); }

}  // namespace

std::string number_text(double value, int digits) {
  if (value == 0) return "0";
  const std::string sign = value < 0 ? "−" : "";
  const double magnitude = std::abs(value);
  if (magnitude >= 1e-3 && magnitude < 1e5) return sign + fmt::format("{:.{}g}", magnitude, digits);
  // Rounded first: 9.99999 is 10, and the power one higher.
  const std::string rounded = fmt::format("{:.{}e}", magnitude, std::max(digits - 3, 0));
  const std::size_t e = rounded.find('e');
  const int exponent = std::stoi(rounded.substr(e + 1));
  const std::string power = power_text(exponent);
  double mantissa = 0;
  std::from_chars(rounded.data(), rounded.data() + e, mantissa);
  return sign + (mantissa == 1 ? power : fmt::format("{:.{}g}·", mantissa, digits) + power);
}

std::vector<std::string> number_texts(const std::vector<double>& values) {
  double largest = 0, step = std::numeric_limits<double>::infinity();
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    largest = std::max(largest, std::abs(sorted[k]));
    if (k > 0 && sorted[k] > sorted[k - 1]) step = std::min(step, sorted[k] - sorted[k - 1]);
  }
  if (largest == 0) return std::vector<std::string>(values.size(), "0");
  if (!(step < largest * 1e5)) step = 1e-5 * largest;  // one value
  // The fewest digits after the point that keep every number to a hundredth of the step; below 0: zeros before the
  // point.
  const int least = static_cast<int>(std::floor(-std::log10(step))), most = least + 4;
  int places = least;
  const auto keeps = [&](int n) {
    const double unit = std::pow(10.0, n);
    return std::all_of(values.begin(), values.end(),
                       [&](double v) { return std::abs(v * unit - std::round(v * unit)) <= 0.01 * step * unit; });
  };
  while (places < most && !keeps(places)) ++places;
  const int exponent = static_cast<int>(std::floor(std::log10(largest) + 1e-12));
  const int after_point = std::max(places, 0), of_mantissa = std::clamp(places + exponent, 0, 16);
  const int plain_length = std::max(exponent + 1, 1) + (after_point > 0 ? after_point + 1 : 0);
  const int power_length = (of_mantissa > 0 ? of_mantissa + 2 : 1) + 3;
  const bool usual = largest >= 1e-3 && largest < 1e5 && after_point <= 6;
  const bool plain = usual || (plain_length <= power_length && plain_length <= 16);
  std::vector<std::string> texts;
  for (const double v : values) {
    const std::string sign = v < 0 ? "−" : "";
    const std::string mantissa = fmt::format("{:.{}f}", std::abs(v) / std::pow(10.0, exponent), of_mantissa);
    if (plain)
      texts.push_back(sign + fmt::format("{:.{}f}", std::abs(v), after_point));
    else if (v == 0)
      texts.emplace_back("0");
    else
      texts.push_back(sign + (mantissa == "1" ? "" : mantissa + "·") + power_text(exponent));
  }
  return texts;
}

}  // namespace render
