// Material labels and tracer dots, by which pictures show the motion of the membrane itself. A label is the point of
// the unit sphere where the material point started. As long as grid points move with the fluid, the label of a
// parameter does not change; a relabelling transports the field, and so does a grid that slides along the membrane. In
// steady tank-treading the labels wind up; when their degree no longer resolves them they are reset, L(s) = s, and the
// state records when.
#pragma once

#include "sim/surface/reparametrize.h"

#include <vector>

namespace sim {

/// L(s) = s in the given degree.
Coefficients fresh_labels(int order);

/// True when the last quarter of the label spectrum contains more than 2 % of it.
bool labels_wound_up(const Coefficients& labels);

/// The 14 dots of every vesicle, in fixed order: +-x, +-y, +-z, then the corners (x slowest, + before -): 14 x 3.
Matrix tracer_directions();

/// A surface and the velocity w of its grid points along it, relative to the material, at up to three times, between
/// which both are polynomials in time.
struct SlidingPath {
  std::vector<double> times;
  std::vector<Coefficients> positions, sliding;
};

/// Labels after a time in which the grid slid over the material: L' = w.grad L. By the classical Runge-Kutta method, in
/// as many steps as the grid moves by labels.
Coefficients slid_labels(Plans&, const SlidingPath&, const Coefficients& labels, double from, double to);
/// Labels between two times from those at both, for many: cubic in time, as L' says.
class LabelsBetween {
 public:
  LabelsBetween(Plans&, const SlidingPath&, Coefficients before, double from, Coefficients after, double to);
  Coefficients at(double time) const;

 private:
  Coefficients before_, after_;
  Matrix rate_before_, rate_after_;
  double from_, to_;
};
/// Parameters (rows of unit vectors) of material points after that time: s' = -w in the parameters.
Matrix slid_points(const SlidingPath&, const Matrix& parameters, double from, double to);

}  // namespace sim
