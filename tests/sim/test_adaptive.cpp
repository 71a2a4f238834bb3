// Steps that follow a tolerance, formulas of high order, saved states between steps, and grids that slide.
#include "../support/temporary_folder.h"
#include "sim/measures/statement.h"
#include "sim/membrane/sliding.h"
#include "sim/stepping/control.h"
#include "sim/stepping/multistep.h"
#include "sim/stepping/simulate.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <cmath>
#include <numbers>

using namespace sim;

namespace {

constexpr double four_pi = 4 * std::numbers::pi;

/// Tumbles, or tank-treads.
Scene shear_of(double tolerance, double end, double lambda) {
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 6, lambda), 0.1, end);
  scene.time.step.reset();
  scene.time.scheme.reset();
  scene.time.tolerance = tolerance;
  scene.time.save_every = end;
  scene.numerics.upsampling = 3;
  return scene;
}

struct Outcome {
  std::vector<State> states;
  std::vector<StepRecord> steps;
  SimulationOutcome outcome;
};
Outcome run(const Scene& scene) {
  const support::TemporaryFolder folder;
  SimulationOptions options;
  options.trajectory = folder.path() / "a.h5";
  Outcome o;
  o.outcome = simulate(scene, options, {});
  const TrajectoryReader reader(options.trajectory);
  for (std::int64_t k = 0; k < reader.count(); ++k) o.states.push_back(reader.state(k));
  o.steps = reader.steps();
  return o;
}

double distance(const Coefficients& a, const Coefficients& b) {
  return (a.values - b.values).norm() / std::sqrt(four_pi);
}

const Coefficients& last_position(const Outcome& o) { return o.states.back().vesicles[0].position; }

}  // namespace

TEST_CASE("formulas of every order are exact for polynomials of that degree on uneven steps") {
  const std::vector<double> times{-0.3, -0.5, -1.2, -1.3, -2};
  for (int order = 1; order <= 5; ++order) {
    const Bdf formula = bdf(times, order);
    for (int degree = 0; degree <= order; ++degree) {
      double behind = 0;
      for (int j = 0; j < order; ++j) behind += formula.behind[j] * std::pow(2 + times[j], degree);
      // x(t) = (2 + t)^degree at t = 0
      const double slope = degree == 0 ? 0 : degree * std::pow(2, degree - 1);
      CHECK((std::pow(2, degree) - behind) / formula.c == Approx(slope).margin(1e-12));
    }
  }
  CHECK(bdf(std::vector<double>{-0.1, -0.2}, 2).c == Approx(0.1 * 2 / 3));
  // At equal steps the error of x' over dt that order k leaves is dt^(k+1) x^(k+1) / (k+1); the distance from the
  // polynomial through k + 1 levels is dt^(k+1) x^(k+1) for an exact position, and so much more for that of the
  // formula.
  for (int k = 1; k <= 4; ++k) {
    std::vector<double> equal;
    for (int j = 1; j <= k + 1; ++j) equal.push_back(-0.1 * j);
    double harmonic = 0;
    for (int j = 1; j <= k; ++j) harmonic += 1.0 / j;
    const double by_formula = 1 + 1 / (harmonic * (k + 1));
    CHECK(error_share(equal, k) * by_formula == Approx(1.0 / (k + 1)));
  }
}

TEST_CASE("formulas have their order in time, with the correction of area and volume and with a grid that slides") {
  // After a start by short steps; the finest run stands for the limit. Not with both at once: the grid slides by what
  // is known before the correction, which moves points, along the membrane, by 1e-7 more or less.
  const bool corrects = GENERATE(true, false);
  const auto position_after = [&](const char* scheme, int count) {
    Plans plans;
    Scene scene = test::shear_scene(test::vesicle("prolate", 0.9, 6, 3), 1, 2, scheme);
    scene.numerics.upsampling = 3;
    scene.numerics.gmres_tolerance = 1e-12;
    scene.numerics.correction = corrects;
    scene.numerics.reparametrization = corrects ? "off" : "moving";
    const Model s = make_model(scene, plans);
    Dynamics d = initial_dynamics(s);
    expect(s, d, evaluate(s, d).value());
    constexpr double until = 0.4;
    for (const double dt : {1e-4, 1e-4, 2e-4, 4e-4, 8e-4, 1.6e-3, 3.2e-3, 6.4e-3}) d = test::advanced(s, d, dt, 1);
    d = test::advanced(s, d, (until - d.time) / 24, 24);
    return test::advanced(s, d, 1.2 / count, count).vesicles[0].position.values;
  };
  const auto [scheme, order] = GENERATE(table<const char*, double>({{"bdf2", 2.0}, {"bdf3", 3.0}, {"bdf4", 4.0}}));
  INFO(scheme << (corrects ? ", correction" : ", sliding"));
  const Matrix limit = position_after("bdf4", 96);
  const double coarse = (position_after(scheme, 24) - limit).norm(), fine = (position_after(scheme, 48) - limit).norm();
  INFO(coarse << ", " << fine);
  CHECK(std::log2(coarse / fine) > order - 0.5);
  CHECK(std::log2(coarse / fine) < order + 1.3);
}

TEST_CASE("adaptive steps err by less than the tolerance for each radius that the membrane moves, and by little less") {
  const double lambda = GENERATE(1.0, 10.0);
  constexpr double end = 6, path = 0.3 * end;  // the root mean square of the velocity is about 0.3
  const Outcome reference = run(shear_of(2e-6, end, lambda));
  double last = 1;
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    const Outcome o = run(shear_of(tolerance, end, lambda));
    const double error = distance(last_position(o), last_position(reference));
    double sum = 0;
    for (const StepRecord& step : o.steps) sum += step.error;
    INFO("lambda " << lambda << ", tolerance " << tolerance << ": " << o.steps.size() << " steps, error " << error
                   << ", sum of estimates " << sum);
    CHECK(error < tolerance * path);
    CHECK(error > tolerance * path / 100);
    CHECK(error < last);
    // What is stated: the sum of what the steps leave, good to a factor of three.
    CHECK(error < 3 * sum);
    last = error;
    for (const VesicleStep& v : {o.steps.back().vesicles[0]}) CHECK(std::abs(v.area_error) < 1e-10);
  }
  CHECK(reference.steps.back().order == 4);
}

TEST_CASE("what is saved does not change the steps, and a state between two of them is as good as they are") {
  Scene scene = shear_of(1e-3, 3, 5);
  const Outcome seldom = run(scene);
  scene.time.save_every = 0.05;
  const Outcome often = run(scene);
  INFO(often.outcome.reason << " at t = " << often.outcome.time);
  REQUIRE(often.states.size() == 61);
  REQUIRE(often.steps.size() == seldom.steps.size());
  for (std::size_t k = 0; k < often.steps.size(); ++k) CHECK(often.steps[k].dt == seldom.steps[k].dt);
  CHECK(last_position(often).values == last_position(seldom).values);
  scene.time.tolerance = 1e-5;
  const Outcome fine = run(scene);
  Plans plans;
  const Model s = make_model(scene, plans);
  const double area = area_volume(plans.basis(6, measure_order(6)), often.states[0].vesicles[0].position).area;
  double worst = 0, velocity = 0, tension = 0;
  for (std::size_t k = 0; k < often.states.size(); ++k) {
    CHECK(often.states[k].time == fine.states[k].time);
    const VesicleState &a = often.states[k].vesicles[0], &b = fine.states[k].vesicles[0];
    worst = std::max(worst, distance(a.position, b.position));
    velocity = std::max(velocity, distance(a.velocity, b.velocity));
    tension = std::max(tension, distance(a.tension, b.tension) / (1 + b.tension.values.norm()));
    const AreaVolume size = area_volume(plans.basis(6, measure_order(6)), a.position);
    CHECK(std::abs(size.area / area - 1) < 1e-11);
  }
  const double tolerance = 1e-3 * 0.3 * 3;
  CHECK(worst < tolerance);
  CHECK(velocity < 2 * tolerance);
  CHECK(tension < 5 * tolerance);
}

TEST_CASE("adaptive steps take a rigid motion at any length, and spheres as they turn") {
  for (const char* kind : {"uniform", "rotation"}) {
    INFO(kind);
    Scene scene = shear_of(1e-3, 1, 10);
    scene.vesicles[0].center = {1, 0, 2};
    scene.flows[0].kind = kind;
    scene.flows[0].velocity = {50, 0, 20};
    scene.flows[0].angular_velocity = {0, 50, 0};
    Scene at_rest = scene;
    at_rest.flows[0].kind = "none";
    const Outcome moved = run(scene), still = run(at_rest);
    REQUIRE(moved.outcome.end == SimulationEnd::finished);
    const RigidBody a = rigid_body(last_position(moved)), b = rigid_body(last_position(still));
    const bool turns = std::string_view(kind) == "rotation";
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(turns ? 50 : 0, Vec3::UnitY()).toRotationMatrix();
    const Vec3 way = turns ? Vec3(turn * b.centre) : Vec3(b.centre + Vec3(50, 0, 20));
    CHECK((a.centre - way).norm() < 1e-6);
    // Bending alone deforms it by 0.003 in that time, in steps that the motion makes shorter here than there.
    CHECK((a.arm.values - b.arm.values * turn.transpose()).norm() < 1e-3);
  }
  Scene scene = shear_of(1e-3, 2, 1);
  scene.vesicles[0].shape = "sphere";
  scene.vesicles[0].reduced_volume.reset();
  const Outcome turned = run(scene);
  REQUIRE(turned.outcome.end == SimulationEnd::finished);
  const Matrix arm = rigid_body(last_position(turned)).arm.values,
               start = rigid_body(turned.states[0].vesicles[0].position).arm.values;
  CHECK((arm - start * Eigen::AngleAxisd(1, Vec3::UnitY()).toRotationMatrix().transpose()).norm() < 1e-2);
  CHECK(turned.steps.size() < 60);
}

TEST_CASE("steps end where a flow is switched, and start anew there") {
  Scene scene = shear_of(1e-3, 2, 3);
  scene.flows[0].time_factor = "step";
  scene.flows[0].from = 0.5;
  scene.flows[0].until = 0.8;
  const Outcome o = run(scene);
  for (const double switched : {0.5, 0.8})
    CHECK(std::count_if(o.steps.begin(), o.steps.end(), [&](const StepRecord& s) { return s.time == switched; }) == 1);
  const auto after = std::find_if(o.steps.begin(), o.steps.end(), [](const StepRecord& s) { return s.time > 0.5; });
  CHECK(after->order == 1);
  CHECK(after->dt < 0.02);
  Scene pulse = scene;
  pulse.time.tolerance = 1e-5;
  CHECK(distance(last_position(o), last_position(run(pulse))) < 1e-3);
}

TEST_CASE("the length of a step meets a time without a tiny remainder") {
  CHECK(length_towards(1, 2, 3) == 1);
  CHECK(length_towards(1, 2, 0.6) == 0.5);
  CHECK(length_towards(1, 2, 0.3) == 0.3);
}

TEST_CASE("the grid slides along the membrane, not through it, and is as low in J as any field beside it") {
  Plans plans;
  const int p = 8;
  Scene scene = test::shear_scene(test::vesicle("biconcave", 0.65, p, 2), 0.1, 1);
  const Model s = make_model(scene, plans);
  Dynamics d = initial_dynamics(s);
  const State state = evaluate(s, d).value();
  expect(s, d, state);
  const VesicleDynamics& v = d.vesicles[0];
  const Basis& basis = plans.basis(p, measure_order(p));
  const Geometry g = geometry(basis, v.position);
  const Matrix w = basis.synthesize(v.sliding).values;
  const double along = w.cwiseProduct(g.n).rowwise().sum().norm(), size = w.norm();
  INFO(along << " of " << size);
  CHECK(size > 0.01);
  CHECK(along < 0.02 * size);
  // The value of J falls to first order in no direction.
  const RigidBody body = rigid_body(v.position);
  const RigidMotion rigid = shape_motion(body, g, basis.synthesize(v.motion.velocity).values);
  const Matrix within = v.motion.velocity.values - rigid_velocity(body, rigid).values;
  const Eigen::Matrix3d strain = (v.frame.drift + v.frame.drift.transpose()) / 2;
  const double rate = std::max(motion_rate({p, within}, std::sqrt(v.area / four_pi)), strain.norm() / 2);
  const auto J = [&](const Matrix& field) {
    double sum = 0.1 * field.squaredNorm();
    for (int n = 1; n <= p; ++n)
      sum += std::pow(double(n) / p, 4) *
             (field + within + rate * v.position.values).middleRows(n * n, 2 * n + 1).squaredNorm();
    const Matrix on_grid = basis.synthesize({p, field}).values;
    const Vector normal = on_grid.cwiseProduct(g.n).rowwise().sum();
    return sum + 100 * basis.weights().dot(normal.cwiseAbs2());
  };
  const double least = J(v.sliding.values);
  for (const int seed : {1, 2, 3}) {
    const Matrix change = 1e-3 * test::smooth_field(p, p, 3, seed).values;
    CHECK(J(v.sliding.values + change) > least);
    CHECK(J(v.sliding.values - change) > least);
    CHECK(J(v.sliding.values + change) - J(v.sliding.values - change) ==
          Approx(0).margin(1e-3 * (J(v.sliding.values + change) - least)));
  }
}

TEST_CASE("a grid that slides leaves the shape alone and keeps the high degrees of the position small") {
  constexpr double end = 8;
  Scene scene = shear_of(1e-4, end, 1);
  scene.vesicles[0].order = 8;
  const Outcome slides = run(scene);
  scene.numerics.reparametrization = "off";
  const Outcome stays = run(scene);
  const VesicleState &a = slides.states.back().vesicles[0], &b = stays.states.back().vesicles[0];
  CHECK(high_degree_share(a.position) < 0.6 * high_degree_share(b.position));
  Plans plans;
  const Basis& basis = plans.basis(8, measure_order(8));
  const Measures ma = measures(geometry(basis, a.position)), mb = measures(geometry(basis, b.position));
  // Both have errors of space of this size at order 8.
  CHECK(inclination(ma.moments) == Approx(inclination(mb.moments)).margin(0.2 * std::numbers::pi / 180));
  CHECK(ma.h_squared == Approx(mb.h_squared).epsilon(5e-3));
}

TEST_CASE("little viscosity inside asks for tighter solves, not for shorter steps") {
  // The volume answers to a residual by one over the contrast. With a residual as for equal viscosities the steps are
  // ten times as many.
  const Outcome equal = run(shear_of(1e-3, 2, 1)), thin = run(shear_of(1e-3, 2, 0.01));
  REQUIRE(thin.outcome.end == SimulationEnd::finished);
  CHECK(thin.steps.size() < 4 * equal.steps.size());
  for (const StepRecord& step : thin.steps) CHECK(step.residual <= 1e-6);
  Scene scene = shear_of(1e-3, 2, 0.01);
  CHECK(solve_tolerance(scene) == Approx(1e-6));
  scene.numerics.gmres_tolerance = 1e-4;
  CHECK(solve_tolerance(scene) == 1e-4);
}

TEST_CASE("fifty steps of which a million would not reach the end are called a stall, and one longer step is none") {
  Plans plans;
  const Scene scene = shear_of(1e-3, 1, 1);
  const Model s = make_model(scene, plans);
  Step step{initial_dynamics(s), {}, {}};
  step.record.dt = 1e-7;
  for (int k = 1; k < 50; ++k) CHECK_FALSE(stalls(s, step));
  CHECK(stalls(s, step));
  step.record.dt = 1e-5;
  CHECK_FALSE(stalls(s, step));
  step.record.dt = 1e-7;
  CHECK_FALSE(stalls(s, step));
}

TEST_CASE("a run states the sum of what its steps leave, the worst of the rest, and how good its quadrature is") {
  StepRecord a, b;
  a.error = 1e-4, a.residual = 1e-6, b.error = 2e-4, b.residual = 3e-6;
  a.vesicles = {{.area_error = -1e-9, .volume_error = 1e-12, .tail = 0.02}, {.area_error = 1e-10, .tail = 0.03}};
  b.vesicles = {{.volume_error = -2e-12, .tail = 0.01}, {}};
  const std::vector<StepRecord> steps{a, b};
  const ErrorStatement e = stated_errors(steps);
  CHECK(e.time == Approx(3e-4));
  CHECK(e.solve == 3e-6);
  CHECK(e.area == 1e-9);
  CHECK(e.volume == 2e-12);
  CHECK(e.space == 0.03);
  // It falls spectrally, and knows neither place nor size.
  Plans plans;
  const Coefficients coarse = initial_position(test::vesicle("prolate", 0.85, 8));
  Coefficients elsewhere = coarse;
  elsewhere.values *= 1e-6;
  elsewhere.values.row(0).array() += 1e-4;
  const double error = quadrature_error(plans, coarse);
  CHECK(quadrature_error(plans, elsewhere) == Approx(error).epsilon(1e-6));
  CHECK(quadrature_error(plans, initial_position(test::vesicle("prolate", 0.85, 12))) < error / 5);
}
