// Interpolation between two saved states, so that a movie may have more frames than the trajectory has states.
#pragma once

#include "sim/core/types.h"

namespace render {

/// The scene at `time` between two consecutive saved states a and b: position is the cubic Hermite interpolant of the
/// positions and velocities of both states, velocity its derivative. Everything is in b's parametrisation, in which b
/// also stores its predecessor; labels and tracers are b's, since a material point keeps its parameter from a to b.
/// At (to rounding errors) or before a.time the result is a itself, at or after b.time it is b. Throws
/// std::invalid_argument when the two do not have the same number of vesicles.
sim::State interpolated(const sim::State& a, const sim::State& b, double time);

}  // namespace render
