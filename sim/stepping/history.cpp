#include "sim/stepping/history.h"

namespace sim {

History pushed(const History& history, PastLevel newest, int most_levels) {
  History next;
  if (most_levels == 0) return next;
  next.levels.push_back(std::move(newest));
  for (const PastLevel& level : history.levels) {
    if (static_cast<int>(next.levels.size()) == most_levels) break;
    next.levels.push_back(level);
  }
  return next;
}

void carry(Plans& plans, const Relabelling& r, History& history) {
  for (PastLevel& level : history.levels) level.position = pulled_back(plans, r, level.position);
}

void move_along(History& history, const Coefficients& shift) {
  for (std::size_t k = 0; k < history.levels.size(); ++k) {
    Coefficients& x = history.levels[k].position;
    // To the present, by the steps in between, and back.
    for (std::size_t j = k + 1; j-- > 0;) x = carried(history.levels[j].carrier, history.levels[j].dt, x);
    x.values += shift.values;
    for (std::size_t j = 0; j <= k; ++j) x = carried(history.levels[j].carrier, -history.levels[j].dt, x);
  }
}

}  // namespace sim
