#include "sim/fast/kernel_split.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

constexpr long double pi_l = std::numbers::pi_v<long double>;

/// Spherical Bessel functions j_0 to j_3.
std::array<long double, 4> spherical_bessel(long double x) {
  std::array<long double, 4> j{};
  if (x > 5) {
    const long double sine = std::sin(x), cosine = std::cos(x), inverse = 1 / x;
    j[0] = sine * inverse;
    j[1] = (j[0] - cosine) * inverse;
    j[2] = 3 * inverse * j[1] - j[0];
    j[3] = 5 * inverse * j[2] - j[1];
    return j;
  }
  long double first = 1;
  for (int n = 0; n < 4; ++n) {
    if (n > 0) first *= x / (2 * n + 1);
    long double term = first;
    for (int m = 1; m < 30; ++m) {  // x^2/2 is below 12.5
      j[n] += term;
      term *= -x * x / (2 * m * (2 * n + 2 * m + 1));
    }
  }
  return j;
}

constexpr int samples = 48;  // Chebyshev nodes at which functions are known
using Series = std::array<long double, samples>;

Series chebyshev_series(const Series& values) {
  Series series{};
  for (int m = 0; m < samples; ++m)
    for (int j = 0; j < samples; ++j)
      series[m] += values[j] * std::cos(pi_l * m * (j + 0.5L) / samples) * (m > 0 ? 2 : 1) / samples;
  return series;
}

/// H as a series in 2 (k/K)^2 - 1.
std::vector<double> multiplier_series(double wave_number) {
  const Prolate mollifier(wave_number - 0.5);  // half less than c leaves five times less error of the double layer
  Series values{};
  for (int j = 0; j < samples; ++j) {
    const double x = std::sqrt((std::cos(std::numbers::pi * (j + 0.5) / samples) + 1) / 2);
    const Prolate::Value psi = mollifier(x);
    values[j] = psi.value - x / 2 * psi.slope;
  }
  const Series series = chebyshev_series(values);
  return {series.begin(), series.end()};
}

/// Chebyshev series of the four radial functions.
std::array<Series, 4> radial_series(const KernelSplit& split) {
  const GaussRule rule = gauss_rule(100);  // k r is below 30
  std::array<Series, 4> values{}, series{};
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const long double k = split.wave_number() * (rule.node[i] + 1) / 2;
    const long double h = split.multiplier(static_cast<double>(k)) * rule.weight[i] * split.wave_number() / 2;
    for (int j = 0; j < samples; ++j) {
      const long double r = std::sqrt((std::cos(pi_l * (j + 0.5L) / samples) + 1) / 2), x = k * r;
      const auto [j0, j1, j2, j3] = spherical_bessel(x);
      values[0][j] += 4 / pi_l * h * (j0 - j1 / x);
      values[1][j] += 4 / pi_l * h * j2 / (r * r);
      values[2][j] += 2 / (3 * pi_l) * h * k * (j1 - 2 * j2 / x) / r;
      values[3][j] += 4 / (3 * pi_l) * h * k * j3 / (r * r * r);
    }
  }
  for (std::size_t part = 0; part < 4; ++part) series[part] = chebyshev_series(values[part]);
  return series;
}

/// Degree at which the rest of a series is below the accuracy.
int needed_degree(const Series& series, double accuracy) {
  double rest = 0;
  for (int m = samples - 1; m > 0; --m) {
    rest += static_cast<double>(std::abs(series[m]));
    if (rest > accuracy) return m;
  }
  return 0;
}

/// The terms of a Chebyshev series up to a degree, as coefficients of powers.
std::vector<double> powers(const Series& series, int degree) {
  const std::size_t count = static_cast<std::size_t>(degree) + 1;
  std::vector<long double> t(count), next(count), sum(count);
  t[0] = 1;
  next[1] = 1;
  for (std::size_t m = 0; m < count; ++m) {
    for (std::size_t i = 0; i < count; ++i) sum[i] += series[m] * t[i];
    std::vector<long double> after(count);
    for (std::size_t i = 0; i + 1 < count; ++i) after[i + 1] = 2 * next[i];
    for (std::size_t i = 0; i < count; ++i) after[i] -= t[i];
    t = std::move(next);
    next = std::move(after);
  }
  return {sum.begin(), sum.end()};
}

}  // namespace

KernelSplit::KernelSplit(double wave_number, double accuracy)
    : wave_number_(wave_number), multiplier_(multiplier_series(wave_number)) {
  const auto series = radial_series(*this);
  for (const Series& one : series) degree_ = std::max(degree_, needed_degree(one, accuracy));
  degree_ = std::min((degree_ + 1) / 2 * 2, most_degree);
  for (std::size_t part = 0; part < 4; ++part) polynomials_[part] = powers(series[part], degree_);
}

double KernelSplit::multiplier(double k) const {
  if (k > wave_number_) return 0;
  const double x = 2 * (k / wave_number_) * (k / wave_number_) - 1;
  double here = 0, before = 0;  // Clenshaw
  for (std::size_t m = multiplier_.size() - 1; m > 0; --m) {
    const double next = multiplier_[m] + 2 * x * here - before;
    before = here;
    here = next;
  }
  return multiplier_[0] + x * here - before;
}

}  // namespace sim
