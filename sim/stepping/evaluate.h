// From what evolves to what is saved: velocity and tension at the positions of an instant.
#pragma once

#include "sim/stepping/schemes.h"
#include "sim/surface/correction.h"

namespace sim {

/// On the grid on which areas and volumes are measured.
Geometry measured_geometry(Plans&, const Coefficients& position);

/// The shift of a position, with its geometry on that grid, to the area and volume of the start; rejected where there
/// is none, or a long one.
Attempt<Correction> correction_of(const Model&, const VesicleDynamics&, const Coefficients& position, const Geometry&);

/// A saved state, between ranks.
void transfer(Parcel&, State&);

/// Velocity and tension that solve (3a)-(3b) at the present positions, and all else that is saved.
Attempt<State> evaluate(const Model&, const Dynamics&);
/// States between two successive ones, or at the later: by the polynomials in time of the step that led from one to
/// the other, through one level more than its formula has, with area and volume corrected. No solve.
Attempt<std::vector<State>> interpolated(const Model&, const Dynamics& before, const Dynamics& after,
                                         std::span<const double> times);
/// Takes velocity, tension, sliding and frames of a state of the present for what the next step starts from and
/// expects.
void expect(const Model&, Dynamics&, const State&);
/// Call it with a state that has been saved: it becomes the earlier end of the next interpolation.
void mark_saved(Dynamics&, const State&);

}  // namespace sim
