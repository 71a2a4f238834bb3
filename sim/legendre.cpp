#include "legendre.h"

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
      auto row = result.row(legendre_index(p, n, m));
      const double down = std::sqrt(double(n + m) * (n - m + 1)), up = std::sqrt(double(n - m) * (n + m + 1));
      row.setZero();
      if (m == 0) {  // P_n,-1 = -P_n,1 without the Condon-Shortley sign
        if (n >= 1) row -= 0.5 * (down + up) * table.row(legendre_index(p, n, 1));
      } else {
        row += 0.5 * down * table.row(legendre_index(p, n, m - 1));
        if (m + 1 <= n) row -= 0.5 * up * table.row(legendre_index(p, n, m + 1));
      }
    }
  return result;
}

}  // namespace

LegendreTable legendre_table(int p, const Vector& theta, int derivatives) {
  LegendreTable table{p, Matrix(legendre_count(p), theta.size()), {}, {}};
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    const double z = std::cos(theta[i]), s = std::sin(theta[i]);
    double diagonal = std::sqrt(0.5);
    for (int m = 0; m <= p; ++m) {
      if (m > 0) diagonal *= std::sqrt((2.0 * m + 1) / (2.0 * m)) * s;
      double previous = 0, current = diagonal;
      table.value(legendre_index(p, m, m), i) = current;
      for (int n = m + 1; n <= p; ++n) {
        const double nn = double(n) * n, mm = double(m) * m;
        const double a = std::sqrt((4 * nn - 1) / (nn - mm));
        const double b = n == m + 1 ? 0
                                    : std::sqrt((2.0 * n + 1) * (n - m - 1.0) * (n + m - 1.0) / ((2.0 * n - 3) * (nn - mm)));
        const double next = a * z * current - b * previous;
        previous = current;
        current = next;
        table.value(legendre_index(p, n, m), i) = current;
      }
    }
  }
  if (derivatives > 0) table.d1 = ladder_derivative(p, table.value);
  if (derivatives > 1) table.d2 = ladder_derivative(p, table.d1);
  return table;
}

}  // namespace sim
