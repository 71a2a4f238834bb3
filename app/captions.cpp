#include "captions.h"

#include <fmt/format.h>

#include <cmath>

namespace app {

namespace {

/// The flow's rate at the size of a vesicle, 1/time; 0: none that deforms.
double deformation_rate(const sim::FlowParameters& flow, double radius) {
  if (flow.kind == "shear" || flow.kind == "extension") return std::abs(flow.rate);
  if (flow.kind == "poiseuille") return std::abs(flow.curvature) * radius;
  return 0;
}

}  // namespace

TimeUnit time_unit(const sim::Scene& scene) {
  const bool shear = scene.flows.size() == 1 && scene.flows[0].kind == "shear" && scene.flows[0].time_factor == "constant" &&
                     scene.flows[0].rate != 0;
  return shear ? TimeUnit{"γ̇t", std::abs(scene.flows[0].rate)} : TimeUnit{};
}

std::string time_caption(const sim::Scene& scene, double time) {
  const TimeUnit unit = time_unit(scene);
  return fmt::format("{} = {:.2f}", unit.symbol, unit.factor * time);
}

std::string parameter_caption(const sim::Scene& scene, double area_radius, double reduced_volume) {
  const sim::VesicleParameters& vesicle = scene.vesicles.front();
  const double stiffness = vesicle.bending_modulus;
  std::string text;
  const auto add = [&](std::string_view symbol, double value) {
    text += fmt::format("{}{} = {:.3g}", text.empty() ? "" : "   ", symbol, value);
  };
  double rate = 0;
  for (const sim::FlowParameters& flow : scene.flows) rate = std::max(rate, deformation_rate(flow, area_radius));
  if (rate > 0 && stiffness > 0) add("Ca", rate * std::pow(area_radius, 3) / stiffness);
  const double weight = std::abs(vesicle.density_difference) * scene.buoyancy.gravity.norm();
  if (weight > 0 && stiffness > 0) add("Bo", weight * std::pow(area_radius, 4) / stiffness);
  add("λ", vesicle.viscosity_contrast);
  add("ν", reduced_volume);
  return text;
}

}  // namespace app
