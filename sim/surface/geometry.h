// Geometry of a surface x(theta, phi) on a grid: first and second fundamental form, normal, mean and Gaussian
// curvature, area element, and the surface gradient (25), divergence (26) and Laplacian built from them. n = x_theta x
// x_phi / W points outward; H = (EN - 2FM + GL)/(2 W^2), so H = -1/R on a sphere and Laplacian x = 2 H n.
#pragma once

#include "sim/sphere/basis.h"

namespace sim {

/// Order of the grid on which all areas and volumes are measured, so that all parts of the program use the same
/// number.
constexpr int measure_order(int p) { return 2 * p + 8; }

struct Geometry {
  SecondDerivatives x;    ///< position and derivatives, points x 3
  Vector E, F, G, W;      ///< first fundamental form, W = sqrt(EG - F^2) (contains sin theta)
  Vector L, M, N;         ///< second fundamental form
  Matrix n;               ///< outward unit normal, points x 3
  Vector H, K;            ///< mean and Gaussian curvature
  Vector dA;              ///< quadrature weights of surface integrals, Eq. (17): w_i mu_j W / sin theta
  Matrix grad_t, grad_f;  ///< (G x_t - F x_f)/W^2 and (E x_f - F x_t)/W^2: gradient = grad_t f_t + grad_f f_f
  Vector lap_tt, lap_tf, lap_ff, lap_t, lap_f;  ///< Laplacian f = lap_tt f_tt + ... + lap_f f_f, pointwise
};

/// Position: 3 fields. Throws std::domain_error when the area element vanishes or is not finite.
Geometry geometry(const Basis&, const Coefficients& position);

/// Eq. (25): points x 3.
Matrix surface_gradient(const Geometry&, const FirstDerivatives& scalar);
/// Eq. (26) of a vector field given by its derivatives in theta and phi (points x 3 each).
Vector surface_divergence(const Geometry&, const Matrix& u_t, const Matrix& u_f);
/// Laplacian of a scalar, from its derivatives on the same grid; nothing is projected in between.
Vector surface_laplacian(const Geometry&, const SecondDerivatives& scalar);

/// Integral of a scalar over the surface, Eq. (17).
inline double integrate(const Geometry& g, const Vector& f) { return g.dA.dot(f); }

/// Area, enclosed volume, volume centroid and second moments M = int (x-c)(x-c)^T dV, bending energy integral.
struct Measures {
  double area = 0, volume = 0;
  Vec3 centroid = Vec3::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double h_squared = 0;  ///< int H^2 dA; the energy is kappa_b times this, E/(8 pi kappa) is this / (4 pi)
};
Measures measures(const Geometry&);

/// Area and volume alone, from first derivatives.
struct AreaVolume {
  double area = 0, volume = 0;
};
AreaVolume area_volume(const Basis&, const Coefficients& position);

/// Angle of the longest axis in the (x, z) plane of a shear flow, from x towards z, by second moments M:
/// atan2(2 M_xz, M_xx - M_zz)/2 in (-pi/2, pi/2].
double inclination(const Eigen::Matrix3d& moments);

/// nu = V / ((4 pi/3) (A/4 pi)^(3/2)).
double reduced_volume(double area, double volume);

}  // namespace sim
