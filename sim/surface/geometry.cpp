#include "sim/surface/geometry.h"

#include "sim/surface/rows.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sim {

namespace {

using std::numbers::pi;

Matrix cross(const Matrix& a, const Matrix& b) {
  Matrix c(a.rows(), 3);
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    c.col(d) = a.col(e).cwiseProduct(b.col(f)) - a.col(f).cwiseProduct(b.col(e));
  }
  return c;
}

}  // namespace

Geometry geometry(const Basis& basis, const Coefficients& position) {
  Geometry g;
  g.x = basis.second(position);
  const auto& x = g.x;
  g.E = row_products(x.t, x.t);
  g.F = row_products(x.t, x.f);
  g.G = row_products(x.f, x.f);
  g.n = cross(x.t, x.f);
  g.W = row_products(g.n, g.n).cwiseSqrt();
  if (!g.W.allFinite() || g.W.minCoeff() <= 0) throw std::domain_error("the surface is not finite or not regular");
  const Vector inverse = g.W.cwiseInverse(), inverse2 = inverse.cwiseAbs2();
  g.n = scaled_rows(inverse, g.n);
  g.L = row_products(x.tt, g.n);
  g.M = row_products(x.tf, g.n);
  g.N = row_products(x.ff, g.n);
  const Eigen::ArrayXd E = g.E, F = g.F, G = g.G, w2 = inverse2;
  g.H = 0.5 * w2 * (E * g.N.array() - 2 * F * g.M.array() + G * g.L.array());
  g.K = w2 * (g.L.array() * g.N.array() - g.M.array().square());
  g.dA = basis.weights().cwiseProduct(g.W).cwiseQuotient(basis.sin_theta());
  g.lap_tt = G * w2;
  g.lap_tf = -2 * F * w2;
  g.lap_ff = E * w2;
  const Vector half_tf = 0.5 * g.lap_tf;
  g.grad_t = sum_of_rows(g.lap_tt, x.t, half_tf, x.f);
  g.grad_f = sum_of_rows(g.lap_ff, x.f, half_tf, x.t);
  const Matrix v = sum_of_rows(g.lap_tt, x.tt, g.lap_tf, x.tf) + scaled_rows(g.lap_ff, x.ff);
  g.lap_t = -row_products(v, g.grad_t);
  g.lap_f = -row_products(v, g.grad_f);
  return g;
}

Matrix surface_gradient(const Geometry& g, const FirstDerivatives& s) {
  return sum_of_rows(s.t.col(0), g.grad_t, s.f.col(0), g.grad_f);
}

Vector surface_divergence(const Geometry& g, const Matrix& u_t, const Matrix& u_f) {
  return row_products(g.grad_t, u_t) + row_products(g.grad_f, u_f);
}

Vector surface_laplacian(const Geometry& g, const SecondDerivatives& s) {
  return (g.lap_tt.array() * s.tt.col(0).array() + g.lap_tf.array() * s.tf.col(0).array() +
          g.lap_ff.array() * s.ff.col(0).array() + g.lap_t.array() * s.t.col(0).array() +
          g.lap_f.array() * s.f.col(0).array())
      .matrix();
}

Measures measures(const Geometry& g) {
  Measures m;
  m.area = g.dA.sum();
  // The divergence theorem about the mean of the surface points, where cancellation is least.
  const Vec3 origin = g.x.value.transpose() * g.dA / m.area;
  const Matrix y = g.x.value.rowwise() - origin.transpose();
  const Matrix flux = scaled_rows(g.dA, g.n);   // n dA
  const Vector height = row_products(y, flux);  // y.n dA
  m.volume = height.sum() / 3;
  // int y dV = (1/4) int y (y.n) dA, int y y^T dV = (1/5) int y y^T (y.n) dA
  const Vec3 offset = y.transpose() * height / (4 * m.volume);
  m.centroid = origin + offset;
  m.moments = sum_of_products(scaled_rows(height, y), y) / 5;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) m.moments(a, b) -= m.volume * offset[a] * offset[b];
  m.h_squared = g.dA.dot(g.H.cwiseAbs2());
  return m;
}

AreaVolume area_volume(const Basis& basis, const Coefficients& position) {
  const FirstDerivatives x = basis.first(position);
  const Matrix n = cross(x.t, x.f);
  const Vector weight = basis.weights().cwiseQuotient(basis.sin_theta());
  const Vec3 origin = x.value.colwise().mean().transpose();
  const Matrix y = x.value.rowwise() - origin.transpose();
  return {weight.dot(row_products(n, n).cwiseSqrt()), weight.dot(row_products(y, n)) / 3};
}

double inclination(const Eigen::Matrix3d& moments) {
  const double angle = 0.5 * std::atan2(2 * moments(0, 2), moments(0, 0) - moments(2, 2));
  return angle <= -std::numbers::pi / 2 ? angle + std::numbers::pi : angle;
}

double reduced_volume(double area, double volume) { return volume / (4 * pi / 3 * std::pow(area / (4 * pi), 1.5)); }

}  // namespace sim
