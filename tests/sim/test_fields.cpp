// Fields of a membrane against spheres, ellipsoids and rigid motions.
#include "sim/measures/fields.h"

#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;

namespace {

constexpr int order = 8;

VesicleState at(const Coefficients& position, const Vec3& centre) {
  VesicleState v;
  v.position = position;
  v.position.values += test::constant_field(position.order, centre).values;
  v.velocity = test::constant_field(position.order, Vec3::Zero());
  v.tension = {position.order, Matrix::Zero(coefficient_count(position.order), 1)};
  return v;
}

State state_of(std::vector<VesicleState> vesicles) {
  State s;
  s.vesicles = std::move(vesicles);
  return s;
}

/// Samples of the field and of the surface at the same points.
struct Samples {
  Vector field;
  Matrix points, normals;
};

Samples samples(std::string_view name, const State& state, double modulus = 0.02) {
  Plans plans;
  const Coefficients f = membrane_field(plans, find_field(name), state, 0, modulus);
  const Vector theta = Vector::LinSpaced(9, 0.2, 2.9), phi = Vector::LinSpaced(7, 0.1, 6.0);
  const FirstDerivatives x = sample_grid(state.vesicles[0].position, theta, phi);
  Samples s{sample_grid(f, theta, phi).value.col(0), x.value, x.value};
  for (Eigen::Index k = 0; k < s.normals.rows(); ++k) {
    const Vec3 t = x.t.row(k), p = x.f.row(k);
    s.normals.row(k) = t.cross(p).normalized().transpose();
  }
  return s;
}

}  // namespace

TEST_CASE("on a sphere of radius R the mean curvature is 1/R, the Gaussian 1/R^2, and bending exerts no force") {
  const double radius = 1.7;
  const State state = state_of({at(test::ellipsoid(Vec3::Constant(radius), order), {3, -1, 2})});
  const auto largest = [](const Vector& v) { return v.cwiseAbs().maxCoeff(); };
  CHECK(largest(samples("mean-curvature", state).field.array() - 1 / radius) < 1e-11);
  CHECK(largest(samples("gaussian-curvature", state).field.array() - 1 / (radius * radius)) < 1e-11);
  CHECK(largest(samples("bending-force", state).field) < 1e-9);  // fourth derivatives of rounding errors
}

TEST_CASE("curvatures of an ellipsoid are the exact ones") {
  const Vec3 a(1.3, 0.9, 1.1);
  const State state = state_of({at(test::ellipsoid(a, order), Vec3::Zero())});
  const Samples k = samples("gaussian-curvature", state), h = samples("mean-curvature", state);
  for (Eigen::Index i = 0; i < k.field.size(); ++i) {
    const Vec3 x = k.points.row(i);
    const double q = (x.array() / a.array().square()).matrix().squaredNorm(), product = a.prod() * a.prod();
    const double gaussian = 1 / (product * q * q);
    const double mean = (a.squaredNorm() - x.squaredNorm()) / (2 * product * std::pow(q, 1.5));
    CHECK(k.field[i] == Approx(gaussian).epsilon(1e-4));  // degree 24 resolves them to this
    CHECK(h.field[i] == Approx(mean).epsilon(1e-4));
  }
}

TEST_CASE("the tension is that of the state, and a constant one on a sphere presses with 2 sigma / R") {
  const double radius = 1.4, sigma = 0.6;
  State state = state_of({at(test::ellipsoid(Vec3::Constant(radius), order), Vec3::Zero())});
  state.vesicles[0].tension = {order, test::constant_field(order, Vec3::Constant(sigma)).values.leftCols(1)};
  CHECK((samples("tension", state).field.array() - sigma).abs().maxCoeff() < 1e-12);
  CHECK((samples("tension-force", state).field.array() - 2 * sigma / radius).abs().maxCoeff() < 1e-10);
}

TEST_CASE(
    "a vesicle that moves as a whole has no velocity relative to itself, and one that turns only along the membrane") {
  const Vec3 spin(0, 0.7, 0), drift(5, 1, -2);
  State state = state_of({at(test::ellipsoid(Vec3::Constant(1.2), order), Vec3::Zero())});
  VesicleState& v = state.vesicles[0];
  v.velocity.values = test::cross_rows(spin, v.position.values) + test::constant_field(order, drift).values;
  CHECK(samples("normal-velocity", state).field.cwiseAbs().maxCoeff() < 1e-11);
  const Samples speed = samples("membrane-speed", state);
  for (Eigen::Index i = 0; i < speed.field.size(); ++i) {
    const double exact = spin.cross(Vec3(speed.points.row(i))).norm();
    CHECK(speed.field[i] == Approx(exact).margin(0.01));  // the modulus has a kink on the axis of rotation
  }
}

TEST_CASE("the distance between two spheres is known at every point, near and far") {
  for (const double gap : {0.01, 0.4, 3.0}) {
    const double radius = 0.8;
    const Vec3 other(0, 0.6 * (1 + radius + gap), 0.8 * (1 + radius + gap));
    const State state = state_of({at(test::ellipsoid(Vec3::Ones(), order), Vec3::Zero()),
                                  at(test::ellipsoid(Vec3::Constant(radius), order), other)});
    const Samples s = samples("neighbour-distance", state);
    for (Eigen::Index i = 0; i < s.field.size(); ++i) {
      const double exact = (Vec3(s.points.row(i)) - other).norm() - radius;
      INFO("gap " << gap);
      CHECK(s.field[i] == Approx(exact).margin(2e-3));
    }
  }
}

TEST_CASE("a lone vesicle has no neighbour, and an unknown field is answered with the nearest name") {
  Plans plans;
  const State state = state_of({at(test::ellipsoid(Vec3::Ones(), order), Vec3::Zero())});
  CHECK_THROWS_WITH(membrane_field(plans, find_field("neighbour-distance"), state, 0, 1),
                    Catch::Contains("two vesicles"));
  CHECK_THROWS_WITH(find_field("tenson"), Catch::Contains("did you mean 'tension'"));
}
