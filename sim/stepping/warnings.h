// What a user should know of a scene or a state although nothing has failed.
#pragma once

#include "sim/stepping/resolution.h"

namespace sim {

/// Whether the shape of vesicle k is not resolved by its order, and no higher one will come by itself.
bool unresolved(const Model&, const Dynamics&, std::size_t k);
/// The warning that vesicle k is not resolved by its order.
std::string resolution_warning(const Model&, const Dynamics&, std::size_t k);
/// Whether the errors that the degrees of vesicle k leave are so many times as large as allowed that one must be told,
/// and no higher order will come by itself.
bool limited(const Model&, const Dynamics&, std::size_t k, double times_allowed);
/// The warning of that for vesicle k, the worst, and so many others.
std::string limit_warning(const Model&, const Dynamics&, std::size_t k, double times_allowed, std::size_t others);
/// A vesicle so near to another that its degrees do not tell how near: what they leave is more than a quarter of the
/// gap.
struct ThinFilm {
  std::size_t vesicle = 0;
  double gap = 0, error = 0;  ///< in its area radii
};
/// All of these, the worst first; where steps adapt none, since estimates of their errors know the films.
std::vector<ThinFilm> thin_films(const Model&, const Dynamics&);
/// The warning of that for a vesicle, the worst, and so many others.
std::string film_warning(const Dynamics&, const ThinFilm&, std::size_t others);
/// All warnings about a scene before its first step: unresolved vesicles, flows that move nothing or vary faster than
/// the step.
std::vector<std::string> scene_warnings(const Model&, const Dynamics&);

}  // namespace sim
