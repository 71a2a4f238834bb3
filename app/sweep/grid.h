// The scenes of a sweep: all combinations of the values of some keys, the last key running fastest.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace app {

/// One key of the scene and its values, both as after --set.
struct SweepAxis {
  std::string key;
  std::vector<std::string> values;
};
/// "KEY=VALUES": values separated by commas, each one value or a range, FIRST:LAST:STEP or FIRST:LAST:*FACTOR with both
/// ends as far as steps meet them. Throws std::runtime_error.
SweepAxis read_axis(std::string_view text);

struct SweepPoint {
  std::vector<std::string> values;  ///< one an axis
  /// Of its folder, "viscosity_contrast-5_reduced_volume-0.8"; with eight digits behind it where values do not fit.
  std::string name;
};
/// Throws std::runtime_error for the same key twice and for more than 10,000 points.
std::vector<SweepPoint> points_of(const std::vector<SweepAxis>&);

/// The numbers of an axis; empty where a value is none.
std::vector<double> numbers_of(const SweepAxis&);
/// The last part of a key that tells the axes apart: "viscosity_contrast".
std::string short_name(const std::vector<SweepAxis>&, std::size_t axis);

/// The changes of the scene at a point, for --set.
std::vector<std::string> changes_at(const std::vector<SweepAxis>&, const SweepPoint&);

}  // namespace app
