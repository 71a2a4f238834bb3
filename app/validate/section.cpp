#include "app/validate/section.h"

#include "app/base/progress.h"
#include "app/base/version.h"

#include "render/figures/panel_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace app {

namespace {

constexpr const char* page_head =
    "# Validation\n\n"
    "Each section is written by `tanktread validate NAME`, all of them by `tanktread validate all`: runs against "
    "closed\n"
    "forms, published figures, and an independent implementation of the same equations. Every row is one measured "
    "value;\n"
    "the command ends with status 1 when one misses. Times are those of one core.\n";

/// A page cut at its headings of second level: the head, then sections from their heading on.
std::vector<std::string> parts_of(const std::string& page) {
  std::vector<std::string> parts{""};
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t end = std::min(page.find('\n', at), page.size() - 1) + 1;
    const std::string line = page.substr(at, end - at);
    if (line.starts_with("## ")) parts.emplace_back();
    parts.back() += line;
    at = end;
  }
  return parts;
}

std::string title_of(const std::string& part) {
  return part.starts_with("## ") ? part.substr(3, part.find('\n') - 3) : std::string();
}

}  // namespace

void Section::table(std::vector<std::string> columns) { tables.push_back({"", std::move(columns), {}}); }
void Section::row(std::vector<std::string> cells) { tables.back().rows.push_back(std::move(cells)); }

std::string Section::verdict(bool good) {
  failures += good ? 0 : 1;
  return good ? "pass" : "FAIL";
}

void Section::checks() { table({"quantity", "measured", "expected", ""}); }

void Section::check(const std::string& what, double measured, double expected, double tolerance, int digits) {
  row({what, fmt::format("{:.{}f}", measured, digits), fmt::format("{:g} ± {:g}", expected, tolerance),
       verdict(std::abs(measured - expected) <= tolerance)});
}

void Section::below(const std::string& what, double measured, double bound) {
  row({what, fmt::format("{:.1e}", measured), fmt::format("below {:g}", bound), verdict(std::abs(measured) <= bound)});
}

void Section::check_texts(const std::string& what, const std::string& measured, const std::string& expected,
                          bool good) {
  row({what, measured, expected, verdict(good)});
}

void Section::note(const std::string& what, const std::string& measured) { row({what, measured, "", ""}); }

double rounded(double value, int digits) {
  const double unit = std::pow(10.0, digits);
  return std::round(value * unit) / unit;
}

render::Curve line_curve(std::string name, std::vector<double> x, std::vector<double> y, std::size_t colour, int dash) {
  render::Curve curve;
  curve.name = std::move(name);
  curve.x = std::move(x);
  curve.y = std::move(y);
  curve.colour = colour;
  curve.dash = dash;
  return curve;
}

render::Curve point_curve(std::string name, std::vector<double> x, std::vector<double> y, std::size_t colour,
                          render::Marker marker, bool line) {
  render::Curve curve = line_curve(std::move(name), std::move(x), std::move(y), colour);
  curve.marker = marker;
  curve.line = line;
  return curve;
}

render::Figure panels(const std::vector<render::Plot>& plots) {
  render::FigureInput input;
  input.parameters.columns = static_cast<int>(std::min<std::size_t>(plots.size(), 2));
  return render::arranged(input, plots, false, "");
}

std::string section_title(std::string_view name) {
  std::string title(name);
  title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

std::string markdown_text(const Section& section, const Measurement& how, const std::string& picture) {
  std::string text =
      fmt::format("## {}\n\n{}\n\n`tanktread validate {}` on {} with tanktread {} ({}), {}", section_title(how.name),
                  section.text, how.name, how.date, version(), build(), duration_text(how.seconds));
  if (how.runs == 1) text += fmt::format(". Its run: `{}`", how.command);
  if (how.runs > 1) text += fmt::format(". The first of its {} runs: `{}`", how.runs, how.command);
  text += "\n";
  if (section.figure) text += fmt::format("\n![{}]({})\n\n{}\n", section_title(how.name), picture, section.caption);
  for (const TextTable& table : section.tables) text += fmt::format("\n{}", markdown_text(table));
  return text;
}

std::string plain_text(const Section& section, const Measurement& how) {
  std::string text = fmt::format("{}, {}\n", section_title(how.name), duration_text(how.seconds));
  for (const TextTable& table : section.tables) text += fmt::format("\n{}", plain_text(table));
  return text;
}

std::string with_section(const std::string& page, const std::string& section, const std::vector<std::string>& order) {
  std::vector<std::string> parts = parts_of(page.empty() ? page_head : page);
  const auto place = [&](const std::string& title) {
    return std::find(order.begin(), order.end(), title) - order.begin();
  };
  const std::string title = title_of(section);
  auto at = std::find_if(parts.begin() + 1, parts.end(), [&](const std::string& p) { return title_of(p) == title; });
  if (at != parts.end()) {
    *at = section;
  } else {  // before the first that comes later
    at = std::find_if(parts.begin() + 1, parts.end(),
                      [&](const std::string& p) { return place(title_of(p)) > place(title); });
    parts.insert(at, section);
  }
  std::string text;
  for (std::string& part : parts) {
    while (part.ends_with('\n')) part.pop_back();
    text += (text.empty() ? "" : "\n\n") + part;
  }
  return text + "\n";
}

}  // namespace app
