// Optional short-range repulsion of membranes: the traction strength exp(-h / range) away from the nearest point of
// another vesicle, or image, at the distance h.
//
// It is a peak as wide as sqrt(curvature radius x range), which the grids of the vesicles may well miss between two of
// their points. So it is sampled on a grid that tells the peak of two tips apart, and projected on the degree of the
// vesicle, which keeps its resultant (within what the degree resolves of the metric) wherever the tips are.
#pragma once

#include "sim/core/cells.h"
#include "sim/core/ranks.h"
#include "sim/layers/plans.h"

#include <span>
#include <vector>

namespace sim {

struct Repulsion {
  double strength = 0;  ///< force per area of the membrane; 0: none
  double range = 0.05;
};

/// Order of the grid of a vesicle of a radius R0 on which a repulsion is sampled, beside vesicles as small as the
/// smallest.
int repulsion_order(int degree, double radius, double smallest_radius, double range);
/// Strength that keeps membranes apart where a fluid of viscosity 1 is strained at such a rate: measured in crowds of
/// up to a volume fraction of 0.4 (docs/stepping.md), where the force between two tips, ~ strength x range, decides.
double sufficient_repulsion(double straining_rate, double radius, double range);
/// The least range that is sampled on vesicles from the smallest to the largest radius.
double least_repulsion_range(double smallest_radius, double largest_radius);

/// Force densities as coefficients of the vesicles' degrees; of this rank's vesicles, empty ones for the others. None
/// at all for strength 0 and for a single vesicle in unbounded fluid. Throws std::domain_error where vesicles cross.
std::vector<Coefficients> repulsion_forces(Plans&, std::span<const Coefficients> positions, const Repulsion&,
                                           const CellSides& = {}, const Division& = {});

}  // namespace sim
