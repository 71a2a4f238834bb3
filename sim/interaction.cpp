#include "interaction.h"

#include "parallel.h"
#include "small_product.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace sim {

namespace {

constexpr double pi = std::numbers::pi;

/// Order of the smooth source grid: q ~ p^(3/2).
int smooth_order(int p, int wanted) { return std::max(p + 1, wanted > 0 ? wanted : int(std::ceil(std::pow(p, 1.5)))); }

Vec3 direction(const Basis& basis, Eigen::Index k) {
  return unit_vector(basis.theta()[k % basis.latitudes()], basis.phi()[k / basis.latitudes()]);
}

double distance_to_box(const Vec3& x, const Vec3& low, const Vec3& high) {
  return (low - x).cwiseMax(x - high).cwiseMax(0).norm();
}

}  // namespace

Sources make_sources(const Basis& basis, const Coefficients& x) {
  const FirstDerivatives d = basis.first(x);
  Sources s;
  s.points = d.value;
  s.normals.resize(basis.points(), 3);
  s.area.resize(basis.points());
  s.spacing.resize(basis.points());
  const double step = pi / basis.latitudes();
  for (Eigen::Index k = 0; k < basis.points(); ++k) {
    const Vec3 t = d.t.row(k).transpose(), f = d.f.row(k).transpose();
    const Vec3 n = t.cross(f) * basis.weights()[k] / basis.sin_theta()[k];
    s.normals.row(k) = n.transpose();
    s.area[k] = n.norm();
    s.spacing[k] = step * std::max(t.norm(), f.norm() / basis.sin_theta()[k]);
  }
  s.low = s.points.colwise().minCoeff().transpose();
  s.high = s.points.colwise().maxCoeff().transpose();
  return s;
}

std::pair<Eigen::Index, double> nearest_source(const Sources& s, const Vec3& x) {
  Eigen::Index k = 0;
  const double square = ((s.points.col(0).array() - x[0]).square() + (s.points.col(1).array() - x[1]).square() +
                         (s.points.col(2).array() - x[2]).square())
                            .minCoeff(&k);
  return {k, std::sqrt(square)};
}

Interaction plan_interaction(Plans& plans, std::span<const Coefficients> positions, std::span<const Material> materials,
                             const InteractionOptions& options) {
  Interaction w;
  const int n = int(positions.size());
  if (n < 2) return w;
  std::vector<const RotationPlan*> rotations;
  for (int i = 0; i < n; ++i) {
    const int p = positions[i].order;
    w.source_basis.push_back(&plans.basis(p, smooth_order(p, options.source_order)));
    w.target_basis.push_back(&plans.basis(p, p + 1));
    rotations.push_back(&plans.rotation(p));
    w.dual.push_back(materials[i].viscosity_contrast != 1);
  }
  w.sources.resize(n);
  w.coarse_sources.resize(n);
  w.targets.resize(n);
  w.pairs.assign(n, std::vector<PairPlan>(n));
  parallel_for(n, [&](int i) {
    w.sources[i] = make_sources(*w.source_basis[i], positions[i]);
    w.coarse_sources[i] = make_sources(*w.target_basis[i], positions[i]);
    w.targets[i] = w.coarse_sources[i].points;
  });
  parallel_for(n * n, [&](int task) {
    const int i = task / n, j = task % n;
    if (i == j) return;
    PairPlan& pair = w.pairs[i][j];
    const Sources& s = w.sources[j];
    const double reach = options.near_spacings * s.spacing.maxCoeff();
    const double coarse_reach = options.coarse_spacings * w.coarse_sources[j].spacing.maxCoeff();
    for (int k = 0; k < int(w.targets[i].rows()); ++k) {
      const Vec3 x = w.targets[i].row(k).transpose();
      const double to_box = distance_to_box(x, s.low, s.high);
      if (coarse_reach > 0 && to_box >= coarse_reach) {
        pair.coarse.push_back(k);
        continue;
      }
      if (options.near_rule && to_box < reach) {
        const auto [source, away] = nearest_source(s, x);
        if (away < (options.near_spacings + 1) * s.spacing[source]) {
          const NearestPoint nearest = nearest_point(positions[j], x, direction(*w.source_basis[j], source));
          if (nearest.inside) throw std::domain_error(fmt::format("vesicle {} crosses vesicle {}", i, j));
          if (nearest.distance < options.near_spacings * s.spacing[source]) {
            pair.near.push_back(k);
            pair.rows.push_back(near_row(*rotations[j], positions[j], x, nearest, options.near_order, w.dual[j]));
            pair.nearest.push_back(nearest);
            continue;
          }
        }
      }
      pair.fine.push_back(k);
    }
  });
  return w;
}

void add_direct_sum(const Sources& s, const Matrix& force, const Matrix* dual, const Matrix& points, Matrix& velocity) {
  const Eigen::Index count = points.rows(), sources = s.points.rows();
  // Weighted densities once; four targets a lane, sources in order: the result does not depend on how targets are split.
  Matrix f(3, sources), u, n, y = s.points.transpose();
  for (int d = 0; d < 3; ++d) f.row(d) = (force.col(d).array() * s.area.array() / (8 * pi)).matrix().transpose();
  if (dual) {
    u = dual->transpose();
    n = s.normals.transpose() * (3 / (4 * pi));
  }
  for (Eigen::Index first = 0; first < count; first += lanes) {
    Lane t[3], v[3] = {};
    for (int d = 0; d < 3; ++d) {
      double x[lanes];
      for (int lane = 0; lane < lanes; ++lane) x[lane] = points(std::min(first + lane, count - 1), d);
      __builtin_memcpy(&t[d], x, sizeof x);
    }
    for (Eigen::Index k = 0; k < sources; ++k) {
      const Lane r0 = t[0] - y(0, k), r1 = t[1] - y(1, k), r2 = t[2] - y(2, k);
      const Lane rr = r0 * r0 + r1 * r1 + r2 * r2;
      const Lane inverse = 1.0 / lane_sqrt(rr), inverse2 = inverse * inverse;
      const Lane rf = (r0 * f(0, k) + r1 * f(1, k) + r2 * f(2, k)) * inverse2;
      Lane along = rf * inverse;
      if (dual) {
        const Lane rn = r0 * n(0, k) + r1 * n(1, k) + r2 * n(2, k), ru = r0 * u(0, k) + r1 * u(1, k) + r2 * u(2, k);
        along += rn * ru * inverse2 * inverse2 * inverse;
      }
      v[0] += f(0, k) * inverse + along * r0;
      v[1] += f(1, k) * inverse + along * r1;
      v[2] += f(2, k) * inverse + along * r2;
    }
    for (int lane = 0; lane < lanes && first + lane < count; ++lane)
      for (int d = 0; d < 3; ++d) velocity(first + lane, d) += v[d][lane];
  }
}

std::vector<Coefficients> induced_velocity(const Interaction& w, std::span<const Densities> densities) {
  const int n = int(densities.size());
  struct Samples {
    Matrix force, dual;
  };
  std::vector<Samples> fine(n), coarse(n);
  parallel_for(n, [&](int j) {
    fine[j].force = w.source_basis[j]->synthesize(densities[j].force).values;
    coarse[j].force = w.target_basis[j]->synthesize(densities[j].force).values;
    if (!w.dual[j]) return;
    fine[j].dual = w.source_basis[j]->synthesize(densities[j].dual).values;
    coarse[j].dual = w.target_basis[j]->synthesize(densities[j].dual).values;
  });
  std::vector<Coefficients> result(n);
  parallel_for(n, [&](int i) {
    Matrix velocity = Matrix::Zero(w.targets[i].rows(), 3);
    const auto add = [&](const std::vector<int>& list, const Sources& sources, const Samples& samples, bool dual) {
      if (list.empty()) return;
      Matrix sum = Matrix::Zero(Eigen::Index(list.size()), 3);
      add_direct_sum(sources, samples.force, dual ? &samples.dual : nullptr, w.targets[i](list, Eigen::seqN(0, 3)), sum);
      for (std::size_t k = 0; k < list.size(); ++k) velocity.row(list[k]) += sum.row(Eigen::Index(k));
    };
    for (int j = 0; j < n; ++j) {
      if (i == j) continue;
      const PairPlan& pair = w.pairs[i][j];
      add(pair.coarse, w.coarse_sources[j], coarse[j], w.dual[j]);
      add(pair.fine, w.sources[j], fine[j], w.dual[j]);
      for (std::size_t k = 0; k < pair.near.size(); ++k) {
        Vec3 v = apply_row(pair.rows[k].single, densities[j].force.values);
        if (w.dual[j]) v += apply_row(pair.rows[k].dual, densities[j].dual.values);
        velocity.row(pair.near[k]) += v.transpose();
      }
    }
    result[i] = w.target_basis[i]->analyze(velocity);
  });
  return result;
}

std::vector<Coefficients> repulsion(const Interaction& w, double strength, double range) {
  const int n = int(w.targets.size());
  std::vector<Coefficients> result(n);
  for (int i = 0; i < n; ++i) {
    Matrix force = Matrix::Zero(w.targets[i].rows(), 3);
    for (int j = 0; j < n; ++j)
      for (std::size_t k = 0; i != j && k < w.pairs[i][j].near.size(); ++k) {
        const NearestPoint& nearest = w.pairs[i][j].nearest[k];
        const int row = w.pairs[i][j].near[k];
        force.row(row) += strength * std::exp(-nearest.distance / range) *
                          (w.targets[i].row(row) - nearest.position.transpose()).normalized();
      }
    result[i] = w.target_basis[i]->analyze(force);
  }
  return result;
}

namespace {

/// Solid angle of a surface at x over 4 pi: 1 inside, 0 outside; by the smooth rule, so right to about one half near it.
double winding(const Sources& s, const Vec3& x) {
  double sum = 0;
  for (Eigen::Index k = 0; k < s.points.rows(); ++k) {
    const Vec3 r = s.points.row(k).transpose() - x;
    sum += s.normals.row(k).dot(r) / std::pow(r.squaredNorm(), 1.5);
  }
  return sum / (4 * pi);
}

/// Two parameters on two surfaces, and Newton for the least distance between them.
struct Approach {
  Vec3 s, t;  ///< parameters on the first and the second surface
  double distance = 0;
};

/// |x - y|^2 / 2 in tangent coordinates q about (s, t).
struct ApproachSlope {
  const Coefficients &x, &y;
  Vec3 s, t, a1, a2, b1, b2;
  ApproachSlope(const Coefficients& first, const Coefficients& second, const Approach& at)
      : x(first), y(second), s(at.s), t(at.t), a1(s.unitOrthogonal()), a2(s.cross(a1)), b1(t.unitOrthogonal()),
        b2(t.cross(b1)) {}
  Approach moved(const Eigen::Vector4d& q) const {
    Approach m{(s + q[0] * a1 + q[1] * a2).normalized(), (t + q[2] * b1 + q[3] * b2).normalized(), 0};
    m.distance = (sample_points(x, m.s.transpose()) - sample_points(y, m.t.transpose())).norm();
    return m;
  }
  double half_square(const Eigen::Vector4d& q) const { return 0.5 * std::pow(moved(q).distance, 2); }
};

/// Newton with differences for slope and curvature; a step that does not come nearer is halved.
Approach nearest_approach(const Coefficients& x, const Coefficients& y, Approach at) {
  at = ApproachSlope(x, y, at).moved(Eigen::Vector4d::Zero());
  for (int iteration = 0; iteration < 30; ++iteration) {
    const ApproachSlope f(x, y, at);
    constexpr double h = 1e-4;  // rounding 1e-16/h^2 and truncation h^2 both leave eight digits in the curvature
    Eigen::Vector4d slope;
    Eigen::Matrix4d curvature;
    const double centre = f.half_square(Eigen::Vector4d::Zero());
    for (int a = 0; a < 4; ++a) {
      const Eigen::Vector4d e = h * Eigen::Vector4d::Unit(a);
      const double plus = f.half_square(e), minus = f.half_square(-e);
      slope[a] = (plus - minus) / (2 * h);
      curvature(a, a) = (plus - 2 * centre + minus) / (h * h);
      for (int b = 0; b < a; ++b) {
        const Eigen::Vector4d d = h * Eigen::Vector4d::Unit(b);
        curvature(a, b) = curvature(b, a) =
            (f.half_square(e + d) - f.half_square(e - d) - f.half_square(d - e) + f.half_square(-e - d)) / (4 * h * h);
      }
    }
    // Directions of negative or no curvature are walked down by their size.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(curvature);
    const Eigen::Vector4d size = eigen.eigenvalues().cwiseAbs().cwiseMax(1e-6 * eigen.eigenvalues().cwiseAbs().maxCoeff());
    Eigen::Vector4d step = -eigen.eigenvectors() * (eigen.eigenvectors().transpose() * slope).cwiseQuotient(size);
    if (step.norm() > 0.2) step *= 0.2 / step.norm();
    bool nearer = false;
    for (int half = 0; half < 20 && !nearer; ++half, step /= 2) {
      const Approach trial = f.moved(step);
      if (trial.distance < at.distance) {
        nearer = at.distance - trial.distance > 1e-14 * at.distance;
        at = trial;
        if (!nearer) return at;
      }
    }
    if (!nearer) break;
  }
  return at;
}

}  // namespace

Gap smallest_gap(Plans& plans, std::span<const Coefficients> positions) {
  const int n = int(positions.size());
  Gap best{std::numeric_limits<double>::infinity(), -1, -1, false};
  if (n < 2) return best;
  std::vector<const Basis*> bases;
  std::vector<Sources> surfaces(n);
  for (const Coefficients& x : positions) bases.push_back(&plans.basis(x.order, smooth_order(x.order, 0)));
  parallel_for(n, [&](int i) { surfaces[i] = make_sources(*bases[i], positions[i]); });
  std::vector<Gap> gaps(n, best);
  parallel_for(n, [&](int i) {
    for (int j = 0; j < i; ++j) {
      const Sources &a = surfaces[i], &b = surfaces[j];
      const Vec3 apart = (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0);
      if (apart.norm() >= gaps[i].distance) continue;
      // Nearest pair of source points, then Newton on the two spectral surfaces.
      double nearest = std::numeric_limits<double>::infinity();
      Eigen::Index at_a = 0, at_b = 0;
      for (Eigen::Index k = 0; k < a.points.rows(); ++k) {
        const Vec3 x = a.points.row(k).transpose();
        if (distance_to_box(x, b.low, b.high) >= nearest) continue;
        const auto [l, d] = nearest_source(b, x);
        if (d < nearest) nearest = d, at_a = k, at_b = l;
      }
      Gap gap{nearest, j, i, false};
      if (nearest < 3 * std::max(a.spacing[at_a], b.spacing[at_b])) {
        const Approach approach = nearest_approach(
            positions[i], positions[j], {direction(*bases[i], at_a), direction(*bases[j], at_b), nearest});
        const Vec3 x = sample_points(positions[i], approach.s.transpose()).row(0).transpose();
        gap.distance = approach.distance;
        // Where they cross, the least distance is zero up to rounding and has no side.
        constexpr double touching = 1e-5;  // of the spacing: what the search for a zero distance leaves
        gap.crossing = gap.distance < touching * b.spacing[at_b] || nearest_point(positions[j], x, approach.t).inside;
      }
      if (!gap.crossing && apart.isZero(0))  // boxes overlap: one may hold the other, or they may cross by far
        gap.crossing = winding(b, a.points.row(0).transpose()) > 0.5 || winding(a, b.points.row(0).transpose()) > 0.5;
      if (!gap.crossing)
        for (Eigen::Index k = 0; k < a.points.rows() && !gap.crossing; k += 7)
          if (distance_to_box(a.points.row(k).transpose(), b.low, b.high) == 0)
            gap.crossing = winding(b, a.points.row(k).transpose()) > 0.9;
      if (gap.crossing) gap.distance = 0;
      if (gap.distance < gaps[i].distance) gaps[i] = gap;
    }
  });
  for (const Gap& gap : gaps)
    if (gap.distance < best.distance) best = gap;
  return best;
}

}  // namespace sim
