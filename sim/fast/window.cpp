#include "sim/fast/window.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>

namespace sim {

namespace {

using std::numbers::pi;

CosineRule window_rule(int width, const Prolate& shape, const GaussRule& rule) {
  CosineRule window;
  for (std::size_t i = 0; i < rule.node.size() / 2; ++i) {  // even: one half
    const double x = static_cast<double>(rule.node[i]);
    window.node.push_back(x * width / 2);
    window.weight.push_back(static_cast<double>(rule.weight[i]) * width * shape(x).value);
  }
  return window;
}

/// The largest relative error that spreading makes by aliases of a wave number.
double aliasing(const CosineRule& window, const KernelSplit& split, double oversampling) {
  double worst = 0;
  constexpr int intervals = 40, aliases = 3;
  for (int i = 0; i <= intervals; ++i) {
    const double share = static_cast<double>(i) / intervals, k = pi / oversampling * share;
    double square = 0;
    for (int m = -aliases; m <= aliases; ++m)
      if (m != 0) square += std::pow(window(k + 2 * pi * m), 2);
    worst = std::max(worst, split.multiplier(split.wave_number() * share) * std::sqrt(square) / std::abs(window(k)));
  }
  return worst;
}

}  // namespace

double CosineRule::operator()(double k) const {
  double sum = 0;
  for (std::size_t i = 0; i < node.size(); ++i) sum += weight[i] * std::cos(k * node[i]);
  return sum;
}

Window::Window(int width, const KernelSplit& split, double oversampling) : width_(width), degree_(width + 7) {
  const GaussRule rule = gauss_rule(80);
  double least = std::numeric_limits<double>::infinity(), bandwidth = 0;
  for (int step = 20; step <= 40; ++step) {
    const double trial = pi * width * step / 50;
    const double error = aliasing(window_rule(width, Prolate(trial), rule), split, oversampling);
    if (error < least) {
      least = error;
      bandwidth = trial;
    }
  }
  const Prolate shape(bandwidth);
  transform_ = window_rule(width, shape, rule);
  // Interpolated at Chebyshev nodes of the cell of each mesh node.
  const int count = degree_ + 1;
  Eigen::MatrixXd vandermonde(count, count), values(count, 2 * width);
  for (int i = 0; i < count; ++i) {
    const double z = std::cos(pi * (i + 0.5) / count);
    for (int d = 0; d < count; ++d) vandermonde(i, d) = std::pow(z, d);
    for (int j = 0; j < width; ++j) {
      const Prolate::Value psi = shape((-width / 2.0 + j + (z + 1) / 2) / (width / 2.0));
      values(i, j) = psi.value;
      values(i, width + j) = psi.slope / (width / 2.0);
    }
  }
  const Eigen::MatrixXd solved = vandermonde.partialPivLu().solve(values);
  for (int slope = 0; slope < 2; ++slope)
    for (int d = 0; d < count; ++d)
      for (int j = 0; j < width; ++j) coefficients_.push_back(solved(d, slope * width + j));
}

void Window::evaluate(double z, double* values, double* slopes) const {
  const double t = 2 * z - 1;
  const double* c = coefficients_.data();
  for (double* out : {values, slopes}) {
    if (out) {
      for (int j = 0; j < width_; ++j) out[j] = c[degree_ * width_ + j];
      for (int d = degree_ - 1; d >= 0; --d)
        for (int j = 0; j < width_; ++j) out[j] = out[j] * t + c[d * width_ + j];
    }
    c += static_cast<std::ptrdiff_t>(degree_ + 1) * width_;
  }
}

}  // namespace sim
