#include "sim/layers/near.h"

#include "sim/core/lanes.h"
#include "sim/layers/kernels.h"

#include <array>
#include <cmath>
#include <numbers>

namespace sim {

using std::numbers::pi;

NearestPoint nearest_point(const PointSampler& surface, const Vec3& target, const Vec3& start) {
  // Newton on |x(s) - target|^2 / 2 along great circles through s; a step that does not come nearer is halved.
  Vec3 s = beside_the_pole(start.normalized());
  PointTangents y = surface.tangents(s);
  double distance = (y.x - target).norm();
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Vec3 miss = target - y.x;
    const Eigen::Vector2d slope(y.a.dot(miss), y.b.dot(miss));
    const double ab = y.a.dot(y.b);
    Eigen::Matrix2d metric, curved;
    metric << y.a.dot(y.a), ab, ab, y.b.dot(y.b);
    curved << y.aa.dot(miss), y.ab.dot(miss), y.ab.dot(miss), y.bb.dot(miss);
    curved = metric - curved;
    // Where the target lies beyond a centre of curvature the least distance is elsewhere: the metric always descends.
    // So it does at a pole, where second derivatives lose their digits.
    const bool newton = y.pole > 1e-4 && curved(0, 0) > 0 && curved.determinant() > 0.01 * metric.determinant();
    const Eigen::Vector2d step = (newton ? curved : metric).ldlt().solve(slope);
    if (step.norm() < 1e-14) break;
    const bool last = newton && step.norm() < 1e-7;  // its square is below rounding; the distance no longer tells
    double length = std::min(1.0, 0.5 / step.norm());
    bool nearer = false;
    for (int half = 0; half < 30 && !nearer; ++half, length /= 2) {
      const Vec3 trial = (s + length * (step[0] * y.e1 + step[1] * y.e2)).normalized();
      const PointTangents z = surface.tangents(trial);
      const double d = (z.x - target).norm();
      if (d < distance || last) {
        s = beside_the_pole(trial);
        y = z;
        nearer = true;
        distance = d;
      }
    }
    if (!nearer || last) break;
  }
  return {s, y.x, distance, y.a.cross(y.b).dot(target - y.x) < 0};
}

namespace {

/// The graded grid about the nearest point, in the frame where that is the pole: nt x nf arrays.
struct GradedGrid {
  double theta0, phi0;
  LegendreTable table;                   ///< of the graded colatitudes
  Eigen::ArrayXXd r[3], n[3], rr, area;  ///< target - y, weighted normal, |r|^2, dA
};

/// Separable synthesis of the fields given by their coefficients in the pole's frame: spectra of all of them, one below
/// the other, (nt columns) x (2p+1).
Matrix spectra(int p, const Matrix& values, const Matrix& legendre) {
  const Eigen::Index nt = legendre.rows(), fields = values.cols();
  Matrix s(nt * fields, 2 * p + 1), c(p + 1, fields);
  for (int m = -p; m <= p; ++m) {
    const int k = std::abs(m), first = legendre_index(p, k, k), count = p - k + 1;
    for (int n = k; n <= p; ++n) c.row(n - k) = values.row(coefficient_index(n, m));
    Eigen::Map<Matrix>(s.col(p + m).data(), nt, fields).noalias() =
        legendre.middleCols(first, count) * c.topRows(count);
  }
  return s;
}

GradedGrid graded_grid(const NearRule& rule, const RotationPlan& plan, const Coefficients& x, const Vec3& target,
                       const NearestPoint& nearest) {
  const int p = rule.degree;
  const Eigen::Index nt = rule.latitudes.theta.size(), nf = rule.cosines.cols();
  const Vec3& s = nearest.parameter;
  GradedGrid g{std::atan2(std::hypot(s[0], s[1]), s[2]), std::atan2(s[1], s[0]), {}, {}, {}, {}, {}};
  const Matrix turned = plan.to_pole(resized(x, p).values, g.theta0, g.phi0);

  // Graded colatitudes. The metric at the pole is that of the longer tangent: the narrower width in the parameter.
  const Matrix pole_tangents = [&] {
    Vector zero(1), quarter(2);
    zero << 0;
    quarter << 0, pi / 2;
    return sample_grid({p, turned}, zero, quarter).t;
  }();
  const double metric = std::max(pole_tangents.row(0).norm(), pole_tangents.row(1).norm());
  const double eps = std::max(nearest.distance / metric, 1e-12), a = std::asinh(pi / eps);
  Vector t(nt), weight(nt);
  for (Eigen::Index i = 0; i < nt; ++i) {
    const double u = 0.5 * (1 - std::cos(rule.latitudes.theta[i]));
    t[i] = eps * std::sinh(a * u);
    weight[i] = 0.5 * rule.latitudes.weight[i] * eps * a * std::cosh(a * u) * 2 * pi / double(nf);
  }
  g.table = legendre_table(p, t, 1);
  const Matrix values = spectra(p, turned, g.table.value);
  const Matrix y = values * rule.cosines, y_f = values * rule.slopes;
  const Matrix y_t = spectra(p, turned, g.table.d1) * rule.cosines;
  const auto field = [&](const Matrix& all, int d) { return all.middleRows(d * nt, nt).array(); };
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    g.r[d] = target[d] - field(y, d);
    g.n[d] = (field(y_t, e) * field(y_f, f) - field(y_t, f) * field(y_f, e)).colwise() * weight.array();
  }
  g.rr = g.r[0].square() + g.r[1].square() + g.r[2].square();
  g.area = (g.n[0].square() + g.n[1].square() + g.n[2].square()).sqrt();
  return g;
}

/// The outer part of the double layer's kernel with its weights.
Eigen::ArrayXXd dual_outer(const GradedGrid& g, const Eigen::ArrayXXd& inverse) {
  const Eigen::ArrayXXd rn = g.r[0] * g.n[0] + g.r[1] * g.n[1] + g.r[2] * g.n[2];
  return stresslet(inverse, Eigen::ArrayXXd(stresslet_factor * rn));
}

/// The kernel of the single layer with its weights.
KernelTensor<Eigen::ArrayXXd> single_kernel(const GradedGrid& g, const Eigen::ArrayXXd& inverse) {
  return stokeslet(inverse, Eigen::ArrayXXd(stokeslet_factor * g.area));
}

}  // namespace

NearOrder near_order_for(int degree, double error) {
  constexpr int least = 12, even = 2;
  const double nodes = degree + 12 + 6 * std::log10(1e-4 / error);
  const int latitudes = std::max(least, even * int(std::ceil(nodes / even)));
  return {latitudes, latitudes + std::max(0, latitudes - 32)};  // longitudes so as measured
}

NearRule near_rule(int degree, NearOrder order) {
  const int p = degree, nf = order.longitudes;
  NearRule rule{p, gauss_legendre(order.latitudes), Matrix(2 * p + 1, nf), Matrix(2 * p + 1, nf)};
  for (int j = 0; j < nf; ++j)
    for (int m = 0; m <= p; ++m) {
      const double f = 2 * pi * j / nf, k = longitude_norm(m);
      const double c = k * std::cos(m * f), d = k * std::sin(m * f);
      rule.cosines(p + m, j) = c, rule.slopes(p + m, j) = -m * d;
      if (m > 0) rule.cosines(p - m, j) = d, rule.slopes(p - m, j) = m * c;
    }
  return rule;
}

PointRow near_row(const NearRule& rule, const RotationPlan& plan, const Coefficients& x, const Vec3& target,
                  const NearestPoint& nearest, bool with_double) {
  const GradedGrid g = graded_grid(rule, plan, x, target, nearest);
  const int p = rule.degree, blocks = with_double ? 12 : 6;
  const Eigen::Index nt = g.rr.rows();
  const Eigen::ArrayXXd inverse = g.rr.rsqrt();
  const KernelTensor<Eigen::ArrayXXd> single = single_kernel(g, inverse);
  const Eigen::ArrayXXd outer = with_double ? dual_outer(g, inverse) : Eigen::ArrayXXd();

  // The transposed synthesis of all components together: those of the single layer, then those of the double layer.
  Matrix kernels(blocks * nt, g.rr.cols());
  int block = 0;
  for (int c = 0; c < 3; ++c)
    for (int e = c; e < 3; ++e, ++block) {
      const Eigen::ArrayXXd rce = g.r[c] * g.r[e];
      auto kernel = kernels.middleRows(block * nt, nt).array();
      kernel = single.outer * rce;
      if (c == e) kernel += single.even;
      if (with_double) kernels.middleRows((6 + block) * nt, nt).array() = outer * rce;
    }
  const Matrix spectrum = kernels * rule.cosines.transpose();  // (nt blocks) x (2p+1)
  Matrix rows(coefficient_count(p), blocks), part(p + 1, blocks);
  for (int m = -p; m <= p; ++m) {
    const int k = std::abs(m), first = legendre_index(p, k, k), count = p - k + 1;
    const Eigen::Map<const Matrix> column(spectrum.col(p + m).data(), nt, blocks);
    part.topRows(count).noalias() = g.table.value.middleCols(first, count).transpose() * column;
    for (int l = k; l <= p; ++l) rows.row(coefficient_index(l, m)) = part.row(l - k);
  }
  rows = plan.from_pole(rows, g.theta0, g.phi0);
  return {rows.leftCols(6), with_double ? Matrix(rows.rightCols(6)) : Matrix()};
}

Vec3 near_velocity(const NearRule& rule, const RotationPlan& plan, const Coefficients& x, const Vec3& target,
                   const NearestPoint& nearest, const Coefficients& force, const Coefficients* dual) {
  const GradedGrid g = graded_grid(rule, plan, x, target, nearest);
  const auto sampled = [&](const Coefficients& density) {
    const Matrix turned = plan.to_pole(resized(density, rule.degree).values, g.theta0, g.phi0);
    const Matrix all = spectra(rule.degree, turned, g.table.value) * rule.cosines;
    std::array<Eigen::ArrayXXd, 3> values;
    for (int d = 0; d < 3; ++d) values[d] = all.middleRows(d * g.rr.rows(), g.rr.rows()).array();
    return values;
  };
  const Eigen::ArrayXXd inverse = g.rr.rsqrt();
  const KernelTensor<Eigen::ArrayXXd> single = single_kernel(g, inverse);
  const auto f = sampled(force);
  Eigen::ArrayXXd along = single.outer * (g.r[0] * f[0] + g.r[1] * f[1] + g.r[2] * f[2]);
  if (dual) {
    const auto u = sampled(*dual);
    along += dual_outer(g, inverse) * (g.r[0] * u[0] + g.r[1] * u[1] + g.r[2] * u[2]);
  }
  Vec3 velocity;
  for (int d = 0; d < 3; ++d) velocity[d] = (single.even * f[d] + along * g.r[d]).sum();
  return velocity;
}

Vec3 apply_row(const Matrix& row, const Matrix& density) {
  // One pass over the row, which is read once and far larger than what is made of it.
  const Eigen::Index count = row.rows(), whole = count - count % lanes;
  const double *k = row.data(), *f = density.data();
  Lane sums[3] = {};
  Vec3 v = Vec3::Zero();
  for (Eigen::Index n = 0; n < whole; n += lanes) {
    const Lane x = load_lane(f + n), y = load_lane(f + count + n), z = load_lane(f + 2 * count + n);
    const Lane xy = load_lane(k + count + n), xz = load_lane(k + 2 * count + n), yz = load_lane(k + 4 * count + n);
    sums[0] += load_lane(k + n) * x + xy * y + xz * z;
    sums[1] += xy * x + load_lane(k + 3 * count + n) * y + yz * z;
    sums[2] += xz * x + yz * y + load_lane(k + 5 * count + n) * z;
  }
  for (int d = 0; d < 3; ++d) v[d] = (sums[d][0] + sums[d][1]) + (sums[d][2] + sums[d][3]);
  for (Eigen::Index n = whole; n < count; ++n) {
    const double x = f[n], y = f[count + n], z = f[2 * count + n];
    const double xy = k[count + n], xz = k[2 * count + n], yz = k[4 * count + n];
    v += Vec3(k[n] * x + xy * y + xz * z, xy * x + k[3 * count + n] * y + yz * z,
              xz * x + yz * y + k[5 * count + n] * z);
  }
  return v;
}

}  // namespace sim
