// The past of a vesicle: its positions at earlier times, as far back as a multistep scheme asks for. Level 0 is that of
// the step before, with the length of the step that led on from it.
//
// Positions belong to the present parametrisation: whoever moves the grid points along the membrane carries them too.
#pragma once

#include "sim/membrane/rigid.h"
#include "sim/surface/reparametrize.h"

#include <vector>

namespace sim {

struct PastLevel {
  Coefficients position;  ///< x_{n-k}
  Frame frame;            ///< motion of the shape at that time
  Frame carrier;          ///< mean motion of the frame in the step that led on from it
  double dt = 0;          ///< length of that step
};

struct History {
  std::vector<PastLevel> levels;  ///< the latest first
};

/// Every part of a level with its name; f(name, member).
template <class Level, class F>
void visit_level(Level& level, F&& f) {
  f("position", level.position);
  f("frame", level.frame);
  f("carrier", level.carrier);
  f("dt", level.dt);
}

/// The history of the next step, of at most so many levels.
History pushed(const History&, PastLevel newest, int most_levels);

/// After a relabelling: f(map(s')) of every level.
void carry(Plans&, const Relabelling&, History&);

/// Moves all levels along with a shift of the present position, turned back as the steps since have turned the vesicle.
void move_along(History&, const Coefficients& shift);

}  // namespace sim
