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
  constexpr std::array<Colour, 5> stops{{{0.985, 0.985, 0.965}, {0.85, 0.93, 0.87}, {0.62, 0.83, 0.82}, {0.38, 0.68, 0.77}, {0.22, 0.50, 0.69}}};
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

void draw_streamline(const Pen& pen, const Panel& panel, const Streamline& line, double length, double width, const Colour& colour) {
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
void draw_head(const Pen& pen, const Eigen::Vector2d& at, const Eigen::Vector2d& along, double size, const Colour& colour) {
  const Eigen::Vector2d u = along.normalized(), n(-u.y(), u.x());
  const std::array<Eigen::Vector2d, 4> corners{Eigen::Vector2d(at + 0.62 * size * u), Eigen::Vector2d(at - 0.38 * size * u + 0.36 * size * n),
                                               Eigen::Vector2d(at - 0.20 * size * u), Eigen::Vector2d(at - 0.38 * size * u - 0.36 * size * n)};
  cairo_new_path(pen.cairo);
  for (const Eigen::Vector2d& c : corners) cairo_line_to(pen.cairo, c.x(), c.y());
  cairo_close_path(pen.cairo);
  set_colour(pen, colour);
  cairo_fill(pen.cairo);
}

}  // namespace

Figure draw_streamlines(const FigureInput& input) {
  const FlowPicture& flow = input.flow;
  if (input.states.empty() || !(flow.x.size() > 0) || !(flow.y.size() > 0))
    throw std::invalid_argument("a figure of streamlines needs a state and a window");
  const Page page = page_of(input.parameters);
  const Theme& theme = page.theme;
  const Ruler ruler;
  const double length = input.length;
  const auto [right, up] = axis_names(flow.plane);
  const auto label = [&](const std::string& name) {
    return input.length_symbol.empty() ? name : name + " / " + input.length_symbol;
  };
  const Axes axes{{label(right), Scale::linear, true, false}, {label(up), Scale::linear, true, false}, 0};
  Panel panel;
  panel.x = {flow.x.low / length, flow.x.high / length};
  panel.y = {flow.y.low / length, flow.y.high / length};
  panel.width = panel.height = 200;
  // The colour bar: a second panel beside the first.
  const bool with_bar = flow.speed.size() > 0;
  const double top_speed = with_bar ? round_up(flow.speed_factor * flow.speed.maxCoeff()) : 1;
  const double bar_width = 1.1 * theme.text, bar_gap = 1.3 * theme.text;
  Panel bar;
  bar.x = {0, 1};
  bar.y = {0, top_speed};
  bar.width = bar_width;
  const double page_width = page.width > 0 ? page.width : page.height > 0 ? theme.width : 0.85 * theme.width;
  double page_height = page.height;
  Ticks bar_ticks;
  const double title = title_height(theme);
  for (int round = 0; round < 3; ++round) {
    const Margins m = margins_of(ruler, theme, axes, panel);
    bar_ticks = ticks_of(ruler, theme, {}, bar.y, panel.height, false);
    const double beside = with_bar ? bar_gap + bar_width + 0.5 * theme.text + bar_ticks.widest + 1.6 * theme.label : m.right;
    double scale = (page_width - m.left - beside) / panel.x.size();
    if (page.height > 0) scale = std::min(scale, (page.height - title - m.bottom) / panel.y.size());
    panel.width = scale * panel.x.size();
    panel.height = scale * panel.y.size();
    panel.left = m.left + (page_width - m.left - beside - panel.width) / 2;
    if (page.height == 0) page_height = std::ceil(title + panel.height + m.bottom);
    panel.top = title + (page_height - title - panel.height - m.bottom) / 2;
    bar.left = panel.left + panel.width + bar_gap;
    bar.top = panel.top;
    bar.height = panel.height;
  }
  Figure figure;
  for (const std::string& remark : flow.remarks) figure.csv += "# " + remark + "\n";
  figure.csv += fmt::format("line,closed,{},{},speed\n", right, up);
  for (std::size_t k = 0; k < flow.lines.size(); ++k)
    for (Eigen::Index i = 0; i < flow.lines[k].points.rows(); ++i)
      figure.csv += fmt::format("{},{},{:.6g},{:.6g},{:.6g}\n", k, flow.lines[k].closed ? 1 : 0, flow.lines[k].points(i, 0) / length,
                                flow.lines[k].points(i, 1) / length, flow.speed_factor * flow.lines[k].speed[i]);
  // The sections, in the plane's own coordinates.
  std::vector<std::vector<ClosedCurve>> sections;
  for (const sim::VesicleState& vesicle : input.states.front().vesicles) {
    sections.push_back(cut(vesicle.position, flow.plane));
    for (ClosedCurve& curve : sections.back()) curve.points /= length;
  }
  std::shared_ptr<const Image> image;
  if (with_bar) image = std::make_shared<const Image>(picture_of(flow.speed, top_speed / flow.speed_factor));
  figure.drawing = {page_width, page_height, nullptr, theme.ground, dots_per_inch(input.parameters)};
  figure.drawing.paint = [=, lines = flow.lines, cells = flow.speed_window, spacing = flow.spacing, speed_label = flow.speed_label,
                          shown = fmt::format("{}", time_text(input, input.time_factor * input.states.front().time)),
                          frame = input.parameters.frame, vesicles = input.states.front().vesicles.size(),
                          theme = page.theme](cairo_t* cairo, const Font& font) {
    const Pen pen{cairo, font, theme};
    const double unit = panel.width / panel.x.size();  // points per length
    cairo_save(cairo);
    cairo_rectangle(cairo, panel.left, panel.top, panel.width, panel.height);
    cairo_clip(cairo);
    if (image)
      draw_picture(cairo, *image, panel.page_x(cells[0].low / length), panel.page_y(cells[1].high / length),
                   cells[0].size() / length * unit, cells[1].size() / length * unit);
    const Colour stroke = image ? Colour{0.16, 0.20, 0.28} : theme.ink;
    const double width = std::min(0.55 * theme.stroke, 0.12 * spacing / length * unit);
    const double head = std::clamp(0.42 * spacing / length * unit, 2.2 * theme.stroke, 4.2 * theme.stroke);
    for (const Streamline& line : lines) draw_streamline(pen, panel, line, length, width, stroke);
    for (const Streamline& line : lines)
      for (const Eigen::Index i : arrow_places(line, std::max(1.6 * length, 8 * spacing))) {
        const auto place = [&](Eigen::Index k) {
          return Eigen::Vector2d(panel.page_x(line.points(k, 0) / length), panel.page_y(line.points(k, 1) / length));
        };
        if (i < 1 || i + 1 >= line.points.rows()) continue;
        draw_head(pen, place(i), place(i + 1) - place(i - 1), head, stroke);
      }
    cairo_restore(cairo);
    for (std::size_t v = 0; v < sections.size(); ++v)
      for (const ClosedCurve& curve : sections[v]) {
        draw_closed_curve(pen, panel, curve, Eigen::Vector2d::Zero(), {theme.ground, 2.6, 0.85});
        draw_closed_curve(pen, panel, curve, Eigen::Vector2d::Zero(), {vesicle_colour(theme, v), 1.5});
      }
    draw_axes(pen, panel, axes);
    draw_title(pen, panel, shown);
    set_colour(pen, theme.soft);
    draw_text(cairo, font, theme.text, panel.left + panel.width, panel.top - 0.55 * theme.label,
              frame == "vesicle" ? vesicles > 1 ? "frame of the centroid" : "frame of the vesicle" : "laboratory frame", Align::right);
    if (!image) return;
    constexpr int steps = 256;
    Image ramp(1, steps, 3);
    for (int k = 0; k < steps; ++k) {
      const Colour c = colour_of_speed(1 - (k + 0.5) / steps);
      std::uint8_t* p = ramp.at(0, k);
      p[0] = byte(c.r);
      p[1] = byte(c.g);
      p[2] = byte(c.b);
    }
    draw_picture(cairo, ramp, bar.left, bar.top, bar.width, bar.height);
    set_colour(pen, theme.ink);
    cairo_set_line_width(cairo, theme.line);
    cairo_rectangle(cairo, bar.left, bar.top, bar.width, bar.height);
    cairo_stroke(cairo);
    for (std::size_t k = 0; k < bar_ticks.values.size(); ++k) {
      const double y = bar.page_y(bar_ticks.values[k]);
      cairo_move_to(cairo, bar.left + bar.width, y);
      cairo_rel_line_to(cairo, -0.3 * bar.width, 0);
      cairo_stroke(cairo);
      draw_text(cairo, font, theme.text, bar.left + bar.width + 0.4 * theme.text, y + 0.36 * theme.text, bar_ticks.texts[k]);
    }
    cairo_save(cairo);
    cairo_translate(cairo, bar.left + bar.width + 0.5 * theme.text + bar_ticks.widest + 1.3 * theme.label, bar.top + bar.height / 2);
    cairo_rotate(cairo, -std::numbers::pi / 2);
    draw_text(cairo, font, theme.label, 0, 0, speed_label, Align::centre);
    cairo_restore(cairo);
  };
  return figure;
}

}  // namespace render
