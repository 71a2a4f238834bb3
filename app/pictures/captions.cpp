#include "app/pictures/captions.h"

#include "sim/membrane/flows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace app {

namespace {

/// The flow's rate at the size of a vesicle, 1/time; 0: none that deforms.
double deformation_rate(const sim::FlowParameters& flow, double radius) {
  if (flow.kind == "shear" || flow.kind == "extension") return std::abs(flow.rate);
  if (flow.kind == "poiseuille") return std::abs(flow.curvature) * radius;
  if (flow.kind == "streams") {  // on the axis it is a Poiseuille flow with a = U k^2/2
    const double k = 2 * std::numbers::pi / flow.wavelength.value_or(sim::unlimited);
    return std::abs(flow.centreline_velocity) * k * k / 2 * radius;
  }
  return 0;
}

}  // namespace

double flow_rate(const sim::Scene& scene, double area_radius) {
  double rate = 0;
  for (const sim::FlowParameters& flow : scene.flows) rate = std::max(rate, deformation_rate(flow, area_radius));
  return rate;
}

TimeUnit time_unit(const sim::Scene& scene) {
  const std::optional<double> rate = sim::steady_shear_rate(scene.flows);
  return rate ? TimeUnit{"γ̇t", std::abs(*rate)} : TimeUnit{};
}

TimeFormat time_format(const sim::Scene& scene, double spacing, double end) {
  const double factor = time_unit(scene).factor;
  spacing *= factor;
  end *= factor;
  if (!(spacing > 0 && end > 0)) return {};
  constexpr int most = 4;  // places after the point without a power of ten
  const auto places = [](double step) { return std::max(2, static_cast<int>(std::ceil(-std::log10(step) - 1e-9))); };
  if (places(spacing) <= most && end < 1e5) return {places(spacing), 0};
  const int exponent = static_cast<int>(std::floor(std::log10(end)));
  return {std::min(places(spacing * std::pow(10.0, -exponent)), 9), exponent};
}

std::string time_caption(const sim::Scene& scene, double time, const TimeFormat& format) {
  const TimeUnit unit = time_unit(scene);
  std::string number = fmt::format("{:.{}f}", unit.factor * time * std::pow(10.0, -format.exponent), format.places);
  if (format.exponent != 0)
    number += fmt::format("·10^{{{}{}}}", format.exponent < 0 ? "−" : "", std::abs(format.exponent));
  return fmt::format("{} = {}", unit.symbol, number);
}

std::string parameter_caption(const sim::Scene& scene, std::span<const double> area_radii, double reduced_volume) {
  std::string text;
  // The values of all vesicles, each once: "λ = 1, 10"; of many different ones the range.
  const auto add = [&](std::string_view symbol, auto&& value_of) {
    std::vector<double> values;
    for (std::size_t k = 0; k < scene.vesicles.size(); ++k)
      if (const double value = value_of(scene.vesicles[k], area_radii[k]); value > 0) values.push_back(value);
    std::sort(values.begin(), values.end());
    std::vector<std::string> words;
    for (const double value : values)
      if (std::string word = fmt::format("{:.3g}", value); words.empty() || word != words.back()) words.push_back(word);
    if (words.empty()) return;
    constexpr std::size_t most = 3;
    if (words.size() > most) words = {fmt::format("{} to {}", words.front(), words.back())};
    text += fmt::format("{}{} = {}", text.empty() ? "" : "   ", symbol, fmt::join(words, ", "));
  };
  const double gravity = scene.buoyancy.gravity.norm();
  add("Ca", [&](const sim::VesicleParameters& v, double radius) {
    return v.bending_modulus > 0 ? flow_rate(scene, radius) * std::pow(radius, 3) / v.bending_modulus : 0;
  });
  add("Bo", [&](const sim::VesicleParameters& v, double radius) {
    return v.bending_modulus > 0 ? std::abs(v.density_difference) * gravity * std::pow(radius, 4) / v.bending_modulus
                                 : 0;
  });
  add("λ", [](const sim::VesicleParameters& v, double) { return v.viscosity_contrast; });
  const sim::VesicleParameters& first = scene.vesicles.front();
  const bool alike = std::all_of(scene.vesicles.begin(), scene.vesicles.end(), [&](const sim::VesicleParameters& v) {
    return v.shape == first.shape && v.reduced_volume == first.reduced_volume && v.axes == first.axes &&
           v.coefficients == first.coefficients && v.file == first.file;
  });
  if (alike) text += fmt::format("   ν = {:.3g}", reduced_volume);
  return text;
}

std::string error_caption(std::span<const sim::StepRecord> steps, double time) {
  double error = 0;
  for (const sim::StepRecord& step : steps)
    if (step.dt > 0) {
      double degrees = 0;
      for (const sim::VesicleStep& v : step.vesicles) degrees = std::max(degrees, v.space_error);
      error += (step.error + degrees) * std::clamp((time - step.time) / step.dt + 1, 0.0, 1.0);
    }
  if (!(error > 0)) return {};
  const std::string text = fmt::format("{:.1e}", error);
  const std::size_t e = text.find('e');
  const int exponent = std::stoi(text.substr(e + 1));
  return fmt::format("error of position {}·10^{{{}{}}} R_{{0}}", text.substr(0, e), exponent < 0 ? "−" : "",
                     std::abs(exponent));
}

}  // namespace app
