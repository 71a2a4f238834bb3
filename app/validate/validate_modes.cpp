// Waves on a nearly spherical vesicle decay as linear theory says.
#include "app/validate/base_scenes.h"
#include "app/validate/theory.h"
#include "app/validate/validations.h"

#include "sim/sphere/basis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace app {

namespace {

/// Coefficients of Y_20, Y_30, Y_40 of the radius as a function of the direction from the centre.
Amplitudes amplitudes_of(const sim::VesicleState& v, const sim::Vec3& centre) {
  const sim::Basis basis(v.position.order, 2 * v.position.order + 8);
  const sim::FirstDerivatives x = basis.first(v.position);
  const sim::Matrix y = x.value.rowwise() - centre.transpose();
  const sim::Vector radius = y.rowwise().norm();
  const sim::Matrix functions = sim::basis_functions(4, y.array().colwise() / radius.array());
  Amplitudes amplitudes{};
  for (Eigen::Index k = 0; k < y.rows(); ++k) {
    const sim::Vec3 t = x.t.row(k).transpose(), f = x.f.row(k).transpose();
    const double solid_angle =
        y.row(k).dot(t.cross(f).transpose()) / basis.sin_theta()[k] * basis.weights()[k] / std::pow(radius[k], 3);
    for (int n = 2; n <= 4; ++n)
      amplitudes[static_cast<std::size_t>(n - 2)] +=
          (radius[k] - 1) * functions(k, sim::coefficient_index(n, 0)) * solid_angle;
  }
  return amplitudes;
}

constexpr std::array starts{1.0, 0.7, 0.5};  // of degrees 2, 3, 4, times the size of the waves

/// Amplitudes at the first and last state; half the difference of waves and their opposites: what is quadratic cancels.
std::array<Amplitudes, 2> decay(Trials& trials, double contrast, double size, double end) {
  std::array<Amplitudes, 2> found{};
  for (const double sign : {1.0, -1.0}) {
    std::string terms;
    for (std::size_t k = 0; k < starts.size(); ++k)
      terms += fmt::format("{}[{},0,{}]", k > 0 ? "," : "", k + 2, sign * size * starts[k]);
    const Trial trial =
        trials.run("waves", {fmt::format("vesicle.coefficients=[{}]", terms),
                             fmt::format("vesicle.viscosity_contrast={}", contrast), fmt::format("time.end={}", end)});
    const std::array states{trial.trajectory.state(0), trial.last()};
    for (std::size_t at = 0; at < 2; ++at) {
      const sim::Vec3 centre = sim::measure(trials.plans(), states[at].vesicles[0], 1, 1).center;
      const Amplitudes a = amplitudes_of(states[at].vesicles[0], centre);
      for (std::size_t k = 0; k < a.size(); ++k) found[at][k] += sign * a[k] / 2;
    }
  }
  return found;
}

}  // namespace

Section validate_modes(Trials& trials) {
  Section s{fmt::format(
      "Waves of degrees 2, 3 and 4 on a nearly spherical vesicle without flow, κ_b = 1, p = 12, tolerance 1e-6. "
      "Linear theory (derived with the known spectra of the sphere): the coefficient of degree n of the radius "
      "falls at the rate (κ_b/2μR³)(n − 1)n(n + 1)(n + 2)[n(n + 1) + s]/D_n, D_n = 2n³ + 3n² + 4 + λ(2n³ + 3n² − "
      "5), with the tension s that keeps the area, Σ (n − 1)(n + 2) a_n² constant: degrees 2 and 3 grow while "
      "4 falls. Measured: the mean rate −ln(a_n(T)/a_n(0))/T, T a third of what degree 4 takes to fall by e; expected: "
      "the same of the theory, integrated in time. Each is half the difference of waves and their opposites, so "
      "that what is quadratic in the size of the waves cancels. Allowed are 1e-3 of the rate of degree 4, the "
      "largest, for waves of 0.004 R₀ and of half of that: what is cubic shows in the first, and what the steps "
      "leave, up to 1e-6 R₀, in the second. The scene:\n\n```toml\n{}```",
      find_base_scene("waves").text)};
  constexpr double size = 0.004;
  s.table({"λ", "degree", "mean rate", "half the size", "expected", "error / rate of degree 4", "half the size", ""});
  render::Plot plot;
  plot.x = {.label = "viscosity contrast λ", .scale = render::Scale::logarithmic, .grid = true};
  plot.y = {.label = "mean rate / that of degree 4", .grid = true};
  std::array<std::vector<double>, 3> measured, expected;
  std::vector<double> contrasts;
  for (const double contrast : {0.1, 1.0, 10.0, 100.0}) {
    const double end = 1 / (3 * wave_rate(4, contrast, 0));
    std::array<std::array<double, 3>, 2> rates{}, theory{};
    for (const std::size_t half : {0U, 1U}) {
      const std::array<Amplitudes, 2> found = decay(trials, contrast, half == 0 ? size : size / 2, end);
      const Amplitudes after = decayed_waves(found[0], contrast, end);
      for (std::size_t k = 0; k < 3; ++k) {
        rates[half][k] = -std::log(found[1][k] / found[0][k]) / end;
        theory[half][k] = -std::log(after[k] / found[0][k]) / end;
      }
    }
    contrasts.push_back(contrast);
    for (std::size_t k = 0; k < 3; ++k) {
      const double scale = theory[0][2];
      const double error = (rates[0][k] - theory[0][k]) / scale, finer = (rates[1][k] - theory[1][k]) / scale;
      s.row({fmt::format("{}", contrast), fmt::format("{}", k + 2), fmt::format("{:.5f}", rates[0][k]),
             fmt::format("{:.5f}", rates[1][k]), fmt::format("{:.5f}", theory[0][k]), fmt::format("{:+.1e}", error),
             fmt::format("{:+.1e}", finer), s.verdict(std::max(std::abs(error), std::abs(finer)) < 1e-3)});
      measured[k].push_back(rates[1][k] / scale);
      expected[k].push_back(theory[0][k] / scale);
    }
  }
  constexpr std::array marks{render::Marker::ring, render::Marker::square, render::Marker::triangle};
  for (std::size_t k = 0; k < 3; ++k) {
    plot.curves.push_back(point_curve(fmt::format("n = {}", k + 2), contrasts, measured[k], k, marks[k]));
    render::Curve law = line_curve(k == 0 ? "theory" : "", contrasts, expected[k], k, 1);
    law.ink_in_legend = true;
    plot.curves.push_back(law);
  }
  s.figure = panels({plot});
  s.caption = "Rates of decay over that of degree 4: 2 and 3 grow while it falls, since the area is kept.";
  return s;
}

}  // namespace app
