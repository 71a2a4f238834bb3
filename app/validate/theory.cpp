#include "app/validate/theory.h"

#include "app/figures/tank_treading.h"

#include <cmath>
#include <numbers>

namespace app {

using std::numbers::pi;

double excess_area(double reduced_volume) { return 4 * pi * (std::pow(reduced_volume, -2.0 / 3) - 1); }

double jeffery_half_turn(double aspect_ratio) { return pi * (aspect_ratio + 1 / aspect_ratio); }

double keller_skalak_half_turn(double aspect_ratio, double lambda) {
  const double b = keller_skalak_factors(aspect_ratio).b(lambda);
  return 2 * pi / std::sqrt(1 - b * b);
}

double keller_skalak_border(double aspect_ratio) {
  const KellerSkalakFactors f = keller_skalak_factors(aspect_ratio);
  return 1 + (1 / (f.f1 * (1 / f.f0 - f.f1)) - 1) / f.f2;
}

double quasi_spherical_cosine(double lambda) { return (23 * lambda + 32) / (120 * std::sqrt(2 * pi / 15)); }

double quasi_spherical_border(double excess) { return (120 * std::sqrt(2 * pi / 15) / std::sqrt(excess) - 32) / 23; }

double wave_rate(int n, double lambda, double tension) {
  const double shared = 2.0 * n * n * n + 3.0 * n * n;
  return (n - 1.0) * n * (n + 1.0) * (n + 2.0) * (n * (n + 1.0) + tension) / (2 * (shared + 4 + lambda * (shared - 5)));
}

namespace {

Amplitudes wave_velocities(const Amplitudes& a, double lambda) {
  double bending = 0, stretching = 0;  // rates of the area without tension, and by a unit of it
  for (int n = 2; n <= 4; ++n) {
    const double weight = (n - 1) * (n + 2) * std::pow(a[static_cast<std::size_t>(n - 2)], 2);
    bending += weight * wave_rate(n, lambda, 0);
    stretching += weight * (wave_rate(n, lambda, 1) - wave_rate(n, lambda, 0));
  }
  Amplitudes velocities{};
  for (int n = 2; n <= 4; ++n)
    velocities[static_cast<std::size_t>(n - 2)] =
        -wave_rate(n, lambda, -bending / stretching) * a[static_cast<std::size_t>(n - 2)];
  return velocities;
}

Amplitudes moved(const Amplitudes& a, double time, const Amplitudes& velocities) {
  Amplitudes b = a;
  for (std::size_t k = 0; k < b.size(); ++k) b[k] += time * velocities[k];
  return b;
}

}  // namespace

Amplitudes decayed_waves(const Amplitudes& start, double lambda, double time) {
  constexpr int steps = 100;  // of Runge and Kutta's classical formula: exact to 1e-9
  const double h = time / steps;
  Amplitudes a = start;
  for (int step = 0; step < steps; ++step) {
    const Amplitudes k1 = wave_velocities(a, lambda), k2 = wave_velocities(moved(a, h / 2, k1), lambda),
                     k3 = wave_velocities(moved(a, h / 2, k2), lambda), k4 = wave_velocities(moved(a, h, k3), lambda);
    for (std::size_t k = 0; k < a.size(); ++k) a[k] += h / 6 * (k1[k] + 2 * k2[k] + 2 * k3[k] + k4[k]);
  }
  return a;
}

}  // namespace app
