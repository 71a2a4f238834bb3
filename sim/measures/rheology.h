// What a suspension in a periodic cell is as a material, from what its vesicles are: the particle stress is the sum of
// their stresslets over the volume of the cell, so that with the shear rate, viscosity 1 outside and V the cell's
// volume
//   eta_r = 1 + sum S_xz/(rate V),   N_1 = sum (S_xx - S_zz)/V,   N_2 = sum (S_zz - S_yy)/V.
// Inclinations have no sign: their mean and spread are those of the double angle,
//   exp(2 i theta) averaged = r exp(2 i mean),   spread = sqrt(-2 ln r)/2.
// Diffusion shows in how far centres have moved across the flow since the first state, the mean of all aside.
#pragma once

#include "sim/measures/diagnostics.h"
#include "sim/measures/stresslet.h"

#include <span>

namespace sim {

/// At one saved state; NaN: has no meaning there.
struct SuspensionMeasures {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double volume_fraction = none, relative_viscosity = none, normal_stress_1 = none, normal_stress_2 = none;
  double inclination_mean = none, inclination_spread = none;  ///< degrees
  Vec3 displacement = Vec3::Constant(none);                   ///< mean squares along x, y, z, length^2
};

/// The columns of a table of measures, declared once: v(name, meaning, value).
template <class V>
void visit(const SuspensionMeasures& m, V&& v) {
  v("volume_fraction", "volume of all vesicles over that of the cell; nan without a cell", m.volume_fraction);
  v("relative_viscosity", "1 + sum S_xz/(rate V) in a cell in steady shear; nan elsewhere", m.relative_viscosity);
  v("normal_stress_1", "sum (S_xx - S_zz)/(|rate| V), likewise", m.normal_stress_1);
  v("normal_stress_2", "sum (S_zz - S_yy)/(|rate| V), likewise", m.normal_stress_2);
  v("inclination_mean", "mean inclination of all vesicles, degrees, in (-90, 90]", m.inclination_mean);
  v("inclination_spread", "its spread among them, degrees", m.inclination_spread);
  v("displacement_y",
    "mean square of how far centres have moved along the vorticity since the first state, less the mean",
    m.displacement[1]);
  v("displacement_z", "... along the gradient of a shear", m.displacement[2]);
}

/// Of vesicles with these measures; `flow`: none where forces are not known. `first`: centres in the first state.
SuspensionMeasures suspension_measures(const Scene&, std::span<const VesicleMeasures>,
                                       std::span<const FlowMeasures> flow, std::span<const Vec3> first);

/// Distances of all pairs, images included, in bins of equal width up to half of the shortest side of a cell.
class PairDistribution {
 public:
  PairDistribution(const Vec3& cell_size, int bins);
  /// Adds a state: centres in any cells.
  void add(std::span<const Vec3> centres, const Eigen::Matrix3d& cell);
  struct Row {
    double from, to;  ///< distance
    double share;     ///< pairs over those of points at random
  };
  std::vector<Row> rows() const;

 private:
  double reach_, volume_;
  double expected_ = 0;  ///< pairs of points at random in a unit of volume, of all states
  std::vector<double> counts_;
};

/// Centres in any cells of a lattice whose sides are the columns of `cell`.
struct CentresInCell {
  std::vector<Vec3> centres;
  Eigen::Matrix3d cell;
};
struct MeanPairs {
  std::vector<PairDistribution::Row> rows;
  std::vector<double> error;  ///< standard error of each share; empty with a single state
};
/// The distribution over all states, in the order of time. Its error is that of the mean of up to `blocks` blocks of
/// neighbouring states, whose differences hold the correlation in time as far as blocks are longer than it.
MeanPairs mean_pairs(const Vec3& cell_size, int bins, std::span<const CentresInCell> states, int blocks = 8);

}  // namespace sim
