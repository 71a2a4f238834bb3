#include "sim/sphere/rotation.h"

#include <cmath>

namespace sim {

namespace {

/// f(Rz(angle) s) in place; the inverse for -angle.
void rotate_z(Matrix& c, int p, double angle) {
  for (int m = 1; m <= p; ++m) {
    const double co = std::cos(m * angle), si = std::sin(m * angle);
    for (int n = m; n <= p; ++n) {
      auto a = c.row(coefficient_index(n, m)), b = c.row(coefficient_index(n, -m));
      const Eigen::RowVectorXd cosine = a;
      a = co * cosine + si * b;
      b = co * b - si * cosine;
    }
  }
}

void apply_blocks(Matrix& c, const std::vector<Matrix>& blocks, bool transposed) {
  for (int n = 0; n < int(blocks.size()); ++n) {
    auto rows = c.middleRows(n * n, 2 * n + 1);
    if (transposed) {
      rows = (blocks[n].transpose() * rows).eval();
    } else {
      rows = (blocks[n] * rows).eval();
    }
  }
}

}  // namespace

RotationPlan::RotationPlan(int order) : order_(order) {
  const Basis basis(order, order);
  const Matrix s = grid_directions(basis);
  Matrix turned(basis.points(), 3);
  turned << s.col(0), -s.col(2), s.col(1);  // Rx(pi/2): y -> z, z -> -y
  const Matrix projection = basis_functions(order, s).transpose() * basis.weights().asDiagonal();
  const Matrix values = basis_functions(order, turned);
  for (int n = 0; n <= order; ++n) {
    quarter_.push_back(projection.middleRows(n * n, 2 * n + 1) * values.middleCols(n * n, 2 * n + 1));
    Matrix z = Matrix::Zero(2 * n + 1, 2 * n + 1);  // L_z = d/dphi
    for (int m = 1; m <= n; ++m) {
      z(n + m, n - m) = m;
      z(n - m, n + m) = -m;
    }
    const Matrix y = -quarter_[n].transpose() * z * quarter_[n];  // the quarter turn lays z on -y
    const Matrix x = z * y - y * z;                               // [L_y, L_z] = -L_x
    second_generators_.push_back({-x * x, -y * y, -z * z, -y * z - z * y, -z * x - x * z, -x * y - y * x});
  }
}

Matrix RotationPlan::to_pole(const Matrix& coefficients, double theta, double phi) const {
  Matrix c = coefficients;
  rotate_z(c, order_, phi);
  apply_blocks(c, quarter_, true);  // f(Rx(-pi/2) s)
  rotate_z(c, order_, theta);
  apply_blocks(c, quarter_, false);
  return c;
}

Matrix RotationPlan::from_pole(const Matrix& functionals, double theta, double phi) const {
  Matrix c = functionals;
  apply_blocks(c, quarter_, true);
  rotate_z(c, order_, -theta);
  apply_blocks(c, quarter_, false);
  rotate_z(c, order_, -phi);
  return c;
}

}  // namespace sim
