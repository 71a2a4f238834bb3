// A phase diagram: motions over two parameters, each vesicle drawn at its place.
#include "render/figures/figure_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace render {
namespace {

/// A colour and a mark for each kind of motion: told apart in grey, too.
struct Look {
  std::size_t colour;
  Marker marker;
};
constexpr std::array<Look, 4> looks{{{0, Marker::dot}, {2, Marker::triangle}, {1, Marker::square}, {6, Marker::ring}}};
Look look_of(std::size_t kind) { return looks[kind % looks.size()]; }

/// Values of one axis over its length, 0 to 1; on a logarithmic axis where they span more than a decade and a half.
struct Span {
  Axis axis;
  Range range;  ///< of the coordinate
  std::vector<double> shares;
};

Span span_of(const std::vector<double>& values, const std::string& label) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  constexpr double wide = 40;
  Span span{.axis = {.label = label, .grid = true}, .range = {*least, *most}, .shares = {}};
  const bool logarithmic = *least > 0 && *most > wide * *least;
  if (logarithmic) {
    span.axis.scale = Scale::logarithmic;
    span.range = {std::log10(*least), std::log10(*most)};
  }
  for (const double v : values) {
    const double at = logarithmic ? std::log10(v) : v;
    span.shares.push_back(span.range.size() > 0 ? (at - span.range.low) / span.range.size() : 0.5);
  }
  if (!(span.range.size() > 0)) {
    const double half = std::max(std::abs(span.range.low), 1e-300) / 2;
    span.range = {span.range.low - half, span.range.high + half};
  }
  return span;
}

std::pair<Span, Span> spans_of(const Diagram& diagram) {
  if (diagram.points.empty()) throw std::invalid_argument("a phase diagram needs at least one vesicle");
  std::vector<double> xs, ys;
  for (const DiagramPoint& p : diagram.points) {
    xs.push_back(p.x);
    ys.push_back(p.y);
  }
  return {span_of(xs, diagram.x), span_of(ys, diagram.y)};
}

/// The range of the whole axis, where the span has `room` at both ends, of `length`.
Range with_room(const Range& range, double room, double length) {
  const double more = range.size() * room / std::max(length - 2 * room, 1e-9);
  return {range.low - more, range.high + more};
}

struct DiagramLayout {
  Panel panel;
  Axes axes;
  LaidLegend legend;
  double radius = 0;  ///< of a picture, pt
  double width = 0, height = 0;
};

constexpr double picture_room = 1.15;  ///< a picture reaches beyond what it shows

double room_round(double radius, const Theme& theme) { return radius + 1.2 * theme.text; }

/// The largest radius of which no two pictures touch; at most a share of the panel.
double radius_in(const Panel& panel, const Span& x, const Span& y, const Theme& theme) {
  double radius = 0.13 * std::min(panel.width, panel.height);
  for (int round = 0; round < 12; ++round) {
    const double across = panel.width - 2 * room_round(radius, theme),
                 down = panel.height - 2 * room_round(radius, theme);
    double nearest = 1e300;
    for (std::size_t i = 0; i < x.shares.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) {
        const double apart = std::hypot((x.shares[i] - x.shares[k]) * across, (y.shares[i] - y.shares[k]) * down);
        if (apart > 1e-6 * panel.width) nearest = std::min(nearest, apart);
      }
    radius = std::min(radius, std::max(0.47 * nearest, 0.8 * theme.text));
  }
  return radius;
}

std::vector<LegendEntry> legend_of(const Diagram& diagram, const Theme& theme) {
  std::vector<LegendEntry> entries;
  for (std::size_t kind = 0; kind < diagram.kinds.size(); ++kind) {
    const auto has_it = [&](const DiagramPoint& p) { return p.kind == kind; };
    if (std::none_of(diagram.points.begin(), diagram.points.end(), has_it)) continue;
    LegendEntry entry;
    entry.line = false;
    entry.name = diagram.kinds[kind];
    entry.colour = curve_colour(theme, look_of(kind).colour);
    entry.marker = look_of(kind).marker;
    entries.push_back(std::move(entry));
  }
  return entries;
}

DiagramLayout layout_of(const FigureInput& input, const Page& page, const Span& x, const Span& y) {
  const Theme& theme = page.theme;
  const Ruler ruler(theme.family);
  DiagramLayout d;
  d.width = page.width > 0 ? page.width : page.height > 0 ? theme.width : 0.7 * theme.width;
  const double edge = 0.5 * theme.text;
  d.legend = laid_legend(ruler, theme, legend_of(input.diagram, theme), d.width - 2 * edge);
  const double top = d.legend.height + edge;
  d.panel.width = d.panel.height = 0.8 * d.width;
  Margins before;
  for (int round = 0; round < layout_rounds; ++round) {
    d.radius = radius_in(d.panel, x, y, theme);
    d.panel.x = with_room(x.range, room_round(d.radius, theme), d.panel.width);
    d.panel.y = with_room(y.range, room_round(d.radius, theme), d.panel.height);
    d.axes = {x.axis, y.axis, 0};
    d.axes.x = fitted(ruler, theme, d.axes.x, d.panel.width);
    d.axes.y = fitted(ruler, theme, d.axes.y, d.panel.height);
    Margins m = margins_of(ruler, theme, d.axes, d.panel);
    if (round > free_rounds) m = widest(m, before);
    before = m;
    d.panel.width = std::max(d.width - m.left - m.right, 4 * theme.text);
    d.panel.height =
        page.height > 0 ? std::max(page.height - top - m.top - m.bottom, 4 * theme.text) : 0.8 * d.panel.width;
    d.panel.left = m.left;
    d.panel.top = top + m.top;
    d.height = page.height > 0 ? page.height : std::ceil(d.panel.top + d.panel.height + m.bottom);
  }
  return d;
}

/// The largest distance of what is shown from its centre, R0.
double reach_of(const Diagram& diagram) {
  double reach = 0;
  for (const DiagramPoint& p : diagram.points) reach = std::max(reach, p.reach);
  for (const DiagramPoint& p : diagram.points)
    for (const std::vector<ClosedCurve>& instant : p.outlines)
      for (const ClosedCurve& curve : instant)
        if (curve.points.rows() > 0) reach = std::max(reach, curve.points.rowwise().norm().maxCoeff());
  return reach > 0 ? reach : 1;
}

void draw_point(const Pen& pen, const DiagramPoint& point, double x, double y, double radius, double reach) {
  const Look look = look_of(point.kind);
  const Colour colour = curve_colour(pen.theme, look.colour);
  Panel own;
  own.x = own.y = {-picture_room * reach, picture_room * reach};
  own.width = own.height = 2 * picture_room * radius;
  own.left = x - own.width / 2;
  own.top = y - own.height / 2;
  for (std::size_t k = 0; k < point.outlines.size(); ++k) {
    const bool last = k + 1 == point.outlines.size();
    if (last && point.picture) break;
    for (const ClosedCurve& curve : point.outlines[k])
      draw_closed_curve(pen, own, curve, Eigen::Vector2d::Zero(), {colour, last ? 0.75 : 0.4, last ? 1.0 : 0.45},
                        last ? 0.22 : 0);
  }
  if (point.picture) {
    draw_picture(pen.cairo, *point.picture, own.left, own.top, own.width, own.height);
    draw_markers(pen, own, {0}, {0}, look.marker, pen.theme.ground, 2.3);  // a rim, on a body of the mark's own colour
  }
  draw_markers(pen, own, {0}, {0}, look.marker, colour, 1.3);
}

}  // namespace

Colour diagram_colour(const Theme& theme, std::size_t kind) {
  const Colour colour = curve_colour(theme, look_of(kind).colour);
  return colour == theme.ink || colour == Colour{} ? Colour{0.62, 0.63, 0.65} : colour;
}

DiagramPicture diagram_picture(const FigureInput& input) {
  const auto [x, y] = spans_of(input.diagram);
  const DiagramLayout layout = layout_of(input, page_of(input.parameters), x, y);
  return {2 * picture_room * layout.radius, picture_room * reach_of(input.diagram)};
}

Figure draw_phase_diagram(const FigureInput& input) {
  const Diagram& diagram = input.diagram;
  const Page page = page_of(input.parameters);
  const auto [x, y] = spans_of(diagram);
  const DiagramLayout layout = layout_of(input, page, x, y);
  const auto paint = [layout, x = x, y = y, points = diagram.points, reach = reach_of(diagram), theme = page.theme](
                         cairo_t* cairo, const Font& font) {
    const Pen pen{cairo, font, theme};
    const Panel& panel = layout.panel;
    const double room = room_round(layout.radius, theme);
    draw_grid(pen, panel, layout.axes);
    for (std::size_t k = 0; k < points.size(); ++k)
      draw_point(pen, points[k], panel.left + room + x.shares[k] * (panel.width - 2 * room),
                 panel.top + panel.height - room - y.shares[k] * (panel.height - 2 * room), layout.radius, reach);
    draw_axes(pen, panel, layout.axes);
    draw_legend(pen, layout.legend,
                std::max(0.5 * theme.text, std::min(panel.left, layout.width - 0.5 * theme.text - layout.legend.width)),
                0.25 * theme.text);
  };
  Figure figure;
  figure.csv = diagram.csv;
  figure.drawing = drawing_on(page.theme, input.parameters, layout.width, layout.height, paint);
  return figure;
}

}  // namespace render
