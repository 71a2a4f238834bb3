// What a study of convergence varies: a catalogue. A row knows the key of the scene, the values that surround the
// scene's own, and how small each makes the error.
#pragma once

#include "app/scene/settings.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace app {

struct VariationRow {
  std::string_view name;  ///< as in --vary, and in names of files
  std::string_view meaning;
  std::string_view key;     ///< of the scene
  std::string_view symbol;  ///< in tables and figures
  bool whole;               ///< the values are whole numbers
  bool falls;               ///< smaller values are more accurate
  /// The scene's own value; nothing where it has none to vary, with the reason in `why`.
  std::optional<double> (*own)(const sim::Scene&, std::string& why);
  /// Three values, one of them the scene's own.
  std::vector<double> (*around)(double own);
  double (*smallness)(double value);  ///< h of sequence.h
  /// The order that theory gives to the error, if it does.
  std::optional<double> (*expected)(const sim::Scene&);
  /// Effort of a run, up to a factor, for the estimate of the time left.
  double (*effort)(double value);
};
const std::vector<VariationRow>& variations();
/// Throws std::runtime_error that names the nearest known one.
const VariationRow& find_variation(std::string_view name);
/// What the steps of a scene follow: "tolerance" or "step".
const VariationRow& natural_variation(const sim::Scene&);

/// "0.001,1e-4,1e-5", two numbers at least, all different; the most accurate comes last. Throws std::runtime_error.
std::vector<double> read_variation_values(const VariationRow&, std::string_view text);
/// The shortest digits that give the same number: "0.001", "1e-5", "12".
std::string value_text(double value);

/// Time between saved states, the same in all runs where each of the fixed steps fits into it; nothing: as each run
/// has it. `given`: of each run.
std::optional<double> common_save_interval(const std::vector<double>& steps, const std::vector<double>& given);

}  // namespace app
