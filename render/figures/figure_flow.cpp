// Streamlines in a plane, with the speed as colour under them and the membranes on top.
#include "render/figures/figure_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace render {
namespace {

// Pale to deep blue-green: light enough under black lines, monotone in grey.
Colour colour_of_speed(double t) {
  constexpr std::array<Colour, 5> stops{
      {{0.985, 0.985, 0.965}, {0.85, 0.93, 0.87}, {0.62, 0.83, 0.82}, {0.38, 0.68, 0.77}, {0.22, 0.50, 0.69}}};
  return between(stops, t);
}

std::uint8_t byte(double v) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0))); }

Image picture_of(const sim::Matrix& speed, double top) {
  Image image(static_cast<int>(speed.cols()), static_cast<int>(speed.rows()), 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Colour c = colour_of_speed(speed(y, x) / top);
      std::uint8_t* p = image.at(x, y);
      p[0] = byte(c.r);
      p[1] = byte(c.g);
      p[2] = byte(c.b);
    }
  return image;
}

// The least round number that is not below.
double round_up(double v) {
  if (!(v > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(v)));
  for (const double f : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (f * power >= v * (1 - 1e-9)) return f * power;
  return 10 * power;
}

void draw_streamline(const Pen& pen, const Panel& panel, const Streamline& line, double length, double width,
                     const Colour& colour) {
  cairo_t* cairo = pen.cairo;
  cairo_new_path(cairo);
  for (Eigen::Index i = 0; i < line.points.rows(); ++i)
    cairo_line_to(cairo, panel.page_x(line.points(i, 0) / length), panel.page_y(line.points(i, 1) / length));
  if (line.closed) cairo_close_path(cairo);
  set_colour(pen, colour);
  cairo_set_line_width(cairo, width);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
  cairo_stroke(cairo);
}

// A slender head whose tip leads the flow.
void draw_head(const Pen& pen, const Eigen::Vector2d& at, const Eigen::Vector2d& along, double size,
               const Colour& colour) {
  const Eigen::Vector2d u = along.normalized(), n(-u.y(), u.x());
  const std::array<Eigen::Vector2d, 4> corners{
      Eigen::Vector2d(at + 0.62 * size * u), Eigen::Vector2d(at - 0.38 * size * u + 0.36 * size * n),
      Eigen::Vector2d(at - 0.20 * size * u), Eigen::Vector2d(at - 0.38 * size * u - 0.36 * size * n)};
  cairo_new_path(pen.cairo);
  for (const Eigen::Vector2d& c : corners) cairo_line_to(pen.cairo, c.x(), c.y());
  cairo_close_path(pen.cairo);
  set_colour(pen, colour);
  cairo_fill(pen.cairo);
}

/// Sections of one vesicle in the plane's own coordinates, in units of the length of the figure.
using Contours = std::vector<std::vector<ClosedCurve>>;
Contours sections_of(const sim::State& state, const CutPlane& plane, double length) {
  Contours sections;
  for (const sim::VesicleState& vesicle : state.vesicles) {
    sections.push_back(cut(vesicle.position, plane));
    for (ClosedCurve& curve : sections.back()) curve.points /= length;
  }
  return sections;
}

std::string csv_of(const FlowPicture& flow, double length) {
  const auto [right, up] = axis_names(flow.plane);
  std::string csv;
  for (const std::string& remark : flow.remarks) csv += "# " + remark + "\n";
  csv += fmt::format("line,closed,{},{},speed\n", right, up);
  for (std::size_t k = 0; k < flow.lines.size(); ++k)
    for (Eigen::Index i = 0; i < flow.lines[k].points.rows(); ++i)
      csv += fmt::format("{},{},{:.6g},{:.6g},{:.6g}\n", k, flow.lines[k].closed ? 1 : 0,
                         flow.lines[k].points(i, 0) / length, flow.lines[k].points(i, 1) / length,
                         flow.speed_factor * flow.lines[k].speed[i]);
  return csv;
}

Axes axes_of(const FigureInput& input) {
  const auto [right, up] = axis_names(input.flow.plane);
  const auto label = [&](const std::string& name) {
    return input.length_symbol.empty() ? name : name + " / " + input.length_symbol;
  };
  return {.x = {.label = label(right)}, .y = {.label = label(up)}};
}

/// Places on the page, pt.
struct FlowLayout {
  Panel panel;
  Panel bar;  ///< of the speeds, beside the panel
  Ticks bar_ticks;
  Axis bar_axis;                 ///< its label
  bool frame_below = false;      ///< the frame of reference stands in a line of its own, under the time
  double width = 0, height = 0;  ///< of the page
};

/// top_speed: at the upper end of the bar; 0: there is no bar. titles: width of the texts above the panel, in one line.
FlowLayout layout_of(const FigureInput& input, const Page& page, Axes& axes, double top_speed, double titles) {
  const FlowPicture& flow = input.flow;
  const Theme& theme = page.theme;
  const Ruler ruler(theme.family);
  const double length = input.length;
  const double bar_width = 1.1 * theme.text, bar_gap = 1.3 * theme.text;
  FlowLayout layout;
  Panel &panel = layout.panel, &bar = layout.bar;
  panel.x = {flow.x.low / length, flow.x.high / length};
  panel.y = {flow.y.low / length, flow.y.high / length};
  panel.width = panel.height = 200;  // to begin with
  bar.x = {0, 1};
  bar.y = {0, top_speed > 0 ? top_speed : 1};
  bar.width = bar_width;
  layout.width = page.width > 0 ? page.width : page.height > 0 ? theme.width : 0.85 * theme.width;
  layout.height = page.height;
  layout.bar_axis.label = input.flow.speed_label;
  double title = title_height(theme);
  Margins before;
  for (int round = 0; round < layout_rounds;
       ++round) {  // the size of the panel decides its ticks, and they the margins
    layout.frame_below = layout.frame_below || (round > 0 && titles > panel.width);
    title = title_height(theme) + (layout.frame_below ? 1.3 * theme.text : 0);
    for (Axis* axis : {&axes.x, &axes.y, &layout.bar_axis}) axis->label_scale = 1;
    axes.x = fitted(ruler, theme, axes.x, panel.width);
    axes.y = fitted(ruler, theme, axes.y, panel.height);
    layout.bar_axis = fitted(ruler, theme, layout.bar_axis, panel.height);
    const auto bar_lines = static_cast<double>(lines_of(layout.bar_axis.label).size());
    Margins m = margins_of(ruler, theme, axes, panel);
    if (round > free_rounds) m = widest(m, before);
    before = m;
    layout.bar_ticks = ticks_of(ruler, theme, {}, bar.y, panel.height, false);
    const double beside = top_speed > 0 ? bar_gap + bar_width + 0.5 * theme.text + layout.bar_ticks.widest +
                                              (0.4 + 1.2 * bar_lines) * theme.label
                                        : m.right;
    double scale = (layout.width - m.left - beside) / panel.x.size();
    if (page.height > 0) scale = std::min(scale, (page.height - title - m.bottom) / panel.y.size());
    scale = std::max(scale, 1e-6);
    panel.width = scale * panel.x.size();
    panel.height = scale * panel.y.size();
    panel.left = m.left + (layout.width - m.left - beside - panel.width) / 2;
    if (page.height == 0) layout.height = std::ceil(title + panel.height + m.bottom);
    panel.top = title + (layout.height - title - panel.height - m.bottom) / 2;
    bar.left = panel.left + panel.width + bar_gap;
    bar.top = panel.top;
    bar.height = panel.height;
  }
  return layout;
}

/// Everything that the paper shows, as values.
struct FlowDrawing {
  FlowLayout layout;
  Axes axes;
  Theme theme;
  double length = 1;                   ///< of the scene, that is 1 in the panel
  std::vector<Streamline> lines;       ///< lengths of the scene
  double spacing = 0;                  ///< of the lines, likewise
  std::array<Range, 2> cells;          ///< covered by the image, likewise
  std::shared_ptr<const Image> image;  ///< of the speeds; null: none
  Contours sections;
  std::vector<std::size_t> owners;  ///< of them, as in FlowPicture
  std::string title, frame;
};

void draw_lines(const Pen& pen, const FlowDrawing& d) {
  const Panel& panel = d.layout.panel;
  const double unit = panel.width / panel.x.size();  // points per length
  const Colour stroke = d.image ? Colour{0.16, 0.20, 0.28} : pen.theme.ink;
  const double width = std::min(0.55 * pen.theme.stroke, 0.12 * d.spacing / d.length * unit);
  const double head = std::clamp(0.42 * d.spacing / d.length * unit, 2.2 * pen.theme.stroke, 4.2 * pen.theme.stroke);
  for (const Streamline& line : d.lines) draw_streamline(pen, panel, line, d.length, width, stroke);
  for (std::size_t l = 0; l < d.lines.size(); ++l) {
    const Streamline& line = d.lines[l];
    // Heads of neighbours would stand in columns: multiples of the golden ratio are never in step.
    const double phase = 0.2 + 0.6 * std::fmod(static_cast<double>(l) / std::numbers::phi, 1.0);
    const auto place = [&](Eigen::Index k) {
      return Eigen::Vector2d(panel.page_x(line.points(k, 0) / d.length), panel.page_y(line.points(k, 1) / d.length));
    };
    for (const Eigen::Index i : arrow_places(line, std::max(1.6 * d.length, 8 * d.spacing), phase))
      if (i >= 1 && i + 1 < line.points.rows()) draw_head(pen, place(i), place(i + 1) - place(i - 1), head, stroke);
  }
}

void draw_flow(const Pen& pen, const FlowDrawing& d) {
  const Panel& panel = d.layout.panel;
  const double unit = panel.width / panel.x.size();  // points per length
  cairo_save(pen.cairo);
  cairo_rectangle(pen.cairo, panel.left, panel.top, panel.width, panel.height);
  cairo_clip(pen.cairo);
  if (d.image)
    draw_picture(pen.cairo, *d.image, panel.page_x(d.cells[0].low / d.length), panel.page_y(d.cells[1].high / d.length),
                 d.cells[0].size() / d.length * unit, d.cells[1].size() / d.length * unit);
  draw_lines(pen, d);
  cairo_restore(pen.cairo);
}

void draw_sections(const Pen& pen, const FlowDrawing& d) {
  const Panel& panel = d.layout.panel;
  cairo_save(pen.cairo);
  if (!d.owners.empty()) {  // images cross the edges of the window
    cairo_rectangle(pen.cairo, panel.left, panel.top, panel.width, panel.height);
    cairo_clip(pen.cairo);
  }
  for (std::size_t v = 0; v < d.sections.size(); ++v)
    for (const ClosedCurve& curve : d.sections[v]) {
      draw_closed_curve(pen, d.layout.panel, curve, Eigen::Vector2d::Zero(), {pen.theme.ground, 2.6, 0.85});
      draw_closed_curve(pen, d.layout.panel, curve, Eigen::Vector2d::Zero(),
                        {vesicle_colour(pen.theme, d.owners.empty() ? v : d.owners[v]), 1.5});
    }
  cairo_restore(pen.cairo);
}

void draw_speed_bar(const Pen& pen, const FlowDrawing& d) {
  constexpr int steps = 256;
  cairo_t* cairo = pen.cairo;
  const Theme& theme = pen.theme;
  const Panel& bar = d.layout.bar;
  const Ticks& ticks = d.layout.bar_ticks;
  sim::Matrix ramp(steps, 1);
  for (int k = 0; k < steps; ++k) ramp(k, 0) = 1 - (k + 0.5) / steps;
  draw_picture(cairo, picture_of(ramp, 1), bar.left, bar.top, bar.width, bar.height);
  set_colour(pen, theme.ink);
  cairo_set_line_width(cairo, theme.line);
  cairo_rectangle(cairo, bar.left, bar.top, bar.width, bar.height);
  cairo_stroke(cairo);
  for (std::size_t k = 0; k < ticks.values.size(); ++k) {
    const double y = bar.page_y(ticks.values[k]);
    cairo_move_to(cairo, bar.left + bar.width, y);
    cairo_rel_line_to(cairo, -0.3 * bar.width, 0);
    cairo_stroke(cairo);
    draw_text(cairo, pen.font, theme.text, bar.left + bar.width + 0.4 * theme.text, y + 0.36 * theme.text,
              ticks.texts[k]);
  }
  const Axis& axis = d.layout.bar_axis;
  const double size = theme.label * axis.label_scale;
  cairo_save(cairo);
  cairo_translate(cairo, bar.left + bar.width + 0.5 * theme.text + ticks.widest + 1.3 * size, bar.top + bar.height / 2);
  cairo_rotate(cairo, -std::numbers::pi / 2);
  double y = 0;
  for (const std::string& line : lines_of(axis.label)) {
    draw_text(cairo, pen.font, size, 0, y, line, Align::centre);
    y += 1.2 * size;
  }
  cairo_restore(cairo);
}

void draw(const Pen& pen, const FlowDrawing& d) {
  const Panel& panel = d.layout.panel;
  draw_flow(pen, d);
  draw_sections(pen, d);
  draw_axes(pen, panel, d.axes);
  const bool below = d.layout.frame_below;
  Panel titled = panel;
  if (below) titled.top -= 1.3 * pen.theme.text;
  draw_title(pen, titled, d.title);
  set_colour(pen, pen.theme.soft);
  draw_text(pen.cairo, pen.font, pen.theme.text, below ? panel.left : panel.left + panel.width,
            panel.top - 0.55 * pen.theme.label, d.frame, below ? Align::left : Align::right);
  if (d.image) draw_speed_bar(pen, d);
}

std::string frame_text(const FigureInput& input) {
  if (input.parameters.frame != "vesicle") return "laboratory frame";
  const bool several = !input.flow.owners.empty() || input.states.front().vesicles.size() > 1;
  return several ? "frame of the centroid" : "frame of the vesicle";
}

}  // namespace

Figure draw_streamlines(const FigureInput& input) {
  const FlowPicture& flow = input.flow;
  if (input.states.empty() || !(flow.x.size() > 0) || !(flow.y.size() > 0))
    throw std::invalid_argument("a figure of streamlines needs a state and a window");
  const Page page = page_of(input.parameters);
  const sim::State& state = input.states.front();
  const double top_speed = flow.speed.size() > 0 ? round_up(flow.speed_factor * flow.speed.maxCoeff()) : 0;
  FlowDrawing d;
  d.axes = axes_of(input);
  d.title = time_text(input, input.time_factor * state.time);
  d.frame = frame_text(input);
  const Ruler ruler(page.theme.family);
  const double titles =
      ruler.width(page.theme.label, d.title) + 1.5 * page.theme.text + ruler.width(page.theme.text, d.frame);
  d.layout = layout_of(input, page, d.axes, top_speed, titles);
  d.theme = page.theme;
  d.length = input.length;
  d.lines = flow.lines;
  d.spacing = flow.spacing;
  d.cells = flow.speed_window;
  if (top_speed > 0) d.image = std::make_shared<const Image>(picture_of(flow.speed, top_speed / flow.speed_factor));
  d.sections = sections_of(state, flow.plane, input.length);
  d.owners = flow.owners;
  Figure figure;
  figure.csv = csv_of(flow, input.length);
  figure.drawing =
      drawing_on(page.theme, input.parameters, d.layout.width, d.layout.height, [d](cairo_t* cairo, const Font& font) {
        draw({cairo, font, d.theme}, d);
      });
  return figure;
}

}  // namespace render
