// A sheet of pictures, (a) to (h), all at one scale.
#include "render/core/style.h"
#include "render/figures/figure_kinds.h"
#include "render/scene/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace render {
namespace {

/// What one state needs of its panel, along the axes of the picture.
struct Extent {
  Eigen::Vector2d low, high;
};

glm::dvec3 corner_of(const FaceBox& box, int k) {
  return {(k & 1) ? box.high.x : box.low.x, (k & 2) ? box.high.y : box.low.y, (k & 4) ? box.high.z : box.low.z};
}

Extent extent_of(const sim::State& state, const std::optional<FaceBox>& box, const ViewAxes& axes) {
  Extent e{Eigen::Vector2d::Constant(1e300), Eigen::Vector2d::Constant(-1e300)};
  const auto add = [&](const glm::dvec3& point) {
    const Eigen::Vector2d p(glm::dot(point, axes.right), glm::dot(point, axes.up));
    e.low = e.low.cwiseMin(p);
    e.high = e.high.cwiseMax(p);
  };
  if (box) {
    for (int k = 0; k < 8; ++k) add(corner_of(*box, k));
    return e;
  }
  const StateSummary summary = summarize(state);
  for (std::size_t k = 0; k < summary.points.size(); ++k) add(summary.point(k));
  return e;
}

/// What the panels of a sheet need, in lengths of the scene.
struct SheetNeeds {
  std::vector<Extent> extents;
  std::vector<double> widths;
  double half_height = 0;      ///< of all panels
  std::vector<double> titles;  ///< widths of the texts above the panels, pt

  double width_at(std::size_t k, double scale) const { return std::max(widths[k] * scale, titles[k]); }
};
SheetNeeds needs_of(const FigureInput& input, const ViewAxes& axes) {
  SheetNeeds needs;
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();
  for (const sim::State& state : input.states) {
    needs.extents.push_back(extent_of(state, input.box, axes));
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
  double foot;           ///< below them all
};

/// Rows filled one after the other at a scale; the index after the last panel of each.
std::vector<std::size_t> row_ends(const SheetNeeds& needs, const SheetPage& page, std::size_t most, double scale) {
  std::vector<std::size_t> ends;
  double used = 0;
  std::size_t in_row = 0;
  for (std::size_t k = 0; k < needs.widths.size(); ++k) {
    const double w = needs.width_at(k, scale);
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
  return static_cast<double>(rows) * (2 * needs.half_height * scale + page.title + page.space) + page.foot;
}

struct Rows {
  std::vector<std::size_t> ends;
  double scale = 1;    ///< points per length
  double uniform = 0;  ///< width of all panels, pt; 0: each as its state needs
};

/// The grid of equal panels with the largest scale.
Rows fitted_grid(const SheetNeeds& needs, const SheetPage& page, std::size_t most) {
  const std::size_t count = needs.widths.size();
  const double tallest = page.height > 0 ? page.height : 0.86 * page.width;
  const double widest = *std::max_element(needs.widths.begin(), needs.widths.end());
  const double title = *std::max_element(needs.titles.begin(), needs.titles.end());
  Rows best{.ends = {}, .scale = 0};
  for (std::size_t columns = 1; columns <= std::min(most, count); ++columns) {
    const std::size_t rows = (count + columns - 1) / columns;
    const double width = (page.width - page.gap * static_cast<double>(columns - 1)) / static_cast<double>(columns);
    const double room = (tallest - page.foot - static_cast<double>(rows) * (page.title + page.space)) /
                        (static_cast<double>(rows) * 2 * needs.half_height);
    const double scale = std::min(width / widest, room);
    if (scale <= best.scale || title > width) continue;
    best = {.ends = {}, .scale = scale, .uniform = width};
    for (std::size_t end = columns; end < count + columns; end += columns) best.ends.push_back(std::min(end, count));
  }
  return best;
}

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
  const double room = (tallest - page.foot - count * (page.title + page.space)) / (count * 2 * needs.half_height);
  const double larger = std::max(rows.scale, std::min(1 / fullest, room));
  if ((page.height > 0 || rows.ends.size() > 1) && row_ends(needs, page, most, larger) == rows.ends)
    rows.scale = larger;
  return rows;
}

/// A line so long with its ends marked, and what it is beside it.
void draw_scale_bar(const Pen& pen, double left, double baseline, double length, const std::string& symbol) {
  const double text = pen.theme.text, y = baseline - 0.3 * text, tick = 0.22 * text;
  set_colour(pen, pen.theme.ink);
  cairo_set_line_width(pen.cairo, 1.4 * pen.theme.line);
  cairo_set_line_cap(pen.cairo, CAIRO_LINE_CAP_BUTT);
  const double inset = 0.7 * pen.theme.line;
  cairo_move_to(pen.cairo, left + inset, y);
  cairo_rel_line_to(pen.cairo, length, 0);
  for (const double x : {left + inset, left + inset + length}) {
    cairo_move_to(pen.cairo, x, y - tick);
    cairo_rel_line_to(pen.cairo, 0, 2 * tick);
  }
  cairo_stroke(pen.cairo);
  draw_text(pen.cairo, pen.font, text, left + length + 0.8 * text, baseline, symbol);
}

/// The colours of the field below the panels: its label, the bar, numbers.
void draw_field_bar(const Pen& pen, const Legend& field, double left, double right, double top) {
  const Theme& theme = pen.theme;
  const double text = theme.text, height = 0.8 * text, point = 0.8 * height;
  const Ruler ruler(theme.family);
  Panel bar;
  bar.x = {field.low, field.high};
  bar.y = {0, 1};
  bar.left = left + point;
  bar.width = right - left - 2 * point;
  bar.top = top + 1.35 * text;
  bar.height = height;
  constexpr int steps = 256;
  Image ramp(steps, 1, 3);
  for (int k = 0; k < steps; ++k)
    std::copy(field.colours[static_cast<std::size_t>(k)].begin(), field.colours[static_cast<std::size_t>(k)].end(),
              ramp.at(k, 0));
  draw_picture(pen.cairo, ramp, bar.left, bar.top, bar.width, bar.height);
  const double bottom = bar.top + height, end = bar.left + bar.width;
  const auto outside = [&](double from, double tip, double share) {  // values beyond the range
    const Colour c = mapped(field.colours, share);
    set_colour(pen, c);
    cairo_move_to(pen.cairo, from, bar.top);
    cairo_line_to(pen.cairo, tip, bar.top + height / 2);
    cairo_line_to(pen.cairo, from, bottom);
    cairo_close_path(pen.cairo);
    cairo_fill(pen.cairo);
  };
  if (field.mirrored) {  // the dots of values in the lower half
    const double spacing = height / 2;
    for (double x = bar.left + bar.width / 2 - spacing / 2; x > bar.left + spacing / 4; x -= spacing)
      for (const double y : {bar.top + spacing / 2, bottom - spacing / 2}) {
        const double share = (x - bar.left) / bar.width, shown = std::min((0.5 - share) / SignDots::full, 1.0);
        set_colour(pen, sign_dot_colour(mapped(field.colours, share)));
        cairo_new_path(pen.cairo);
        cairo_arc(pen.cairo, x, y, SignDots::radius * spacing * shown, 0, 2 * std::numbers::pi);
        cairo_fill(pen.cairo);
      }
  }
  if (field.below) outside(bar.left, bar.left - point, 0);
  if (field.above) outside(end, end + point, 1);
  set_colour(pen, theme.ink);
  cairo_set_line_width(pen.cairo, 0.8 * theme.line);
  cairo_move_to(pen.cairo, bar.left, bar.top);
  cairo_line_to(pen.cairo, end, bar.top);
  if (field.above) cairo_line_to(pen.cairo, end + point, bar.top + height / 2);
  cairo_line_to(pen.cairo, end, bottom);
  cairo_line_to(pen.cairo, bar.left, bottom);
  if (field.below) cairo_line_to(pen.cairo, bar.left - point, bar.top + height / 2);
  cairo_close_path(pen.cairo);
  cairo_stroke(pen.cairo);
  const Ticks ticks = ticks_of(ruler, theme, {}, bar.x, bar.width, true);
  for (std::size_t k = 0; k < ticks.values.size(); ++k) {
    const double x = bar.page_x(ticks.values[k]);
    cairo_move_to(pen.cairo, x, bottom);
    cairo_rel_line_to(pen.cairo, 0, 0.3 * text);
    cairo_stroke(pen.cairo);
    draw_text(pen.cairo, pen.font, text, x, bottom + 1.25 * text, ticks.texts[k], Align::centre);
  }
  const Axis label = fitted(ruler, theme, {.label = field.label}, bar.width);
  draw_text(pen.cairo, pen.font, std::min(text, theme.label * label.label_scale), bar.left + bar.width / 2,
            top + 0.95 * text, field.label, Align::centre);
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
                       .space = 0.3 * theme.text,
                       .foot = (input.shows_field ? 4.1 : 1.7) * theme.text};
  const ViewAxes axes = find_camera(input.camera).axes;
  SheetNeeds needs = needs_of(input, axes);
  const Ruler ruler(theme.family);
  std::vector<std::string> titles;
  for (std::size_t k = 0; k < input.states.size(); ++k) {
    titles.push_back(fmt::format("({})  {}", letter(k), time_text(input, input.time_factor * input.states[k].time)));
    needs.titles.push_back(ruler.width(theme.label, titles.back()) + 0.3 * theme.text);
  }
  const std::size_t most =
      input.parameters.columns > 0 ? static_cast<std::size_t>(input.parameters.columns) : needs.widths.size();
  Rows rows = fitted_rows(needs, page, most);
  // Equal panels look calmer, where the vesicles do not become much smaller in them.
  if (Rows grid = fitted_grid(needs, page, most); grid.scale > 0.65 * rows.scale) rows = std::move(grid);
  const auto& [ends, scale, uniform] = rows;

  Sheet sheet;
  sheet.width = page.width;
  sheet.scale = scale;
  const double height = 2 * needs.half_height * scale;
  const double used = height_of(needs, page, scale, ends.size());
  sheet.height = page.height > 0 ? page.height : std::ceil(used);
  const double first = std::max(0.0, sheet.height - used) / 2;
  for (std::size_t r = 0, k = 0; r < ends.size(); ++r) {
    double sum = 0;
    for (std::size_t i = k; i < ends[r]; ++i) sum += needs.width_at(i, scale);
    const auto in_row = static_cast<double>(ends[r] - k);
    const double extra = (page.width - page.gap * (in_row - 1) - sum) / in_row;
    double left = 0;
    for (; k < ends[r]; ++k) {
      SheetPanel p;
      p.left = left;
      p.top = first + static_cast<double>(r) * (height + page.title + page.space) + page.title;
      p.width = uniform > 0 ? uniform : needs.width_at(k, scale) + extra;
      p.height = height;
      const Eigen::Vector2d middle = (needs.extents[k].low + needs.extents[k].high) / 2;
      p.target = middle.x() * to_sim(axes.right) + middle.y() * to_sim(axes.up);
      p.half_height = needs.half_height;
      p.title = titles[k];
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
  const auto paint = [sheet, stills, scale_bar = sheet.scale * input.length, symbol = input.length_symbol,
                      field = input.field, theme = page.theme](cairo_t* cairo, const Font& font) {
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
    // All panels have one scale.
    const double foot = sheet.panels.back().top + sheet.panels.back().height, left = sheet.panels.front().left;
    draw_scale_bar(pen, left, foot + 0.95 * theme.text, scale_bar, symbol);
    if (!field) return;
    const double from = left + scale_bar + 4 * theme.text, width = std::min(0.55 * sheet.width, 26 * theme.text);
    draw_field_bar(pen, *field, std::max(from, sheet.width - width), sheet.width - 0.5 * theme.text, foot);
  };
  figure.drawing = drawing_on(page.theme, input.parameters, sheet.width, sheet.height, paint);
  return figure;
}

}  // namespace render
