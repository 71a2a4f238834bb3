// The stress of a dilute suspension, in the limit of small excess area.
#include "app/validate/theory.h"
#include "app/validate/validations.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

namespace app {

using std::numbers::pi;

Section validate_rheology(Trials& trials) {
  Section s{
      "Stress of a dilute suspension in the limit of small excess area Δ, here ν = 0.999, p = 8, γ̇t = 20. Of first "
      "order in the shape N₁/γ̇φ = √(30Δ/π) and N₂/γ̇φ = −(13/56) √(30Δ/π) for every λ, and [η] = 5/2 − Δ(23λ + "
      "32)/(16π) (Misbah 2006; Danker, Misbah 2007). The shape itself, of second order, adds a part of the order Δ "
      "to [η] that does not depend on λ: its number is shown for information, and differences between contrasts are "
      "compared, to 3 % of themselves, the next order again. What comes next in N₁ and N₂ is smaller by about the "
      "square of cos 2θ: they are allowed 0.002 + Δ((23λ + 32)/120)² of N₁. A sphere has 5/2."};
  constexpr double nu = 0.999;
  const double excess = excess_area(nu), first = rounded(std::sqrt(30 * excess / pi), 4);
  std::map<double, double> viscosity;
  s.checks();
  for (const double contrast : {0.2, 1.0, 3.0}) {
    const sim::FlowMeasures last = trials.last_flow(
        trials.run("tank-treading", {"vesicle.order=8", fmt::format("vesicle.viscosity_contrast={}", contrast),
                                     fmt::format("vesicle.reduced_volume={}", nu), "vesicle.axis=[1, 0, 0.85]",
                                     "time.end=20", "time.tolerance=1e-5", "time.save_every=2"}));
    viscosity[contrast] = last.intrinsic_viscosity;
    const double tolerance = rounded(first * (0.002 + excess * std::pow((23 * contrast + 32) / 120, 2)), 4);
    s.check(fmt::format("λ = {}: N₁", contrast), last.normal_stress_1, first, tolerance);
    s.check(fmt::format("λ = {}: N₂", contrast), last.normal_stress_2, rounded(-13.0 / 56 * first, 4), tolerance);
    const double rest = (viscosity[contrast] - 2.5) / excess + (23 * contrast + 32) / (16 * pi);
    s.note(fmt::format("λ = {}: [η], and of what the first order leaves the share of Δ", contrast),
           fmt::format("{:.5f}, {:.3f}", viscosity[contrast], rest));
  }
  for (const auto& [a, b] : {std::pair{0.2, 1.0}, std::pair{1.0, 3.0}}) {
    const double lowered = rounded((b - a) * 23 * excess / (16 * pi), 5);
    s.check(fmt::format("[η] at λ = {} less that at λ = {}", a, b), viscosity[a] - viscosity[b], lowered,
            rounded(0.03 * lowered, 5), 5);
  }
  for (const double contrast : {1.0, 100.0}) {
    const sim::FlowMeasures last = trials.last_flow(
        trials.run("tank-treading", {"vesicle.order=8", fmt::format("vesicle.viscosity_contrast={}", contrast),
                                     "vesicle.reduced_volume=1", "time.end=2"}));
    s.check(fmt::format("sphere, λ = {}: [η]", contrast), last.intrinsic_viscosity, 2.5, 0.001);
  }
  render::Plot plot;
  plot.x = {.label = "viscosity contrast λ", .grid = true};
  plot.y = {.label = "intrinsic viscosity [η]", .grid = true};
  std::vector<double> x, y, lambdas, theory;
  for (const auto& [contrast, value] : viscosity) {
    x.push_back(contrast);
    y.push_back(value);
  }
  // The part that does not depend on λ is taken from the smallest contrast.
  const double offset = y[0] - (2.5 - excess * (23 * x[0] + 32) / (16 * pi));
  for (double lambda = 0; lambda < 3.26; lambda += 0.25) {
    lambdas.push_back(lambda);
    theory.push_back(2.5 - excess * (23 * lambda + 32) / (16 * pi) + offset);
  }
  plot.curves = {line_curve("theory, its part without λ from the first point", lambdas, theory, 1, 1),
                 point_curve("Tanktread, ν = 0.999", x, y, 0, render::Marker::ring)};
  s.figure = panels({plot});
  s.caption = "Intrinsic viscosity against λ: the slope is that of theory.";
  return s;
}

}  // namespace app
