// All that tables, series and motions know of the vesicles of one saved state.
#pragma once

#include "app/tables/quantities.h"

#include "sim/layers/plans.h"

#include <span>
#include <vector>

namespace app {

/// Without what flow and forces are needed for; `initial`: measures of the first state.
std::vector<VesicleSample> samples_of(sim::Plans&, const sim::State&, std::span<const sim::VesicleMeasures> initial);
/// Adds that: with Needs::velocity what takes no forces.
void add_flow(sim::Plans&, const sim::Scene&, const sim::State&, Needs, std::span<VesicleSample>);

/// The suspension as a whole, stresses only where forces have been added.
sim::SuspensionMeasures whole_of(const sim::Scene&, std::span<const VesicleSample>,
                                 std::span<const sim::VesicleMeasures> initial, Needs);

/// Taylor's, (L - B) / (L + B) with the axes of the second moments in the shear plane.
double deformation_of(const Eigen::Matrix3d& moments);

}  // namespace app
