#include "app/converge/sequence.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace app {

namespace {

/// A difference must fall at least by this factor for a limit: the rest is then at most three times the last one.
constexpr double least_fall = 4.0 / 3;

/// (h_1^q - h_2^q)/(h_2^q - h_3^q), which grows with q, in terms of x = log h_1/h_2 and y = log h_2/h_3.
double ratio_of_differences(double q, double x, double y) { return -std::expm1(q * x) / std::expm1(-q * y); }

bool finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// Largest distance of each value from another of the last ones.
std::vector<double> spreads(const std::vector<double>& values, std::size_t last) {
  std::vector<double> all;
  for (const double v : values) {
    double most = 0;
    for (std::size_t k = values.size() - std::min(last, values.size()); k < values.size(); ++k)
      most = std::max(most, std::abs(v - values[k]));
    all.push_back(most);
  }
  return all;
}

std::vector<double> distances(const std::vector<double>& values, double limit) {
  std::vector<double> all;
  for (const double v : values) all.push_back(std::abs(v - limit));
  return all;
}

/// What is left after the last value where the last difference is d and errors fall as h^q.
double rest(double d, double q, double y) { return d / std::expm1(q * y); }

}  // namespace

std::string_view text_of(OrderVerdict verdict) {
  switch (verdict) {
    case OrderVerdict::converges:
      return "converges";
    case OrderVerdict::settled:
      return "within noise";
    case OrderVerdict::slow:
      return "falls too slowly";
    case OrderVerdict::grows:
      return "differences do not fall";
    case OrderVerdict::alternates:
      return "alternates";
    case OrderVerdict::too_few:
      return "two values";
    case OrderVerdict::undefined:
      return "not in all runs";
  }
  return {};
}

std::optional<double> observed_order(const double (&h)[3], const double (&v)[3]) {
  const double x = std::log(h[0] / h[1]), y = std::log(h[1] / h[2]), ratio = (v[0] - v[1]) / (v[1] - v[2]);
  if (!(x > 0 && y > 0)) throw std::invalid_argument("the smallness of runs must fall from one to the next");
  if (!std::isfinite(ratio) || ratio <= x / y) return std::nullopt;  // x / y: the limit of q = 0
  double low = 0, high = 1;
  constexpr double most = 1e4;
  while (ratio_of_differences(high, x, y) < ratio) {
    low = high;
    high *= 2;
    if (high > most) return std::nullopt;
  }
  for (int k = 0; k < 200 && high - low > 1e-15 * high; ++k) {
    const double middle = (low + high) / 2;
    (ratio_of_differences(middle, x, y) < ratio ? low : high) = middle;
  }
  return (low + high) / 2;
}

Convergence convergence_of(const std::vector<double>& h, const std::vector<double>& values, double noise,
                           std::optional<double> expected) {
  if (h.size() != values.size() || h.size() < 2) throw std::invalid_argument("a sequence has two values at least");
  Convergence c;
  const std::size_t n = values.size();
  if (!finite(values)) {
    c.errors.assign(n, std::nan(""));
    c.uncertainty = std::nan("");
    return c;
  }
  const double last = values[n - 2] - values[n - 1];
  c.errors = spreads(values, 3);
  c.uncertainty = n > 2 ? std::max(std::abs(last), std::abs(values[n - 3] - values[n - 2])) : std::abs(last);
  if (n == 2) {
    c.verdict = OrderVerdict::too_few;
    return c;
  }
  const double before = values[n - 3] - values[n - 2];
  const auto take_last = [&](double uncertainty) {
    c.limit = values[n - 1];
    c.uncertainty = uncertainty;
    c.errors = distances(values, *c.limit);
  };
  if (std::abs(last) <= noise) {
    c.verdict = OrderVerdict::settled;
    take_last(noise);
    return c;
  }
  if (last * before < 0) {
    c.verdict = OrderVerdict::alternates;
    if (std::abs(before) >= least_fall * std::abs(last)) take_last(std::abs(last));
    return c;
  }
  const double y = std::log(h[n - 2] / h[n - 1]);
  c.order = observed_order({h[n - 3], h[n - 2], h[n - 1]}, {values[n - 3], values[n - 2], values[n - 1]});
  if (!c.order) {
    c.verdict = OrderVerdict::grows;
    return c;
  }
  if (std::exp(*c.order * y) < least_fall) {
    c.order.reset();
    c.verdict = OrderVerdict::slow;
    return c;
  }
  c.verdict = OrderVerdict::converges;
  c.limit = values[n - 1] - rest(last, *c.order, y);
  c.errors = distances(values, *c.limit);
  c.uncertainty = std::abs(rest(last, expected ? std::min(*expected, *c.order) : *c.order, y));
  if (n > 3) {  // ... and what the limit was one run earlier
    const Convergence earlier =
        convergence_of({h.begin(), h.end() - 1}, {values.begin(), values.end() - 1}, noise, expected);
    if (earlier.limit) c.uncertainty = std::max(c.uncertainty, std::abs(*earlier.limit - *c.limit));
  }
  return c;
}

}  // namespace app
