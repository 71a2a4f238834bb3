#include "render/figures/plot_legend.h"

#include <algorithm>
#include <cmath>

namespace render {

namespace {

constexpr double sample = 2.6, legend_spacing = 1.45, legend_edge = 0.8, line_spacing = 1.2;  // in heights of the text

void draw_entry(const Pen& pen, const LegendEntry& entry, double x, double baseline) {
  const double y = baseline - 0.33 * pen.theme.text, length = sample * pen.theme.text;
  const Colour colour = entry.colour.value_or(pen.theme.ink);
  if (entry.line) {
    set_colour(pen, colour);
    cairo_save(pen.cairo);
    cairo_set_line_width(pen.cairo, pen.theme.stroke);
    set_dash(pen.cairo, entry.dash, pen.theme.stroke);
    cairo_set_line_cap(pen.cairo, CAIRO_LINE_CAP_BUTT);
    cairo_move_to(pen.cairo, x, y);
    cairo_rel_line_to(pen.cairo, length, 0);
    cairo_stroke(pen.cairo);
    cairo_restore(pen.cairo);
  }
  if (entry.marker) draw_marker(pen, *entry.marker, x + length / 2, y, colour, 1.8);
}

}  // namespace

Eigen::Vector2d legend_size(const Ruler& ruler, const Theme& theme, const std::vector<LegendEntry>& entries) {
  if (entries.empty()) return Eigen::Vector2d::Zero();
  double widest = 0;
  for (const LegendEntry& e : entries) widest = std::max(widest, ruler.width(theme.text, e.name));
  return {widest + (sample + 0.6 + 2 * legend_edge) * theme.text,
          (legend_spacing * static_cast<double>(entries.size()) + 2 * legend_edge - 0.4) * theme.text};
}

void draw_legend(const Pen& pen, const Panel& p, const std::vector<LegendEntry>& entries, Corner corner) {
  if (entries.empty()) return;
  const Eigen::Vector2d size = legend_size(Ruler(pen.theme.family), pen.theme, entries);
  const bool right = corner == Corner::upper_right || corner == Corner::lower_right;
  const bool upper = corner == Corner::upper_right || corner == Corner::upper_left;
  const double text = pen.theme.text, x = (right ? p.left + p.width - size.x() : p.left) + legend_edge * text;
  double y = (upper ? p.top : p.top + p.height - size.y()) + (legend_edge + 0.9) * text;
  for (const LegendEntry& entry : entries) {
    draw_entry(pen, entry, x, y);
    set_colour(pen, pen.theme.ink);
    draw_text(pen.cairo, pen.font, text, x + (sample + 0.6) * text, y, entry.name);
    y += legend_spacing * text;
  }
}

void draw_legend_line(const Pen& pen, double right, double baseline, const std::vector<LegendEntry>& entries) {
  const double text = pen.theme.text;
  double x = right;
  for (std::size_t i = entries.size(); i-- > 0;) {
    set_colour(pen, pen.theme.ink);
    x -= draw_text(pen.cairo, pen.font, text, x, baseline, entries[i].name, Align::right) + (sample + 0.6) * text;
    draw_entry(pen, entries[i], x, baseline);
    x -= 1.8 * text;
  }
}

std::optional<Eigen::Vector2d> free_place(
    const Panel& p, const Eigen::Vector2d& size,
    const std::vector<std::pair<std::vector<double>, std::vector<double>>>& curves, double distance) {
  if (size.x() > p.width || size.y() > p.height) return {};
  const auto is_free = [&](const Eigen::Vector2d& corner) {
    const auto holds = [&](double x, double y) {
      return x > corner.x() - distance && x < corner.x() + size.x() + distance && y > corner.y() - distance &&
             y < corner.y() + size.y() + distance;
    };
    for (const auto& [x, y] : curves)
      for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
        if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
        const double x1 = p.page_x(x[i]), y1 = p.page_y(y[i]);
        if (holds(x1, y1)) return false;
        if (i == 0 || !std::isfinite(x[i - 1]) || !std::isfinite(y[i - 1])) continue;
        const double x0 = p.page_x(x[i - 1]), y0 = p.page_y(y[i - 1]);
        const int pieces = std::clamp(static_cast<int>(std::hypot(x1 - x0, y1 - y0) / 2), 1, 400);
        for (int k = 1; k < pieces; ++k)
          if (holds(x0 + (x1 - x0) * k / pieces, y0 + (y1 - y0) * k / pieces)) return false;
      }
    return true;
  };
  const double right = p.left + p.width - size.x(), low = p.top + p.height - size.y();
  const double middle = (p.left + right) / 2, half = (p.top + low) / 2;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(right, p.top), Eigen::Vector2d(p.left, p.top), Eigen::Vector2d(right, low),
        Eigen::Vector2d(p.left, low), Eigen::Vector2d(middle, p.top), Eigen::Vector2d(middle, low),
        Eigen::Vector2d(right, half), Eigen::Vector2d(p.left, half)})
    if (is_free(corner)) return corner;
  return {};
}

LaidLegend laid_legend(const Ruler& ruler, const Theme& theme, const std::vector<LegendEntry>& entries, double width,
                       std::size_t lines, std::size_t most) {
  LaidLegend legend;
  if (entries.empty()) return legend;
  const double text = theme.text, mark = (sample + 0.6) * text, between = 1.6 * text;
  for (const LegendEntry& entry : entries) {
    if (legend.entries.size() == most && entries.size() > most + 1) {
      LegendEntry& rest = legend.entries.emplace_back();
      rest.name = "and " + std::to_string(entries.size() - most) + " more";
      rest.line = false;
      break;
    }
    LegendEntry& laid = legend.entries.emplace_back(entry);
    std::vector<std::string> parts = wrapped(ruler, text, entry.name, std::max(width - mark, 3 * text));
    if (parts.size() > lines) {
      std::string rest;
      for (std::size_t k = lines - 1; k < parts.size(); ++k) rest += (rest.empty() ? "" : " ") + parts[k];
      parts.resize(lines);
      parts.back() = shortened(ruler, text, rest, width - mark);
    }
    laid.name.clear();
    for (const std::string& part : parts) laid.name += (laid.name.empty() ? "" : "\n") + part;
  }
  const std::size_t count = legend.entries.size();
  std::vector<double> widths, heights;
  for (const LegendEntry& entry : legend.entries) {
    double widest = 0;
    const std::vector<std::string> parts = lines_of(entry.name);
    for (const std::string& line : parts) widest = std::max(widest, ruler.width(text, line));
    widths.push_back(mark + widest);
    heights.push_back((legend_spacing + line_spacing * static_cast<double>(parts.size() - 1)) * text);
  }
  // The most columns that fit, then as few as the same rows need.
  const auto columns_of = [&](std::size_t columns) {
    std::vector<double> all(columns, 0);
    for (std::size_t k = 0; k < count; ++k) all[k % columns] = std::max(all[k % columns], widths[k]);
    return all;
  };
  const auto total = [&](const std::vector<double>& columns) {
    double sum = between * static_cast<double>(columns.size() - 1);
    for (const double c : columns) sum += c;
    return sum;
  };
  std::size_t columns = count;
  while (columns > 1 && total(columns_of(columns)) > width) --columns;
  const std::size_t rows = (count + columns - 1) / columns;
  columns = (count + rows - 1) / rows;
  while (columns > 1 && total(columns_of(columns)) > width) --columns;
  const std::vector<double> across = columns_of(columns);
  double x = 0, y = 0, row_height = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (k > 0 && k % columns == 0) {
      x = 0;
      y += row_height;
      row_height = 0;
    }
    legend.places.emplace_back(x, y);
    x += across[k % columns] + between;
    row_height = std::max(row_height, heights[k]);
  }
  legend.width = total(across);
  legend.height = y + row_height;
  return legend;
}

void draw_legend(const Pen& pen, const LaidLegend& legend, double left, double top) {
  const double text = pen.theme.text;
  for (std::size_t k = 0; k < legend.entries.size(); ++k) {
    const double x = left + legend.places[k].x();
    double y = top + legend.places[k].y() + 1.0 * text;
    draw_entry(pen, legend.entries[k], x, y);
    set_colour(pen, pen.theme.ink);
    for (const std::string& line : lines_of(legend.entries[k].name)) {
      draw_text(pen.cairo, pen.font, text, x + (sample + 0.6) * text, y, line);
      y += line_spacing * text;
    }
  }
}

}  // namespace render
