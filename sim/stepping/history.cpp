#include "sim/stepping/history.h"

#include <type_traits>

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
  for (PastLevel& level : history.levels)
    visit_level(level, [&]<class Member>(const char*, Member& member) {
      if constexpr (std::is_same_v<Member, Coefficients>) member = pulled_back(plans, r, member);
    });
}

}  // namespace sim
