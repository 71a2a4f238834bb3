// Hard scenes: none may look fine and be wrong.
#include "app/validate/validations.h"

#include "app/tables/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace app {

namespace {

struct HardScene {
  const char *name, *base;
  Changes changes;
};

const std::vector<HardScene>& hard_scenes() {
  const auto pair = [](const char* centre, const char* other, double contrast, double end) {
    return Changes{fmt::format("vesicle.0.center={}", centre),
                   fmt::format("vesicle.1.center={}", other),
                   "vesicle.axis=[1,0,0]",
                   "numerics.most_order=16",
                   fmt::format("vesicle.viscosity_contrast={}", contrast),
                   fmt::format("time.end={}", end)};
  };
  const auto colliding = [pair](double contrast, double end) {
    return pair("[0,0,0.9]", "[0,0,-0.9]", contrast, end) + Changes{"flow.kind=extension"};
  };
  const auto passing = [pair](double contrast, double end) {
    return pair("[-1.2,0,0.5]", "[1.2,0,-0.5]", contrast, end);
  };
  static const std::vector<HardScene> scenes{
      {"drawn out along an axis towards a neck",
       "tank-treading",
       {"flow.kind=extension", "flow.planar=false", "vesicle.reduced_volume=0.6", "flow.rate=2", "time.end=0.75"}},
      {"drawn out in a plane",
       "tank-treading",
       {"flow.kind=extension", "vesicle.reduced_volume=0.7", "flow.rate=3", "time.end=0.5"}},
      {"slender in shear, ν = 0.6", "tank-treading", {"vesicle.reduced_volume=0.6", "time.end=4"}},
      {"slender in shear, ν = 0.5", "tank-treading", {"vesicle.reduced_volume=0.5", "time.end=1"}},
      {"pressed together, λ = 1", "encounter", colliding(1, 1)},
      {"pressed together, λ = 10", "encounter", colliding(10, 1)},
      {"pressed together, λ = 50", "encounter", colliding(50, 1)},
      {"rolling over each other, λ = 10", "encounter", passing(10, 1.5)},
      {"rolling over each other, λ = 50", "encounter", passing(50, 1.5)},
      {"disc in a narrow tube flow, on the axis", "parachute", {"flow.curvature=1", "time.end=0.5"}},
      {"disc in a narrow tube flow, beside the axis",
       "parachute",
       {"flow.curvature=1", "vesicle.center=[0,0,0.5]", "time.end=0.25"}},
      {"λ = 0.001", "tank-treading", {"vesicle.viscosity_contrast=0.001", "time.end=1"}},
      {"λ = 1000", "tank-treading", {"vesicle.viscosity_contrast=1000", "time.end=8"}},
      {"shear that oscillates fast",
       "tank-treading",
       {"flow.time_factor=oscillating", "flow.frequency=5", "time.end=1"}},
      {"shear that oscillates slowly",
       "tank-treading",
       {"flow.time_factor=oscillating", "flow.frequency=0.2", "time.end=10"}},
      {"a short strong pulse of shear",
       "tank-treading",
       {"flow.rate=5", "flow.time_factor=step", "flow.from=0.31", "flow.until=0.39", "time.end=1"}},
      {"no bending", "tank-treading", {"vesicle.bending_modulus=0", "time.end=5"}},
      {"stiff, κ_b = 10", "tank-treading", {"vesicle.bending_modulus=10", "time.end=1"}},
      {"nearly a sphere, ν = 0.9999", "tank-treading", {"vesicle.reduced_volume=0.9999", "time.end=5"}},
      {"far downstream", "tank-treading", {"vesicle.center=[1e6,0,0]", "time.end=5"}},
      {"far up, in a fast stream", "tank-treading", {"vesicle.center=[0,0,100]", "time.end=5"}},
      {"tiny units", "tank-treading", {"vesicle.radius=1e-6", "vesicle.bending_modulus=1e-20", "time.end=5"}},
      {"strong shear, 1000", "tank-treading", {"flow.rate=1000", "time.end=0.005"}}};
  return scenes;
}

/// Largest over the vesicles of the distance of the final membranes, R0: root mean square over the area.
double final_distance(const Trial& a, const Trial& b) {
  const auto& source = std::get<OfMembranes>(sim::find_row(results(), "shape-distance")->source);
  const sim::State last = a.last(), reference = b.last();
  double most = 0;
  for (std::size_t v = 0; v < last.vesicles.size(); ++v) {
    sim::Plans plans;
    const double area = sim::measure(plans, reference.vesicles[v], 1, 1).area;
    most =
        std::max(most, source.distance(last.vesicles[v], reference.vesicles[v], std::sqrt(area / sim::default_area)));
  }
  return most;
}

struct HardRun {
  Trial trial;
  double stated = 0;  ///< error of position by steps and degrees, R0
  std::string work;   ///< steps, iterations of each, degrees
};

HardRun hard_run(Trials& trials, const HardScene& scene, double tolerance) {
  const Changes own{"vesicle.order=auto", fmt::format("time.tolerance={}", tolerance)};
  HardRun run{.trial = trials.attempt(scene.base, scene.changes + own), .stated = 0, .work = {}};
  const sim::ErrorStatement e = run.trial.statement();
  run.stated = e.time + e.degrees;
  const std::vector<sim::StepRecord> steps = run.trial.trajectory.steps();
  double iterations = 0, degree = 0;
  for (const sim::StepRecord& step : steps) {
    iterations += step.iterations / static_cast<double>(steps.size());
    for (const sim::VesicleStep& v : step.vesicles) degree = std::max(degree, v.degree);
  }
  run.work = fmt::format("{} × {:.1f}, p ≤ {:g}", steps.size(), iterations, degree);
  return run;
}

}  // namespace

Section validate_hard(Trials& trials) {
  Section s{
      "Scenes in which a method may look fine and be wrong, each with the tolerance 1e-3 and again with 1e-4, orders "
      "automatic, of pairs up to 16. Measured: the distance of the final membranes, points of one from the surface of "
      "the other wherever its points lie (root mean square over the area, of the worse vesicle, R₀). Each run states "
      "what its steps and its orders leave in the position; the distance must not exceed the sum of both statements. "
      "A run may also stop before the end, if it says why: the table then has its reason. Besides: steps, iterations "
      "of the linear solver for each, and the highest order."};
  s.table({"scene", "changed", "distance", "stated, 1e-3", "stated, 1e-4", "steps, 1e-3", "steps, 1e-4", ""});
  std::vector<double> distances, statements;
  for (const HardScene& scene : hard_scenes()) {
    const HardRun coarse = hard_run(trials, scene, 1e-3), fine = hard_run(trials, scene, 1e-4);
    std::string changed = fmt::format("{}: ", scene.base);
    for (const std::string& change : scene.changes)
      changed += fmt::format("{}`{}`", change == scene.changes.front() ? "" : ", ", change);
    std::string distance;
    bool good = true;
    if (coarse.trial.stopped.empty() && fine.trial.stopped.empty()) {
      const double apart = final_distance(coarse.trial, fine.trial), stated = coarse.stated + fine.stated;
      distance = fmt::format("{:.1e}", apart);
      good = apart <= stated;
      distances.push_back(apart);
      statements.push_back(stated);
    } else {
      for (const HardRun* run : {&coarse, &fine})
        if (!run->trial.stopped.empty())
          distance += fmt::format("{}{} stops at {}", distance.empty() ? "" : "; ", run == &coarse ? "1e-3" : "1e-4",
                                  run->trial.stopped);
    }
    s.row({scene.name, changed, distance, fmt::format("{:.1e}", coarse.stated), fmt::format("{:.1e}", fine.stated),
           coarse.work, fine.work, s.verdict(good)});
  }
  render::Plot plot;
  plot.x = {.label = "stated by both runs / R_{0}", .scale = render::Scale::logarithmic, .grid = true};
  plot.y = {.label = "distance of the final shapes / R_{0}", .scale = render::Scale::logarithmic, .grid = true};
  if (!statements.empty()) {
    const auto [low, high] = std::minmax_element(statements.begin(), statements.end());
    plot.curves = {line_curve("as stated", {*low, *high}, {*low, *high}, 1, 1),
                   point_curve("scenes", statements, distances, 0, render::Marker::ring)};
    s.figure = panels({plot});
    s.caption = "What the runs are apart against what they state: below the line a statement holds.";
  }
  return s;
}

}  // namespace app
