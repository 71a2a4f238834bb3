#include "sim/surface/labels.h"

#include "sim/sphere/norms.h"
#include "sim/sphere/point_sampler.h"
#include "sim/surface/rows.h"

#include <algorithm>
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

namespace {

/// Where the path is at a time.
struct Place {
  Coefficients position, sliding;
};

Place at(const SlidingPath& path, double time) {
  Place place;
  for (std::size_t j = 0; j < path.times.size(); ++j) {
    double weight = 1;
    for (std::size_t i = 0; i < path.times.size(); ++i)
      if (i != j) weight *= (time - path.times[i]) / (path.times[j] - path.times[i]);
    if (j == 0) {
      place = {{path.positions[0].order, weight * path.positions[0].values},
               {path.sliding[0].order, weight * path.sliding[0].values}};
    } else {
      place.position.values += weight * path.positions[j].values;
      place.sliding.values += weight * path.sliding[j].values;
    }
  }
  return place;
}

/// (a, b) with a x_theta + b x_phi = w in the sense of least squares: the velocity of the grid over the parameters.
Matrix parameter_velocity(const FirstDerivatives& x, const Matrix& w) {
  const Eigen::ArrayXd E = row_products(x.t, x.t), F = row_products(x.t, x.f), G = row_products(x.f, x.f),
                       determinant = E * G - F * F, along_t = row_products(x.t, w), along_f = row_products(x.f, w);
  Matrix rates(w.rows(), 2);
  rates.col(0) = (G * along_t - F * along_f) / determinant;
  rates.col(1) = (E * along_f - F * along_t) / determinant;
  return rates;
}

/// y' = f(time, y) over [from, to] in so many steps.
template <class F>
Matrix runge_kutta(Matrix y, double from, double to, int steps, F&& f) {
  const double h = (to - from) / steps;
  for (int k = 0; k < steps; ++k) {
    const double t = from + k * h;
    const Matrix a = f(t, y), b = f(t + h / 2, y + h / 2 * a), c = f(t + h / 2, y + h / 2 * b), d = f(t + h, y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

}  // namespace

namespace {

/// The grid on which labels change: products are analysed without aliasing.
struct LabelGrid {
  const Basis& labels;
  const Basis& position;

  LabelGrid(Plans& plans, const SlidingPath& path, int order) : LabelGrid(plans, order, path.positions[0].order) {}
  LabelGrid(Plans& plans, int order, int p)
      : labels(plans.basis(order, points(order, p))), position(plans.basis(p, points(order, p))) {}
  /// A rate of degree p, a slope and the function that it is tested with, both of degree `order`, are integrated
  /// exactly.
  static int points(int order, int p) { return order + (p + 1) / 2; }
  /// Velocity of the grid over the parameters at a time.
  Matrix velocity(const SlidingPath& path, double time) const {
    const Place place = at(path, time);
    return parameter_velocity(position.slopes(place.position), position.synthesize(place.sliding).values);
  }
  /// L' = w.grad L
  Matrix change(const Matrix& w, const Matrix& values) const {
    const FirstDerivatives slopes = labels.slopes({labels.order(), values});
    const Matrix change = slopes.t.array().colwise() * w.col(0).array() + slopes.f.array().colwise() * w.col(1).array();
    return labels.analyze(change).values;
  }
};

}  // namespace

Coefficients slid_labels(Plans& plans, const SlidingPath& path, const Coefficients& labels, double from, double to) {
  const int order = labels.order;
  const LabelGrid grid(plans, path, order);
  const auto rates_at = [&](double time) { return grid.velocity(path, time); };
  const Matrix start = rates_at(from);
  const double fastest =
      (start.col(0).cwiseAbs2() + start.col(1).cwiseProduct(grid.labels.sin_theta()).cwiseAbs2()).maxCoeff();
  constexpr double stable = 2;  // of 2.8, for waves of the highest degree
  const int steps = std::max(1, int(std::ceil(std::sqrt(fastest) * std::abs(to - from) * order / stable)));
  // The stages fall on the ends and the middles of the steps.
  std::vector<Matrix> rates{start};
  for (int k = 1; k <= 2 * steps; ++k) rates.push_back(rates_at(from + (to - from) * k / (2 * steps)));
  return {order, runge_kutta(labels.values, from, to, steps, [&](double time, const Matrix& values) -> Matrix {
            return grid.change(rates[std::size_t(std::lround((time - from) / (to - from) * 2 * steps))], values);
          })};
}

LabelsBetween::LabelsBetween(Plans& plans, const SlidingPath& path, Coefficients before, double from,
                             Coefficients after, double to)
    : before_(std::move(before)), after_(std::move(after)), from_(from), to_(to) {
  const LabelGrid grid(plans, path, before_.order);
  rate_before_ = grid.change(grid.velocity(path, from), before_.values);
  rate_after_ = grid.change(grid.velocity(path, to), after_.values);
}

Coefficients LabelsBetween::at(double time) const {
  const double length = to_ - from_, s = (time - from_) / length, r = 1 - s;  // Hermite's polynomials
  return {before_.order, r * r * (1 + 2 * s) * before_.values + s * s * (1 + 2 * r) * after_.values +
                             length * s * r * (r * rate_before_ - s * rate_after_)};
}

Matrix slid_points(const SlidingPath& path, const Matrix& parameters, double from, double to) {
  const auto velocity = [&](double time, const Matrix& points) -> Matrix {
    const Place place = at(path, time);
    const PointSampler position(place.position), sliding(place.sliding);
    Matrix change(points.rows(), 3);
    for (Eigen::Index k = 0; k < points.rows(); ++k) {
      const Vec3 s = points.row(k).transpose();
      const PointTangents x = position.tangents(s);
      change.row(k) = parameter_shift(x.e1, x.e2, x.a, x.b, -sliding.position(s)).transpose();
    }
    return change;
  };
  return runge_kutta(parameters, from, to, 1, velocity).rowwise().normalized();
}

}  // namespace sim
