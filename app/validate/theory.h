// What theory says of a vesicle in shear, in closed form: references of the validations. Rates are 1, times in units of
// 1/rate, lambda is the viscosity inside over that outside.
#pragma once

#include <array>

namespace app {

/// Delta = 4 pi (nu^(-2/3) - 1).
double excess_area(double reduced_volume);

/// Half a turn of a rigid spheroid of aspect ratio r in shear: pi (r + 1/r).
double jeffery_half_turn(double aspect_ratio);

/// Keller and Skalak 1982, a spheroid of fixed shape: half a turn where it tumbles (NaN where it treads), and the
/// contrast above which it does.
double keller_skalak_half_turn(double aspect_ratio, double lambda);
double keller_skalak_border(double aspect_ratio);

/// The limit Delta -> 0 in strong shear: cos(2 theta)/sqrt(Delta) = (23 lambda + 32)/(120 sqrt(2 pi/15)), and the
/// contrast at which theta reaches 0.
double quasi_spherical_cosine(double lambda);
double quasi_spherical_border(double excess_area);

/// Coefficients of degrees 2, 3, 4 of the radius of a nearly spherical vesicle, R = 1.
using Amplitudes = std::array<double, 3>;
/// Rate at which that of degree n falls without flow, kappa_b = 1, viscosity 1 outside:
///   (n - 1)n(n + 1)(n + 2)[n(n + 1) + s] / (2 D_n),  D_n = 2n^3 + 3n^2 + 4 + lambda (2n^3 + 3n^2 - 5).
double wave_rate(int n, double lambda, double tension);
/// Amplitudes after a time, with the tension s(t) that keeps the area: sum of (n - 1)(n + 2) a_n^2.
Amplitudes decayed_waves(const Amplitudes&, double lambda, double time);

}  // namespace app
