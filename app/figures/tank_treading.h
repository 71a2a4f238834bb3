// Steady tank-treading against reduced volume: our points, published ones, and the theory of Keller and Skalak.
#pragma once

#include "render/figures/figure.h"
#include "sim/layers/plans.h"
#include "sim/measures/motion.h"

#include <vector>

namespace app {

/// Angular frequency 2 pi/T of the membrane round the section y = y of the centre, relative to the shape, which turns
/// at the rate `turning` of its inclination (rad/time): T is the integral of the arc length over the speed along the
/// section, the time in which a point of it goes round where shape and motion are steady. Positive with the vorticity
/// of u = z e_x, about +y; 0 where the speed along the section vanishes somewhere, so that no point goes round; NaN
/// without a section. Velocity (3 fields): relative to the centre.
double membrane_frequency(const sim::Coefficients& position, const sim::Coefficients& velocity, const sim::Vec3& centre,
                          double turning);

struct SteadyPoint {
  double reduced_volume = 0, viscosity_contrast = 1;
  double angle = 0;      ///< inclination / pi
  double frequency = 0;  ///< of the membrane around the section through the centroid, 2 pi / period / rate
  sim::AxisMotion motion = sim::AxisMotion::tank_treading;
};
/// Of a vesicle that tank-treads in a shear flow of that rate, from one state.
SteadyPoint steady_point(sim::Plans&, const sim::VesicleState&, double viscosity_contrast, double rate);

/// The three factors of Keller and Skalak's theory for a prolate spheroid of aspect ratio r, f0 = 2/(r + 1/r),
/// f1 = (r - 1/r)/2, f2 an integral of its ellipsoid: cos(2 theta) = 1/B where B > 1, else it tumbles.
struct KellerSkalakFactors {
  double f0 = 0, f1 = 0, f2 = 0;
  double q(double lambda) const { return 1 + f2 * (lambda - 1); }
  double b(double lambda) const { return f0 * (f1 + 1 / (f1 * q(lambda))); }
};
KellerSkalakFactors keller_skalak_factors(double aspect_ratio);

/// Keller and Skalak 1982 for a prolate spheroid (closed form, approximate physics); frequency 0 and angle NaN where
/// it tumbles.
SteadyPoint keller_skalak(double reduced_volume, double viscosity_contrast);

/// Two panels: angle and frequency. Points with undetermined motion are marked by triangles and not connected to a
/// curve.
std::vector<render::Plot> tank_treading_plots(const std::vector<SteadyPoint>&);

struct LiteraturePoint {
  double viscosity_contrast, reduced_volume, value, error;
  const char* source;
};
const std::vector<LiteraturePoint>& literature_angles();       ///< inclination / pi
const std::vector<LiteraturePoint>& literature_frequencies();  ///< omega / rate

}  // namespace app
