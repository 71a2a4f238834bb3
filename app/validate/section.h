// The section of one validation on the page: what is measured and why the tolerances, the command, the tables with a
// verdict in each row, a figure; and the page that holds all sections.
#pragma once

#include "app/tables/text_table.h"

#include "render/figures/figure.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace app {

struct Section {
  std::string text;  ///< what is measured, the reference, the reason of each tolerance
  std::vector<TextTable> tables = {};
  std::optional<render::Figure> figure = {};
  std::string caption = {};  ///< of the figure
  int failures = 0;

  /// A table of its own columns; rows go to the last one.
  void table(std::vector<std::string> columns);
  void row(std::vector<std::string> cells);
  /// "pass", or "FAIL", which counts.
  std::string verdict(bool good);

  /// A table of quantities: measured, expected, verdict.
  void checks();
  /// Within the tolerance.
  void check(const std::string& what, double measured, double expected, double tolerance, int digits = 4);
  /// Its size alone counts.
  void below(const std::string& what, double measured, double bound);
  void check_texts(const std::string& what, const std::string& measured, const std::string& expected, bool good);
  /// For information.
  void note(const std::string& what, const std::string& measured);
};

/// Rounded to so many digits after the point: references are compared as the page shows them.
double rounded(double value, int digits);

render::Curve line_curve(std::string name, std::vector<double> x, std::vector<double> y, std::size_t colour,
                         int dash = 0);
render::Curve point_curve(std::string name, std::vector<double> x, std::vector<double> y, std::size_t colour,
                          render::Marker marker, bool line = false);
/// Panels side by side.
render::Figure panels(const std::vector<render::Plot>&);

/// When and how it was measured.
struct Measurement {
  std::string name;     ///< of the validation
  std::string date;     ///< 2026-11-26
  double seconds = 0;   ///< wall time
  int runs = 0;         ///< simulations
  std::string command;  ///< that makes the first of them; empty: none
};
std::string section_title(std::string_view name);  ///< "Tank-treading"
/// Markdown, from the heading on; `picture`: where the figure is, as seen from the page.
std::string markdown_text(const Section&, const Measurement&, const std::string& picture);
/// For a terminal.
std::string plain_text(const Section&, const Measurement&);

/// The page with a section in the place of the one with its title, or behind those that stand before it in `order`
/// (titles); head and other sections stay. An empty page gets a head.
std::string with_section(const std::string& page, const std::string& section, const std::vector<std::string>& order);

}  // namespace app
