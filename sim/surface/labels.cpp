#include "sim/surface/labels.h"

#include "sim/sphere/norms.h"

#include <cmath>
#include <numbers>

namespace sim {

Coefficients fresh_labels(int order) {
  Coefficients labels{order, Matrix::Zero(coefficient_count(order), 3)};
  const double k = std::sqrt(4 * std::numbers::pi / 3);
  labels.values(coefficient_index(1, 1), 0) = k;
  labels.values(coefficient_index(1, -1), 1) = k;
  labels.values(coefficient_index(1, 0), 2) = k;
  return labels;
}

bool labels_wound_up(const Coefficients& labels) {
  constexpr double unresolved = 0.02;  // the picture of a line shifts by about this share of a radian
  return tail_share(labels, 3 * labels.order / 4 + 1) > unresolved;
}

Matrix tracer_directions() {
  Matrix s(14, 3);
  s.topRows(6) << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  int row = 6;
  for (const int x : {1, -1})
    for (const int y : {1, -1})
      for (const int z : {1, -1}) s.row(row++) = Vec3(x, y, z).normalized().transpose();
  return s;
}

}  // namespace sim
