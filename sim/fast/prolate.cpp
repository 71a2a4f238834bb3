#include "sim/fast/prolate.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace sim {

GaussRule gauss_rule(int count) {
  GaussRule rule;
  for (int i = 0; i < count; ++i) {
    long double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1;
    for (int newton = 0; newton < 20; ++newton) {
      long double before = 1, here = x;
      for (int k = 2; k <= count; ++k) {
        const long double next = ((2 * k - 1) * x * here - (k - 1) * before) / k;
        before = here;
        here = next;
      }
      slope = count * (x * here - before) / (x * x - 1);
      const long double step = here / slope;
      x -= step;
      if (std::abs(step) < 1e-18L) break;
    }
    rule.node.push_back(x);
    rule.weight.push_back(2 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

Prolate::Prolate(double bandwidth) {
  // In normalised Legendre polynomials (1 - x^2) psi'' - 2 x psi' - c^2 x^2 psi = -chi psi is tridiagonal.
  const int count = 30 + static_cast<int>(bandwidth);
  const double square = bandwidth * bandwidth;
  Eigen::VectorXd diagonal(count), beside(count - 1);
  for (int i = 0; i < count; ++i) {
    const double k = 2.0 * i;
    diagonal[i] = k * (k + 1) + square * (2 * k * (k + 1) - 1) / ((2 * k + 3) * (2 * k - 1));
    if (i + 1 < count) beside[i] = square * (k + 2) * (k + 1) / ((2 * k + 3) * std::sqrt((2 * k + 1) * (2 * k + 5)));
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside);
  for (int i = 0; i < count; ++i) series_.push_back(solver.eigenvectors()(i, 0) * std::sqrt(2 * i + 0.5));
  const double middle = (*this)(0).value;
  for (double& term : series_) term /= middle;
}

Prolate::Value Prolate::operator()(double x) const {
  double before = 1, here = x, slope_before = 0, slope = 1;  // P_k and P_k'
  Value sum{series_[0], 0};
  for (std::size_t k = 2; k < 2 * series_.size(); ++k) {
    const double n = static_cast<double>(k), next = ((2 * n - 1) * x * here - (n - 1) * before) / n,
                 next_slope = slope_before + (2 * n - 1) * here;
    before = here;
    here = next;
    slope_before = slope;
    slope = next_slope;
    if (k % 2 == 0) {
      sum.value += series_[k / 2] * here;
      sum.slope += series_[k / 2] * slope;
    }
  }
  return sum;
}

}  // namespace sim
