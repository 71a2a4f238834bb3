#include "app/converge/variation.h"

#include "sim/core/catalogue.h"
#include "sim/core/derived.h"
#include "sim/stepping/schemes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace app {

namespace {

using sim::Scene;

std::optional<double> own_tolerance(const Scene& scene, std::string& why) {
  if (sim::steps_adapt(scene.time)) return sim::tolerance_of(scene.time);
  why = "its steps are fixed; take --vary step";
  return std::nullopt;
}
std::optional<double> own_step(const Scene& scene, std::string& why) {
  if (!sim::steps_adapt(scene.time)) return scene.time.step;
  why = "its steps follow a tolerance; take --vary tolerance";
  return std::nullopt;
}
std::optional<double> own_order(const Scene& scene, std::string& why) {
  const int order = scene.vesicles.front().order;
  const bool one = std::all_of(scene.vesicles.begin(), scene.vesicles.end(),
                               [&](const sim::VesicleParameters& v) { return v.order == order; });
  if (one && order > 0) return order;
  if (one && !sim::steps_adapt(scene.time)) return sim::fixed_order;
  why = one ? "its order follows the tolerance; give --values, as in --values 8,10,12"
            : "its vesicles differ in order; give --values, each of which is taken by all";
  return std::nullopt;
}

/// Without the last bits of a product, which would be digits in names of files.
double rounded(double value) { return std::stod(fmt::format("{:.12g}", value)); }

std::vector<double> tolerances_around(double own) {
  constexpr double largest = 0.1;  // that a scene may have
  const double first = 10 * own > largest ? own : own < 10 * sim::least_tolerance ? 100 * own : 10 * own;
  std::vector<double> all{rounded(first), rounded(first / 10), rounded(first / 100)};
  for (double& value : all)
    if (std::abs(value / own - 1) < 1e-9) value = own;
  return all;
}
std::vector<double> steps_around(double own) { return {rounded(2 * own), own, rounded(own / 2)}; }
std::vector<double> orders_around(double own) {
  const double apart = own >= 10 ? 4 : 2;
  return own - apart < 2    ? std::vector<double>{own, own + apart, own + 2 * apart}
         : own + apart > 64 ? std::vector<double>{own - 2 * apart, own - apart, own}
                            : std::vector<double>{own - apart, own, own + apart};
}

double itself(double value) { return value; }
double exponential(double order) { return std::exp(-order); }

/// A step of length h may leave an error of tolerance x h.
std::optional<double> linear(const Scene&) { return 1; }
std::optional<double> order_of_scheme(const Scene& scene) {
  const auto* row = sim::find_row(sim::scheme_catalogue(), scene.time.scheme.value_or("bdf2"));
  return row ? std::optional<double>(row->function.order) : std::nullopt;
}
std::optional<double> unknown(const Scene&) { return std::nullopt; }

}  // namespace

const std::vector<VariationRow>& variations() {
  static const std::vector<VariationRow> rows{
      {"tolerance", "error that adaptive steps may leave, time.tolerance", "time.tolerance", "tolerance", false, true,
       own_tolerance, tolerances_around, itself, linear, [](double v) { return std::pow(v, -0.25); }},
      {"step", "length of fixed steps, time.step", "time.step", "step", false, true, own_step, steps_around, itself,
       order_of_scheme, [](double v) { return 1 / v; }},
      {"order", "degree of the spherical harmonics, vesicle.order of all vesicles", "vesicle.order", "order", true,
       false, own_order, orders_around, exponential, unknown, [](double v) { return std::pow(v, 4); }}};
  return rows;
}

const VariationRow& find_variation(std::string_view name) {
  if (const VariationRow* row = sim::find_row(variations(), name)) return *row;
  throw std::runtime_error(
      fmt::format("--vary {}: there is no such study{}", name, sim::suggestion(name, sim::row_names(variations()))));
}

const VariationRow& natural_variation(const Scene& scene) {
  return find_variation(sim::steps_adapt(scene.time) ? "tolerance" : "step");
}

std::vector<double> read_variation_values(const VariationRow& row, std::string_view text) {
  std::vector<double> values;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    std::string_view word = rest.substr(0, comma);
    while (word.starts_with(' ')) word.remove_prefix(1);
    while (word.ends_with(' ')) word.remove_suffix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value) || value <= 0)
      throw std::runtime_error(fmt::format("--values {}: '{}' is not a positive number; write them as {}", text, word,
                                           row.whole ? "6,8,10" : "0.01,0.001,0.0001"));
    if (row.whole && value != std::floor(value))
      throw std::runtime_error(
          fmt::format("--values {}: '{}' is not a whole number, as '{}' wants", text, word, row.key));
    values.push_back(value);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  std::sort(values.begin(), values.end());
  if (const auto twice = std::adjacent_find(values.begin(), values.end()); twice != values.end())
    throw std::runtime_error(fmt::format("--values {}: {} is given twice", text, value_text(*twice)));
  if (values.size() < 2)
    throw std::runtime_error(fmt::format("--values {}: give two values at least, three for an order", text));
  if (row.falls) std::reverse(values.begin(), values.end());
  return values;
}

std::string value_text(double value) {
  std::string text = fmt::format("{}", value);
  if (const std::size_t at = text.find("e-0"); at != std::string::npos) text.erase(at + 2, 1);
  return text;
}

std::optional<double> common_save_interval(const std::vector<double>& steps, const std::vector<double>& given) {
  const auto fits = [&](double interval) {
    return std::all_of(steps.begin(), steps.end(), [&](double step) {
      const double count = interval / step;
      return std::abs(count - std::round(count)) < 1e-6 * count;
    });
  };
  const bool same = std::adjacent_find(given.begin(), given.end(), std::not_equal_to<>()) == given.end();
  if (same && fits(given.front())) return given.front();
  const double longest = *std::max_element(steps.begin(), steps.end());
  return fits(longest) ? std::optional(longest) : std::nullopt;
}

}  // namespace app
