// Plans for real orthonormal spherical harmonics: synthesis and analysis on Gauss-Legendre x uniform grids
// (Eqs. (8)-(15)), first and second derivatives (24), interpolation between grids (23).
#pragma once

#include "sim/core/types.h"
#include "sim/sphere/legendre.h"

#include <memory>

namespace sim {

/// A scalar or vector field on a grid with its first derivatives in theta and phi.
struct FirstDerivatives {
  Matrix value, t, f;  ///< points x fields
};
/// ... and second derivatives.
struct SecondDerivatives {
  Matrix value, t, f, tt, tf, ff;  ///< points x fields
};

/// Plan: degree p on the q-grid (q >= p). Immutable after construction, safe to share between threads.
class Basis {
 public:
  Basis(int order, int grid_order);
  ~Basis();
  Basis(Basis&&) noexcept;
  Basis(const Basis&) = delete;

  int order() const;       ///< p
  int grid_order() const;  ///< q
  int latitudes() const;   ///< q + 1
  int longitudes() const;  ///< 2q + 2
  int points() const;      ///< latitudes * longitudes
  const Vector& theta() const;
  const Vector& phi() const;
  const Vector& weights() const;    ///< quadrature weights of all points over the unit sphere; their sum is 4 pi
  const Vector& sin_theta() const;  ///< sin(theta) of all points

  GridValues synthesize(const Coefficients&) const;
  FirstDerivatives first(const Coefficients&) const;
  SecondDerivatives second(const Coefficients&) const;
  SecondDerivatives derivatives(const Coefficients&) const;  ///< all but the value
  FirstDerivatives slopes(const Coefficients&) const;        ///< t and f only
  SecondDerivatives curvatures(const Coefficients&) const;   ///< tt, tf and ff only
  Coefficients analyze(const GridValues&) const;
  Coefficients analyze(const Eigen::Ref<const Matrix>& samples) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

/// The point of the unit sphere at colatitude theta and longitude phi.
Vec3 unit_vector(double theta, double phi);
/// ... of a grid point, and of every one, as rows.
Vec3 grid_direction(const Basis&, Eigen::Index point);
Matrix grid_directions(const Basis&);

/// Orthonormal tangents of the unit sphere at s, in the directions of increasing theta and phi.
struct SphereFrame {
  Vec3 e_theta, e_phi;
  double sin_theta;  ///< at least 1e-150, so that the poles have frames too
};
SphereFrame sphere_frame(const Vec3& s);

/// Zero-padded or truncated to degree p.
Coefficients resized(const Coefficients&, int order);

/// Value and first derivatives at every (theta_i, phi_j), row i + theta.size() * j. Any angles, poles included
/// (d_phi is 0 there; at a pole the two tangents are d_theta at phi = 0 and at phi = pi/2).
FirstDerivatives sample_grid(const Coefficients&, const Vector& theta, const Vector& phi);

/// All basis functions of degree <= p at arbitrary points of the unit sphere, given as rows: count x (p+1)^2.
Matrix basis_functions(int p, const Matrix& directions);
/// Value at arbitrary points of the unit sphere, given as rows of unit vectors: count x fields.
Matrix sample_points(const Coefficients&, const Matrix& directions);
/// Value and derivatives in theta and phi at arbitrary points (not at the poles themselves).
FirstDerivatives sample_points_first(const Coefficients&, const Matrix& directions);

}  // namespace sim
