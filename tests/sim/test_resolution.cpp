// Orders of vesicles that follow the tolerance.
#include "../support/temporary_folder.h"
#include "sim/measures/diagnostics.h"
#include "sim/measures/statement.h"
#include "sim/stepping/resolution.h"
#include "sim/stepping/simulate.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <cmath>

using namespace sim;

namespace {

/// Tank-treads, or tumbles.
Scene followed(double tolerance, double end, double lambda) {
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 0, lambda), 0.1, end);
  scene.time.step.reset();
  scene.time.scheme.reset();
  scene.time.tolerance = tolerance;
  scene.time.save_every = end / 4;
  return scene;
}

struct Run {
  support::TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "t.h5";
  SimulationOutcome outcome;

  explicit Run(const Scene& scene, int pause_after = -1) {
    SimulationOptions options;
    options.trajectory = path;
    options.scene_text = "a scene";
    options.steps = pause_after;
    outcome = simulate(scene, options, {});
    if (pause_after < 0) return;
    options.steps = -1;
    options.resume = true;
    outcome = simulate(scene, options, {});
  }
};

VesicleMeasures last_measures(const Run& run) {
  const TrajectoryReader reader(run.path);
  Plans plans;
  const State first = reader.state(0), last = reader.state(reader.count() - 1);
  const VesicleMeasures start = measure(plans, first.vesicles[0], 1, 1);
  return measure(plans, last.vesicles[0], start.area, start.volume);
}

/// A flow that begins after a rest: what suits the rest does not suit the flow.
Scene late_flow() {
  Scene scene = followed(1e-3, 1.2, 1);
  scene.flows[0].time_factor = "step";
  scene.flows[0].from = 0.3;
  scene.flows[0].rate = 2;
  scene.vesicles[0].reduced_volume = 0.8;
  return scene;
}

}  // namespace

TEST_CASE("an automatic order gives what a high order gives, to the tolerance") {
  const double lambda = GENERATE(1.0, 10.0);
  Scene fine = followed(3e-5, 2, lambda);
  fine.vesicles[0].order = 12;
  const VesicleMeasures expected = last_measures(Run(fine));
  int before = 0;
  for (const double tolerance : {1e-2, 3e-4}) {
    const Run run(followed(tolerance, 2, lambda));
    REQUIRE(run.outcome.end == SimulationEnd::finished);
    const VesicleMeasures m = last_measures(run);
    const TrajectoryReader reader(run.path);
    const int order = reader.state(reader.count() - 1).vesicles[0].position.order;
    INFO("lambda " << lambda << ", tolerance " << tolerance << ", order " << order);
    // The membrane moves by about a radius in this time; the angle turns the long axis of 1.5 radii.
    CHECK(std::abs(m.inclination_deg - expected.inclination_deg) * test::pi / 180 * 1.5 < tolerance);
    CHECK(std::abs(m.axes[0] - expected.axes[0]) < tolerance);
    CHECK(std::abs(m.area_error) < 1e-10);
    CHECK(std::abs(m.volume_error) < 1e-10);
    CHECK(order >= before);
    before = order;
  }
  CHECK(before > NumericsParameters{}.least_order);
}

TEST_CASE(
    "the error that fewer degrees predict is that which more degrees find, all of it where the flow only stretches, "
    "and more of it where the flow ends before material has turned") {
  // A pulse of shear 1 that ends at 0.5 turns material by a quarter.
  const double short_pulse = 0.15 + 0.85 * std::exp(-1.0);
  for (const auto& [kind, p, until, share] : {std::tuple{"shear", 8, 5.0, 0.15},
                                              {"shear", 12, 5.0, 0.15},
                                              {"shear", 8, 0.5, short_pulse},
                                              {"extension", 8, 5.0, 1.0}}) {
    Scene scene = followed(1e-4, 10, 5);
    scene.flows[0].kind = kind;
    if (until < 5) {
      scene.flows[0].time_factor = "step";
      scene.flows[0].until = until;
    }
    scene.vesicles[0].order = p;
    Plans plans;
    const Model s = make_model(scene, plans);
    Dynamics before = initial_dynamics(s);
    expect(s, before, evaluate(s, before).value());
    start_steps(s, before);
    Dynamics after = before;
    for (int k = 0; k < 12; ++k) {
      before = after;
      Step step = take_step(s, before, before.dt_limit).value();
      plan_next(s, before, step);
      after = step.dynamics;
    }
    const std::vector<SpaceError> error = space_errors(s, before, after);
    REQUIRE(error.size() == 1);
    // The same step with four degrees more has this step as its own of four degrees less.
    const std::vector<int> more{p + 4};
    const Dynamics finer = in_orders(s, before, more).value();
    const Step step = take_step(s, finer, after.time - before.time).value();
    const Basis& basis = plans.basis(p + 4, measure_order(p + 4));
    const Geometry g = geometry(basis, step.dynamics.vesicles[0].position);
    const Matrix difference = basis
                                  .synthesize({p + 4, step.dynamics.vesicles[0].motion.velocity.values -
                                                          resized(after.vesicles[0].motion.velocity, p + 4).values})
                                  .values;
    const Vector along = difference.cwiseProduct(g.n).rowwise().sum();
    const double found = share * std::sqrt(integrate(g, along.cwiseAbs2()) / (4 * test::pi));
    INFO(kind << " until " << until << ", order " << p << ": predicted " << error[0].here << ", found " << found
              << ", lower " << error[0].lower);
    // The decay with the degree is only roughly geometric.
    CHECK(error[0].here < 4 * found);
    CHECK(error[0].here > found / 4);
    CHECK(error[0].lower > error[0].here);
  }
}

TEST_CASE("more degrees change no surface, and fewer keep its area and volume") {
  Plans plans;
  Scene scene = followed(1e-3, 10, 2);
  scene.vesicles[0].order = 10;
  const Model s = make_model(scene, plans);
  Dynamics d = initial_dynamics(s);
  expect(s, d, evaluate(s, d).value());
  d = test::advanced(s, d, 0.05, 6);
  const std::vector<int> more{14}, fewer{8};
  const Dynamics raised = in_orders(s, d, more).value(), back = in_orders(s, d, fewer).value();
  const VesicleDynamics &v = d.vesicles[0], &higher = raised.vesicles[0], &lower = back.vesicles[0];
  CHECK(higher.position.order == 14);
  CHECK(resized(higher.position, 10).values == v.position.values);
  CHECK(higher.position.values.bottomRows(coefficient_count(14) - coefficient_count(10)).isZero(0));
  REQUIRE(higher.history.levels.size() == v.history.levels.size());
  for (const PastLevel& level : higher.history.levels) {
    CHECK(level.position.order == 14);
    CHECK(level.motion.tension.order == 14);
    CHECK(level.sliding.order == 14);
  }
  CHECK(lower.position.order == 8);
  const Measures size = measures(measured_geometry(plans, lower.position));
  CHECK(size.area / v.area == Approx(1).epsilon(1e-11));
  CHECK(size.volume / v.volume == Approx(1).epsilon(1e-11));
  // Both go on.
  CHECK(take_step(s, raised, 0.05).value().dynamics.vesicles[0].position.order == 14);
  CHECK(take_step(s, back, 0.05).value().dynamics.vesicles[0].position.order == 8);
}

TEST_CASE("a run whose orders change is the same, byte for byte, where it was interrupted") {
  const Scene scene = late_flow();
  const Run whole(scene);
  REQUIRE(whole.outcome.end == SimulationEnd::finished);
  const TrajectoryReader reader(whole.path);
  const int first = reader.state(0).vesicles[0].position.order,
            last = reader.state(reader.count() - 1).vesicles[0].position.order;
  REQUIRE(last > first);
  CHECK(reader.layout().order >= last);
  CHECK(reader.damaged().empty());
  const std::vector<StepRecord> steps = reader.steps();
  CHECK(steps.front().vesicles[0].degree == first);
  CHECK(steps.back().vesicles[0].degree == last);
  CHECK(stated_errors(steps).degrees > 0);
  const std::string bytes = support::read_file(whole.path);
  std::size_t change = 0;
  while (steps[change].vesicles[0].degree == first) ++change;
  for (const std::size_t pause : {change, change + 1, steps.size() - 1}) {
    INFO("after " << pause << " of " << steps.size() << " steps");
    CHECK(support::read_file(Run(scene, int(pause)).path) == bytes);
  }
}

TEST_CASE("bounds of automatic orders are kept, and with fixed steps the order is eight") {
  Scene scene = followed(1e-4, 0.1, 1);
  scene.numerics.most_order = 7;
  CHECK(TrajectoryReader(Run(scene).path).state(1).vesicles[0].position.order == 7);
  scene.numerics.most_order = 32;
  scene.numerics.least_order = 13;
  scene.time.tolerance = 1e-2;
  CHECK(TrajectoryReader(Run(scene).path).state(1).vesicles[0].position.order == 13);
  scene.time.tolerance.reset();
  scene.time.step = 0.05;
  CHECK(TrajectoryReader(Run(scene).path).state(1).vesicles[0].position.order == 8);
}

TEST_CASE("vesicles a film apart begin with the degrees that resolve it, or with a warning that they lack them") {
  Scene scene = followed(1e-2, 10, 1);
  scene.vesicles.push_back(scene.vesicles[0]);
  const double thickness = 2 * spheroid_axes(0.85, true).y();
  const auto order_at = [&](double gap) {
    scene.vesicles[1].center = {0, thickness + gap, 0};
    Plans plans;
    return resolved_start(make_model(scene, plans)).vesicles[1].position.order;
  };
  CHECK(order_at(1) == 6);
  // The least p of exp(-2.1 p sqrt(0.05)) < 0.01/2 is 11.3; a rise goes to half of that, 12.8.
  CHECK(order_at(0.05) == 14);
  scene.numerics.most_order = 8;
  scene.vesicles[1].center.y() = thickness + 0.05;
  SimulationOptions options;
  support::TemporaryFolder folder;
  options.trajectory = folder.path() / "t.h5";
  options.scene_text = "a scene";
  options.steps = 1;
  std::string warnings;
  SimulationObserver observer;
  observer.on_warning = [&](const std::string& warning) { warnings += warning; };
  simulate(scene, options, observer);
  CHECK_THAT(warnings, Catch::Contains("order 8 leaves errors") && Catch::Contains("try numerics.most_order 12"));
}

TEST_CASE("with fixed steps vesicles nearer than their order tells apart are warned of, and no others") {
  Scene scene = followed(1e-2, 10, 1);
  scene.time.tolerance.reset();
  scene.time.step = 0.05;
  scene.vesicles.push_back(scene.vesicles[0]);
  const double thickness = 2 * spheroid_axes(0.85, true).y();
  const auto warnings_at = [&](int order, double gap) {
    for (VesicleParameters& v : scene.vesicles) v.order = order;
    scene.vesicles[1].center = {0, thickness + gap, 0};
    Plans plans;
    const Model model = make_model(scene, plans);
    return scene_warnings(model, initial_dynamics(model));
  };
  // exp(-2.1 p sqrt(h)) is a quarter of h at 0.062 for p = 8, and at 0.035 for p = 12.
  CHECK(warnings_at(8, 0.08).empty());
  CHECK(warnings_at(12, 0.05).empty());
  const std::vector<std::string> warnings = warnings_at(8, 0.05);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Catch::Contains("vesicle 0 (and 1 more): the nearest neighbour is 0.05 area radii away") &&
                              Catch::Contains("order 8 tells gaps from 0.062 on") && Catch::Contains("try order 10"));
  CHECK_THAT(warnings_at(8, 0.002).at(0), Catch::Contains("begin farther apart"));
}
