// The legend of a panel or a figure: where it goes, and its lines.
#pragma once

#include "render/figures/plot_marks.h"

#include <optional>

namespace render {

/// One line of a legend.
struct LegendEntry {
  std::string name;              ///< '\n' separates lines
  std::optional<Colour> colour;  ///< none: ink
  std::optional<Marker> marker;
  int dash = 0;
  bool line = true;
};
enum class Corner { upper_right, lower_right, upper_left, lower_left };
void draw_legend(const Pen& pen, const Panel& panel, const std::vector<LegendEntry>& entries, Corner corner);
/// The same in one line whose right end is at (right, baseline).
void draw_legend_line(const Pen& pen, double right, double baseline, const std::vector<LegendEntry>& entries);
/// Size including its margin, pt.
Eigen::Vector2d legend_size(const Ruler& ruler, const Theme& theme, const std::vector<LegendEntry>& entries);
/// A rectangle of that size within the panel that no curve comes nearer than `distance` (pt): its upper left corner, if
/// any.
std::optional<Eigen::Vector2d> free_place(
    const Panel& panel, const Eigen::Vector2d& size,
    const std::vector<std::pair<std::vector<double>, std::vector<double>>>& curves, double distance);

/// A legend in as many columns as fit, with long names in several lines.
struct LaidLegend {
  std::vector<LegendEntry> entries;
  std::vector<Eigen::Vector2d> places;  ///< upper left corners
  double width = 0, height = 0;
};
/// lines: at most so many for a name, which is then shortened; most: further entries become "and 3 more".
LaidLegend laid_legend(const Ruler& ruler, const Theme& theme, const std::vector<LegendEntry>& entries, double width,
                       std::size_t lines = 3, std::size_t most = 40);
void draw_legend(const Pen& pen, const LaidLegend& legend, double left, double top);

}  // namespace render
