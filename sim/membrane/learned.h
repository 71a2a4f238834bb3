// What earlier solves have taught of the inverse of a body's block A: A on a few directions.
//
// Consecutive steps solve nearly the same system for nearly the same kind of right-hand side. The directions that one
// solve has searched serve the next as a part of the inverse; what has changed since is left to the iterations. With
// directions Y, orthonormal columns U = A Y and the approximate inverse M^{-1} for the rest,
//   P r = Y U^T r + M^{-1} (r - U U^T r).
// In single precision, of which an approximate inverse needs no more.
//
// Symmetries. The later directions of a solve correct what its residual holds of rounding, too. Taken up again, scaled
// to length one, they would feed on themselves from step to step until a symmetric shape is symmetric only to the
// tolerance of the solves, and slow instabilities would start from there. Directions therefore count only as long as
// the residual is large, and those that are all but even or odd under a symmetry about the axes are made so.
#pragma once

#include "sim/membrane/gmres.h"

#include <memory>
#include <vector>

namespace sim {

/// Size of the block x number of directions. Immutable once made, and shared by the states that know it.
struct Learned {
  Eigen::MatrixXf directions, images;  ///< Y and U
};
/// By body; null where nothing is known, or another rank knows it.
using Lessons = std::vector<std::shared_ptr<const Learned>>;

/// P v; M^{-1} v where nothing is known of a block of this size.
Vector precondition(const Learned*, const LinearMap& inverse, const Vector& v);

/// Directions and A on them, in the order in which a solve has met them.
struct Searched {
  std::vector<Vector> directions, images;
};
/// How many of them tell of more than rounding, from the residual before each.
std::size_t telling(std::span<const double> residuals);
/// Enough of them for one body, and for each of many, whose directions the others stir.
inline int directions_kept(std::size_t bodies) { return bodies == 1 ? 20 : 32; }
/// At most so many directions: the first `count` of the last solve, then what `before` has besides. Directions whose
/// images add nothing are left out.
std::shared_ptr<const Learned> learned(const Learned* before, const Searched&, std::size_t count, int most);

}  // namespace sim
