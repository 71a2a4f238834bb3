#include "../support/temporary_folder.h"
#include "sim/core/parallel.h"
#include "sim/stepping/simulate.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <fstream>

using namespace sim;

namespace {

Scene short_scene(double end = 0.6) {
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 6, 3), 0.1, end);
  scene.time.save_every = 0.2;
  scene.numerics.reparametrization = "always";
  return scene;
}

SimulationOutcome run(const Scene& scene, const std::filesystem::path& file, bool resume = false,
                      std::int64_t steps = -1, std::function<bool()> stop = {}) {
  SimulationOptions options;
  options.trajectory = file;
  options.resume = resume;
  options.steps = steps;
  options.scene_text = "test";
  SimulationObserver observer;
  observer.should_stop = std::move(stop);
  return simulate(scene, options, observer);
}

/// All numbers of all states and step records.
std::vector<double> contents(const std::filesystem::path& file) {
  const TrajectoryReader reader(file);
  std::vector<double> all;
  const auto add = [&](const Matrix& m) { all.insert(all.end(), m.data(), m.data() + m.size()); };
  for (std::int64_t k = 0; k < reader.count(); ++k) {
    const State s = reader.state(k);
    all.push_back(double(s.step));
    all.push_back(s.time);
    for (const VesicleState& v : s.vesicles) {
      for (const auto* c :
           {&v.position, &v.velocity, &v.tension, &v.labels, &v.position_before, &v.velocity_before, &v.sliding})
        add(c->values);
      add(v.tracers);
      all.push_back(double(v.relabelled));
    }
  }
  for (const StepRecord& r : reader.steps()) {
    for (const double x : {r.step, r.time, r.dt, r.iterations, r.residual, r.order, r.error}) all.push_back(x);
    for (const VesicleStep& v : r.vesicles) all.insert(all.end(), {v.area_error, v.energy, v.tail, v.correction});
  }
  return all;
}

std::string bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("a run that is stopped and resumed anywhere equals the uninterrupted one bit for bit, in every scheme") {
  for (const auto& row : scheme_catalogue()) {
    INFO(row.name);
    Scene scene = short_scene();
    scene.time.scheme = row.name;
    const support::TemporaryFolder folder;
    run(scene, folder.path() / "whole.h5");
    const std::vector<double> whole = contents(folder.path() / "whole.h5");
    for (const int stop : {1, 2, 3, 5}) {
      const auto file = folder.path() / ("part" + std::to_string(stop) + ".h5");
      CHECK(run(scene, file, false, stop).end == SimulationEnd::step_limit);
      CHECK(run(scene, file, true).end == SimulationEnd::finished);
      const bool same = contents(file) == whole;
      CHECK(same);
    }
  }
}

TEST_CASE("a run in a cell that shears is resumed bit for bit, too") {
  Scene scene = short_scene();
  scene.vesicles[0].order = 4;
  scene.cell.size = Vec3(3.8, 3.2, 3.4);
  const support::TemporaryFolder folder;
  run(scene, folder.path() / "whole.h5");
  CHECK(run(scene, folder.path() / "part.h5", false, 2).end == SimulationEnd::step_limit);
  CHECK(run(scene, folder.path() / "part.h5", true).end == SimulationEnd::finished);
  const bool same = contents(folder.path() / "part.h5") == contents(folder.path() / "whole.h5");
  CHECK(same);
}

TEST_CASE("the same scene gives the same bytes twice, and with one and two threads") {
  const support::TemporaryFolder folder;
  with_threads(1, [&] {
    run(short_scene(), folder.path() / "a.h5");
    run(short_scene(), folder.path() / "b.h5");
  });
  with_threads(2, [&] { run(short_scene(), folder.path() / "c.h5"); });
  const bool twice = bytes(folder.path() / "a.h5") == bytes(folder.path() / "b.h5");
  const bool threaded = bytes(folder.path() / "a.h5") == bytes(folder.path() / "c.h5");
  CHECK(twice);
  CHECK(threaded);
}

TEST_CASE("states are saved at the times asked for, and the end is always one of them") {
  const support::TemporaryFolder folder;
  Scene scene = short_scene(0.5);
  scene.time.save_every = 0.13;  // no multiple of the step
  run(scene, folder.path() / "t.h5");
  const TrajectoryReader reader(folder.path() / "t.h5");
  const double times[] = {0, 0.13, 0.26, 0.39, 0.5};
  REQUIRE(reader.count() == 5);
  for (int k = 0; k < 5; ++k) CHECK(reader.time(k) == Approx(times[k]).epsilon(1e-14));
  for (const StepRecord& r : reader.steps()) CHECK(r.dt <= 0.1 + 1e-12);
}

TEST_CASE("zero steps evaluate the initial state only") {
  const support::TemporaryFolder folder;
  CHECK(run(short_scene(), folder.path() / "zero.h5", false, 0).end == SimulationEnd::step_limit);
  const TrajectoryReader reader(folder.path() / "zero.h5");
  CHECK(reader.count() == 1);
  CHECK(reader.state(0).vesicles[0].velocity.values.norm() > 0.1);
}

TEST_CASE("an interrupt ends the run after the step it came in") {
  const support::TemporaryFolder folder;
  int asked = 0;
  const auto outcome = run(short_scene(), folder.path() / "i.h5", false, -1, [&] { return ++asked == 3; });
  CHECK(outcome.end == SimulationEnd::interrupted);
  CHECK(outcome.step == 3);
}

TEST_CASE("a run that cannot go on stops with its reason and the last good state in the file") {
  const support::TemporaryFolder folder;
  Scene scene = short_scene(50);
  scene.flows[0].time_factor = "step";
  scene.flows[0].from = 0.25;
  scene.flows[0].rate = 1e7;  // far beyond what the retries can follow
  scene.numerics.step_retries = 2;
  const auto outcome = run(scene, folder.path() / "f.h5");
  CHECK(outcome.end == SimulationEnd::failed);
  CHECK(outcome.reason.find("t = ") == 0);
  const TrajectoryReader reader(folder.path() / "f.h5");
  const State last = reader.state(reader.count() - 1);
  CHECK(last.time == Approx(outcome.time));
  CHECK(last.vesicles[0].position.values.allFinite());
  bool said = false;
  for (const std::string& note : reader.notes()) said = said || note.find("stopped at") != std::string::npos;
  CHECK(said);
}

TEST_CASE("a gap that closes on its floor ends the run at once, with the reason and without halvings") {
  const support::TemporaryFolder folder;
  Scene scene = short_scene();
  scene.flows[0].kind = "extension";  // presses together along z
  scene.time.step.reset();
  scene.time.scheme.reset();
  scene.vesicles = {test::vesicle("prolate", 0.95, 6, 10), test::vesicle("prolate", 0.95, 6, 10)};
  const double thickness = 2 * spheroid_axes(0.95, true).y();
  for (VesicleParameters& v : scene.vesicles) v.axis = Vec3::UnitX();
  scene.vesicles[1].center = {0, 0, thickness + 0.3};
  scene.numerics.gap_floor = 0.25;
  int warnings = 0;
  SimulationObserver observer;
  observer.on_warning = [&](const std::string& w) { warnings += w.find("trying a step") != std::string::npos; };
  SimulationOptions options;
  options.trajectory = folder.path() / "g.h5";
  options.scene_text = "a scene";
  const auto outcome = simulate(scene, options, observer);
  CHECK(outcome.end == SimulationEnd::failed);
  CHECK(outcome.reason.find("come within numerics.gap_floor = 0.25") != std::string::npos);
  CHECK(outcome.reason.find("numerics.repulsion_strength = ") != std::string::npos);
  CHECK(outcome.reason.find("(its range is 0.05)") != std::string::npos);
  CHECK(warnings == 0);
}

TEST_CASE("a failing step is retried with half its length before the run gives up") {
  const support::TemporaryFolder folder;
  Scene scene = short_scene(0.4);
  scene.numerics.correction = false;
  scene.time.scheme = "globally-implicit";
  scene.time.save_every.reset();
  scene.numerics.step_area_bound =
      3e-4;  // backward Euler at dt = 0.1 inflates by more, at dt = 0.05 by a quarter of it
  run(scene, folder.path() / "r.h5");
  const TrajectoryReader reader(folder.path() / "r.h5");
  double retries = 0;
  for (const StepRecord& r : reader.steps()) retries += r.retries;
  CHECK(retries > 0);
  CHECK(reader.time(reader.count() - 1) == Approx(0.4));
}
