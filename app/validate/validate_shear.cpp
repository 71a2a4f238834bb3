// One vesicle in shear: angle, frequency, half turn, limits of small excess area and of a rigid body.
#include "app/figures/tank_treading.h"
#include "app/validate/theory.h"
#include "app/validate/validations.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>

namespace app {

namespace {

/// cos 2 theta / sqrt(Delta) of a vesicle.
double cosine_ratio(const Sample& sample, double nu) {
  return std::cos(sample.inclination_deg * std::numbers::pi / 90) / std::sqrt(excess_area(nu));
}

std::vector<double> times_of(const Samples& samples) {
  std::vector<double> times;
  for (const Sample& s : samples) times.push_back(s.time);
  return times;
}

}  // namespace

Section validate_tank_treading(Trials& trials) {
  Section s{
      "Steady angle of the prolate of reduced volume 0.85 in shear, λ = 1, at γ̇t = 20, with the default tolerance. "
      "The reference is an independent implementation of the same equations, which states 24.16 ± 0.02° and axes to "
      "four digits; p = 8 is allowed the error of its grid besides, 0.15°, and p = 12 a third of that. Axes differ "
      "by what is left of the way to the steady shape, below 0.005. Area and volume are corrected in each step."};
  s.checks();
  render::Plot plot;
  plot.x = {.label = "γ̇t", .grid = true};
  plot.y = {.label = "inclination (°)", .grid = true};
  for (const auto& [order, tolerance] : {std::pair{8, 0.15}, std::pair{12, 0.06}}) {
    const Samples rows = trials.history("tank-treading", {fmt::format("vesicle.order={}", order)});
    const Sample& last = rows.back();
    s.check(fmt::format("p = {}: angle (degrees)", order), last.inclination_deg, 24.16, tolerance, 3);
    constexpr std::array lengths{1.6621, 0.7675, 0.6663};
    for (int k = 0; k < 3; ++k)
      s.check(fmt::format("p = {}: axis_{}", order, k + 1), last.axes[k], lengths[static_cast<std::size_t>(k)], 0.005);
    s.below(fmt::format("p = {}: largest area error", order), largest(rows, &Sample::area_error), 1e-6);
    s.below(fmt::format("p = {}: largest volume error", order), largest(rows, &Sample::volume_error), 1e-6);
    plot.curves.push_back(line_curve(fmt::format("p = {}", order), times_of(rows), unwrapped(rows), plot.curves.size(),
                                     order == 8 ? 0 : 1));
  }
  plot.curves.push_back(line_curve("24.16°", {0, 20}, {24.16, 24.16}, 2, 2));
  s.figure = panels({plot});
  s.caption = "From along the flow to the steady angle: p = 8 and 12 lie on each other.";
  return s;
}

Section validate_treading_frequency(Trials& trials) {
  Section s{
      "Frequency of the membrane in steady tank-treading against published values (± as they state it), λ = 1, p = "
      "8, κ_b = 0.01, at γ̇t = 20, taken from the last state. The figure stands under [literature](#literature), "
      "whose runs cover more reduced volumes."};
  s.checks();
  struct Case {
    double nu, frequency, tolerance;
  };
  for (const Case& c : {Case{0.80, 0.33, 0.02}, {0.95, 0.454, 0.0135}}) {
    const Trial trial =
        trials.run("tank-treading", {"vesicle.order=8", fmt::format("vesicle.reduced_volume={}", c.nu)});
    const SteadyPoint point = steady_point(trials.plans(), trial.last().vesicles[0], 1, 1);
    s.check(fmt::format("ν = {}: ω/γ̇", c.nu), point.frequency, c.frequency, c.tolerance);
  }
  return s;
}

Section validate_tumbling(Trials& trials) {
  Section s{
      "The same vesicle with λ = 10: when the long axis passes −180°, with the default tolerance. The reference is the "
      "independent implementation's 13.055 ± 0.005; it and we are allowed ten times that."};
  s.checks();
  render::Plot plot;
  plot.x = {.label = "γ̇t", .grid = true};
  plot.y = {.label = "inclination (°)", .scale = render::Scale::degrees, .grid = true};
  for (const int order : {8, 12}) {
    const Samples rows = trials.history("tumbling", {fmt::format("vesicle.order={}", order), "time.end=15"});
    s.check(fmt::format("p = {}: half turn at γ̇t", order), time_at(rows, -180), 13.055, 0.05, 3);
    s.below(fmt::format("p = {}: largest area error", order), largest(rows, &Sample::area_error), 1e-6);
    plot.curves.push_back(line_curve(fmt::format("p = {}", order), times_of(rows), unwrapped(rows), plot.curves.size(),
                                     order == 8 ? 0 : 1));
  }
  plot.curves.push_back(point_curve("independent implementation", {13.055}, {-180}, 2, render::Marker::diamond));
  s.figure = panels({plot});
  s.caption = "Half a turn: p = 8 and 12 lie on each other.";
  return s;
}

Section validate_quasi_spherical(Trials& trials) {
  Section s{
      "Steady cos 2θ/√Δ in strong shear for ν = 0.999 against the limit Δ → 0, (23λ + 32)/(120 √(2π/15)); p = 8, "
      "γ̇t = 40. Allowed are 1.5 %, of the order of the next term, Δ times the square of the number itself."};
  s.checks();
  std::vector<double> contrasts, found, limits, theory;
  for (double contrast = 0; contrast <= 6.01; contrast += 0.25) {
    theory.push_back(contrast);
    limits.push_back(quasi_spherical_cosine(contrast));
  }
  for (const double contrast : {0.2, 1.0, 5.6}) {
    const Sample last = trials.last(
        "tank-treading", {"vesicle.order=8", fmt::format("vesicle.viscosity_contrast={}", contrast),
                          "vesicle.reduced_volume=0.999", "time.end=40", "time.step=0.05", "time.save_every=1"});
    const double limit = rounded(quasi_spherical_cosine(contrast), 4);
    s.check(fmt::format("λ = {}", contrast), cosine_ratio(last, 0.999), limit, rounded(0.015 * limit, 4));
    contrasts.push_back(contrast);
    found.push_back(cosine_ratio(last, 0.999));
  }
  render::Plot plot;
  plot.x = {.label = "viscosity contrast λ", .grid = true};
  plot.y = {.label = "cos 2θ / √Δ", .grid = true};
  plot.curves = {line_curve("limit Δ → 0", theory, limits, 1, 1),
                 point_curve("Tanktread, ν = 0.999", contrasts, found, 0, render::Marker::ring)};
  s.figure = panels({plot});
  s.caption = "The limit is a straight line in λ.";
  return s;
}

Section validate_literature(Trials& trials) {
  Section s{
      "Steady angles and frequencies that others computed, read from their figures to ± 0.002 π; here p = 8, κ_b = "
      "0.01, γ̇t = 40. For information: this is what two methods differ by. At ν = 0.974 ours does not change with "
      "p (8, 12) or κ_b (0.01 to 1) by more than 0.0005 π and goes on to the quasi-spherical limit above."};
  s.table({"λ", "ν", "angle / π", "published", "difference", "frequency / γ̇"});
  std::vector<SteadyPoint> points;
  for (const LiteraturePoint& p : literature_angles()) {
    const Trial trial =
        trials.run("tank-treading",
                   {"vesicle.order=8", fmt::format("vesicle.viscosity_contrast={}", p.viscosity_contrast),
                    fmt::format("vesicle.reduced_volume={}", p.reduced_volume), "time.end=40", "time.save_every=1"});
    const SteadyPoint own = steady_point(trials.plans(), trial.last().vesicles[0], p.viscosity_contrast, 1);
    points.push_back(own);
    s.row({fmt::format("{}", p.viscosity_contrast), fmt::format("{}", p.reduced_volume),
           fmt::format("{:.4f}", own.angle), fmt::format("{:.3f}, {}", p.value, p.source),
           fmt::format("{:+.4f}", own.angle - p.value), fmt::format("{:.4f}", own.frequency)});
  }
  s.figure = panels(tank_treading_plots(points));
  s.caption =
      "Inclination and frequency of the membrane over reduced volume. Rings: this program; diamonds and squares: "
      "published; dashes: Keller and Skalak's ellipsoid of fixed shape.";
  return s;
}

Section validate_jeffery(Trials& trials) {
  Section s{
      "A prolate of axes 2:1 (ν = 0.8950367), κ_b = 0.01, in shear, p = 12, tolerance 1e-4 (`scenes/tumbling.toml` "
      "with `vesicle.viscosity_contrast`): the time of half a turn, from −0° to −180°. A membrane that cannot "
      "stretch round a fluid that cannot be sheared is a rigid body, so the limit λ → ∞ is Jeffery's orbit, π(r + "
      "1/r) = 7.853982 for r = 2. The correction is c/λ + d/λ² + ...: times λ it must tend to a constant, and two "
      "values of λ extrapolate the limit but for −d/(λ₁λ₂), with d ≈ 144 from the first two rows: 0.005; three "
      "values but for a term of the next order and for errors of resolution of some 1e-4. Keller and Skalak's "
      "ellipsoid of fixed shape has the same limit and a c of the same size; no exact c is known to us."};
  s.table({"λ", "half turn", "(half turn − 7.853982) λ", "that of Keller and Skalak"});
  const double limit = jeffery_half_turn(2);
  constexpr std::array contrasts{30.0, 100.0, 300.0};
  std::array<double, 3> turns{}, corrections{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double contrast = contrasts[k];
    turns[k] = time_at(trials.history("tumbling", {fmt::format("vesicle.viscosity_contrast={}", contrast),
                                                   "vesicle.reduced_volume=0.8950367", "time.end=10",
                                                   "time.tolerance=1e-4", "time.save_every=0.05"}),
                       -180);
    corrections[k] = (turns[k] - limit) * contrast;
    s.row({fmt::format("{}", contrast), fmt::format("{:.5f}", turns[k]), fmt::format("{:.3f}", corrections[k]),
           fmt::format("{:.3f}", (keller_skalak_half_turn(2, contrast) - limit) * contrast)});
  }
  s.checks();
  s.check("correction times λ: its change from λ = 100 to 300 over that from 30 to 100; (1/100 − 1/300)/(1/30 − 1/100)",
          std::abs(corrections[2] - corrections[1]) / std::abs(corrections[1] - corrections[0]), rounded(2.0 / 7, 4),
          0.07);
  s.check("limit by two values, λ = 100 and 300", (300 * turns[2] - 100 * turns[1]) / 200, 7.853982, 0.006, 6);
  double three = 0;  // the polynomial of second degree in 1/λ, at 0
  for (std::size_t a = 0; a < 3; ++a) {
    double weight = contrasts[a] * contrasts[a];
    for (std::size_t b = 0; b < 3; ++b)
      if (b != a) weight /= contrasts[a] - contrasts[b];
    three += turns[a] * weight;
  }
  s.check("limit by three values", three, 7.853982, 0.001, 6);
  render::Plot plot;
  plot.x = {.label = "viscosity contrast λ", .scale = render::Scale::logarithmic, .grid = true};
  plot.y = {.label = "γ̇ × half turn − π(r + 1/r)", .scale = render::Scale::logarithmic, .grid = true};
  std::vector<double> x, own, lambdas, theory;
  for (std::size_t k = 0; k < 3; ++k) {
    x.push_back(contrasts[k]);
    own.push_back(turns[k] - limit);
  }
  for (double lambda = 20; lambda < 401; lambda *= std::pow(20, 0.05)) {
    lambdas.push_back(lambda);
    theory.push_back(keller_skalak_half_turn(2, lambda) - limit);
  }
  plot.curves = {line_curve("Keller, Skalak 1982", lambdas, theory, 1, 1),
                 point_curve("Tanktread", x, own, 0, render::Marker::ring)};
  s.figure = panels({plot});
  s.caption = "The approach to Jeffery's orbit: what half a turn exceeds that of the rigid spheroid by falls like 1/λ.";
  return s;
}

}  // namespace app
