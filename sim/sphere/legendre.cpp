#include "sim/sphere/legendre.h"

#include <cmath>
#include <numbers>

namespace sim {

GaussLegendre gauss_legendre(int n) {
  GaussLegendre rule{Vector(n), Vector(n)};
  for (int i = 0; i < (n + 1) / 2; ++i) {
    double z = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double derivative = 0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double p0 = 1, p1 = z;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * z * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      derivative = n * (z * p1 - p0) / (z * z - 1);
      const double step = p1 / derivative;
      z -= step;
      if (std::abs(step) < 1e-15) break;
    }
    if (2 * i + 1 == n) z = 0;
    const double weight = 2 / ((1 - z * z) * derivative * derivative);
    rule.theta[i] = std::acos(z);
    rule.theta[n - 1 - i] = std::numbers::pi - rule.theta[i];
    rule.weight[i] = rule.weight[n - 1 - i] = weight;
  }
  return rule;
}

namespace {

/// d/dtheta of every P_nm by the ladder in m, from the table of the functions themselves or of a derivative.
Matrix ladder_derivative(int p, const Matrix& table) {
  Matrix result(table.rows(), table.cols());
  for (int m = 0; m <= p; ++m)
    for (int n = m; n <= p; ++n) {
      auto column = result.col(legendre_index(p, n, m));
      const double down = std::sqrt(double(n + m) * (n - m + 1)), up = std::sqrt(double(n - m) * (n + m + 1));
      column.setZero();
      if (m == 0) {  // P_n,-1 = -P_n,1 without the Condon-Shortley sign
        if (n >= 1) column -= 0.5 * (down + up) * table.col(legendre_index(p, n, 1));
      } else {
        column += 0.5 * down * table.col(legendre_index(p, n, m - 1));
        if (m + 1 <= n) column -= 0.5 * up * table.col(legendre_index(p, n, m + 1));
      }
    }
  return result;
}

}  // namespace

LegendreTable legendre_table(int p, const Vector& theta, int derivatives) {
  LegendreTable table{p, Matrix(theta.size(), legendre_count(p)), {}, {}};
  const Eigen::ArrayXd z = theta.array().cos(), s = theta.array().sin();
  Eigen::ArrayXd diagonal = Eigen::ArrayXd::Constant(theta.size(), std::sqrt(0.5));
  for (int m = 0; m <= p; ++m) {
    if (m > 0) diagonal *= std::sqrt((2.0 * m + 1) / (2.0 * m)) * s;
    const int first = legendre_index(p, m, m);
    table.value.col(first) = diagonal;
    for (int n = m + 1; n <= p; ++n) {
      const double nn = double(n) * n, mm = double(m) * m;
      const double a = std::sqrt((4 * nn - 1) / (nn - mm));
      auto next = table.value.col(first + n - m).array();
      next = a * z * table.value.col(first + n - m - 1).array();
      if (n > m + 1) {
        const double b = std::sqrt((2.0 * n + 1) * (n - m - 1.0) * (n + m - 1.0) / ((2.0 * n - 3) * (nn - mm)));
        next -= b * table.value.col(first + n - m - 2).array();
      }
    }
  }
  if (derivatives > 0) table.d1 = ladder_derivative(p, table.value);
  if (derivatives > 1) table.d2 = ladder_derivative(p, table.d1);
  return table;
}

double longitude_norm(int m) { return 1 / std::sqrt(m == 0 ? 2 * std::numbers::pi : std::numbers::pi); }

}  // namespace sim
