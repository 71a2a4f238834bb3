// Values that pass between the modules: coefficients, grid samples, states, diagnostics.
//
// Real orthonormal spherical harmonics Y_nm on the unit sphere, n = 0..p, m = -n..n:
//   m = 0: P_n0(theta)/sqrt(2 pi),  m > 0: P_nm(theta) cos(m phi)/sqrt(pi),  m < 0: P_n|m|(theta) sin(|m| phi)/sqrt(pi)
// with P_nm normalised to unit square integral over cos(theta), without the Condon-Shortley sign (all P_mm >= 0).
// The coefficient of Y_nm stands in row n(n+1) + m, so a lower order is a prefix of a higher one.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <string>
#include <vector>

namespace sim {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Vec3 = Eigen::Vector3d;

/// Number of real coefficients of a scalar of degree p.
constexpr int coefficient_count(int p) { return (p + 1) * (p + 1); }
/// Row of Y_nm among the coefficients; m < 0 is the sine of |m| phi.
constexpr int coefficient_index(int n, int m) { return n * (n + 1) + m; }

/// Spectral coefficients of one or more scalar fields, one field a column: (p+1)^2 x fields.
struct Coefficients {
  int order = 0;
  Matrix values;
};

/// Samples of one or more scalar fields on a q-grid, one field a column: (q+1)(2q+2) x fields.
/// Point (theta_i, phi_j) stands in row i + (q+1) j: latitude runs fastest, theta_0 is nearest to the pole theta = 0.
struct GridValues {
  int order = 0;
  Matrix values;
};

/// One vesicle at one instant. Everything is a function of the parameter s on the unit sphere.
struct VesicleState {
  Coefficients position;         ///< x(s): 3 fields, order p
  Coefficients velocity;         ///< u(s), solves (3a)-(3b) at this very state: 3 fields, order p
  Coefficients tension;          ///< sigma(s): 1 field, order p
  Coefficients labels;           ///< material label, a unit vector (normalise after sampling): 3 fields, own order
  Matrix tracers;                ///< tracer dots: their parameters s as unit vectors, count x 3; the dot is at x(s)
  Coefficients position_before;  ///< previous saved state in *this* parametrisation (first state: = position)
  Coefficients velocity_before;  ///< velocity of its points, likewise; Hermite interpolation uses the two
  /// Velocity of the points s along the membrane, and of the correction of area and volume: x' = velocity + sliding.
  Coefficients sliding;          ///< 3 fields, order p
  std::int64_t relabelled = 0;   ///< how often the parametrisation has been changed since t = 0
  std::int64_t labels_laid = 0;  ///< how often the labels have been laid anew (they then restart as s)
  double labels_laid_time = 0;   ///< when that last happened
};

/// A saved state of the whole scene.
struct State {
  std::int64_t step = 0;
  double time = 0;
  std::vector<VesicleState> vesicles;
};

}  // namespace sim
