#include "render/image/text.h"

#include "render/core/assets.h"

#include <cairo-ft.h>
#include <fmt/format.h>
#include <fontconfig/fontconfig.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
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

struct Face {
  FT_Face letters = nullptr;  ///< lives as long as the Cairo face
  std::shared_ptr<cairo_font_face_t> cairo;
};

/// Takes the FreeType face over. Cairo keeps scaled fonts in a cache of its own: it must live as long as Cairo's.
Face face_of(std::unique_ptr<FreeTypeFace> owner) {
  const FT_Face letters = owner->face;
  cairo_font_face_t* face = cairo_ft_font_face_create_for_ft_face(letters, FT_LOAD_NO_HINTING);
  static const cairo_user_data_key_t key{};
  const auto destroy = [](void* p) { delete static_cast<FreeTypeFace*>(p); };
  if (cairo_font_face_set_user_data(face, &key, owner.get(), destroy) != CAIRO_STATUS_SUCCESS) {
    cairo_font_face_destroy(face);
    throw std::runtime_error("Cairo cannot use an embedded font");
  }
  static_cast<void>(owner.release());  // Cairo deletes it
  return {letters, std::shared_ptr<cairo_font_face_t>(face, cairo_font_face_destroy)};
}

Face embedded_face(const char* name) {
  auto owner = std::make_unique<FreeTypeFace>();
  const std::span<const unsigned char> file = asset(name);
  if (FT_Init_FreeType(&owner->library) != 0 ||
      FT_New_Memory_Face(owner->library, file.data(), static_cast<FT_Long>(file.size()), 0, &owner->face) != 0)
    throw std::runtime_error(fmt::format("FreeType cannot use the embedded font {}", name));
  return face_of(std::move(owner));
}

/// A font of the system with that letter, in outlines; none without one, or without fontconfig's files.
std::optional<Face> system_face(char32_t letter) {
  const std::unique_ptr<FcConfig, void (*)(FcConfig*)> config(FcInitLoadConfigAndFonts(), FcConfigDestroy);
  if (!config) return {};
  const std::unique_ptr<FcCharSet, void (*)(FcCharSet*)> letters(FcCharSetCreate(), FcCharSetDestroy);
  FcCharSetAddChar(letters.get(), letter);
  const std::unique_ptr<FcPattern, void (*)(FcPattern*)> wanted(FcPatternCreate(), FcPatternDestroy);
  FcPatternAddCharSet(wanted.get(), FC_CHARSET, letters.get());
  FcPatternAddBool(wanted.get(), FC_OUTLINE, FcTrue);
  FcPatternAddBool(wanted.get(), FC_COLOR, FcFalse);
  FcPatternAddString(wanted.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
  FcConfigSubstitute(config.get(), wanted.get(), FcMatchPattern);
  FcDefaultSubstitute(wanted.get());
  FcResult result = FcResultNoMatch;
  const std::unique_ptr<FcFontSet, void (*)(FcFontSet*)> found(
      FcFontSort(config.get(), wanted.get(), FcTrue, nullptr, &result), FcFontSetDestroy);
  for (int k = 0; found && k < found->nfont; ++k) {
    FcChar8* file = nullptr;
    int index = 0;
    if (FcPatternGetString(found->fonts[k], FC_FILE, 0, &file) != FcResultMatch) continue;
    FcPatternGetInteger(found->fonts[k], FC_INDEX, 0, &index);
    auto owner = std::make_unique<FreeTypeFace>();
    if (FT_Init_FreeType(&owner->library) != 0 ||
        FT_New_Face(owner->library, reinterpret_cast<const char*>(file), index, &owner->face) != 0)
      continue;
    if (FT_IS_SCALABLE(owner->face) && !FT_HAS_COLOR(owner->face) && FT_Get_Char_Index(owner->face, letter) != 0)
      return face_of(std::move(owner));
  }
  return {};
}

/// A code point of UTF-8 that begins at `at`, and its length; bytes that are none stand for themselves.
struct Letter {
  char32_t code = 0;
  std::size_t length = 1;
};
Letter letter_at(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[at + k]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 1;
  if (length == 1 || at + length > text.size()) return {first, 1};
  char32_t code = first & (0xff >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    if (byte(k) >> 6 != 2) return {first, 1};
    code = code << 6 | (byte(k) & 0x3f);
  }
  return {code, length};
}

/// One letter of a text, with its height on the line.
struct Sign {
  std::string bytes;
  char32_t code;
  int level;
  bool italic = false;
};

std::vector<Sign> signs_of(std::string_view text, int level) {
  std::vector<Sign> signs;
  for (std::size_t i = 0; i < text.size();) {
    const Letter letter = letter_at(text, i);
    signs.push_back({std::string(text.substr(i, letter.length)), letter.code, level});
    i += letter.length;
  }
  return signs;
}

bool is_latin(char32_t c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_greek(char32_t c) { return c >= 0x391 && c <= 0x3c9; }
bool is_mark(char32_t c) { return c >= 0x300 && c < 0x370; }  // the dot of a rate
bool is_letter(char32_t c) {
  return is_latin(c) || is_mark(c) || (c >= 0xc0 && c < 0x250) || (c >= 0x370 && c < 0x530);
}
bool is_variable_of_greek(char32_t c) { return c >= 0x3b1 && c <= 0x3c9 && c != 0x3c0; }

/// The e of 1e-4.
bool of_exponent(const std::vector<Sign>& signs, std::size_t at) {
  const auto digit = [&](std::size_t k) {
    return k < signs.size() && signs[k].level == signs[at].level && signs[k].code >= '0' && signs[k].code <= '9';
  };
  const auto sign = [&](std::size_t k) {
    return k < signs.size() && (signs[k].code == '-' || signs[k].code == '+' || signs[k].code == 0x2212);
  };
  return (signs[at].code == 'e' || signs[at].code == 'E') && at > 0 && digit(at - 1) &&
         (digit(at + 1) || (sign(at + 1) && digit(at + 2)));
}

/// The letters signs[from..to) are one word: which of them are variables?
void set_italics(std::vector<Sign>& signs, std::size_t from, std::size_t to) {
  std::size_t letters = 0, latin = 0, greek = 0;
  for (std::size_t k = from; k < to; ++k) {
    letters += is_mark(signs[k].code) ? 0 : 1;
    latin += is_latin(signs[k].code) ? 1 : 0;
    greek += is_greek(signs[k].code) ? 1 : 0;
  }
  if (latin + greek != letters || letters == 0) return;
  const auto beside = [&](int way) -> const Sign* {  // the next sign that is no blank
    for (std::ptrdiff_t k = way < 0 ? static_cast<std::ptrdiff_t>(from) - 1 : static_cast<std::ptrdiff_t>(to);
         k >= 0 && k < static_cast<std::ptrdiff_t>(signs.size()); k += way)
      if (const char32_t c = signs[static_cast<std::size_t>(k)].code; c != ' ' && c != 0xa0)
        return &signs[static_cast<std::size_t>(k)];
    return nullptr;
  };
  const Sign *before = beside(-1), *after = beside(1);
  const bool touches_before = from > 0 && before == &signs[from - 1];
  const auto is = [](const Sign* sign, std::u32string_view any) {
    return sign != nullptr && any.find(sign->code) != std::u32string_view::npos;
  };
  const std::u32string_view mathematics = U"=<>≤≥/·×+−⟨⟩|^∂";
  const bool indexed = to < signs.size() && signs[to].level != signs[from].level;
  const bool in_formula = indexed || is(before, mathematics) || is(after, mathematics);
  const char32_t first = signs[from].code;
  bool variable = false;
  if (signs[from].level != 0)
    variable =
        letters <= 2 && (greek > 0 || std::u32string_view(U"xyznmijkpqt").find(first) != std::u32string_view::npos);
  else if (greek > 0)
    variable = letters <= 3;  // not a word of a Greek title
  else if (letters == 2)
    variable = first == 'd' && is(before, U"/");
  else if (letters == 1 && !is(before, U".'’") && !is(after, U".'’") && !(is(before, U"(") && is(after, U")"))) {
    const bool unit = before != nullptr && !touches_before && before->code >= '0' && before->code <= '9';
    const bool alone = before == nullptr && after == nullptr;
    variable = !unit && !of_exponent(signs, from) && (in_formula || alone || (first >= 'b' && first <= 'z'));
  }
  if (!variable) return;
  for (std::size_t k = from; k < to; ++k) {
    const bool differential = k == from && signs[k].code == 'd' && letters > 1;
    signs[k].italic = !differential && (is_latin(signs[k].code) || is_variable_of_greek(signs[k].code) ||
                                        (is_mark(signs[k].code) && k > from && signs[k - 1].italic));
  }
}

}  // namespace

std::vector<TextRun> text_runs(std::string_view text) {
  std::vector<Sign> signs;
  const auto add = [&](std::string_view part, int level) {
    const std::vector<Sign> more = signs_of(part, level);
    signs.insert(signs.end(), more.begin(), more.end());
  };
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool mark = (text[i] == '_' || text[i] == '^') && i + 1 < text.size() && text[i + 1] == '{';
    const std::size_t end = mark ? text.find('}', i) : std::string_view::npos;
    if (end == std::string_view::npos) continue;
    add(text.substr(begin, i - begin), 0);
    add(text.substr(i + 2, end - i - 2), text[i] == '_' ? -1 : 1);
    i = end;
    begin = end + 1;
  }
  add(text.substr(begin), 0);
  for (std::size_t from = 0; from < signs.size();) {
    std::size_t to = from;
    while (to < signs.size() && signs[to].level == signs[from].level && is_letter(signs[to].code)) ++to;
    if (to > from) set_italics(signs, from, to);
    from = std::max(to, from + 1);
  }
  std::vector<TextRun> runs;
  for (const Sign& sign : signs) {
    if (runs.empty() || runs.back().level != sign.level || runs.back().italic != sign.italic)
      runs.push_back({{}, sign.level, sign.italic});
    runs.back().text += sign.bytes;
  }
  return runs;
}

struct FontFaces {
  Face upright, italic;
  std::vector<Face> others;
  std::vector<std::pair<char32_t, std::string>> missing;
};

Font::Font(Use use, FontFamily family, bool italics)
    : faces_(std::make_shared<FontFaces>()), use_(use), italics_(italics) {
  const bool serif = family == FontFamily::serif;
  faces_->upright = embedded_face(serif ? "DejaVuSerif.ttf" : "DejaVuSans.ttf");
  if (italics) faces_->italic = embedded_face(serif ? "DejaVuSerif-Italic.ttf" : "DejaVuSans-Oblique.ttf");
}

std::string Font::missing() const {
  std::string all;
  for (const auto& [code, bytes] : faces_->missing) all += bytes;
  return all;
}

namespace {

/// The face for a letter: the wanted one, or one of the system; the wanted one again where nobody has the letter.
const Face& face_for(FontFaces& faces, const Face& wanted, char32_t code, const std::string& bytes) {
  if (code < 0x20 || FT_Get_Char_Index(wanted.letters, code) != 0) return wanted;
  if (FT_Get_Char_Index(faces.upright.letters, code) != 0) return faces.upright;
  for (const Face& other : faces.others)
    if (FT_Get_Char_Index(other.letters, code) != 0) return other;
  const auto is_it = [&](const auto& pair) { return pair.first == code; };
  if (std::any_of(faces.missing.begin(), faces.missing.end(), is_it)) return wanted;
  if (std::optional<Face> found = system_face(code)) return faces.others.emplace_back(std::move(*found));
  faces.missing.emplace_back(code, bytes);
  return wanted;
}

/// A part of a text in one font, on one height.
struct Piece {
  std::string text;
  std::shared_ptr<cairo_font_face_t> face;
  double size = 1, shift = 0;  ///< relative to the height of the text; shift: upward
};

std::vector<Piece> pieces_of(const Font& font, std::string_view text) {
  std::vector<Piece> pieces;
  for (const TextRun& run : text_runs(text)) {
    const std::size_t first = pieces.size();
    const Face wanted = run.italic && font.italics() ? font.faces().italic : font.faces().upright;
    for (const Sign& sign : signs_of(run.text, run.level)) {
      // An invisible selector of a variant, or a joiner, has no letter of its own.
      if ((sign.code >= 0xfe00 && sign.code <= 0xfe0f) || sign.code == 0x200d) continue;
      const Face& face = face_for(font.faces(), wanted, sign.code, sign.bytes);
      if (pieces.size() == first || pieces.back().face != face.cairo)
        pieces.push_back({{}, face.cairo, run.size(), run.shift()});
      pieces.back().text += sign.bytes;
    }
  }
  return pieces;
}

void set_font(cairo_t* cairo, const Piece& piece, double size) {
  cairo_set_font_face(cairo, piece.face.get());
  cairo_set_font_size(cairo, piece.size * size);
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

double width_of(cairo_t* cairo, const std::vector<Piece>& pieces, double size) {
  double width = 0;
  for (const Piece& piece : pieces) {
    set_font(cairo, piece, size);
    width += advance(cairo, piece.text);
  }
  return width;
}

double start_of(double x, double width, Align align) {
  return align == Align::left ? x : align == Align::centre ? x - width / 2 : x - width;
}

}  // namespace

double text_width(cairo_t* cairo, const Font& font, double size, std::string_view text) {
  return width_of(cairo, pieces_of(font, text), size);
}

TextBox text_box(cairo_t* cairo, const Font& font, double size, double x, double y, std::string_view text,
                 Align align) {
  const std::vector<Piece> pieces = pieces_of(font, text);
  double pen = start_of(x, width_of(cairo, pieces, size), align);
  TextBox box{1e300, 1e300, -1e300, -1e300};
  for (const Piece& piece : pieces) {
    set_font(cairo, piece, size);
    cairo_text_extents_t e;
    cairo_text_extents(cairo, piece.text.c_str(), &e);
    if (e.width > 0 && e.height > 0) {
      const double base = y - piece.shift * size;
      box = {std::min(box.left, pen + e.x_bearing), std::min(box.top, base + e.y_bearing),
             std::max(box.right, pen + e.x_bearing + e.width), std::max(box.bottom, base + e.y_bearing + e.height)};
    }
    pen += e.x_advance;
  }
  return box.left <= box.right ? box : TextBox{x, y, x, y};
}

namespace {

// The outlines of all letters as the current path, or the letters themselves; the advance width.
double set_text(cairo_t* cairo, const Font& font, double size, double x, double y, std::string_view text, Align align) {
  const std::vector<Piece> pieces = pieces_of(font, text);
  const double width = width_of(cairo, pieces, size);
  double pen = start_of(x, width, align);
  cairo_new_path(cairo);
  for (const Piece& piece : pieces) {
    set_font(cairo, piece, size);
    cairo_move_to(cairo, pen, y - piece.shift * size);
    font.use() == Font::Use::glyphs ? cairo_show_text(cairo, piece.text.c_str())
                                    : cairo_text_path(cairo, piece.text.c_str());
    pen += advance(cairo, piece.text);
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
