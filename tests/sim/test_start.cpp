// Runs that start in a saved state of another run.
#include "../support/temporary_folder.h"
#include "sim/measures/diagnostics.h"
#include "sim/stepping/saved_start.h"
#include "sim/stepping/simulate.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <fmt/format.h>

using namespace sim;
using Catch::Contains;

namespace {

SimulationOutcome run(const Scene& scene, const std::filesystem::path& file, std::string* warning = nullptr) {
  SimulationOptions options;
  options.trajectory = file;
  options.scene_text = "a scene";
  SimulationObserver observer;
  observer.on_warning = [&](const std::string& text) {
    if (warning) *warning += text + "\n";
  };
  return simulate(scene, options, observer);
}

State last_state(const std::filesystem::path& file) {
  const TrajectoryReader reader(file);
  return reader.state(reader.count() - 1);
}

Scene started(Scene scene, const std::filesystem::path& from) {
  scene.start.from = from.string();
  return scene;
}

std::string refusal(const Scene& scene) {
  return support::message_of([&] { preview(scene); });
}

}  // namespace

TEST_CASE("a run of 2T is one of T and one from its last state, but for a time error of the order of the scheme") {
  const support::TemporaryFolder folder;
  const auto difference = [&](double dt) {
    Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 6, 3), dt, 1);
    scene.numerics.reparametrization = "off";
    run(scene, folder / "whole.h5");
    scene.time.end = 0.5;
    run(scene, folder / "half.h5");
    run(started(scene, folder / "half.h5"), folder / "other.h5");
    const State begin = TrajectoryReader(folder / "other.h5").state(0), left = last_state(folder / "half.h5");
    CHECK(begin.time == 0);
    CHECK(begin.vesicles[0].position.values == left.vesicles[0].position.values);
    CHECK(begin.vesicles[0].labels.values == left.vesicles[0].labels.values);
    const Matrix a = last_state(folder / "whole.h5").vesicles[0].position.values,
                 b = last_state(folder / "other.h5").vesicles[0].position.values;
    return (a - b).norm() / std::sqrt(4 * test::pi);
  };
  // The first steps are those of a start, bdf1 over a quarter of a step: an error of the second order.
  const double coarse = difference(0.1), fine = difference(0.05);
  CAPTURE(coarse, fine);
  CHECK(coarse < 1e-3);
  CHECK(fine < coarse / 3);
}

TEST_CASE("a state is taken over in another order, with its area and volume, and what that cuts off is told") {
  const support::TemporaryFolder folder;
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 8, 3), 0.1, 0.3);
  run(scene, folder / "a.h5");
  const Coefficients before = last_state(folder / "a.h5").vesicles[0].position;
  Plans plans;
  const Measures there = measures(measured_geometry(plans, before));
  scene = started(scene, folder / "a.h5");
  scene.time.end = 0;

  scene.vesicles[0].order = 11;
  std::string warnings;
  run(scene, folder / "b.h5", &warnings);
  const Coefficients higher = last_state(folder / "b.h5").vesicles[0].position;
  CHECK(higher.order == 11);
  CHECK(higher.values.topRows(before.values.rows()) == before.values);
  CHECK(higher.values.bottomRows(higher.values.rows() - before.values.rows()).isZero(0));
  CHECK_THAT(warnings, !Contains("cuts off"));

  scene.vesicles[0].order = 5;
  run(scene, folder / "c.h5", &warnings);
  const Coefficients lower = last_state(folder / "c.h5").vesicles[0].position;
  CHECK(lower.order == 5);
  CHECK_THAT(warnings, Contains("order 5 cuts off") && Contains("vesicle 0") && Contains("of order 8"));
  const Measures here = measures(measured_geometry(plans, lower));
  CHECK(here.area == Approx(there.area).epsilon(1e-9));
  CHECK(here.volume == Approx(there.volume).epsilon(1e-9));
  CHECK(cut_off(before, 5) < most_cut_off);
  CHECK(cut_off(before, 8) == 0);

  scene.vesicles[0].order = 0;  // automatic: at least that of the state
  scene.time.step.reset();
  scene.time.scheme.reset();
  scene.time.end = 0.1;
  CHECK(preview(scene).state.vesicles[0].position.order >= 8);
}

TEST_CASE("an order that would cut off too much of a shape is refused with one that would not") {
  const support::TemporaryFolder folder;
  VesicleParameters bumpy = test::vesicle("harmonics", 1, 6);
  bumpy.reduced_volume.reset();
  bumpy.coefficients = {{2, 0, 0.3}, {3, 3, -0.2}};
  Scene scene = test::shear_scene(bumpy, 0.1, 0);
  run(scene, folder / "a.h5");
  scene = started(scene, folder / "a.h5");
  scene.vesicles[0].order = 2;
  const Coefficients there = last_state(folder / "a.h5").vesicles[0].position;
  CHECK(cut_off(there, 2) > most_cut_off);
  int enough = 3;
  while (cut_off(there, enough) > most_cut_off) ++enough;
  CHECK_THAT(refusal(scene), Contains("order 2 would cut off") &&
                                 Contains(fmt::format("of order 6; give an order of at least {}", enough)));
  scene.start.from.reset();
  CHECK_THAT(refusal(scene), !Contains("cut off"));
}

TEST_CASE("vesicles of another number or size, times of no state and changed states are refused by name") {
  const support::TemporaryFolder folder;
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 6), 0.1, 0.2);
  scene.time.save_every = 0.1;
  run(scene, folder / "a.h5");
  scene = started(scene, folder / "a.h5");

  Scene other = scene;
  other.vesicles.push_back(other.vesicles[0]);
  CHECK_THAT(refusal(other), Contains("the scene has 2 vesicles, ") && Contains("a.h5' has 1"));
  other = scene;
  other.vesicles[0].radius = 1e-6;  // in metres
  CHECK_THAT(refusal(other), Contains("vesicle 0 has the area 1.25664e-11 in the scene and 12.566"));
  other = scene;
  other.vesicles[0].reduced_volume = 0.8;
  CHECK_THAT(refusal(other), Contains("vesicle 0 has the volume "));
  other = scene;
  other.start.time = 0.14;
  CHECK_THAT(refusal(other), Contains("has no state at time 0.14; the nearest are at 0.1 and 0.2"));
  other.start.time = 3;
  CHECK_THAT(refusal(other), Contains("the nearest is at 0.2"));
  other.start.time = 0.1;
  CHECK(preview(other).state.vesicles[0].position.values ==
        TrajectoryReader(folder / "a.h5").state(1).vesicles[0].position.values);
  other.start.checksum = read_start(scene.start).checksum;  // of the last
  CHECK_THAT(refusal(other), Contains("the state at time 0.1 of ") && Contains("is another one"));
}

TEST_CASE("vesicles that stopped where they met go on with a repulsion") {
  const support::TemporaryFolder folder;
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.95, 6, 10), 0.1, 0.4, "adaptive");
  scene.time.step.reset();
  scene.flows[0].kind = "extension";  // presses together along z
  scene.vesicles.push_back(scene.vesicles[0]);
  for (VesicleParameters& v : scene.vesicles) v.axis = Vec3::UnitX();
  scene.vesicles[1].center = {0, 0, 2 * spheroid_axes(0.95, true).y() + 0.3};
  scene.numerics.gap_floor = 0.22;
  REQUIRE(run(scene, folder / "a.h5").end == SimulationEnd::failed);
  const State stopped = last_state(folder / "a.h5");
  scene = started(scene, folder / "a.h5");
  CHECK(run(scene, folder / "b.h5").end == SimulationEnd::failed);  // as before
  scene.numerics.repulsion_strength = 60;
  scene.numerics.repulsion_range = 0.2;
  const SimulationOutcome on_it_goes = run(scene, folder / "c.h5");
  INFO(on_it_goes.reason);
  CHECK(on_it_goes.end == SimulationEnd::finished);
  const TrajectoryReader on(folder / "c.h5");
  CHECK(on.state(0).vesicles[1].position.values == stopped.vesicles[1].position.values);
  CHECK(on.time(on.count() - 1) == 0.4);
}

TEST_CASE("a cell that starts with a strain leans by it and by what the flow adds") {
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.9, 4), 0.1, 1);
  scene.cell.size = Vec3(4, 5, 6);
  const auto lean = [&](double t) { return (*cell_at(scene, t))(0, 2); };
  const double at = lean(0.9), later = lean(1.2);
  scene.start.strain = at / 6;
  CHECK(lean(0) == Approx(at).epsilon(1e-14));
  CHECK(lean(0.3) == Approx(later).epsilon(1e-14));
}
