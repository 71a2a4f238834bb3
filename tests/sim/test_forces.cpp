#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;
using test::pi;

namespace {

double energy(const Basis& basis, const Coefficients& x) { return measures(geometry(basis, x)).h_squared; }

}  // namespace

TEST_CASE("the bending force is minus the gradient of the bending energy") {
  const int p = 8, q = 40;
  const Coefficients x = test::potato(p), v = test::smooth_field(p, 5, 3, 21);
  const Basis field(p, q), full(q, q);
  const Geometry g = geometry(field, x);
  const double kappa = 0.7;
  const Matrix f = bending_force({field, full}, g, kappa);
  const double power = integrate(g, f.cwiseProduct(field.synthesize(v).values).rowwise().sum());
  const double h = 1e-4;
  const auto moved = [&](double s) { return energy(field, {p, x.values + s * v.values}); };
  // Fourth-order difference: error h^4 times a fifth derivative.
  const double slope = (8 * (moved(h) - moved(-h)) - (moved(2 * h) - moved(-2 * h))) / (12 * h);
  CHECK(power == Approx(-kappa * slope).epsilon(1e-6));
}

TEST_CASE("the tension force is dual to the surface divergence") {
  const int p = 8, q = 40;
  const Coefficients x = test::potato(p), u = test::smooth_field(p, 6, 3, 4), sigma = test::smooth_field(p, 6, 1, 5);
  const Basis field(p, q), full(q, q);
  const Geometry g = geometry(field, x);
  const FirstDerivatives d = field.first(u);
  const double left = integrate(g, field.synthesize(sigma).values.col(0).cwiseProduct(surface_divergence(g, d.t, d.f)));
  const double right = -integrate(g, tension_force({field, full}, g, sigma).cwiseProduct(d.value).rowwise().sum());
  CHECK(left == Approx(right).epsilon(1e-8));
}

TEST_CASE("the linear change of H is its first variation, and a rigid motion leaves H alone") {
  const int p = 8, q = 40;
  const Coefficients x = test::potato(p), v = test::smooth_field(p, 5, 3, 21);
  const Basis field(p, q), full(q, q);
  const Geometry g = geometry(field, x);
  const Matrix slope = curvature_gradient({field, full}, g);
  const Vector change = curvature_change(full, g, slope, field.synthesize(v).values);
  const auto moved = [&](double s) { return geometry(field, {p, x.values + s * v.values}).H; };
  const double h = 1e-3;
  // Fourth-order difference at fixed parameters, that is at material points.
  const Vector exact = (8 * (moved(h) - moved(-h)) - (moved(2 * h) - moved(-2 * h))) / (12 * h);
  CHECK((change - exact).cwiseAbs().maxCoeff() < 1e-5 * exact.cwiseAbs().maxCoeff());
  Matrix rigid(field.points(), 3);
  for (Eigen::Index k = 0; k < rigid.rows(); ++k)
    rigid.row(k) =
        Vec3(0.3, -1, 0.7).cross(Vec3(g.x.value.row(k).transpose())).transpose() + Eigen::RowVector3d(1, 2, 3);
  CHECK(curvature_change(full, g, slope, rigid).cwiseAbs().maxCoeff() < 1e-5 * g.H.cwiseAbs().maxCoeff());
}

TEST_CASE("a sphere feels no bending force, and a constant tension presses it by 2 sigma / R") {
  const int p = 8, q = 16;
  VesicleParameters v = test::vesicle("sphere", 1, p);
  v.radius = 2;
  const Coefficients x = initial_position(v);
  const Basis field(p, q), full(q, q);
  const Geometry g = geometry(field, x);
  CHECK(bending_force({field, full}, g, 1).cwiseAbs().maxCoeff() < 1e-11);
  Coefficients sigma{p, Matrix::Zero(coefficient_count(p), 1)};
  sigma.values(0, 0) = 3 * std::sqrt(4 * pi);
  CHECK((tension_force({field, full}, g, sigma) + 3 * g.n).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("membrane forces exert neither a net force nor a net torque") {
  const int p = 10, q = 50;
  const Coefficients x = test::potato(p), sigma = test::smooth_field(p, 4, 1, 8);
  const Basis field(p, q), full(q, q);
  const Geometry g = geometry(field, x);
  const Matrix f = bending_force({field, full}, g, 0.3) + tension_force({field, full}, g, sigma);
  Vec3 force = f.transpose() * g.dA, torque = Vec3::Zero();
  for (Eigen::Index k = 0; k < f.rows(); ++k)
    torque += g.dA[k] * Vec3(g.x.value.row(k).transpose()).cross(Vec3(f.row(k).transpose()));
  CHECK(force.norm() < 1e-6);
  CHECK(torque.norm() < 1e-6);
}

TEST_CASE(
    "every flow of the catalogue is free of divergence and driven by at most a constant gradient of pressure, streams "
    "by "
    "a force along them") {
  FlowParameters f;
  f.rate = 1.3, f.curvature = 0.4, f.centreline_velocity = 2, f.angular_velocity = {1, 2, 3}, f.velocity = {4, 5, 6};
  f.wavelength = 6;
  const double h = 1e-3;
  for (const auto& row : flow_catalogue())
    for (const bool planar : {true, false}) {
      INFO(row.name);
      f.planar = planar;
      const auto u = [&](const Vec3& x) { return row.function(f, x); };
      const auto divergence = [&](const Vec3& at) {
        double sum = 0;
        for (int d = 0; d < 3; ++d) sum += (u(at + h * Vec3::Unit(d))[d] - u(at - h * Vec3::Unit(d))[d]) / (2 * h);
        return sum;
      };
      const auto laplacian = [&](const Vec3& at) {
        Vec3 sum = Vec3::Zero();
        for (int d = 0; d < 3; ++d)
          sum += (u(at + h * Vec3::Unit(d)) + u(at - h * Vec3::Unit(d)) - 2 * u(at)) / (h * h);
        return sum;
      };
      const Vec3 here(0.3, -0.7, 1.1), there(-1.4, 0.2, 0.6);
      CHECK(std::abs(divergence(here)) < 1e-11);
      CHECK(std::abs(divergence(there)) < 1e-11);
      if (row.name == "streams") {  // the force on the fluid; differences of second order err by (k h)^2/12
        const double force = 8 * test::pi * test::pi / 36;
        for (const Vec3& x : {here, there}) CHECK((laplacian(x) + force * u(x)).norm() < 1e-6 * force);
        continue;
      }
      // The gradient of a pressure, which is the same everywhere.
      CHECK((laplacian(here) - laplacian(there)).norm() < 1e-8);
    }
}

TEST_CASE("flows add up and follow their time factors") {
  FlowParameters a = test::shear(2), b = test::shear(3), c = test::shear(5);
  b.time_factor = "oscillating";
  b.frequency = 0.5;
  c.time_factor = "step";
  c.from = 1;
  c.until = 2;
  const std::vector<FlowParameters> flows{a, b, c};
  const Matrix at = Vec3(0, 0, 1).transpose();
  CHECK(background_velocity(flows, 0, at)(0, 0) == Approx(5));
  CHECK(background_velocity(flows, 1, at)(0, 0) == Approx(2 - 3 + 5));
  CHECK(background_velocity(flows, 2, at)(0, 0) == Approx(2 + 3));
}
