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

}  // namespace app
