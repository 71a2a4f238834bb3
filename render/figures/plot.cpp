#include "render/figures/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

namespace render {
namespace {

constexpr double number_gap = 0.5;     // between the frame and a number, in heights of the text
constexpr double label_spacing = 1.2;  // of the lines of a label, likewise

double label_height(const Theme& theme, const Axis& axis) {
  return label_spacing * theme.label * axis.label_scale * static_cast<double>(lines_of(axis.label).size());
}

std::string power_text(double decade) {
  const int n = static_cast<int>(std::lround(decade));
  return fmt::format("10^{{{}{}}}", n < 0 ? "−" : "", std::abs(n));
}

}  // namespace

void set_colour(const Pen& pen, const Colour& c, double opacity) {
  cairo_set_source_rgba(pen.cairo, c.r, c.g, c.b, opacity);
}

Ruler::Ruler(FontFamily family) : font_(Font::Use::paths, family, true) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  cairo_ = {cairo_create(surface), cairo_destroy};
  cairo_surface_destroy(surface);
}

double Ruler::width(double size, std::string_view text) const { return text_width(cairo_.get(), font_, size, text); }

namespace {

/// The longest part of a word from its begin that is not wider, at least one letter; never within `_{...}`.
std::size_t fitting(const Ruler& ruler, double size, std::string_view word, double width) {
  std::size_t best = 0;
  bool raised = false;
  for (std::size_t k = 0; k < word.size(); ++k) {
    if (word[k] == '{') raised = true;
    if (word[k] == '}') raised = false;
    const bool within_letter = k + 1 < word.size() && (static_cast<unsigned char>(word[k + 1]) & 0xc0) == 0x80;
    const bool before_index = k + 2 < word.size() && (word[k + 1] == '_' || word[k + 1] == '^') && word[k + 2] == '{';
    if (raised || within_letter || before_index || word[k] == '_' || word[k] == '^') continue;
    if (best > 0 && ruler.width(size, word.substr(0, k + 1)) > width) break;
    best = k + 1;
  }
  return best > 0 ? best : word.size();
}

}  // namespace

std::vector<std::string> wrapped(const Ruler& ruler, double size, std::string_view text, double width) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t at = 0; at <= text.size();) {
    std::size_t end = text.find(' ', at);
    if (end == std::string_view::npos) end = text.size();
    std::string_view word = text.substr(at, end - at);
    at = end + 1;
    const std::string longer = line.empty() ? std::string(word) : line + " " + std::string(word);
    if (ruler.width(size, longer) <= width) {
      line = longer;
      continue;
    }
    if (!line.empty()) lines.push_back(line);
    while (ruler.width(size, word) > width) {
      const std::size_t part = fitting(ruler, size, word, width);
      if (part >= word.size()) break;
      lines.emplace_back(word.substr(0, part));
      word.remove_prefix(part);
    }
    line = word;
  }
  if (!line.empty() || lines.empty()) lines.push_back(line);
  return lines;
}

std::string shortened(const Ruler& ruler, double size, const std::string& text, double width) {
  if (ruler.width(size, text) <= width) return text;
  std::string kept = text;
  while (!kept.empty()) {
    const std::string_view less(kept.data(), kept.size() - 1);
    const std::size_t part = fitting(ruler, size, less, width - ruler.width(size, "…"));
    if (part == 0 || part >= kept.size()) break;
    kept.resize(part);
    while (kept.ends_with(' ')) kept.pop_back();
    if (ruler.width(size, kept + "…") <= width) break;
  }
  return kept + "…";
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.emplace_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

Axis fitted(const Ruler& ruler, const Theme& theme, Axis axis, double length) {
  if (axis.label.empty()) return axis;
  const std::vector<std::string> whole = lines_of(axis.label);
  std::string text;
  for (const std::string& line : whole) text += (text.empty() ? "" : " ") + line;
  const double size = theme.label * axis.label_scale;
  double longest_word = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    longest_word = std::max(longest_word, 1.001 * ruler.width(size, text.substr(at, end - at)));
    at = end + 1;
  }
  double best = 0;
  for (int lines = 1; lines <= 3; ++lines) {
    // The narrowest lines, of so many.
    double width = std::max(ruler.width(size, text) / lines, longest_word);
    std::vector<std::string> broken = wrapped(ruler, size, text, width);
    for (int k = 0; k < 60 && broken.size() > static_cast<std::size_t>(lines); ++k)
      broken = wrapped(ruler, size, text, width *= 1.04);
    double widest = 0;
    for (const std::string& line : broken) widest = std::max(widest, ruler.width(size, line));
    const double factor = std::min(1.0, length / std::max(widest, 1e-9));
    if (factor <= best * 1.02) continue;
    best = factor;
    axis.label.clear();
    for (const std::string& line : broken) axis.label += (axis.label.empty() ? "" : "\n") + line;
    if (factor == 1) break;
  }
  axis.label_scale *= best;
  return axis;
}

std::vector<double> tick_values(const Range& range, int wanted, Scale scale) {
  if (!(range.size() > 0) || wanted < 1) return {};
  const double raw = range.size() / wanted, power = std::pow(10.0, std::floor(std::log10(raw)));
  std::vector<double> steps;
  if (scale == Scale::logarithmic)
    for (const double s : {1.0, 2.0, 3.0, 4.0, 5.0, 10.0, 20.0, 50.0, 100.0}) steps.push_back(s);
  else if (scale == Scale::degrees && raw > 4)
    steps = {5, 15, 30, 45, 90, 180, 360, 720, 1800, 3600};
  else
    for (const double factor : {1.0, 2.0, 2.5, 5.0, 10.0}) steps.push_back(factor * power);
  double step = steps.back();
  for (const double s : steps)
    if (s >= raw * 0.75) {
      step = s;
      break;
    }
  std::vector<double> ticks;
  for (double k = std::ceil(range.low / step - 1e-9); k * step <= range.high + 1e-9 * step; ++k) {
    if (k + 1 == k || (!ticks.empty() && !(k * step > ticks.back()))) break;  // finer than double precision
    ticks.push_back(k == 0 ? 0 : k * step);
  }
  return ticks;
}

std::vector<std::string> tick_texts(const std::vector<double>& values, Scale scale) {
  if (scale != Scale::logarithmic) return number_texts(values);
  std::vector<std::string> texts;
  for (const double v : values) texts.push_back(power_text(v));
  return texts;
}

Range range_of(const std::vector<double>& values, double margin, double least) {
  Range r{1e300, -1e300};
  for (const double v : values)
    if (std::isfinite(v)) r = {std::min(r.low, v), std::max(r.high, v)};
  if (r.low > r.high) return {0, 1};
  const double size = std::max(std::abs(r.low), std::abs(r.high));
  const double half = std::max({r.size() / 2 * (1 + 2 * margin), least / 2, 1e-12 * size}),
               middle = (r.low + r.high) / 2;
  if (half == 0) return {-1, 1};
  return {middle - half, middle + half};
}

Range decades(const std::vector<double>& values) {
  double low = 1e300, high = 0;
  for (const double v : values)
    if (v > 0 && std::isfinite(v)) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  if (high == 0) return {0, 1};
  const Range range{std::floor(std::log10(low) + 1e-9), std::ceil(std::log10(high) - 1e-9)};
  return {range.low, std::max(range.high, range.low + 1)};
}

std::vector<double> logarithms(const std::vector<double>& values) {
  std::vector<double> logs;
  for (const double v : values) logs.push_back(v > 0 ? std::log10(v) : std::nan(""));
  return logs;
}

Ticks ticks_of(const Ruler& ruler, const Theme& theme, const Axis& axis, const Range& range, double length,
               bool horizontal) {
  const auto measured = [&](std::vector<double> values) {
    Ticks t{std::move(values), {}, 0};
    t.texts = tick_texts(t.values, axis.scale);
    for (const std::string& text : t.texts) t.widest = std::max(t.widest, ruler.width(theme.text, text));
    return t;
  };
  const auto fits = [&](const Ticks& t) {
    double end = -1e300;  // of the number before
    for (std::size_t k = 0; k < t.values.size(); ++k) {
      const double extent = horizontal ? ruler.width(theme.text, t.texts[k]) : 1.15 * theme.text;
      const double at = (t.values[k] - range.low) / range.size() * length;
      if (at - extent / 2 < end + 0.55 * theme.text) return false;
      end = at + extent / 2;
    }
    return true;
  };
  const int most = std::clamp(static_cast<int>(length / (horizontal ? 5 : 3.2) / theme.text), 2, 6);
  for (int wanted = most; wanted >= 1; --wanted)
    if (Ticks t = measured(tick_values(range, wanted, axis.scale)); t.values.size() >= 2 && fits(t)) return t;
  for (int wanted = most + 1; wanted <= most + 3; ++wanted)
    if (Ticks t = measured(tick_values(range, wanted, axis.scale)); t.values.size() >= 2 && fits(t)) return t;
  // A short axis: two numbers that are far apart, or one.
  for (int wanted = 1; wanted <= 6; ++wanted)
    if (std::vector<double> v = tick_values(range, wanted, axis.scale); v.size() >= 2)
      if (Ticks t = measured({v.front(), v.back()}); fits(t)) return t;
  for (int wanted = 1; wanted <= 6; ++wanted)
    if (const std::vector<double> v = tick_values(range, wanted, axis.scale); !v.empty())
      return measured({v[v.size() / 2]});
  return {};
}

Margins margins_of(const Ruler& ruler, const Theme& theme, const Axes& axes, const Panel& panel) {
  Margins m;
  const double edge = 0.35 * theme.text;
  m.top = m.left = m.right = m.bottom = edge;
  const Ticks x = ticks_of(ruler, theme, axes.x, panel.x, panel.width, true);
  const Ticks y = ticks_of(ruler, theme, axes.y, panel.y, panel.height, false);
  if (axes.y.numbers) {
    m.left += y.widest + number_gap * theme.text;
    m.top = std::max(m.top, 0.6 * theme.text);
  }
  if (!axes.y.label.empty())
    m.left = std::max(m.left, axes.label_room) + 0.15 * theme.label + label_height(theme, axes.y);
  if (axes.x.numbers) {
    m.bottom += 1.3 * theme.text + number_gap * theme.text;
    if (!x.texts.empty()) {  // a number at the end of the axis hangs over
      const double at = (x.values.back() - panel.x.low) / panel.x.size() * panel.width;
      m.right = std::max(m.right, edge + at + ruler.width(theme.text, x.texts.back()) / 2 - panel.width);
      const double from = (x.values.front() - panel.x.low) / panel.x.size() * panel.width;
      m.left = std::max(m.left, edge + ruler.width(theme.text, x.texts.front()) / 2 - from);
    }
  }
  if (!axes.x.label.empty()) m.bottom += 0.3 * theme.label + label_height(theme, axes.x);
  return m;
}

Margins widest(const Margins& a, const Margins& b) {
  return {std::max(a.left, b.left), std::max(a.right, b.right), std::max(a.top, b.top), std::max(a.bottom, b.bottom)};
}

void draw_grid(const Pen& pen, const Panel& p, const Axes& axes) {
  const Ruler ruler(pen.theme.family);
  cairo_set_line_width(pen.cairo, 0.65 * pen.theme.line);
  set_colour(pen, pen.theme.faint);
  if (axes.x.grid)
    for (const double v : ticks_of(ruler, pen.theme, axes.x, p.x, p.width, true).values) {
      cairo_move_to(pen.cairo, p.page_x(v), p.top);
      cairo_line_to(pen.cairo, p.page_x(v), p.top + p.height);
    }
  if (axes.y.grid)
    for (const double v : ticks_of(ruler, pen.theme, axes.y, p.y, p.height, false).values) {
      cairo_move_to(pen.cairo, p.left, p.page_y(v));
      cairo_line_to(pen.cairo, p.left + p.width, p.page_y(v));
    }
  cairo_stroke(pen.cairo);
}

void draw_axes(const Pen& pen, const Panel& p, const Axes& axes) {
  cairo_t* cairo = pen.cairo;
  const Theme& theme = pen.theme;
  const Ruler ruler(pen.theme.family);
  set_colour(pen, theme.ink);
  cairo_set_line_width(cairo, theme.line);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_BUTT);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_MITER);
  const Ticks xs = ticks_of(ruler, theme, axes.x, p.x, p.width, true),
              ys = ticks_of(ruler, theme, axes.y, p.y, p.height, false);
  const auto mark = [&](bool horizontal, double v, double length) {
    const Range& range = horizontal ? p.x : p.y;
    if (v < range.low - 1e-9 * range.size() || v > range.high + 1e-9 * range.size()) return;
    cairo_move_to(cairo, horizontal ? p.page_x(v) : p.left, horizontal ? p.top + p.height : p.page_y(v));
    cairo_rel_line_to(cairo, horizontal ? 0 : length, horizontal ? -length : 0);
  };
  const auto marks = [&](bool horizontal, const Axis& axis, const Ticks& ticks) {
    for (const double v : ticks.values) mark(horizontal, v, theme.tick);
    if (axis.scale != Scale::logarithmic) return;
    const Range& range = horizontal ? p.x : p.y;
    const double length = horizontal ? p.width : p.height;
    for (double decade = std::floor(range.low); decade <= range.high; ++decade) {
      mark(horizontal, decade, theme.tick);
      if (length / range.size() > 2.5 * theme.text)  // room for the marks between
        for (int k = 2; k < 10; ++k) mark(horizontal, decade + std::log10(k), 0.55 * theme.tick);
    }
  };
  marks(true, axes.x, xs);
  marks(false, axes.y, ys);
  cairo_stroke(cairo);
  cairo_rectangle(cairo, p.left, p.top, p.width, p.height);
  cairo_stroke(cairo);
  if (axes.x.numbers)
    for (std::size_t k = 0; k < xs.values.size(); ++k)
      draw_text(cairo, pen.font, theme.text, p.page_x(xs.values[k]), p.top + p.height + (number_gap + 1) * theme.text,
                xs.texts[k], Align::centre);
  if (axes.y.numbers)
    for (std::size_t k = 0; k < ys.values.size(); ++k)
      draw_text(cairo, pen.font, theme.text, p.left - number_gap * theme.text,
                p.page_y(ys.values[k]) + 0.36 * theme.text, ys.texts[k], Align::right);
  if (!axes.x.label.empty()) {
    const double size = theme.label * axes.x.label_scale;
    double y = p.top + p.height + (axes.x.numbers ? (number_gap + 1.3) * theme.text : 0) + 1.15 * size;
    for (const std::string& line : lines_of(axes.x.label)) {
      draw_text(cairo, pen.font, size, p.left + p.width / 2, y, line, Align::centre);
      y += label_spacing * size;
    }
  }
  if (axes.y.label.empty()) return;
  const double beside = axes.label_room > 0 ? axes.label_room
                        : axes.y.numbers    ? ys.widest + number_gap * theme.text
                                            : 0;
  const double size = theme.label * axes.y.label_scale;
  const std::vector<std::string> lines = lines_of(axes.y.label);
  cairo_save(cairo);
  cairo_translate(cairo, p.left - beside - 0.6 * size, p.top + p.height / 2);
  cairo_rotate(cairo, -std::numbers::pi / 2);
  for (std::size_t k = 0; k < lines.size(); ++k)
    draw_text(cairo, pen.font, size, 0, -label_spacing * size * static_cast<double>(lines.size() - 1 - k), lines[k],
              Align::centre);
  cairo_restore(cairo);
}

double title_height(const Theme& theme) { return 1.75 * theme.label; }

void draw_title(const Pen& pen, const Panel& p, std::string_view text) {
  set_colour(pen, pen.theme.ink);
  draw_text(pen.cairo, pen.font, pen.theme.label, p.left, p.top - 0.55 * pen.theme.label, text);
}

}  // namespace render
