// What must be exact: rigid motions, spheres, and units.
#include "sim/measures/diagnostics.h"
#include "sim/membrane/flows.h"
#include "sim/stepping/warnings.h"
#include "sim/suspension/velocity.h"
#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;

namespace {

/// The scene of a prolate, askew, with flows to be added.
Scene lone(double lambda, int order, double step) {
  VesicleParameters v = test::vesicle("prolate", 0.85, order, lambda);
  v.axis = Vec3(1, 0.2, 0.1);
  Scene scene = test::shear_scene(v, step, 1);
  scene.flows.clear();
  return scene;
}

FlowParameters stream(const Vec3& velocity) {
  FlowParameters f;
  f.kind = "uniform";
  f.velocity = velocity;
  return f;
}

FlowParameters rotation(const Vec3& omega) {
  FlowParameters f;
  f.kind = "rotation";
  f.angular_velocity = omega;
  return f;
}

/// What a run of equal steps ends with.
struct End {
  VesicleMeasures measures;
  State state;
};
End end_of(const Scene& scene, double dt, int steps) {
  Plans plans;
  const Model s = make_model(scene, plans);
  const Dynamics d = test::advanced(s, initial_dynamics(s), dt, steps);
  const State state = evaluate(s, d).value();
  return {measure(plans, state.vesicles[0], d.vesicles[0].area, d.vesicles[0].volume), state};
}

}  // namespace

TEST_CASE("the six rigid motions solve the equations of a membrane exactly for every viscosity contrast") {
  Plans plans;
  const Coefficients x = initial_position(lone(1, 8, 0.1).vesicles[0]);
  for (const double lambda : {0.01, 1.0, 1000.0}) {
    const Membrane m = freeze_membrane(plans, {lambda, 0.01, 0}, x, 2, 0);
    for (int k = 0; k < 6; ++k) {
      RigidMotion r;
      (k < 3 ? r.translation : r.rotation)[k % 3] = 1;
      const Coefficients u = rigid_velocity(m.body, r);
      const Coefficients v = double_layer(m, u);
      const Matrix left = m.material.alpha() * u.values - (v.values.size() ? v.values : Matrix(0 * u.values));
      CHECK((left - u.values).norm() < 1e-13 * lambda * u.values.norm() + 1e-12);  // rounding of alpha u
      CHECK(divergence(m, u).values.norm() < 1e-12);
    }
  }
}

TEST_CASE("a velocity is its rigid part and a rest that has none, in any place") {
  VesicleParameters p = lone(1, 6, 0.1).vesicles[0];
  p.center = {100, -50, 20};
  const Coefficients x = initial_position(p);
  const RigidBody body = rigid_body(x);
  const RigidMotion given{{1, 2, 3}, {-0.5, 0.25, 2}, {3, 4, 5}};
  const RigidMotion found = rigid_part(body, rigid_velocity(body, given));
  CHECK((found.at({7, 8, 9}) - given.at({7, 8, 9})).norm() < 1e-11);
  Coefficients u{6, Matrix::Random(49, 3)};
  const RigidMotion left = rigid_part(body, without_rigid_part(body, u));
  CHECK(left.translation.norm() + left.rotation.norm() < 1e-13);
}

TEST_CASE("a frame carries positions as its equations of motion say") {
  const Coefficients x = initial_position(lone(1, 4, 0.1).vesicles[0]);
  Frame f;
  f.motion = {{1, 0.5, -2}, {0.3, -1.1, 0.4}, {2, 1, 0}};
  f.drift << 0.2, -0.5, 1, 0.3, 0, 0.1, -0.4, 0.6, -0.2;
  for (const double time : {1e-3, 0.7, -4.0}) {
    // d/dt of the carried position is the frame's motion where it is: central differences, whose error is of the order
    // of h^2.
    const double h = 1e-4;
    const Coefficients now = carried(f, {0, time}, x);
    const RigidBody body = rigid_body(now);
    const Matrix rate = (carried(f, {0, time + h}, x).values - carried(f, {0, time - h}, x).values) / (2 * h);
    CHECK((rate - rigid_velocity(body, f.at(body.centre)).values).norm() < 1e-6 * (1 + rate.norm()));
    // Of one whose rotation changes, at the beginning of a span: the axis may change in it.
    Frame g = f;
    g.spin_up = {-0.7, 0.2, 0.9};
    const Matrix at_start = (carried(g, {time, time + h}, x).values - carried(g, {time, time - h}, x).values) / (2 * h);
    const RigidBody there = rigid_body(x);
    const RigidMotion then = g.from(time).at(there.centre);
    CHECK((then.rotation - f.motion.rotation - time * g.spin_up).norm() < 1e-14);
    CHECK((at_start - rigid_velocity(there, then).values).norm() < 1e-6 * (1 + at_start.norm()));
    for (const Frame& frame : {f, g}) {
      const Coefficients then_back = carried(frame, {time, 0.2}, carried(frame, {0.2, time}, x));
      CHECK((then_back.values - x.values).norm() < 1e-12 * (1 + now.values.norm()));
      CHECK(turned(frame, {0.2, time}, x).values.norm() == Approx(x.values.norm()).epsilon(1e-13));
    }
  }
}

TEST_CASE("a vesicle is carried by a uniform stream exactly and deforms as it would at rest") {
  const double lambda = GENERATE(0.1, 10.0, 100.0);
  const int order = GENERATE(6, 8, 12);
  if (order == 12 && lambda != 10) return;  // the same code; the whole table is in docs/validation.md
  constexpr double dt = 0.1;
  constexpr int steps = 4;
  Scene scene = lone(lambda, order, dt);
  const End still = end_of(scene, dt, steps);
  for (const double speed : {1.0, 10.0, 100.0}) {
    scene.flows = {stream({speed, 0, -speed / 2})};
    const End moved = end_of(scene, dt, steps);
    const Vec3 way = Vec3(speed, 0, -speed / 2) * dt * steps;
    CHECK((moved.measures.center - still.measures.center - way).norm() < 1e-9 * way.norm());
    CHECK(moved.measures.energy == Approx(still.measures.energy).margin(1e-8));
    CHECK(moved.measures.tension_mean == Approx(still.measures.tension_mean).margin(1e-8));
  }
}

TEST_CASE("a vesicle is carried by a turning fluid exactly and deforms as it would at rest") {
  const double lambda = GENERATE(0.1, 10.0, 1000.0);
  constexpr double dt = 0.1;
  constexpr int steps = 4;
  Scene scene = lone(lambda, 8, dt);
  scene.vesicles[0].center = {1, 0, 2};
  const End still = end_of(scene, dt, steps);
  for (const double omega : {1.0, 10.0, 100.0}) {
    scene.flows = {rotation({0, omega, 0})};
    const End moved = end_of(scene, dt, steps);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(omega * dt * steps, Vec3::UnitY()).toRotationMatrix();
    const double path = omega * dt * steps;
    CHECK((moved.measures.center - turn * still.measures.center).norm() < 1e-9 * path);
    CHECK(moved.measures.energy == Approx(still.measures.energy).margin(1e-8));
    CHECK(moved.measures.tension_mean == Approx(still.measures.tension_mean).margin(1e-8));
    CHECK((moved.measures.axes - still.measures.axes).norm() < 1e-8);
  }
}

TEST_CASE("a vesicle far off the axis of a shear flow does what one on the axis does") {
  constexpr double dt = 0.1;
  Scene scene = lone(10, 6, dt);
  scene.flows = {test::shear()};
  const End near = end_of(scene, dt, 6);
  scene.vesicles[0].center = {0, 0, 50};
  const End far = end_of(scene, dt, 6);
  CHECK(far.measures.inclination_deg == Approx(near.measures.inclination_deg).margin(1e-6));
  CHECK(far.measures.energy == Approx(near.measures.energy).margin(1e-8));
  CHECK(far.measures.center[0] - near.measures.center[0] == Approx(50 * 0.6).epsilon(1e-9));
}

TEST_CASE("spheres turn rigidly with half the shear rate, wherever they are") {
  const double lambda = GENERATE(0.1, 1.0, 10.0);
  const double height = GENERATE(0.0, 20.0);
  constexpr double dt = 0.1;
  constexpr int steps = 10;
  VesicleParameters v = test::vesicle("sphere", 1, 6, lambda);
  v.center = {0, 0, height};
  const Scene scene = test::shear_scene(v, dt, 1);
  Plans plans;
  const Model s = make_model(scene, plans);
  const Dynamics start = initial_dynamics(s), d = test::advanced(s, start, dt, steps);
  const Matrix arm = rigid_body(d.vesicles[0].position).arm.values;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5 * dt * steps, Vec3::UnitY()).toRotationMatrix();
  // The constant tension lets it be out of round by 0.7e-5 of its radius; each axis has sqrt(4 pi / 3) of the
  // coefficients.
  CHECK((arm - rigid_body(start.vesicles[0].position).arm.values * turn.transpose()).norm() < 2e-4);
  CHECK(rigid_body(d.vesicles[0].position).centre[0] == Approx(height).margin(1e-8));
  CHECK(scene_warnings(s, d).empty());  // its spectrum is rounding
  const State state = evaluate(s, d).value();
  // A sphere that cannot stretch is a rigid one: its surface bears the traction 5 E.n, and div (sigma P) along it gives
  // sigma = const - (5/2) n.E.n, E_xz = 1/2, whatever lambda.
  const Basis& basis = plans.basis(6, 8);
  const Matrix sigma = basis.synthesize(state.vesicles[0].tension).values;
  const Matrix n = basis.synthesize({6, arm}).values;
  CHECK((sigma + 2.5 * n.col(0).cwiseProduct(n.col(2))).cwiseAbs().maxCoeff() <
        0.01);  // of 1.25; the tension holds only to 1e-5
}

TEST_CASE("nearly round vesicles deform within their excess area without a failed step") {
  // Quasi-spherical: the radius is out of round by about 0.58 sqrt(1 - nu) (RMS), so the longest axis by less than 1.5
  // of that.
  const double lambda = GENERATE(0.1, 1.0, 10.0);
  for (const double excess : {1e-9, 1e-7, 1e-5, 1e-3}) {
    VesicleParameters v = test::vesicle("prolate", 1 - excess, 6, lambda);
    const Scene scene = test::shear_scene(v, 0.1, 1);
    Plans plans;
    const Model s = make_model(scene, plans);
    Dynamics d = initial_dynamics(s);
    while (d.time < 0.5) d = take_step(s, d, std::min(d.dt_limit, 0.1)).value().dynamics;
    const VesicleMeasures m =
        measure(plans, evaluate(s, d).value().vesicles[0], d.vesicles[0].area, d.vesicles[0].volume);
    CHECK(std::abs(m.axes[0] - 1) < 1.5 * std::sqrt(excess) + 1e-4);
    CHECK(std::abs(m.volume_error) < 1e-12);
    CHECK(std::abs(m.area_error) < 1e-8);
    CHECK(scene_warnings(s, d).empty());
  }
}

TEST_CASE("two sinking spheres fall side by side, round and faster than one") {
  Scene scene = test::shear_scene(test::vesicle("sphere", 1, 6, 5), 0.1, 1);
  scene.flows.clear();
  scene.buoyancy.gravity = {0, 0, -1};
  scene.vesicles[0].density_difference = 1;
  scene.vesicles.push_back(scene.vesicles[0]);
  scene.vesicles[0].center = {-1.5, 0, 0};
  scene.vesicles[1].center = {1.5, 0, 0};
  Plans plans;
  const Model s = make_model(scene, plans);
  const Dynamics d = test::advanced(s, initial_dynamics(s), 0.1, 5);
  const State state = evaluate(s, d).value();
  for (std::size_t k = 0; k < 2; ++k) {
    const VesicleMeasures m = measure(plans, state.vesicles[k], d.vesicles[k].area, d.vesicles[k].volume);
    // One rigid sphere: 2/9. Two, d between the centres, falling abreast: 1 + 3/(4 d) + 1/(2 d^3) by the method of
    // reflections, right to (1/d)^4; the spheres hold their shape to the stiffness of the pinned tension.
    const double expected = 2.0 / 9 * (1 + 0.75 / 3 + 0.5 / 27);
    CHECK(-m.center[2] == Approx(expected * 0.5).epsilon(0.015));
    CHECK(std::abs(m.axes[0] - 1) < 2e-4);
  }
}

TEST_CASE("the fluid inside of a vesicle that a stream carries moves with the stream") {
  Scene scene = lone(50, 6, 0.1);
  scene.vesicles[0].bending_modulus = 0;
  scene.flows = {stream({3, 1, 0}), rotation({0, 0, 2})};
  Plans plans;
  const Model s = make_model(scene, plans);
  const State state = evaluate(s, initial_dynamics(s)).value();
  const FlowField field = flow_field(plans, scene, state);
  Matrix points(3, 3);
  points << 0.1, 0.2, 0, 1.2, 0.1, 0.1, 0, 3, 0;  // two inside, one outside
  const FlowSamples at = velocity_at(field, points);
  CHECK(at.within == std::vector<int>{0, 0, -1});
  CHECK((at.velocity - background_velocity(scene.flows, 0, points)).norm() < 1e-10);
}

TEST_CASE("a scene in other units has the same result in those units") {
  // Lengths times s; the modulus is viscosity times velocity times length squared.
  const auto pair = [](double s) {
    Scene scene = test::shear_scene(test::vesicle("prolate", 0.9, 6, 5), 0.1, 1);
    scene.vesicles[0].radius = s;
    scene.vesicles[0].bending_modulus = 0.01 * s * s * s;
    scene.vesicles.push_back(scene.vesicles[0]);
    scene.vesicles[0].center = s * Vec3(-0.8, 0, 0.85);
    scene.vesicles[1].center = s * Vec3(0.8, 0, -0.85);
    scene.numerics.repulsion_strength = 0.1;
    return scene;
  };
  const End one = end_of(pair(1), 0.1, 5);
  for (const double s : {1e-12, 2.8e-6, 1e6}) {
    const End other = end_of(pair(s), 0.1, 5);
    CHECK((other.measures.center / s - one.measures.center).norm() < 1e-9);
    CHECK(other.measures.inclination_deg == Approx(one.measures.inclination_deg).margin(1e-6));
    CHECK(other.measures.energy == Approx(one.measures.energy).margin(1e-9));
    CHECK(other.measures.tension_mean / s == Approx(one.measures.tension_mean).margin(1e-8));
  }
}
