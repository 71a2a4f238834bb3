#include "app/validate/validations.h"

namespace app {

const std::vector<ValidationRow>& validations() {
  static const std::vector<ValidationRow> rows{
      {"rigid-motions", "a vesicle in a stream or in turning fluid moves as a rigid body", 30, validate_rigid_motions},
      {"spheres", "spheres stay round, and nearly round vesicles deform by the root of their excess", 30,
       validate_spheres},
      {"sedimentation", "a sphere sinks as Stokes says, under the tension that holds it", 10, validate_sedimentation},
      {"faxen", "a sphere lags behind a parabolic flow by Faxén's law", 30, validate_faxen},
      {"jeffery", "half a turn tends to that of Jeffery's spheroid as the inside gets viscous", 60, validate_jeffery},
      {"tank-treading", "steady angle and axes in shear", 20, validate_tank_treading},
      {"treading-frequency", "frequency of the membrane beside published ones", 10, validate_treading_frequency},
      {"tumbling", "time of half a turn in shear", 30, validate_tumbling},
      {"quasi-spherical", "steady angle in the limit of small excess area", 60, validate_quasi_spherical},
      {"rheology", "intrinsic viscosity and normal stresses in the limit of small excess area", 60, validate_rheology},
      {"suspensions", "viscosity of suspensions in sheared cells, from dilute to a volume fraction of 0.4", 3000,
       validate_crowds},
      {"border", "where treading ends and tumbling begins, over reduced volume and viscosity contrast", 500,
       validate_border},
      {"literature", "steady angles beside published ones", 60, validate_literature},
      {"poiseuille", "parachute and slipper: what they converge to", 300, validate_poiseuille},
      {"encounter", "how far two vesicles that pass push each other aside", 500, validate_encounter},
      {"reversibility", "without bending, a flow that turns back brings every point back", 100, validate_reversibility},
      {"modes", "waves on a nearly spherical vesicle decay at the rates of linear theory", 60, validate_modes},
      {"relaxation", "energies of shapes at rest, at the default tolerance", 100, validate_relaxation},
      {"equilibria", "energies of shapes at rest against exact minima, as the order grows", 300, validate_equilibria},
      {"schemes", "errors of fixed steps, by scheme", 60, validate_schemes},
      {"long-runs", "treading and tumbling up to 1000 shear times, without drift", 500, validate_long_runs},
      {"hard", "hard scenes: right within what the run states, or stopped with the reason", 1000, validate_hard}};
  return rows;
}

}  // namespace app
