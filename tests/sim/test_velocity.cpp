// The velocity between and inside of the membranes against closed forms, and against the membranes' own velocity.
#include "sim/suspension/velocity.h"

#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;

namespace {

constexpr double pi = test::pi;

Scene scene_of(double lambda, const Eigen::Matrix3d& gradient, const std::string& shape, double nu, int order) {
  Scene scene;
  scene.vesicles = {test::vesicle(shape, nu, order, lambda)};
  // A linear flow as the sum of two of the catalogue's: planar extension and a rotation.
  FlowParameters strain, turn;
  strain.kind = "extension";
  strain.rate = gradient(0, 0);
  strain.planar = true;
  turn.kind = "rotation";
  turn.angular_velocity = {0, (gradient(0, 2) - gradient(2, 0)) / 2, 0};
  scene.flows = {strain, turn};
  return scene;
}

State solved(Plans& plans, const Scene& scene) {
  const Model model = make_model(scene, plans);
  return evaluate(model, initial_dynamics(model)).value();
}

/// The same of one vesicle by the equations (3a)-(3b) alone, which let a sphere stretch.
State solved_alone(Plans& plans, const Scene& scene) {
  const Model model = make_model(scene, plans);
  State state = solved(plans, scene);
  VesicleState& v = state.vesicles[0];
  const Membrane m = freeze_membrane(plans, model.materials[0], v.position, 2, 0);
  const Solve s =
      solve_system(m, 0, test::forcing(m, scene.flows, Vec3::Zero()), test::at_rest(v.position.order), 1e-12);
  v.velocity = s.motion.velocity;
  v.tension = s.motion.tension;
  return state;
}
const FlowFieldOptions stretching{.hold_spheres = false};

/// Points at `distance` from the membrane (negative: inside) above a few parameters, and the membrane's velocity there.
struct Beside {
  Matrix points, membrane;
};
Beside beside(const VesicleState& v, double distance) {
  Matrix s(6, 3);
  s << 0.1, 0.2, 1, 1, 0.1, 0, 0.5, -0.7, 0.3, -0.4, 0.2, -0.8, 0.3, 1, 0.6, -1, -0.2, 0.4;
  s.rowwise().normalize();
  const FirstDerivatives x = sample_points_first(v.position, s);
  Beside b{x.value, sample_points(v.velocity, s)};
  for (Eigen::Index k = 0; k < s.rows(); ++k) {
    const Vec3 t = x.t.row(k), f = x.f.row(k);
    b.points.row(k) += distance * t.cross(f).normalized().transpose();
  }
  return b;
}

/// Velocity round an inextensible or fluid sphere whose surface moves with u_s = a (x.E.x) x + b E.x in the flow E.x:
/// the exterior solution is the sum of a stresslet and a potential quadrupole.
Vec3 outside_sphere(const Eigen::Matrix3d& e, double a, double b, const Vec3& x) {
  const double r = x.norm(), q = x.dot(e * x), r5 = std::pow(r, 5), r7 = std::pow(r, 7);
  // u = E.x + A q x / r^5 + B (2 E.x / r^5 - 5 q x / r^7): at r = 1 the E.x term is 1 + 2B = b, the x term A - 5B = a.
  const double big_b = (b - 1) / 2, big_a = a + 5 * big_b;
  return e * x + big_a * q / r5 * x + big_b * (2 / r5 * (e * x) - 5 * q / r7 * x);
}

}  // namespace

TEST_CASE("a sphere that cannot stretch disturbs a straining flow as the closed form says, outside") {
  const Eigen::Matrix3d e = Vec3(0.7, 0, -0.7).asDiagonal();
  Plans plans;
  for (const double lambda : {1.0, 5.0}) {
    const Scene scene = scene_of(lambda, e, "sphere", 1, 8);
    const FlowField field = flow_field(plans, scene, solved_alone(plans, scene), stretching);
    Matrix x(7, 3);
    x << 1.002, 0, 0, 0.8, 0.5, 0.6, 0, -1.3, 0.4, 1.4, 0.3, -1.1, 3, -2, 1, 0.02, 0.01, 1.03, 12, 3, -9;
    const FlowSamples u = velocity_at(field, x);
    const double k = 60 / (32 + 23 * lambda);  // design: u_s = k [(x.E.x) x + (2/3)(E.x - (x.E.x) x)]
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Vec3 exact = outside_sphere(e, k / 3, 2 * k / 3, x.row(i).transpose());
      INFO("λ = " << lambda << " at " << x.row(i));
      CHECK(u.within[static_cast<std::size_t>(i)] == -1);
      CHECK((Vec3(u.velocity.row(i)) - exact).norm() < 2e-6);  // of the near rule
    }
  }
}

TEST_CASE("inside a sphere that cannot stretch the fluid moves as its surface demands") {
  // Interior solution with u = a q x + b E.x on r = 1: E.x (c0 + c1 r^2) + c2 q x, free of divergence:
  // div = 2 c1 q + 5 c2 q = 0, c2 = a, so c1 = -5a/2 and c0 = b - c1.
  const Eigen::Matrix3d e = Vec3(0.7, 0, -0.7).asDiagonal();
  Plans plans;
  for (const double lambda : {1.0, 5.0}) {
    const Scene scene = scene_of(lambda, e, "sphere", 1, 8);
    const FlowField field = flow_field(plans, scene, solved_alone(plans, scene), stretching);
    Matrix x(6, 3);
    x << 0, 0, 0, 0.5, -0.2, 0.3, 0, 0.9, 0.1, 0.6, 0.4, -0.66, 0.3, 0.1, 0.1, 0.997, 0, 0;
    const FlowSamples u = velocity_at(field, x);
    const double k = 60 / (32 + 23 * lambda), a = k / 3, b = 2 * k / 3;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Vec3 p = x.row(i).transpose();
      const Vec3 exact = (b + 2.5 * a * (1 - p.squaredNorm())) * (e * p) + a * p.dot(e * p) * p;
      INFO("λ = " << lambda << " at " << x.row(i));
      CHECK(u.within[static_cast<std::size_t>(i)] == 0);
      CHECK((Vec3(u.velocity.row(i)) - exact).norm() < 2e-6);
    }
  }
}

TEST_CASE("a vesicle in a rigid rotation turns with it, and so does the fluid in and round it") {
  Eigen::Matrix3d spin = Eigen::Matrix3d::Zero();
  spin(0, 2) = 0.8;
  spin(2, 0) = -0.8;
  Plans plans;
  for (const double lambda : {1.0, 10.0}) {
    Scene scene = scene_of(lambda, spin, "biconcave", 0.65, 10);
    scene.vesicles[0].bending_modulus = 0;  // no force: the exact solution for every λ
    State state = solved(plans, scene);
    VesicleState& v = state.vesicles[0];
    v.tension.values.setZero();
    const Basis& basis = plans.basis(10, 11);
    const Coefficients turning = basis.analyze(test::cross_rows({0, 0.8, 0}, basis.synthesize(v.position).values));
    CHECK((v.velocity.values - turning.values).norm() < 0.02 * turning.values.norm());  // D at p = 10 is right to 1 %
    v.velocity = turning;
    const FlowField field = flow_field(plans, scene, state);
    for (const double distance : {-0.1, -0.02, 0.01, 0.3, 2.0}) {
      const Matrix x = beside(state.vesicles[0], distance).points;
      const FlowSamples u = velocity_at(field, x);
      const Matrix exact = test::cross_rows({0, 0.8, 0}, x);
      INFO("λ = " << lambda << " at a distance of " << distance);
      CHECK((u.velocity - exact).rowwise().norm().maxCoeff() <
            1e-3);  // λ - 1 = 9 times the near rule's 1e-4 on a bent shape
    }
  }
}

TEST_CASE("a drop without tension deforms in a straining flow by 5/(2λ + 3)") {
  const Eigen::Matrix3d e = Vec3(0.7, 0, -0.7).asDiagonal();
  constexpr double lambda = 4;
  Plans plans;
  Scene scene = scene_of(lambda, e, "sphere", 1, 8);
  scene.vesicles[0].bending_modulus = 0;
  // f = 0: the surface moves with u = A (x.E.x) x + B E.x; normal part 5/(2λ+3). Known from the single-phase moments:
  // u.n = (A + B) x.E.x. Solve (3a) for the dual layer alone by fixed-point iteration with the field itself.
  const Model model = make_model(scene, plans);
  State state = evaluate(model, initial_dynamics(model)).value();
  VesicleState& v = state.vesicles[0];
  v.tension.values.setZero();
  const Basis& basis = plans.basis(8, 9);
  const Membrane m = freeze_membrane(plans, model.materials[0], v.position, 2, 0);
  const Coefficients background =
      basis.analyze(background_velocity(scene.flows, 0, basis.synthesize(v.position).values));
  for (int k = 0; k < 200; ++k)  // (1+λ)/2 u = u_inf + (1-λ) D u: contracts with 3/5 · 1.5/2.5
    v.velocity.values =
        (background.values + (1 - lambda) * m.layers.dual.apply(v.velocity).values) / ((1 + lambda) / 2);
  const FlowField field = flow_field(plans, scene, state, stretching);
  Matrix x(4, 3);
  x << 1.0005, 0, 0, 0, 0, -1.0005, 0.9996, 0, 0, 0, 0, 0.9996;
  const FlowSamples u = velocity_at(field, x);
  for (Eigen::Index i = 0; i < 4; ++i) {
    const Vec3 n = Vec3(x.row(i).transpose()).normalized();
    CHECK(u.velocity.row(i).dot(n) ==
          Approx(5 / (2 * lambda + 3) * n.dot(e * n)).epsilon(2e-3));  // 5e-4 off the surface
  }
}

TEST_CASE("the velocity is continuous across the membrane and meets the membrane's own") {
  Plans plans;
  for (const double lambda : {1.0, 8.0}) {
    Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 12, lambda), 0.1, 1);
    scene.vesicles[0].axis = Vec3(1, 0, 0.5);
    const State state = solved(plans, scene);
    const FlowField field = flow_field(plans, scene, state);
    for (const double distance : {-1e-3, 1e-3, 1e-12}) {
      const Beside b = beside(state.vesicles[0], distance);
      const FlowSamples u = velocity_at(field, b.points);
      INFO("λ = " << lambda << ", distance " << distance);
      // The slope times 1e-3, and what the projection on degree p leaves out of the surface velocity.
      CHECK((u.velocity - b.membrane).rowwise().norm().maxCoeff() < 6e-3);
      for (const double away : u.distance) CHECK(away == Approx(std::abs(distance)).margin(1e-6));
    }
    // Far rule and near rule meet where one takes over from the other: the same point, with other spacings.
    const Beside b = beside(state.vesicles[0], 0.25);
    FlowFieldOptions near;
    near.spacings = 12;
    const FlowField by_near = flow_field(plans, scene, state, near);
    CHECK((velocity_at(field, b.points).velocity - velocity_at(by_near, b.points).velocity).norm() < 1e-5);
  }
}

TEST_CASE("two vesicles: each point sees both, and the fluid conserves its volume") {
  Plans plans;
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 8, 4), 0.1, 1);
  scene.vesicles.push_back(scene.vesicles[0]);
  scene.vesicles[0].center = {-1.2, 0, 0.5};
  scene.vesicles[1].center = {1.2, 0, -0.5};
  const State state = solved(plans, scene);
  const FlowField field = flow_field(plans, scene, state);
  for (const Vec3& at : {Vec3(0, 0.3, 1.4), Vec3(-1.2, 0.1, 0.6), Vec3(0, 0, 0), Vec3(2, 0, 1)})
    CHECK(std::abs(test::divergence(field, at)) < 1e-3);  // differences of 1e-6 over 2e-3
  // Point symmetry: u(-x) = -u(x).
  Matrix x(2, 3);
  x << 0.4, 0.2, 0.9, -0.4, -0.2, -0.9;
  const Matrix u = velocity_at(field, x).velocity;
  CHECK((u.row(0) + u.row(1)).norm() < 1e-8);
  CHECK((centroid_velocity(plans, state.vesicles[0]) + centroid_velocity(plans, state.vesicles[1])).norm() < 1e-8);
}

TEST_CASE("the centroid of a translating vesicle moves with it") {
  Plans plans;
  VesicleState v;
  v.position = test::potato(8);
  v.velocity = test::constant_field(8, {0.3, -2, 1});
  CHECK((centroid_velocity(plans, v) - Vec3(0.3, -2, 1)).norm() < 1e-10);
}
