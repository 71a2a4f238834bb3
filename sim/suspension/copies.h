// What a placement copies: the sizes of the copies, drawn from its seed, and the room that they take.
#pragma once

#include "sim/core/parameters.h"

#include <functional>
#include <random>
#include <vector>

namespace sim {

/// Uniform in [0, 1), the same on every platform (std::uniform_real_distribution is not).
double uniform(std::mt19937_64&);
Vec3 random_direction(std::mt19937_64&);

/// A surface about the origin: volume, and the radii of the spheres about the origin that hold it and that it holds.
struct Extent {
  double volume, reach, core;
  double radius;  ///< of the sphere of the same area
  Vec3 size;      ///< of the box about it
};

/// Radii over their mean: log-normal, of mean 1 and so large a standard deviation; all 1 where that is 0. One is drawn
/// from each of `count` equally likely ranges, in random order, so that few have the mean, the spread and the volume of
/// many.
std::vector<double> drawn_sizes(int count, double spread, int seed);

/// The copies of a vesicle that a placement makes.
struct Copies {
  PlacementParameters p;
  VesicleParameters original;
  Extent extent;              ///< of the original
  std::vector<double> sizes;  ///< lengths of each copy over those of the original

  int count() const { return p.count; }
  double gap() const;      ///< least distance that is asked for
  double volume() const;   ///< of all
  double largest() const;  ///< size
  double reach(std::size_t k) const { return extent.reach * sizes[k]; }
  /// Without place; of the original's size, shape and axis but for the radius.
  VesicleParameters copy(std::size_t k) const;
  /// The volume fraction: of a cell that is to be filled, that of its own volume.
  double fraction(const std::optional<Vec3>& cell) const;
  /// Share of a room (the region of the centres, and what reaches beyond it) that all fill with half the gap about
  /// each.
  double filled_share(double room) const;
  /// Of a function of the size; exactly its value at 1 where all have the same.
  double mean(const std::function<double(double)>&) const;
};
Copies copies_of(const PlacementParameters&, const VesicleParameters&);

}  // namespace sim
