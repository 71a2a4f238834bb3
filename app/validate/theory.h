// What theory says of a vesicle in shear, in closed form: references of the validations. Rates are 1, times in units of
// 1/rate, lambda is the viscosity inside over that outside.
#pragma once

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

}  // namespace app
