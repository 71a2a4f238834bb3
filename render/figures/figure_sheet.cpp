// A sheet of pictures, (a) to (h), all at one scale.
#include "render/figures/figure_kinds.h"
#include "render/scene/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace render {
namespace {

/// What one state needs of its panel, along the axes of the picture.
struct Extent {
  Eigen::Vector2d low, high;
};

Extent extent_of(const sim::State& state, const ViewAxes& axes) {
  Extent e{Eigen::Vector2d::Constant(1e300), Eigen::Vector2d::Constant(-1e300)};
  const StateSummary summary = summarize(state);
  for (std::size_t k = 0; k < summary.points.size(); ++k) {
    const glm::dvec3 point = summary.point(k);
    const Eigen::Vector2d p(glm::dot(point, axes.right), glm::dot(point, axes.up));
    e.low = e.low.cwiseMin(p);
    e.high = e.high.cwiseMax(p);
  }
  return e;
}

/// What the panels of a sheet need, in lengths of the scene.
struct SheetNeeds {
  std::vector<Extent> extents;
  std::vector<double> widths;
  double half_height = 0;  ///< of all panels
};
SheetNeeds needs_of(const FigureInput& input, const ViewAxes& axes) {
  SheetNeeds needs;
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();
  for (const sim::State& state : input.states) {
    needs.extents.push_back(extent_of(state, axes));
    largest = largest.cwiseMax(needs.extents.back().high - needs.extents.back().low);
  }
  const double margin = 0.10 * largest.y() + 0.15 * input.length;
  needs.half_height = largest.y() / 2 + margin;
  for (const Extent& e : needs.extents)
    needs.widths.push_back(std::max(e.high.x() - e.low.x() + 2 * margin, 1.2 * needs.half_height));
  return needs;
}

/// The page that rows of panels fill, pt.
struct SheetPage {
  double width, height;  ///< height 0: as much as the rows need
  double gap;            ///< between two panels
  double title, space;   ///< above and below each row
};

/// Rows filled one after the other at a scale; the index after the last panel of each.
std::vector<std::size_t> row_ends(const SheetNeeds& needs, const SheetPage& page, std::size_t most, double scale) {
  std::vector<std::size_t> ends;
  double used = 0;
  std::size_t in_row = 0;
  for (std::size_t k = 0; k < needs.widths.size(); ++k) {
    const double w = needs.widths[k] * scale;
    if (in_row > 0 && (used + page.gap + w > page.width * (1 + 1e-9) || in_row == most)) {
      ends.push_back(k);
      used = 0;
      in_row = 0;
    }
    used += (in_row > 0 ? page.gap : 0) + w;
    ++in_row;
  }
  ends.push_back(needs.widths.size());
  return ends;
}

/// Of so many rows, pt.
double height_of(const SheetNeeds& needs, const SheetPage& page, double scale, std::size_t rows) {
  return static_cast<double>(rows) * (2 * needs.half_height * scale + page.title + page.space);
}

struct Rows {
  std::vector<std::size_t> ends;
  double scale = 1;  ///< points per length
};

/// The largest scale whose rows fit on the page.
Rows fitted_rows(const SheetNeeds& needs, const SheetPage& page, std::size_t most) {
  const double tallest = page.height > 0 ? page.height : 0.86 * page.width;
  Rows rows;
  rows.scale = page.width / *std::max_element(needs.widths.begin(), needs.widths.end());
  if (page.height == 0) rows.scale = std::min(rows.scale, 0.5 * page.width / (2 * needs.half_height));
  rows.ends = row_ends(needs, page, most, rows.scale);
  for (int k = 0; k < 400 && height_of(needs, page, rows.scale, rows.ends.size()) > tallest; ++k) {
    rows.scale *= 0.99;
    rows.ends = row_ends(needs, page, most, rows.scale);
  }
  // Full rows may leave room for a larger scale with the same rows.
  const auto count = static_cast<double>(rows.ends.size());
  double fullest = 0;
  for (std::size_t r = 0, k = 0; r < rows.ends.size(); ++r) {
    double sum = 0;
    const auto in_row = static_cast<double>(rows.ends[r] - k);
    for (; k < rows.ends[r]; ++k) sum += needs.widths[k];
    fullest = std::max(fullest, sum / (page.width - page.gap * (in_row - 1)));
  }
  const double room = (tallest - count * (page.title + page.space)) / (count * 2 * needs.half_height);
  if (page.height > 0 || rows.ends.size() > 1) rows.scale = std::max(rows.scale, std::min(1 / fullest, room));
  return rows;
}

}  // namespace

Sheet sheet_layout(const FigureInput& input) {
  if (input.states.empty()) throw std::invalid_argument("a sheet of snapshots needs at least one state");
  const Page paper = page_of(input.parameters);
  const Theme& theme = paper.theme;
  const SheetPage page{.width = paper.width > 0 ? paper.width : theme.width,
                       .height = paper.height,
                       .gap = 0.9 * theme.text,
                       .title = title_height(theme),
                       .space = 0.3 * theme.text};
  const ViewAxes axes = find_camera(input.camera).axes;
  const SheetNeeds needs = needs_of(input, axes);
  const std::size_t most =
      input.parameters.columns > 0 ? static_cast<std::size_t>(input.parameters.columns) : needs.widths.size();
  const auto [ends, scale] = fitted_rows(needs, page, most);

  Sheet sheet;
  sheet.width = page.width;
  sheet.scale = scale;
  const double height = 2 * needs.half_height * scale;
  const double used = height_of(needs, page, scale, ends.size());
  sheet.height = page.height > 0 ? page.height : std::ceil(used);
  const double first = std::max(0.0, sheet.height - used) / 2;
  for (std::size_t r = 0, k = 0; r < ends.size(); ++r) {
    double sum = 0;
    for (std::size_t i = k; i < ends[r]; ++i) sum += needs.widths[i] * scale;
    const auto in_row = static_cast<double>(ends[r] - k);
    const double extra = (page.width - page.gap * (in_row - 1) - sum) / in_row;
    double left = 0;
    for (; k < ends[r]; ++k) {
      SheetPanel p;
      p.left = left;
      p.top = first + static_cast<double>(r) * (height + page.title + page.space) + page.title;
      p.width = needs.widths[k] * scale + extra;
      p.height = height;
      const Eigen::Vector2d middle = (needs.extents[k].low + needs.extents[k].high) / 2;
      p.target = middle.x() * to_sim(axes.right) + middle.y() * to_sim(axes.up);
      p.half_height = needs.half_height;
      p.title = fmt::format("({})  {}", letter(k), time_text(input, input.time_factor * input.states[k].time));
      left += p.width + page.gap;
      sheet.panels.push_back(std::move(p));
    }
  }
  return sheet;
}

Figure draw_snapshots(const FigureInput& input) {
  const Sheet sheet = sheet_layout(input);
  if (input.stills.size() != sheet.panels.size())
    throw std::invalid_argument("a sheet of snapshots needs one picture a state");
  const Page page = page_of(input.parameters);
  Figure figure;
  figure.csv = "panel,time,vesicle,center_x,center_y,center_z\n";
  for (std::size_t k = 0; k < input.states.size(); ++k)
    for (std::size_t v = 0; v < input.states[k].vesicles.size(); ++v) {
      sim::State one;
      one.vesicles = {input.states[k].vesicles[v]};
      const glm::dvec3 c = summarize(one).centroid / input.length;
      figure.csv += fmt::format("{},{:.10g},{},{:.10g},{:.10g},{:.10g}\n", letter(k),
                                input.time_factor * input.states[k].time, v, c.x, c.y, c.z);
    }
  const auto stills = std::make_shared<const std::vector<Image>>(input.stills);
  figure.drawing = {.width = sheet.width,
                    .height = sheet.height,
                    .paint = nullptr,
                    .ground = page.theme.ground,
                    .dots_per_inch = dots_per_inch(input.parameters)};
  figure.drawing.paint = [sheet, stills, input_length = input.length, symbol = input.length_symbol, theme = page.theme](
                             cairo_t* cairo, const Font& font) {
    const Pen pen{cairo, font, theme};
    for (std::size_t k = 0; k < sheet.panels.size(); ++k) {
      const SheetPanel& p = sheet.panels[k];
      draw_picture(cairo, (*stills)[k], p.left, p.top, p.width, p.height);
      set_colour(pen, theme.soft, 0.75);
      cairo_set_line_width(cairo, 0.65 * theme.line);
      const double inset = 0.35 * theme.line;
      cairo_rectangle(cairo, p.left + inset, p.top, p.width - 2 * inset, p.height);
      cairo_stroke(cairo);
      Panel frame;
      frame.left = p.left + inset;
      frame.top = p.top;
      draw_title(pen, frame, p.title);
    }
    // A bar one unit long in the first panel: all panels have one scale. It stands on the picture, which is light.
    const SheetPanel& p = sheet.panels.front();
    const double bar = sheet.scale * input_length, x = p.left + 0.9 * theme.text,
                 y = p.top + p.height - 0.9 * theme.text;
    cairo_set_source_rgb(cairo, ink.r, ink.g, ink.b);
    cairo_rectangle(cairo, x, y - 0.18 * theme.text, bar, 0.18 * theme.text);
    cairo_fill(cairo);
    draw_text(cairo, font, theme.text, x + bar / 2, y - 0.55 * theme.text, symbol, Align::centre);
  };
  return figure;
}

}  // namespace render
