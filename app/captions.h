// What stands on a frame: the time in the flow's own unit and the dimensionless numbers of the scene.
#pragma once

#include "settings.h"

namespace app {

/// The unit in which times are shown: symbol "γ̇t" and factor |rate| in a steady shear flow, "t" and 1 otherwise.
struct TimeUnit {
  std::string symbol = "t";
  double factor = 1;
};
TimeUnit time_unit(const sim::Scene&);

/// Rate of deformation at the size of a vesicle, 1/time: the largest of all flows; 0: none that deforms.
double flow_rate(const sim::Scene&, double area_radius);

/// "γ̇t = 12.50" in a steady shear flow, "t = 12.50" otherwise.
std::string time_caption(const sim::Scene&, double time);
/// "Ca = 100   λ = 1   ν = 0.85": area_radius and reduced_volume of the first vesicle, as
/// they are, not as asked for. Where vesicles differ: "λ = 1, 10", and ν only when all shapes are alike.
/// Ca = mu chi R^3 / kappa_b with chi the shear or extension rate, or the wall-ward shear a R of a Poiseuille flow.
std::string parameter_caption(const sim::Scene&, double area_radius, double reduced_volume);

}  // namespace app
