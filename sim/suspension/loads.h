// What the membranes of a saved state do to the fluid: their force densities, computed as the stepper does.
//
// A saved velocity and tension is as good as the steps were, and where steps follow a tolerance, states between them
// are interpolated. That is enough for a picture. A stresslet answers to the rate of strain inside times lambda - 1,
// and to the large tension of a sphere times its deformation: for these the state is solved once more.
#pragma once

#include "sim/suspension/suspension.h"

namespace sim {

/// One vesicle's.
struct Load {
  Coefficients force;  ///< of the membrane on the fluid per area: bending, tension, buoyancy, repulsion; 3 fields
  RigidBody body;
  Coefficients velocity;  ///< of the membrane, with which the force is consistent
};
/// Of all vesicles of a state. `hold_spheres`: by the tension that keeps them round in a run; otherwise they stretch as
/// by (3a).
std::vector<Load> loads_of(Plans&, const Scene&, const State&, bool hold_spheres = true);

/// The same with velocities and tensions that solve (3a), (3b) at the positions of the state: of each vesicle to a
/// residual of 1e-8 with what the others do, and that three times in turn. Forces are NaN where a solve does not get
/// there. Throws std::domain_error when a vesicle reaches into another.
std::vector<Load> solved_loads(Plans&, const Scene&, const State&);

}  // namespace sim
