// Validations: long runs whose results are known, one function each. `tanktread validate NAME` makes the section of a
// page from it.
#pragma once

#include "app/validate/section.h"
#include "app/validate/trials.h"

#include <string_view>
#include <vector>

namespace app {

Section validate_rigid_motions(Trials&);
Section validate_spheres(Trials&);
Section validate_sedimentation(Trials&);
Section validate_faxen(Trials&);
Section validate_jeffery(Trials&);
Section validate_tank_treading(Trials&);
Section validate_treading_frequency(Trials&);
Section validate_tumbling(Trials&);
Section validate_quasi_spherical(Trials&);
Section validate_rheology(Trials&);
Section validate_crowds(Trials&);
Section validate_border(Trials&);
Section validate_literature(Trials&);
Section validate_poiseuille(Trials&);
Section validate_encounter(Trials&);
Section validate_reversibility(Trials&);
Section validate_modes(Trials&);
Section validate_relaxation(Trials&);
Section validate_equilibria(Trials&);
Section validate_schemes(Trials&);
Section validate_long_runs(Trials&);
Section validate_hard(Trials&);

struct ValidationRow {
  std::string_view name, meaning;
  double seconds;  ///< about so long on one core, for the line of progress
  Section (*measure)(Trials&);
};
/// In the order of the page.
const std::vector<ValidationRow>& validations();

}  // namespace app
