// Steady tank-treading against reduced volume: our points, published ones, and the theory of Keller and Skalak.
#pragma once

#include "render/figures/figure.h"
#include "sim/layers/plans.h"

#include <string_view>
#include <vector>

namespace app {

/// Motion of the long axis in a steady shear flow.
enum class Motion { untold, tank_treading, swinging, tumbling };
/// Determined from times, in units of 1/rate, and unwrapped inclinations in degrees:
///   tumbling       it turned by half a turn or more; between two angles at rest there is less
///   tank_treading  over the last third, which spans a strain of 2 at least, it stays within one degree
///   swinging       its last two swings are larger than a degree, and the last no smaller than 9/10 of the one before
/// Otherwise untold: the run is too short, or still settling.
Motion motion_of(const std::vector<double>& times, const std::vector<double>& degrees);
/// "tumbles", for messages.
std::string_view text_of(Motion);
/// Unwraps an angle in degrees of an axis, modulo 180 degrees, next to the previous one.
double unwrapped(double angle, double before);

struct SteadyPoint {
  double reduced_volume = 0, viscosity_contrast = 1;
  double angle = 0;      ///< inclination / pi
  double frequency = 0;  ///< of the membrane around the section through the centroid, 2 pi / period / rate
  Motion motion = Motion::tank_treading;
};
/// Of a vesicle that tank-treads in a shear flow of that rate, from one state: the period is the integral of the arc
/// length over the speed along the section y = y of the centroid.
SteadyPoint steady_point(sim::Plans&, const sim::VesicleState&, double viscosity_contrast, double rate);

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
