#include "render/figures/canvas.h"

#include "render/image/image.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace render {
namespace {

struct Destroy {
  void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
  void operator()(cairo_t* c) const { cairo_destroy(c); }
};
using Surface = std::unique_ptr<cairo_surface_t, Destroy>;
using Context = std::unique_ptr<cairo_t, Destroy>;

void check(cairo_status_t status, const std::filesystem::path& path) {
  if (status != CAIRO_STATUS_SUCCESS) throw std::runtime_error(path.string() + ": " + cairo_status_to_string(status));
}

void paint(cairo_surface_t* surface, const Drawing& drawing, double scale, const Font& font,
           const std::filesystem::path& path) {
  const Context cairo(cairo_create(surface));
  cairo_scale(cairo.get(), scale, scale);
  if (!drawing.transparent) {
    cairo_set_source_rgb(cairo.get(), drawing.ground.r, drawing.ground.g, drawing.ground.b);
    cairo_paint(cairo.get());
  }
  drawing.paint(cairo.get(), font);
  check(cairo_status(cairo.get()), path);
}

// What XML allows, with its own signs spelt out.
std::string xml_text(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      safe += ' ';
    else
      safe += c;
  }
  return safe;
}

// Cairo would draw each letter as a path. A line of text is one element here, its raised and lowered parts spans of it.
std::string text_element(const PageText& t, FontFamily family) {
  constexpr const char* anchors[] = {"start", "middle", "end"};
  const auto channel = [](double v) { return static_cast<int>(std::lround(255 * v)); };
  const cairo_matrix_t& m = t.place;
  const bool plain = m.xx == 1 && m.yx == 0 && m.xy == 0 && m.yy == 1 && m.x0 == 0 && m.y0 == 0;
  const std::string moved = plain ? ""
                                  : fmt::format(" transform=\"matrix({:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g})\"",
                                                m.xx, m.yx, m.xy, m.yy, m.x0, m.y0);
  std::string element = fmt::format(
      "<text xml:space=\"preserve\"{} x=\"{:.6g}\" y=\"{:.6g}\" font-family=\"{}\" "
      "font-size=\"{:.6g}\" text-anchor=\"{}\" "
      "fill=\"#{:02x}{:02x}{:02x}\"",
      moved, t.x, t.y,
      family == FontFamily::serif ? "'DejaVu Serif', 'Times New Roman', serif" : "'DejaVu Sans', Verdana, sans-serif",
      t.size, anchors[static_cast<int>(t.align)], channel(t.red), channel(t.green), channel(t.blue));
  if (t.alpha < 1) element += fmt::format(" fill-opacity=\"{:.3g}\"", t.alpha);
  element += ">";
  double shift = 0;  // of the baseline, upward
  for (const TextRun& run : text_runs(t.text)) {
    if (run.text.empty()) continue;
    const double rise = run.shift() * t.size - shift;
    shift += rise;
    std::string attributes = run.italic ? " font-style=\"italic\"" : "";
    if (run.level != 0 || rise != 0)
      attributes += fmt::format(" dy=\"{:.6g}\" font-size=\"{:.6g}\"", -rise, run.size() * t.size);
    element +=
        attributes.empty() ? xml_text(run.text) : fmt::format("<tspan{}>{}</tspan>", attributes, xml_text(run.text));
  }
  return element + "</text>\n";
}

cairo_status_t append(void* text, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_'; }

/// The name that begins there.
std::string name_at(const std::string& svg, std::size_t at) {
  std::size_t end = at;
  while (end < svg.size() && is_name(svg[end])) ++end;
  return svg.substr(at, end - at);
}

/// Cairo numbers pictures, masks and whatever else has an id through the life of the process, each version others of
/// them: here all are numbered through the file, each kind in the order in which they are defined.
std::string renumbered(const std::string& svg) {
  constexpr std::string_view definition = " id=\"";
  std::map<std::string, std::string> names;
  std::map<std::string, int> counts;
  for (std::size_t at = 0; (at = svg.find(definition, at)) != std::string::npos;) {
    at += definition.size();
    const std::string name = name_at(svg, at);
    const std::string kind = name.substr(0, name.find_first_of("0123456789"));
    if (names.try_emplace(name, kind + std::to_string(counts[kind])).second) ++counts[kind];
  }
  std::string result;
  for (std::size_t at = 0; at < svg.size();) {
    const bool reference = svg[at] == '#';
    if (!reference && svg.compare(at, definition.size(), definition) != 0) {
      result += svg[at++];
      continue;
    }
    const std::size_t length = reference ? 1 : definition.size();
    result += svg.substr(at, length);
    at += length;
    const std::string name = name_at(svg, at);
    const auto found = names.find(name);
    result += found == names.end() ? name : found->second;
    at += name.size();
  }
  return result;
}

}  // namespace

namespace {

Font font_of(const Drawing& drawing, Font::Use use) {
  return Font(drawing.outlines && use != Font::Use::paths ? Font::Use::paths : use, drawing.family, true);
}

/// Paints without a page; the font holds the texts.
Font texts_kept(const Drawing& drawing) {
  Font font(Font::Use::kept, drawing.family, true);
  const Surface surface(cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, nullptr));
  paint(surface.get(), drawing, 1, font, "a page without a file");
  return font;
}

/// Colour that was multiplied by its opacity, as a byte without it.
std::uint8_t without_opacity(std::uint32_t channel, std::uint32_t alpha) {
  return alpha == 0 ? 0 : static_cast<std::uint8_t>(std::min(255U, (channel * 255 + alpha / 2) / alpha));
}

}  // namespace

std::vector<PlacedText> texts_of(const Drawing& drawing) {
  const Font font = texts_kept(drawing);
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1));
  const Context cairo(cairo_create(surface.get()));
  std::vector<PlacedText> all;
  for (const PageText& t : font.texts()) {
    const TextBox own = text_box(cairo.get(), font, t.size, t.x, t.y, t.text, t.align);
    TextBox page{1e300, 1e300, -1e300, -1e300};
    for (double x : {own.left, own.right})
      for (double y : {own.top, own.bottom}) {
        double px = x, py = y;
        cairo_matrix_transform_point(&t.place, &px, &py);
        page = {std::min(page.left, px), std::min(page.top, py), std::max(page.right, px), std::max(page.bottom, py)};
      }
    all.push_back({t, page});
  }
  return all;
}

std::string missing_letters(const Drawing& drawing) { return texts_kept(drawing).missing(); }

void write_drawing_png(const std::filesystem::path& path, const Drawing& drawing, const PngText& text,
                       const sim::FileWriter& write) {
  const double scale = drawing.dots_per_inch / 72;
  const int width = static_cast<int>(std::lround(drawing.width * scale));
  const int height = static_cast<int>(std::lround(drawing.height * scale));
  const Surface surface(
      cairo_image_surface_create(drawing.transparent ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24, width, height));
  check(cairo_surface_status(surface.get()), path);
  paint(surface.get(), drawing, scale, font_of(drawing, Font::Use::paths), path);
  cairo_surface_flush(surface.get());
  const unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  Image image(width, height, drawing.transparent ? 4 : 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      std::uint32_t v = 0;
      std::memcpy(&v, data + static_cast<std::ptrdiff_t>(y) * stride + 4 * static_cast<std::ptrdiff_t>(x), sizeof v);
      const std::uint32_t alpha = drawing.transparent ? v >> 24 : 255;
      std::uint8_t* p = image.at(x, y);
      for (int c = 0; c < 3; ++c) p[c] = without_opacity(v >> (16 - 8 * c) & 255, alpha);
      if (drawing.transparent) p[3] = static_cast<std::uint8_t>(alpha);
    }
  PngText chunks = text;
  if (!drawing.title.empty()) chunks.emplace_back("Title", drawing.title);
  if (!drawing.subject.empty()) chunks.emplace_back("Description", drawing.subject);
  write_png(path, image, chunks, default_compression, drawing.dots_per_inch, write);
}

void write_drawing_svg(const std::filesystem::path& path, const Drawing& drawing, const sim::FileWriter& write) {
  std::string text;
  const Font font = font_of(drawing, Font::Use::kept);
  {
    const Surface surface(cairo_svg_surface_create_for_stream(append, &text, drawing.width, drawing.height));
    check(cairo_surface_status(surface.get()), path);
    paint(surface.get(), drawing, 1, font, path);
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()), path);
  }
  const std::size_t end = text.rfind("</svg>");
  if (end == std::string::npos) throw std::runtime_error(path.string() + ": Cairo wrote no complete SVG");
  std::string texts;
  for (const PageText& t : font.texts()) texts += text_element(t, drawing.family);
  std::string about;
  if (!drawing.title.empty()) about += "<title>" + xml_text(drawing.title) + "</title>\n";
  if (!drawing.subject.empty()) about += "<desc>" + xml_text(drawing.subject) + "</desc>\n";
  const std::string page = renumbered(text.substr(0, end));
  const std::size_t inside = std::min(page.find('>', page.find("<svg")), page.size() - 1) + 1;
  write(path, page.substr(0, inside) + "\n" + about + page.substr(inside) + texts + text.substr(end));
}

void write_drawing_pdf(const std::filesystem::path& path, const Drawing& drawing, const sim::FileWriter& write) {
  std::string text;
  {
    const Surface surface(cairo_pdf_surface_create_for_stream(append, &text, drawing.width, drawing.height));
    check(cairo_surface_status(surface.get()), path);
    // the time of writing would be the only thing that differs from run to run
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, drawing.title.c_str());
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_SUBJECT, drawing.subject.c_str());
    paint(surface.get(), drawing, 1, font_of(drawing, Font::Use::glyphs), path);
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()), path);
  }
  write(path, text);
}

}  // namespace render
