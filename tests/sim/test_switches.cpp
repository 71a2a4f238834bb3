// Flows that change with time: switches, pulses, oscillations, and flows that do nothing.
#include "../support/temporary_folder.h"
#include "sim/membrane/flows.h"
#include "sim/stepping/simulate.h"
#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;

namespace {

Scene tilted(double step, double end) {
  VesicleParameters v = test::vesicle("prolate", 0.85, 6, 3);
  v.axis = Vec3(1, 0, 0.3);
  v.bending_modulus = 0;
  Scene scene = test::shear_scene(v, step, end);
  scene.numerics.tail_warning = 1;  // it is the flow that is tested
  return scene;
}

/// Positions of the last state, and the times at which steps ended.
struct Run {
  Matrix position;
  std::vector<double> times;
  std::vector<std::string> warnings;
};
Run run(const Scene& scene) {
  const support::TemporaryFolder folder;
  SimulationOptions options;
  options.trajectory = folder.path() / "a.h5";
  Run r;
  SimulationObserver observer;
  observer.on_step = [&](const Dynamics&, const StepRecord& record) { r.times.push_back(record.time); };
  observer.on_warning = [&](const std::string& w) { r.warnings.push_back(w); };
  CHECK(simulate(scene, options, observer).end == SimulationEnd::finished);
  const TrajectoryReader reader(options.trajectory);
  r.position = reader.state(reader.count() - 1).vesicles[0].position.values;
  return r;
}

}  // namespace

TEST_CASE("a flow that is switched on later acts from then on as one that acts from the start") {
  Scene at_once = tilted(0.1, 1);
  at_once.time.save_every = 1;
  const Run from_start = run(at_once);
  for (const double from : {0.4, 0.25, 0.333}) {
    Scene scene = tilted(0.1, 1 + from);
    scene.flows[0].time_factor = "step";
    scene.flows[0].from = from;
    scene.time.save_every = 1 + from;
    const Run later = run(scene);
    CHECK((later.position - from_start.position).norm() < 3e-8);  // a dozen solves to 1e-10
    CHECK(std::find(later.times.begin(), later.times.end(), from) != later.times.end());
  }
}

TEST_CASE("a flow that is switched off leaves the vesicle as it was at that time") {
  Scene whole = tilted(0.1, 0.57);
  whole.time.save_every = 0.57;
  const Run on = run(whole);
  Scene scene = tilted(0.1, 1.5);
  scene.flows[0].time_factor = "step";
  scene.flows[0].until = 0.57;
  scene.time.save_every = 1.5;
  const Run off = run(scene);
  CHECK((off.position - on.position).norm() < 1e-8);  // without bending nothing moves afterwards
  CHECK(std::find(off.times.begin(), off.times.end(), 0.57) != off.times.end());
}

TEST_CASE("a pulse shorter than the step acts") {
  Scene scene = tilted(0.1, 0.5);
  scene.flows[0].time_factor = "step";
  scene.flows[0].from = 0.21;
  scene.flows[0].until = 0.29;
  scene.flows[0].rate = 5;
  const Run coarse = run(scene);
  scene.time.step = 0.004;
  const Run fine = run(scene);
  const Matrix start = initial_position(scene.vesicles[0]).values;
  CHECK((fine.position - start).norm() > 0.3);
  // Four steps over strains of 0.1: the first is of first order, with an error of half the strain's square, the others
  // leave its cube.
  CHECK(coarse.times.size() < 14);
  CHECK((coarse.position - fine.position).norm() < 8e-3);
}

TEST_CASE("steps resolve the period of a flow that oscillates and say so") {
  Scene scene = tilted(0.1, 0.2);
  scene.flows[0].time_factor = "oscillating";
  scene.flows[0].frequency = 10;
  CHECK(longest_step(scene) == Approx(0.005));
  const Run fast = run(scene);
  CHECK(fast.times.size() >= 40);
  CHECK(fast.times.size() < 45);  // some shorter ones at the start
  REQUIRE(fast.warnings.size() == 1);
  CHECK_THAT(fast.warnings[0], Catch::Contains("oscillates"));
  // Two whole periods: the membrane is back where it was, up to the error of 20 steps a period.
  CHECK((fast.position - initial_position(scene.vesicles[0]).values).norm() < 2e-3);
  scene.flows[0].frequency = 0.1;
  CHECK(run(scene).warnings.empty());
  scene.flows[0].frequency = 10;
  scene.flows[0].rate = 0;
  CHECK(longest_step(scene) == Approx(0.1));
}

TEST_CASE("a flow without strength or that never acts is told of, fluid at rest is not") {
  Plans plans;
  for (const auto& row : flow_catalogue()) {
    Scene scene = tilted(0.1, 1);
    scene.flows[0] = {};
    scene.flows[0].kind = row.name;
    scene.flows[0].rate = 0;
    scene.flows[0].wavelength = 6;
    const Model s = make_model(scene, plans);
    const std::vector<std::string> warnings = scene_warnings(s, initial_dynamics(s));
    if (row.name == "none") {
      CHECK(warnings.empty());
      continue;
    }
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Catch::Contains(std::string(row.name)) && Catch::Contains("moves nothing") &&
                                Catch::Contains("flow." + std::string(row.keys.front())));
  }
  Scene scene = tilted(0.1, 1);
  scene.flows[0].time_factor = "step";
  for (const auto& [from, until] : {std::pair{2.0, 3.0}, {0.5, 0.5}, {-2.0, -1.0}}) {
    scene.flows[0].from = from;
    scene.flows[0].until = until;
    const Model s = make_model(scene, plans);
    REQUIRE(scene_warnings(s, initial_dynamics(s)).size() == 1);
    CHECK_THAT(scene_warnings(s, initial_dynamics(s))[0], Catch::Contains("never acts"));
  }
}

TEST_CASE("a shape table keeps its own axes unless an axis is given") {
  const support::TemporaryFolder folder;
  const std::filesystem::path table = folder.path() / "t.txt";
  // An ellipsoid with its long axis along x: coefficients of degree 1.
  std::FILE* out = std::fopen(table.c_str(), "w");
  std::fputs("coefficients\n1 1 3 0 0\n1 -1 0 2 0\n1 0 0 0 2\n", out);
  std::fclose(out);
  VesicleParameters v;
  v.shape = "file";
  v.file = table.string();
  v.order = 4;
  const auto longest = [&] {
    const Coefficients x = initial_position(v);
    Eigen::Index axis = 0;
    x.values.colwise().norm().maxCoeff(&axis);
    return axis;
  };
  CHECK(longest() == 0);
  v.axis = Vec3::UnitX();
  CHECK(longest() == 2);
  v.axis = Vec3::UnitZ();
  CHECK(longest() == 0);
}
