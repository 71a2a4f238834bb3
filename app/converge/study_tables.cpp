// A study as tables, CSV and a page.
#include "app/base/printable.h"
#include "app/base/version.h"
#include "app/converge/study.h"
#include "app/scene/scene_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {

namespace {

/// Values with the digits that their differences need: two of the smallest one.
struct Digits {
  int places = 6;
  bool scientific = false;

  std::string text(double value) const {
    if (!std::isfinite(value)) return "-";
    return scientific ? app::scientific(value, places + 1) : fmt::format("{:.{}f}", value, places);
  }
};

Digits digits_of(const std::vector<double>& values, const Convergence& c) {
  double size = 0, least = c.limit && c.uncertainty > 0 ? c.uncertainty : std::numeric_limits<double>::infinity();
  const bool noisy = c.limit && !c.order;  // differences below the uncertainty mean nothing
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) continue;
    size = std::max(size, std::abs(values[k]));
    if (k > 0 && std::isfinite(values[k - 1]) && values[k] != values[k - 1] && !noisy)
      least = std::min(least, std::abs(values[k] - values[k - 1]));
  }
  constexpr int most = 12;
  const auto decade = [](double v) { return static_cast<int>(std::floor(std::log10(v))); };
  if (size > 0 && (size < 1e-3 || size >= 1e7))
    return {std::clamp(std::isfinite(least) ? decade(size) - decade(least) + 1 : 3, 1, most), true};
  if (!std::isfinite(least)) return {};
  return {std::clamp(1 - decade(least), 0, most), false};
}

/// Two digits.
std::string error_number(double error) {
  return error >= 0.1 && error < 1000 ? fmt::format("{:.2g}", error) : scientific(error);
}

std::string error_text(const Convergence& c, std::size_t k) {
  if (!std::isfinite(c.errors[k])) return "-";
  const std::string text = error_number(c.errors[k]);
  if (c.limit && !c.known(k)) return "< " + error_number(c.uncertainty);
  return c.limit ? text : "~ " + text;
}

std::string heading_of(const Study& study, std::size_t k) {
  const std::string value = value_text(study.runs[k].value);
  return study.own == k ? value + " *" : value;
}

/// Factor by which the error falls from one order to the last.
double gain_of(const Study& study, double q) {
  const std::size_t n = study.runs.size();
  return std::exp(q * (study.runs[n - 1].value - study.runs[n - 2].value));
}

bool spectral(const Study& study) { return study.what.name == "order"; }

std::string order_heading(const Study& study) {
  const std::size_t n = study.runs.size();
  if (spectral(study))
    return fmt::format("gain {} to {}", value_text(study.runs[n - 2].value), value_text(study.runs[n - 1].value));
  const std::optional<double> theory = study.what.expected(study.scene.scene);
  return theory ? fmt::format("order, theory {:g}", *theory) : "order";
}
std::string order_text(const Study& study, const Convergence& c) {
  if (!c.order) return std::string(text_of(c.verdict));
  return spectral(study) ? fmt::format("{:.3g}", gain_of(study, *c.order)) : fmt::format("{:.2f}", *c.order);
}

TextTable table_of_runs(const Study& study, bool with_seconds) {
  TextTable table{"Runs; errors of the final shapes in R0: by the program's own statement, and as found here.",
                  {std::string(study.what.symbol), "steps", "rejected", "iterations a step", "stated", "found"},
                  {}};
  if (with_seconds) table.columns.insert(table.columns.end(), {"seconds", "of processors"});
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    const StudyRun& run = study.runs[k];
    table.rows.push_back({heading_of(study, k), fmt::format("{}", run.steps), fmt::format("{:.0f}", run.rejected),
                          fmt::format("{:.1f}", run.iterations), error_number(run.stated),
                          error_text(study.shapes, k)});
    if (with_seconds)
      for (const auto part : {&RunTime::wall, &RunTime::cpu})
        table.rows.back().push_back(run.seconds ? fmt::format("{:.1f}", *run.seconds.*part) : "kept");
  }
  return table;
}

/// "13.05182 ± 0.00041".
std::string limit_text(const Convergence& c, const Digits& digits) {
  return fmt::format("{} ± {}", digits.text(*c.limit),
                     digits.scientific || c.uncertainty == 0 ? scientific(c.uncertainty)
                                                             : fmt::format("{:.{}f}", c.uncertainty, digits.places));
}

TextTable table_of_values(const Study& study) {
  TextTable table{fmt::format("Values against {}{}.", study.what.key, study.own ? "; *: the scene's own" : ""),
                  {"result", "unit"},
                  {}};
  for (std::size_t k = 0; k < study.runs.size(); ++k) table.columns.push_back(heading_of(study, k));
  table.columns.insert(table.columns.end(), {order_heading(study), "limit"});
  for (const auto& [result, c] : study.rows) {
    const Digits digits = result.from_last_run ? Digits{1, true} : digits_of(result.values, c);
    std::vector<std::string>& cells = table.rows.emplace_back();
    cells = {without_braces(result.name), without_braces(result.unit)};
    for (const double value : result.values) cells.push_back(digits.text(value));
    cells.push_back(order_text(study, c));
    cells.push_back(!c.limit ? "-" : result.from_last_run ? "0" : limit_text(c, digits));
  }
  return table;
}

TextTable table_of_errors(const Study& study) {
  TextTable table{
      "Errors: distances from the limit; <: its uncertainty; ~: without a limit, largest distance from another run.",
      {"result", "unit"},
      {}};
  for (std::size_t k = 0; k < study.runs.size(); ++k) table.columns.push_back(heading_of(study, k));
  for (const auto& [result, c] : study.rows) {
    std::vector<std::string>& cells = table.rows.emplace_back();
    cells = {without_braces(result.name), without_braces(result.unit)};
    for (std::size_t k = 0; k < study.runs.size(); ++k) cells.push_back(error_text(c, k));
  }
  return table;
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.12g}", value) : ""; }
std::string number(const std::optional<double>& value) { return value ? number(*value) : ""; }

std::string title_of(const Study& study) {
  const std::string title = printable(study.scene.scene.title);
  return fmt::format("Convergence in {}{}{}", study.what.key, title.empty() ? "" : ": ", title);
}

}  // namespace

std::vector<TextTable> tables_of(const Study& study, bool with_seconds) {
  return {table_of_runs(study, with_seconds), table_of_values(study), table_of_errors(study)};
}

std::string csv_of(const Study& study) {
  std::string text = fmt::format("# tanktread {}, converge, {}\n", version(), study.what.key);
  const std::string resolved = write_scene(study.scene.scene);
  for (std::string_view rest = resolved; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    if (!line.empty()) text += fmt::format("# {}\n", line);
  }
  text +=
      fmt::format("result,unit,{},steps,stated_error,value,error,order,limit,uncertainty,verdict\n", study.what.name);
  for (const auto& [result, c] : study.rows)
    for (std::size_t k = 0; k < study.runs.size(); ++k) {
      const std::optional<double> limit = result.from_last_run && c.limit ? std::optional(0.0) : c.limit;
      text +=
          fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", render::csv_cell(without_braces(result.name)),
                      render::csv_cell(without_braces(result.unit)), value_text(study.runs[k].value),
                      study.runs[k].steps, number(study.runs[k].stated), number(result.values[k]), number(c.errors[k]),
                      number(c.order), number(limit), number(c.uncertainty), text_of(c.verdict));
    }
  return text;
}

std::string page_of(const Study& study, const std::string& command, const std::string& picture) {
  const std::string title = title_of(study);
  std::string text = fmt::format("# {}\n\n`{}` (tanktread {})\n", title, printable(command), version());
  for (const TextTable& table : tables_of(study, false)) text += fmt::format("\n{}", markdown_text(table));
  text += "\n";
  for (const std::string& line : study.findings) text += line + "\n";
  if (!picture.empty()) text += fmt::format("\n![{}]({})\n", title, picture);
  return text + fmt::format("\n```toml\n{}```\n", write_scene(study.scene.scene));
}

}  // namespace app
