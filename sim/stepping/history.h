// The past of a vesicle: what is known of it at earlier times, as far back as a multistep scheme asks for. Level 0 is
// that of the step before, with the length of the step that led on from it.
//
// All fields belong to the present parametrisation: whoever relabels the membrane carries them too. The correction of
// area and volume does not move them: old levels stay as they were accepted, and the correction acts like the
// multiplier of a constraint, which keeps the order of a scheme. Moved along, they would make the two a splitting of
// first order.
#pragma once

#include "sim/membrane/sheet.h"
#include "sim/surface/reparametrize.h"

#include <vector>

namespace sim {

struct PastLevel {
  Coefficients position;  ///< x_{n-k}
  Motion motion;          ///< velocity and tension at that time
  Coefficients sliding;   ///< w_{n-k}: velocity of the grid points relative to the membrane, and that of the correction
  double dt = 0;          ///< length of the step that led on from it
};

struct History {
  std::vector<PastLevel> levels;  ///< the latest first
};

/// Every part of a level with its name; f(name, member).
template <class Level, class F>
void visit_level(Level& level, F&& f) {
  f("position", level.position);
  f("velocity", level.motion.velocity);
  f("tension", level.motion.tension);
  f("sliding", level.sliding);
  f("dt", level.dt);
}

/// The history of the next step, of at most so many levels.
History pushed(const History&, PastLevel newest, int most_levels);

/// After a relabelling: f(map(s')) of every level.
void carry(Plans&, const Relabelling&, History&);

}  // namespace sim
