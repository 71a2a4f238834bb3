// Captions of a frame: the time in the flow's own unit and the dimensionless numbers of the scene.
#pragma once

#include "app/scene/settings.h"

#include "sim/trajectory/trajectory.h"

#include <span>

namespace app {

/// The unit in which times are shown: symbol "γ̇t" and factor |rate| in a steady shear flow, "t" and 1 otherwise.
struct TimeUnit {
  std::string symbol = "t";
  double factor = 1;
};
TimeUnit time_unit(const sim::Scene&);

/// Rate of deformation at the size of a vesicle, 1/time: the largest of all flows; 0: no flow deforms.
double flow_rate(const sim::Scene&, double area_radius);

/// Format of the times of one movie: the same digits for all, enough to distinguish its frames.
struct TimeFormat {
  int places = 2;    ///< after the point
  int exponent = 0;  ///< power of ten after the number; 0: none
};
/// spacing: of frames; end: of the movie; in time of the scene.
TimeFormat time_format(const sim::Scene&, double spacing, double end);

/// "γ̇t = 12.50" in a steady shear flow, "t = 12.50" otherwise, "t = 1.25·10^{-6}" where times are very short or long.
std::string time_caption(const sim::Scene&, double time, const TimeFormat& = {});
/// "Ca = 100   λ = 1   ν = 0.85": area radii of all vesicles and reduced volume of the first, as measured, not as
/// requested.
/// Where vesicles differ: "λ = 1, 10", and ν only when all shapes are the same. Ca = mu chi R^3 / kappa_b with chi
/// the shear or extension rate, or the wall-ward shear a R of a Poiseuille flow.
std::string parameter_caption(const sim::Scene&, std::span<const double> area_radii, double reduced_volume);
/// "error of position 1.1·10^{−3} R_{0}": what the steps up to a time are estimated to leave, added up as `info` does;
/// of the step that contains it the share that has passed. Empty before the first step.
std::string error_caption(std::span<const sim::StepRecord>, double time);

}  // namespace app
