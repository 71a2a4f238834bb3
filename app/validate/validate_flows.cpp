// Tube flow, an encounter of two vesicles, and flows that turn back.
#include "app/validate/validations.h"

#include "sim/sphere/basis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace app {

namespace {

/// The last state, with the speed of the last ten intervals along x.
struct Steady {
  Sample last;
  double speed = 0;
};

Steady steady_of(const Samples& samples) {
  const Sample &last = samples.back(), &before = samples[samples.size() - 11];
  return {last, (last.center[0] - before.center[0]) / (last.time - before.time)};
}

}  // namespace

Section validate_poiseuille(Trials& trials) {
  Section s{
      "Parachute (t = 40) and slipper (t = 60). The paper's errors there: area 4.24e-2, volume 5.96e-3. What they "
      "converge to, in space by the differences from one order to the next, which must have fallen from p = 8 to p "
      "= 20, and the last of them below 0.002 R₀ and 0.2 degrees: that is the error stated for the value at p = 20. "
      "In time by the difference between fixed steps at p = 12. The parachute keeps to the axis, where symmetry "
      "holds it: what is seen are rounding errors that grow, 1e-3."};
  s.checks();
  constexpr double axis_velocity = 0.25;  // of the fluid: flow.centreline_velocity
  const auto errors = [&](const std::string& scene, const Samples& samples) {
    s.below(scene + ": largest area error", largest(samples, &Sample::area_error), 1e-6);
    s.below(scene + ": largest volume error", largest(samples, &Sample::volume_error), 1e-6);
  };
  std::map<int, Steady> parachute;
  for (const int order : {8, 12, 16}) {
    const Samples samples = trials.history("parachute", {fmt::format("vesicle.order={}", order)});
    parachute[order] = steady_of(samples);
    if (order > 8) continue;
    errors("parachute", samples);
    s.below("parachute: distance from the axis", std::abs(samples.back().center[2]), 1e-3);
  }
  for (const auto& [order, steady] : parachute)
    s.note(fmt::format("parachute: energy, and speed less that of the fluid on the axis, at p = {}", order),
           fmt::format("{:.4f}, {:.4f}", steady.last.energy, steady.speed - axis_velocity));
  std::map<int, Sample> by_order;
  render::Plot paths;
  paths.x = {.label = "t", .grid = true};
  paths.y = {.label = "distance from the axis / R_{0}", .grid = true};
  for (const int order : {8, 12, 16, 20}) {
    const Samples samples = trials.history("slipper", {fmt::format("vesicle.order={}", order)});
    by_order[order] = samples.back();
    if (order == 8) errors("slipper", samples);
    std::vector<double> t, z;
    for (const Sample& sample : samples) {
      t.push_back(sample.time);
      z.push_back(sample.center[2]);
    }
    const std::size_t k = paths.curves.size();
    paths.curves.push_back(line_curve(fmt::format("p = {}", order), t, z, k, static_cast<int>(k)));
  }
  for (const auto& [order, last] : by_order)
    s.note(fmt::format("slipper: tilt (degrees), distance from the axis at p = {}", order),
           fmt::format("{:.3f}, {:.4f}", last.inclination_deg, last.center[2]));
  const auto converges = [&](const std::string& what, double bound, auto&& value) {
    const double first = std::abs(value(by_order[8]) - value(by_order[12])),
                 final = std::abs(value(by_order[16]) - value(by_order[20]));
    s.below(fmt::format("slipper: {}, change from p = 16 to 20", what), final, bound);
    s.below(fmt::format("slipper: {}, that change less the one from p = 8 to 12, if positive", what),
            std::max(final - first, 0.0), 1e-12);
  };
  converges("distance", 0.002, [](const Sample& sample) { return sample.center[2]; });
  converges("tilt (degrees)", 0.2, [](const Sample& sample) { return sample.inclination_deg; });
  std::array<double, 3> z{};
  constexpr std::array steps{0.1, 0.05, 0.025};
  for (std::size_t k = 0; k < 3; ++k)
    z[k] = trials.last("slipper", {"vesicle.order=12", fmt::format("time.step={}", steps[k])}).center[2];
  s.note("slipper: distance at Δt = 0.1, 0.05, 0.025 (p = 12)",
         fmt::format("{:.6f}, {:.6f}, {:.6f}", z[0], z[1], z[2]));
  s.below("slipper: distance, change from Δt = 0.05 to 0.025", std::abs(z[2] - z[1]), 5e-4);
  s.figure = panels({paths});
  s.caption =
      "The slipper's distance from the axis: it migrates inward until the end of the run; p = 12, 16 and 20 lie on "
      "each other.";
  return s;
}

namespace {

/// How much farther from each other across the flow two vesicles are when they have passed.
double displacement(Trials& trials, double contrast, double offset, double tolerance) {
  const double away = std::max(8.0, 5 * offset);
  const Trial trial =
      trials.run("encounter", {"vesicle.order=8", fmt::format("vesicle.viscosity_contrast={}", contrast),
                               fmt::format("vesicle.0.center=[{},0,{}]", -away, offset / 2),
                               fmt::format("vesicle.1.center=[{},0,{}]", away, -offset / 2),
                               fmt::format("time.end={}", 4.1 * away / offset + 2), "time.save_every=0.1",
                               fmt::format("time.tolerance={}", tolerance)});
  const Samples a = trials.history(trial, 0), b = trials.history(trial, 1);
  const auto along = [&](std::size_t k) { return b[k].center[0] - a[k].center[0]; };
  const auto across = [&](std::size_t k) { return a[k].center[2] - b[k].center[2]; };
  for (std::size_t k = 1; k < a.size(); ++k)
    if (along(k) <= -2 * away)
      return across(k - 1) + (along(k - 1) + 2 * away) / (along(k - 1) - along(k)) * (across(k) - across(k - 1)) -
             offset;
  throw std::runtime_error(fmt::format("the vesicles of offset {} have not passed by the end of the run", offset));
}

}  // namespace

Section validate_encounter(Trials& trials) {
  Section s{
      "Two prolates (ν = 0.85, κ_b = 0.01, p = 8) on neighbouring streamlines of a shear flow pass each other "
      "(`scenes/encounter.toml`): their offset across the flow, when they are as far apart along it as at the "
      "start, less the offset at the start. They start 16 R₀ apart along the flow, ten times the offset for the "
      "larger offsets. Expected: positive (they push each other aside and do not come back: a vesicle has normal "
      "stresses along and across the flow, unlike a rigid sphere), smaller the larger the offset, and, far apart, "
      "like 1/offset²: two force dipoles with S_xx, S_zz move each other across by ∝ ∫ z (x² S_xx + z² S_zz) r⁻⁵ dx "
      "/ (γ̇ z) ∝ 1/z². λ = 1 treads at 24°, λ = 5 at a few degrees. The ratio at offsets 4 and 8 may miss 4 by 15 "
      "%, of the order of R₀/offset. Errors: the tolerance 1e-3 promises less than 0.3 γ̇t times 1e-3 of position, "
      "some 0.02 for the small offsets; asked for is a twentieth of it from 1e-3 to 1e-4."};
  s.table({"λ", "offset at the start", "displacement, tolerance 1e-3", "1e-4", "difference",
           "times (offset + half the displacement)²"});
  const std::vector<double> offsets{0.5, 1, 2, 4, 8};
  std::map<double, std::vector<double>> found;
  std::map<double, double> worst;
  for (const double contrast : {1.0, 5.0})
    for (const double offset : offsets) {
      const double coarse = displacement(trials, contrast, offset, 1e-3),
                   fine = displacement(trials, contrast, offset, 1e-4);
      found[contrast].push_back(fine);
      worst[contrast] = std::max(worst[contrast], std::abs(coarse - fine));
      s.row({fmt::format("{}", contrast), fmt::format("{}", offset), fmt::format("{:.4f}", coarse),
             fmt::format("{:.4f}", fine), fmt::format("{:+.4f}", coarse - fine),
             fmt::format("{:.3f}", fine * std::pow(offset + fine / 2, 2))});
    }
  s.checks();
  render::Plot plot;
  plot.x = {.label = "offset at the start / R_{0}", .scale = render::Scale::logarithmic, .grid = true};
  plot.y = {.label = "displacement / R_{0}", .scale = render::Scale::logarithmic, .grid = true};
  for (const auto& [contrast, own] : found) {
    const std::string where = fmt::format("λ = {}: ", contrast);
    const double least = *std::min_element(own.begin(), own.end());
    s.check_texts(where + "least displacement", fmt::format("{:.4f}", least), "above 0", least > 0);
    double step = own[0] - own[1];
    for (std::size_t k = 2; k < own.size(); ++k) step = std::min(step, own[k - 1] - own[k]);
    s.check_texts(where + "least decrease from one offset to the next", fmt::format("{:.4f}", step), "above 0",
                  step > 0);
    s.below(where + "largest difference between the tolerances", worst[contrast], 0.001);
    s.check(where + "displacement at offset 4 over that at 8", own[3] / own[4], 4, 0.6, 2);
    const std::size_t colour = plot.curves.size() / 2;
    plot.curves.push_back(point_curve(fmt::format("λ = {}", contrast), offsets, own, colour,
                                      colour == 0 ? render::Marker::ring : render::Marker::square, true));
    render::Curve law = line_curve(colour == 0 ? "∝ 1/offset²" : "", {2, 8}, {16 * own[4], own[4]}, colour, 1);
    law.ink_in_legend = true;
    plot.curves.push_back(law);
  }
  s.figure = panels({plot});
  s.caption = "Displacement across the flow after an encounter, and the law of force dipoles far apart.";
  return s;
}

Section validate_reversibility(Trials& trials) {
  Section s{
      "Without bending (κ_b = 0) nothing in the equations has a direction of time: the shear γ̇ sin(πt/T) for a "
      "time of T and the same back until 2T brings every point to where it was (`scenes/tank-treading.toml`, p = 8, "
      "`flow.time_factor=\"oscillating\"`, `flow.phase=-π/2`, `numerics.reparametrization=\"off\"` so that points "
      "can be compared). Measured: distance of 1986 points of the membrane from where they started (root of the "
      "mean square, R₀). Expected: it falls like the tolerance, at each, on the average at least eightfold a decade, "
      "and is "
      "below what the tolerance promises for the whole way, 0.3 γ̇ · 2T times the tolerance (see "
      "[stepping](stepping.md)). For T = "
      "4 at λ = 1 there is no such promise: on the way back the flow compresses the membrane, and without bending "
      "all wavelengths buckle, so that errors grow by a factor of a thousand or more before they end. Reversal "
      "still holds in the limit, and the table shows it; only a fall by a factor of 2 a decade on the average is "
      "asked for. For T = 10 at λ = 1 no tolerance that was tried brings the shape back."};
  s.table(
      {"λ", "T", "largest angle", "tolerance 1e-2", "1e-3", "1e-4", "1e-5", "fall a decade", "below the promise", ""});
  const std::vector<double> tolerances{1e-2, 1e-3, 1e-4, 1e-5};
  const sim::Matrix directions = mesh_directions();
  render::Plot plot;
  plot.x = {.label = "tolerance", .scale = render::Scale::logarithmic, .grid = true};
  plot.y = {.label = "distance from the start / R_{0}", .scale = render::Scale::logarithmic, .grid = true};
  constexpr std::array marks{render::Marker::ring, render::Marker::square, render::Marker::triangle,
                             render::Marker::diamond, render::Marker::dot};
  for (const auto& [contrast, duration] :
       {std::pair{1.0, 1.0}, std::pair{5.0, 1.0}, std::pair{5.0, 4.0}, std::pair{5.0, 10.0}, std::pair{1.0, 4.0}}) {
    std::vector<double> errors;
    double turned = 0;
    for (const double tolerance : tolerances) {
      const Trial trial =
          trials.run("tank-treading",
                     {"vesicle.order=8", "vesicle.bending_modulus=0", fmt::format("time.tolerance={}", tolerance),
                      fmt::format("vesicle.viscosity_contrast={}", contrast), "flow.time_factor=oscillating",
                      fmt::format("flow.frequency={}", 0.5 / duration),
                      fmt::format("flow.phase={}", -std::numbers::pi / 2), fmt::format("time.end={}", 2 * duration),
                      fmt::format("time.save_every={}", duration / 4), "numerics.reparametrization=off"});
      const Samples samples = trials.history(trial);
      turned = samples[0].inclination_deg;
      for (const Sample& sample : samples) turned = std::max(turned, sample.inclination_deg);
      const sim::Matrix apart = sim::sample_points(trial.trajectory.state(0).vesicles[0].position, directions) -
                                sim::sample_points(trial.last().vesicles[0].position, directions);
      errors.push_back(std::sqrt(apart.rowwise().squaredNorm().mean()));
    }
    const bool buckles = contrast == 1 && duration == 4;
    const double fall = std::cbrt(errors.front() / errors.back()), least = buckles ? 2 : 8;
    bool kept = true, falls = true;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      falls = falls && (k == 0 || errors[k] < errors[k - 1]);
      kept = kept && errors[k] < 0.6 * duration * tolerances[k];
    }
    std::vector<std::string> cells{fmt::format("{}", contrast), fmt::format("{}", duration),
                                   fmt::format("{:.1f}", turned)};
    for (const double error : errors) cells.push_back(fmt::format("{:.1e}", error));
    cells.push_back(fmt::format("{:.1f}, above {}", fall, least));
    cells.emplace_back(buckles ? "not asked for" : kept ? "yes" : "no");
    cells.push_back(s.verdict(falls && fall > least && (kept || buckles)));
    s.row(cells);
    const std::size_t k = plot.curves.size();
    plot.curves.push_back(
        point_curve(fmt::format("λ = {}, T = {}", contrast, duration), tolerances, errors, k, marks[k], true));
  }
  s.figure = panels({plot});
  s.caption = "How far points are from where they started, after a flow and its reverse.";
  return s;
}

}  // namespace app
