#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;
using test::pi;

namespace {

/// A sphere of area 4 pi with bumps a_n Y_n0, up to the scaling that keeps the area.
Coefficients bumpy_sphere(int order, const std::vector<std::pair<int, double>>& modes) {
  VesicleParameters v;
  v.shape = "harmonics";
  for (const auto& [n, a] : modes) v.coefficients.push_back({double(n), 0, a});
  v.order = order;
  v.axis = Vec3(0, 0, 1);
  return initial_position(v);
}

/// Amplitude of Y_n0 in the radial velocity.
double radial_rate(const Basis& basis, const Matrix& velocity, const Geometry& g, int n) {
  const Vector radial = velocity.cwiseProduct(g.x.value).rowwise().sum().cwiseQuotient(g.x.value.rowwise().norm());
  return basis.analyze(Matrix(radial)).values(coefficient_index(n, 0), 0);
}

/// Amplitude of Y_n0 in the radius.
double amplitude(const Basis& basis, const Geometry& g, int n) {
  return basis.analyze(Matrix(g.x.value.rowwise().norm())).values(coefficient_index(n, 0), 0);
}

}  // namespace

TEST_CASE("a nearly spherical drop relaxes at the rate -40 (lambda+1)/((2 lambda+3)(19 lambda+16)) gamma/mu") {
  const int p = 8, nc = coefficient_count(p);
  const Coefficients x = bumpy_sphere(p, {{2, 1e-4}});
  Plans plans;
  for (const double lambda : {0.2, 1.0, 5.0}) {
    const Membrane m = freeze_membrane(plans, {lambda, 0, 0}, x, 3, 2 * p);
    Motion still = test::at_rest(p);
    still.tension.values(0, 0) = std::sqrt(4 * pi);  // gamma = 1
    const Coefficients force = implicit_force(m, 0, still);
    const Coefficients right = m.layers.single.apply(force);
    const auto left = [&](const Vector& y) {
      const Coefficients u{p, y.reshaped(nc, 3)};
      Matrix v = m.material.alpha() * u.values;
      if (lambda != 1) v -= (1 - lambda) * m.layers.dual.apply(u).values;
      return Vector(v.reshaped());
    };
    const GmresResult s = gmres(
        left, [](const Vector& v) { return v; }, right.values.reshaped(), Vector::Zero(3 * nc), 1e-13, 80);
    const Matrix u = m.bases.field.synthesize({p, s.solution.reshaped(nc, 3)}).values;
    const double rate = radial_rate(m.bases.field, u, m.geometry, 2) / amplitude(m.bases.field, m.geometry, 2);
    const double radius = m.radius;  // the rate goes with 1/R
    CHECK(rate * radius == Approx(-40 * (lambda + 1) / ((2 * lambda + 3) * (19 * lambda + 16))).epsilon(1e-3));
  }
}

TEST_CASE("two modes of a nearly spherical vesicle relax at the exact rates, with the tension that keeps the area") {
  const int p = 10;
  const std::vector<std::pair<int, double>> modes{{2, 4e-4}, {4, 3e-4}};
  const Coefficients x = bumpy_sphere(p, modes);
  Plans plans;
  for (const double lambda : {0.3, 1.0, 6.0}) {
    const Membrane m = freeze_membrane(plans, {lambda, 1, 0}, x, 3, 2 * p);
    const Solve s = solve_system(m, 0, test::forcing(m, {}, Vec3::Zero()), test::at_rest(p), 1e-12);
    REQUIRE(s.converged);
    const Matrix u = m.bases.field.synthesize(s.motion.velocity).values;
    // Rate of a_n: -(kappa_b / 2 mu R^3) k_n (n(n+1) + s), k_n = (n-1)n(n+1)(n+2)/D_n; s from sum (n-1)(n+2) a_n a_n' =
    // 0.
    const auto k = [&](double n) {
      return (n - 1) * n * (n + 1) * (n + 2) /
             (2 * n * n * n + 3 * n * n + 4 + lambda * (2 * n * n * n + 3 * n * n - 5));
    };
    double top = 0, bottom = 0;
    for (const auto& [n, ignored] : modes) {
      const double a = amplitude(m.bases.field, m.geometry, n), w = (n - 1) * (n + 2) * a * a * k(n);
      top += w * n * (n + 1);
      bottom += w;
    }
    const double tension = -top / bottom;
    for (const auto& [n, ignored] : modes) {
      const double a = amplitude(m.bases.field, m.geometry, n);
      const double expected = -0.5 / std::pow(m.radius, 3) * k(n) * (n * (n + 1) + tension) * a;
      CHECK(radial_rate(m.bases.field, u, m.geometry, n) == Approx(expected).epsilon(5e-3));  // next order: a few a_n
    }
  }
}
