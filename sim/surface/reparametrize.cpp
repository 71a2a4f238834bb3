#include "sim/surface/reparametrize.h"

#include "sim/sphere/norms.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sim {

Vec3 parameter_shift(const Vec3& e1, const Vec3& e2, const Vec3& a, const Vec3& b, const Vec3& shift) {
  const double aa = a.dot(a), ab = a.dot(b), bb = b.dot(b), det = aa * bb - ab * ab;
  const double u = a.dot(shift), v = b.dot(shift);
  return ((bb * u - ab * v) * e1 + (aa * v - ab * u) * e2) / det;
}

namespace {

/// The same from derivatives in the angles.
Vec3 parameter_shift(const SphereFrame& frame, const Vec3& x_t, const Vec3& x_f, const Vec3& shift) {
  return sim::parameter_shift(frame.e_theta, frame.e_phi, x_t, x_f / frame.sin_theta, shift);
}

}  // namespace

/// Weight of the degrees p/2..p in E, where those beyond p have 1. Measured on twisted prolates at p = 8, 12, 16:
/// against equal weights it gains somewhat less and loses six times less of the shape.
constexpr double weight_kept = 0.1;

double high_degree_share(const Coefficients& x) { return tail_share(x, (x.order + 1) / 2); }

Relabelling relabel(Plans& plans, const Coefficients& x, int grid_order, double stop, int most) {
  const int p = x.order, cutoff = (p + 1) / 2;
  const Basis& basis = plans.basis(grid_order, grid_order);
  const double scale = band_norm(x, 1, p);
  Relabelling r;
  Matrix map = grid_directions(basis);
  double first_gradient = -1, least = -1, step = 1;
  Matrix best_map = map, direction;
  for (int iteration = 0; iteration <= most; ++iteration) {
    const FirstDerivatives y = sample_points_first(x, map);
    Coefficients gradient = basis.analyze(y.value);
    const double kept = band_norm(gradient, cutoff, p), lost = band_norm(gradient, p + 1, grid_order);
    const double energy = weight_kept * kept * kept + lost * lost;
    if (iteration == 0) r.high_before = std::hypot(kept, lost) / scale;
    if (least >= 0 && energy >= least) {  // the step was too long: go back and take half of it
      step /= 2;
      if (step < 0.1) break;
      map = (best_map + step * direction).rowwise().normalized();
      continue;
    }
    least = energy;
    best_map = map;
    r.high_after = std::hypot(kept, lost) / scale;
    r.lost = lost / scale;
    gradient.values.topRows(cutoff * cutoff).setZero();
    gradient.values.middleRows(cutoff * cutoff, coefficient_count(p) - cutoff * cutoff) *= weight_kept;
    const Matrix slope = basis.synthesize(gradient).values;
    double length = 0;
    direction.resize(map.rows(), 3);
    for (Eigen::Index k = 0; k < map.rows(); ++k) {
      const Vec3 s = map.row(k).transpose(), x_t = y.t.row(k).transpose(), x_f = y.f.row(k).transpose();
      const Vec3 g = slope.row(k).transpose(), normal = x_t.cross(x_f).normalized();
      length += (g - g.dot(normal) * normal).squaredNorm() * basis.weights()[k];
      direction.row(k) = parameter_shift(sphere_frame(s), x_t, x_f, -g).transpose();
    }
    map = (best_map + step * direction).rowwise().normalized();
    if (first_gradient < 0) first_gradient = length;
    if (!std::isfinite(length)) throw std::domain_error("reparametrization: the surface is not regular");
    if (length <= stop * stop * first_gradient) break;
  }
  r.map = basis.analyze(best_map);
  return r;
}

Matrix mapped(const Relabelling& r, const Matrix& parameters) {
  return sample_points(r.map, parameters).rowwise().normalized();
}

Matrix mapped(const Relabelling& r, const Basis& basis) { return mapped(r, grid_directions(basis)); }

Coefficients pulled_back(Plans& plans, const Relabelling& r, const Coefficients& f) {
  const Basis& basis = plans.basis(f.order, std::max(r.map.order, f.order));
  return basis.analyze(sample_points(f, mapped(r, basis)));
}

Matrix carried_points(const Relabelling& r, const Coefficients& before, const Coefficients& after,
                      const Matrix& parameters) {
  const Matrix target = sample_points(before, parameters);
  Matrix s = parameters;
  for (int iteration = 0; iteration < 20; ++iteration) {  // inverse of the map: s' <- s' + (s - map(s'))
    s = (s + parameters - mapped(r, s)).rowwise().normalized();
  }
  for (int iteration = 0; iteration < 20; ++iteration) {  // Gauss-Newton onto the nearest point of the new surface
    const FirstDerivatives x = sample_points_first(after, s);
    double longest = 0;
    for (Eigen::Index k = 0; k < s.rows(); ++k) {
      const Vec3 at = s.row(k).transpose(), miss = (target.row(k) - x.value.row(k)).transpose();
      const Vec3 shift = parameter_shift(sphere_frame(at), x.t.row(k).transpose(), x.f.row(k).transpose(), miss);
      longest = std::max(longest, shift.norm());
      s.row(k) = (at + shift).normalized().transpose();
    }
    if (longest < 1e-13) break;
  }
  return s;
}

}  // namespace sim
