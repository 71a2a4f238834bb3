// Stresslets, intrinsic viscosities and the motion of vesicles as a whole against closed forms and against the flow far
// away.
#include "sim/measures/diagnostics.h"
#include "sim/measures/stresslet.h"
#include "sim/suspension/loads.h"
#include "sim/suspension/velocity.h"

#include "surfaces.h"
#include "tests/support/catch.h"

#include <Eigen/Geometry>

using namespace sim;

namespace {

constexpr double pi = test::pi;

State solved(Plans& plans, const Scene& scene) {
  const Model model = make_model(scene, plans);
  return evaluate(model, initial_dynamics(model)).value();
}

/// Of a vesicle alone in a shear flow.
FlowMeasures in_shear(const VesicleParameters& v, double rate = 1) {
  Plans plans;
  Scene scene = test::shear_scene(v, 0.1 / rate, 1 / rate);
  scene.flows = {test::shear(rate)};
  return flow_measures(plans, scene, solved(plans, scene)).at(0);
}

}  // namespace

TEST_CASE("a sphere in shear has Einstein's viscosity and no normal stresses, for every contrast, size and place") {
  for (const double lambda : {0.2, 1.0, 100.0})
    for (const double rate : {1.0, -3.0}) {
      VesicleParameters v = test::vesicle("sphere", 1, 8, lambda);
      v.radius = 1.7;
      v.center = {0.3, -20, 50};
      const FlowMeasures m = in_shear(v, rate);
      INFO("λ = " << lambda << ", rate " << rate);
      // The tension that holds it round is finite, and lets it deform by 3e-5.
      CHECK(m.intrinsic_viscosity == Approx(2.5).epsilon(2e-4));
      CHECK(m.stresslet(0, 2) == Approx(20 * pi / 3 * std::pow(1.7, 3) * rate / 2).epsilon(2e-4));
      CHECK(m.normal_stress_1 == Approx(0).margin(1e-3));
      CHECK(m.normal_stress_2 == Approx(0).margin(1e-3));
      CHECK((m.center_velocity - Vec3(50 * rate, 0, 0)).norm() < 1e-9 * 50 * std::abs(rate));
      CHECK(m.migration == Approx(0).margin(1e-9));
      CHECK(std::isnan(m.inclination_rate));
    }
}

TEST_CASE("the stresslet of a sphere that cannot stretch in a straining flow is the closed form") {
  // u = k [(x.E.x) x + 2/3 (E.x - (x.E.x) x)], f = -2 sigma n + grad sigma with sigma = -c x.E.x; k = 60/(32 + 23
  // lambda) and c = (80 + 95 lambda)/(2 (32 + 23 lambda)). With oint x x (x.E.x) dA = 8 pi/15 E:
  //   S = [8 pi c/15 + (lambda - 1) 32 pi k/15] E, which is 20 pi/3 E for lambda -> infinity.
  Eigen::Matrix3d e;
  e << 0.5, 0.2, -0.1, 0.2, -0.8, 0.3, -0.1, 0.3, 0.3;
  const Geometry g = geometry(Basis(4, 16), test::ellipsoid(Vec3::Ones(), 4));
  for (const double lambda : {0.1, 1.0, 7.0, 1e6}) {
    const double k = 60 / (32 + 23 * lambda), c = (80 + 95 * lambda) / (2 * (32 + 23 * lambda));
    const Matrix x = g.x.value, strained = x * e;
    const Vector q = x.cwiseProduct(strained).rowwise().sum();
    const Matrix along = (x.array().colwise() * q.array()).matrix();
    const Matrix u = k * (along / 3 + 2.0 / 3 * strained), f = 4 * c * along - 2 * c * strained;
    const Eigen::Matrix3d expected = (8 * pi * c / 15 + (lambda - 1) * 32 * pi * k / 15) * e;
    // Nothing but rounding; a multiple of the unit matrix is a pressure.
    CHECK((stresslet(g, Vec3::Zero(), f, u, lambda) - expected).norm() < 1e-11 * lambda * expected.norm() + 1e-11);
    const Matrix pressed = f + 3 * g.n;
    CHECK((stresslet(g, Vec3::Zero(), pressed, u, lambda) - expected).norm() <
          1e-11 * lambda * expected.norm() + 1e-11);
    if (lambda > 1e5) CHECK((expected - 20 * pi / 3 * e).norm() < 1e-4);
  }
}

TEST_CASE("far away a vesicle disturbs a flow as its stresslet says") {
  Plans plans;
  for (const double lambda : {0.3, 1.0, 10.0}) {
    VesicleParameters v = test::vesicle("prolate", 0.85, 10, lambda);
    v.axis = Vec3(1, 0.3, 0.5);
    Scene scene = test::shear_scene(v, 0.1, 1);
    const State state = solved(plans, scene);
    const Eigen::Matrix3d s = flow_measures(plans, scene, state)[0].stresslet;
    const FlowField field = flow_field(plans, scene, state);
    Matrix x(4, 3);
    x << 30, 0, 40, 50, 0, 0, -10, 45, 20, 20, 20, -40;
    const Matrix disturbance = velocity_at(field, x).velocity - background_velocity(scene.flows, 0, x);
    Matrix expected(4, 3);
    for (Eigen::Index i = 0; i < 4; ++i) {
      const Vec3 r = x.row(i).transpose();
      expected.row(i) = -3 / (8 * pi) * r.dot(s * r) / std::pow(r.norm(), 5) * r.transpose();
    }
    INFO("λ = " << lambda);
    // A body that is symmetric about its centre has no r^-3 term; the next is smaller by (1/50)^2.
    CHECK((disturbance - expected).norm() < 2e-3 * expected.norm());
  }
}

TEST_CASE("a stresslet is a tensor, and one of a membrane without net force has it about any point") {
  const Basis basis(10, 24);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  const auto about = [&](const Eigen::Matrix3d& q, const Vec3& c) {
    Coefficients x = test::potato(10), f = test::smooth_field(10, 4, 3, 5), u = test::smooth_field(10, 4, 3, 6);
    for (Coefficients* field : {&x, &f, &u}) field->values *= q.transpose();
    const Geometry g = geometry(basis, x);
    Matrix force = basis.synthesize(f).values;
    force.rowwise() -= (g.dA.transpose() * force / g.dA.sum()).eval().row(0);
    return stresslet(g, c, force, basis.synthesize(u).values, 3);
  };
  const Eigen::Matrix3d one = about(Eigen::Matrix3d::Identity(), Vec3::Zero());
  CHECK((about(turn, Vec3::Zero()) - turn * one * turn.transpose()).norm() < 1e-12 * one.norm());  // rounding
  CHECK((about(Eigen::Matrix3d::Identity(), Vec3(3, 4, -5)) - one).norm() < 1e-11 * one.norm());
  CHECK(std::abs(one.trace()) < 1e-12 * one.norm());
}

TEST_CASE("a nearly round vesicle that tank-treads has the normal stresses and the viscosity of small excess area") {
  // First order in the shape r = 1 + x.F.x, F of size A = sqrt(15 excess/(32 pi)) along the axis of extension: an
  // inextensible sphere with the normal velocity x.U.x has S = 20 pi/3 (E + 6/7 dev FE) - 16 pi/3 U, and U keeps the
  // shape in place against the vorticity. Hence N1 = 8 A, N2 = -13/7 A for any contrast, and [eta] depends on it by -23
  // excess/(16 pi) (Misbah 2006, Danker and Misbah 2007).
  const double nu = 0.998, excess = 4 * pi * (std::pow(nu, -2.0 / 3) - 1), a = std::sqrt(15 * excess / (32 * pi));
  Plans plans;
  const auto settled = [&](double lambda) {
    VesicleParameters v = test::vesicle("prolate", nu, 6, lambda);
    v.axis = Vec3(std::cos(0.75), 0, std::sin(0.75));  // near its angle
    Scene scene = test::shear_scene(v, 0.05, 8);
    const Model model = make_model(scene, plans);
    const Dynamics d = test::advanced(model, initial_dynamics(model), 0.05, 160);
    return flow_measures(plans, scene, evaluate(model, d).value())[0];
  };
  const FlowMeasures thin = settled(0.2), thick = settled(1);
  for (const FlowMeasures& m : {thin, thick}) {
    // Corrections are of the order of the excess, 0.017.
    CHECK(m.normal_stress_1 == Approx(8 * a).epsilon(0.01));
    CHECK(m.normal_stress_2 == Approx(-13.0 / 7 * a).epsilon(0.01));
    CHECK(m.intrinsic_viscosity < 2.5);
  }
  CHECK(thin.intrinsic_viscosity - thick.intrinsic_viscosity == Approx(0.8 * 23 * excess / (16 * pi)).epsilon(0.03));
}

TEST_CASE("a body far stiffer than the fluid has the stresslet of a rigid spheroid") {
  // S = 20 pi/3 a^3 X E along the axis, X = (8/15) e^5/((3 - e^2) L - 6 e), L = ln((1 + e)/(1 - e)) (Kim and Karrila
  // 1991).
  const Vec3 axes = spheroid_axes(0.9, true);
  const double length = axes[0], e = std::sqrt(1 - std::pow(axes[1] / length, 2)), log = std::log((1 + e) / (1 - e));
  const double x = 8.0 / 15 * std::pow(e, 5) / ((3 - e * e) * log - 6 * e);
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.9, 12, 1e4), 0.1, 1);
  scene.flows[0].kind = "extension";
  scene.flows[0].planar = false;
  Plans plans;
  const Eigen::Matrix3d s = flow_measures(plans, scene, solved(plans, scene))[0].stresslet;
  const Eigen::Matrix3d strain = Vec3(1, -0.5, -0.5).asDiagonal();
  const Eigen::Matrix3d expected = 20 * pi / 3 * std::pow(length, 3) * x * strain;
  CHECK((s - expected).norm() < 2e-3 * expected.norm());  // 1/lambda, and the quadrature of order 13 at lambda = 1e4
}

TEST_CASE("a stresslet does not depend on how well the steps knew velocity and tension") {
  // What interpolation leaves in a saved state is multiplied by lambda - 1, or by the tension of a sphere.
  Plans plans;
  for (const char* shape : {"sphere", "prolate"}) {
    Scene scene = test::shear_scene(test::vesicle(shape, 0.9, 8, 100), 0.1, 1);
    State state = solved(plans, scene);
    const FlowMeasures exact = flow_measures(plans, scene, state)[0];
    VesicleState& v = state.vesicles[0];
    v.velocity.values += 1e-3 * test::smooth_field(8, 4, 3, 1).values;
    v.tension.values += 1e-3 * test::smooth_field(8, 4, 1, 2).values;
    const FlowMeasures rough = flow_measures(plans, scene, state)[0];
    INFO(shape);
    CHECK((rough.stresslet - exact.stresslet).norm() < 1e-5 * exact.stresslet.norm());  // residuals of 1e-8, times 100
    CHECK(std::isnan(flow_measures(plans, scene, state, false)[0].intrinsic_viscosity));
  }
}

TEST_CASE("stresslets of vesicles close to each other are those of the coupled solve, from a rough state") {
  Plans plans;
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.9, 8, 5), 0.1, 1);
  scene.vesicles.push_back(scene.vesicles[0]);
  scene.vesicles[0].center = {-0.3, 0, -0.85};  // 0.2 apart
  scene.vesicles[1].center = {0.3, 0, 0.85};
  State state = solved(plans, scene);
  // Of the state itself, which fixed steps solve to 1e-10: the same forces without a further solve.
  const std::vector<Load> coupled = loads_of(plans, scene, state);
  const std::vector<Load> again = solved_loads(plans, scene, state);
  for (std::size_t k = 0; k < 2; ++k)
    CHECK((again[k].force.values - coupled[k].force.values).norm() < 1e-6 * coupled[k].force.values.norm());
  const std::vector<FlowMeasures> exact = flow_measures(plans, scene, state);
  for (VesicleState& v : state.vesicles) {
    v.velocity.values += 1e-3 * test::smooth_field(8, 4, 3, 1).values;
    v.tension.values += 1e-3 * test::smooth_field(8, 4, 1, 2).values;
  }
  const std::vector<FlowMeasures> rough = flow_measures(plans, scene, state);
  for (std::size_t k = 0; k < 2; ++k)  // 1e-3 times the third power of what one feels of the other
    CHECK((rough[k].stresslet - exact[k].stresslet).norm() < 1e-4 * exact[k].stresslet.norm());
}

TEST_CASE("measures of the flow have no unit and no place but their own") {
  VesicleParameters v = test::vesicle("prolate", 0.9, 8, 4);
  v.axis = Vec3(1, 0.2, 0.4);
  const FlowMeasures one = in_shear(v);
  const double length = 1e-6, rate = 1000;
  v.radius = length;
  v.bending_modulus *= rate * std::pow(length, 3);
  v.center = Vec3(3, -2, 40) * length;
  const FlowMeasures other = in_shear(v, rate);
  const double unit = rate * std::pow(length, 3);
  // Rounding, and the residual of the solve, 1e-10 of velocities that do and do not include the vesicle's own.
  CHECK((other.stresslet / unit - one.stresslet).norm() < 1e-6 * one.stresslet.norm());
  CHECK(other.intrinsic_viscosity == Approx(one.intrinsic_viscosity).epsilon(1e-6));
  CHECK(other.normal_stress_1 == Approx(one.normal_stress_1).epsilon(1e-6));
  CHECK(other.normal_stress_2 == Approx(one.normal_stress_2).epsilon(1e-6));
  CHECK(other.inclination_rate == Approx(one.inclination_rate * rate).epsilon(1e-6));
  CHECK((other.center_velocity / (rate * length) - Vec3(40, 0, 0)).norm() < 1e-6);
}

TEST_CASE("centre, migration and turning of a body in rigid motion are those of the motion") {
  VesicleParameters p = test::vesicle("prolate", 0.85, 8);
  p.center = {2, 3, 4};
  p.axis = Vec3(std::cos(0.4), 0, std::sin(0.4));
  State state;
  VesicleState& v = state.vesicles.emplace_back();
  v.position = initial_position(p);
  const RigidBody body = rigid_body(v.position);
  v.velocity = rigid_velocity(body, {Vec3(0.5, -0.6, 0.7), Vec3(0, -0.3, 0), p.center});
  v.tension = {8, Matrix::Zero(coefficient_count(8), 1)};
  Scene scene;
  scene.vesicles = {p};
  FlowParameters tube, stream;
  tube.kind = "poiseuille";
  tube.curvature = 0.1;
  stream.kind = "uniform";
  stream.velocity = {0, 0, 0.2};
  Plans plans;
  const auto measured = [&](std::vector<FlowParameters> flows) {
    scene.flows = std::move(flows);
    return flow_measures(plans, scene, state)[0];
  };
  const FlowMeasures in_tube = measured({tube});
  CHECK((in_tube.center_velocity - Vec3(0.5, -0.6, 0.7)).norm() < 1e-10);
  CHECK(in_tube.inclination_rate == Approx(0.3));  // omega = -0.3 e_y turns x to z
  CHECK(in_tube.migration == Approx((-0.6 * 3 + 0.7 * 4) / 5));
  CHECK(std::isnan(in_tube.intrinsic_viscosity));
  CHECK(measured({tube, stream}).migration == Approx((-0.6 * 3 + (0.7 - 0.2) * 4) / 5));
  CHECK(measured({test::shear(), stream}).migration == Approx(0.5));
  CHECK(std::isfinite(measured({test::shear(), stream}).normal_stress_2));
  CHECK(std::isnan(measured({stream}).migration));
  CHECK(std::isnan(measured({test::shear(), tube}).migration));
}

TEST_CASE("a steady shear is one constant shear flow, whatever carries it along") {
  FlowParameters stream, tube, pulse = test::shear(2);
  stream.kind = "uniform";
  tube.kind = "poiseuille";
  pulse.time_factor = "step";
  const auto rate = [](std::vector<FlowParameters> flows) { return steady_shear_rate(flows); };
  CHECK(rate({test::shear(-2)}) == -2);
  CHECK(rate({stream, test::shear(2), FlowParameters{}}) == 2);
  CHECK_FALSE(rate({}));
  CHECK_FALSE(rate({stream}));
  CHECK_FALSE(rate({test::shear(0)}));
  CHECK_FALSE(rate({test::shear(1), test::shear(1)}));
  CHECK_FALSE(rate({test::shear(1), tube}));
  CHECK_FALSE(rate({pulse}));
}
