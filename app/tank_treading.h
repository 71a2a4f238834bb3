// Steady tank-treading against reduced volume: our points, published ones, and the theory of Keller and Skalak.
#pragma once

#include "render/figure.h"
#include "sim/plans.h"

namespace app {

struct SteadyPoint {
  double reduced_volume = 0, viscosity_contrast = 1;
  double angle = 0;      ///< inclination / pi
  double frequency = 0;  ///< of the membrane round the section through the centroid, 2 pi / period / rate
};
/// Of a vesicle that tank-treads in a shear flow of that rate, from one state: the period is the integral of the arc length
/// over the speed along the section y = y of the centroid.
SteadyPoint steady_point(sim::Plans&, const sim::VesicleState&, double viscosity_contrast, double rate);

/// Keller and Skalak 1982 for a prolate spheroid (closed form, approximate physics); frequency 0 and angle not a number
/// where it tumbles.
SteadyPoint keller_skalak(double reduced_volume, double viscosity_contrast);

/// Two panels: angle and frequency.
std::vector<render::Plot> tank_treading_plots(const std::vector<SteadyPoint>&);

struct LiteraturePoint {
  double viscosity_contrast, reduced_volume, value, error;
  const char* source;
};
const std::vector<LiteraturePoint>& literature_angles();       ///< inclination / pi
const std::vector<LiteraturePoint>& literature_frequencies();  ///< omega / rate

}  // namespace app
