// Figures 4 and 6: whole simulations, whose scenes and trajectories are left beside the figures.
#include "app/export/simulation.h"
#include "app/figures/figures.h"
#include "app/reproduce/reproduce_items.h"
#include "app/scene/scene_file.h"
#include "app/scene/scene_text.h"

#include "sim/measures/diagnostics.h"
#include "sim/trajectory/trajectory.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace app {

namespace fs = std::filesystem;

namespace {

/// Simulates into folder/NAME.h5 and leaves the scene in folder/NAME.toml.
SimulationReport simulate_scene(const Settings& settings, const std::string& name, const Effort& effort) {
  const fs::path folder = effort.options.output;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("cannot make folder '{}': {}", folder.string(), error.message()));
  const fs::path scene = folder / (name + ".toml"), trajectory = folder / (name + ".h5");
  // A trajectory is an earlier one of ours where our scene stands beside it.
  if (fs::exists(trajectory) && !effort.options.force && !OwnedFiles(folder).listed(scene.filename().string()))
    throw std::runtime_error(
        fmt::format("'{}' exists and was not made by this command; give another -o, or --force to replace it",
                    trajectory.string()));
  effort.files.write(scene, write_scene(settings));
  Options options = effort.options;
  options.steps.reset();
  effort.progress.clear();
  SimulationReport report = simulate_new(settings, trajectory, options);
  if (report.interrupted) throw Interrupted{trajectory};
  return report;
}

sim::TrajectoryReader open_trajectory(const std::string& name, const Effort& effort) {
  return sim::TrajectoryReader(effort.options.output / (name + ".h5"));
}

/// Largest errors of area and volume in the last step; the smallest gap and all retries of a run.
struct RunRecord {
  double area_error = 0, volume_error = 0, gap = std::numeric_limits<double>::infinity();
  int retries = 0;
};
RunRecord record_of(const sim::TrajectoryReader& trajectory) {
  RunRecord r;
  for (const sim::StepRecord& step : trajectory.steps()) {
    r.gap = std::min(r.gap, step.gap);
    r.retries += static_cast<int>(step.retries);
    r.area_error = r.volume_error = 0;
    for (const sim::VesicleStep& vesicle : step.vesicles) {
      r.area_error = std::max(r.area_error, std::abs(vesicle.area_error));
      r.volume_error = std::max(r.volume_error, std::abs(vesicle.volume_error));
    }
  }
  return r;
}

std::vector<sim::VesicleMeasures> measures_of(sim::Plans& plans, const sim::State& state) {
  std::vector<sim::VesicleMeasures> all;
  for (const sim::VesicleState& vesicle : state.vesicles) all.push_back(sim::measure(plans, vesicle, 1, 1));
  return all;
}

std::string end_of(const SimulationReport& report) {
  return report.stopped.empty() ? "completes" : fmt::format("stops: {}", report.stopped);
}

}  // namespace

Report reproduce_poiseuille(const Effort& effort) {
  const std::vector<std::string> shorter =
      effort.quick ? std::vector<std::string>{"time.end=0.8", "time.save_every=0.1"} : std::vector<std::string>{};
  const auto read = [&](std::vector<std::string> changes) {
    changes.insert(changes.end(), shorter.begin(), shorter.end());
    return parse_scene(poiseuille_scene, "fig4", ".", changes);
  };
  const Settings settings = read({});
  const double unit = effort.quick ? 0.001 : 0.05;  // of time, for one of the paper's steps
  Report report;
  report.title = "Figure 4: a biconcave vesicle in Poiseuille flow";
  report.setting = {
      "Biconcave disc, ν = 0.65, area 4π, axis along the flow u_x = −0.1 (y² + z²), on the axis of the tube; κ_b = "
      "0.01, "
      "λ = 1, p = 8, Δt = 0.05, 800 steps. The paper does not state its flow rate.",
      "Drawn: bdf2 with area and volume correction. Below also the paper's own scheme, backward Euler, without."};
  TextTable table{
      "Errors of area and volume at the end.", {"scheme", "correction", "run", "e_A", "e_V", "upsampling"}, {}};
  struct Row {
    const char *name, *scheme;
    bool correction;
  };
  for (const Row& row : {Row{"fig4", "bdf2", true}, Row{"fig4-paper", "globally-implicit", false}}) {
    const Settings changed =
        read({fmt::format("time.scheme={}", row.scheme), fmt::format("numerics.correction={}", row.correction)});
    const SimulationReport run = simulate_scene(changed, row.name, effort);
    const sim::TrajectoryReader trajectory = open_trajectory(row.name, effort);
    const RunRecord record = record_of(trajectory);
    double least = 1e9, most = 0;
    for (const sim::StepRecord& step : trajectory.steps()) {
      least = std::min(least, double(step.vesicles[0].upsampling));
      most = std::max(most, double(step.vesicles[0].upsampling));
    }
    table.rows.push_back({row.scheme, row.correction ? "on" : "off", end_of(run), scientific(record.area_error, 3),
                          scientific(record.volume_error, 3), fmt::format("{}-{}", least, most)});
  }
  table.rows.push_back({"paper", "off", "completes", "4.24e-2", "5.96e-3", "4-5"});
  report.tables.push_back(table);

  const sim::TrajectoryReader trajectory = open_trajectory("fig4", effort);
  render::FigureParameters wanted;
  wanted.kind = "cross-sections";
  wanted.window = "own";
  wanted.columns = effort.quick ? 0 : 7;
  for (const int step : {0, 100, 200, 300, 400, 600, 800}) wanted.times.push_back(step * unit);
  report.figure = make_figure({{trajectory, settings, {}}}, wanted, effort.options);
  report.picture_text =
      "Sections with the plane y = 0, at steps 0, 100, 200, 300, 400, 600 and 800, as in the paper, each in a window "
      "round "
      "its centroid; the flow goes to the right.";
  return report;
}

Report reproduce_two_vesicles(const Effort& effort) {
  const std::vector<std::string> shorter =
      effort.quick
          ? std::vector<std::string>{"time.end=0.63", "numerics.near_latitudes=12", "numerics.near_longitudes=12"}
          : std::vector<std::string>{};
  const Settings settings = parse_scene(two_vesicles_scene, "fig6", ".", shorter);
  const SimulationReport run = simulate_scene(settings, "fig6", effort);
  const sim::TrajectoryReader trajectory = open_trajectory("fig6", effort);
  const RunRecord record = record_of(trajectory);
  Report report;
  report.title = "Figure 6: two vesicles in shear flow";
  report.setting = {
      "Two prolates, ν = 0.85, area 4π, long axes along x, centres ∓(1.2, 0, −0.5) (the paper's are only pictured), in "
      "the "
      "shear flow u = γ̇ z e_x; λ = 10, κ_b = 0.01, p = 8, bdf2, γ̇Δt = 0.21, 330 steps, area and volume correction on.",
      "The membranes start 0.005 R_0 apart, which degree 8 does not resolve; the near-singular rule serves all close "
      "pairs, and a "
      "repulsion of 100 μγ̇ exp(−h / 0.02 R_0) a membrane area keeps them apart."};

  sim::Plans plans;
  const std::int64_t last = trajectory.count() - 1;
  const std::vector<int> steps =
      effort.quick ? std::vector<int>{0, 1, 2, 3} : std::vector<int>{0, 30, 60, 90, 120, 150, 180, 330};
  std::string csv = "step,time,vesicle,center_x,center_y,center_z,inclination_deg\n";
  for (std::int64_t k = 0; k <= last; ++k) {
    stop_if_interrupted();
    const sim::State state = trajectory.state(k);
    const std::vector<sim::VesicleMeasures> all = measures_of(plans, state);
    for (std::size_t v = 0; v < all.size(); ++v)
      csv += fmt::format("{},{:.10g},{},{:.10g},{:.10g},{:.10g},{:.6g}\n", state.step, state.time, v, all[v].center[0],
                         all[v].center[1], all[v].center[2], all[v].inclination_deg);
  }
  TextTable table{
      "The instants shown; x, z: centre of the first vesicle, the second is its mirror image to rounding errors.",
      {"", "step", "γ̇t", "x / R_0", "z / R_0", "inclination (°)"},
      {}};
  render::FigureParameters wanted;
  wanted.kind = "snapshots";
  wanted.dots_per_inch = 300;
  for (std::size_t k = 0; k < steps.size() && steps[k] <= last; ++k) {
    const sim::State state = trajectory.state(steps[k]);
    const std::vector<sim::VesicleMeasures> all = measures_of(plans, state);
    const std::string letter = fmt::format("({})", static_cast<char>('a' + k));
    table.rows.push_back({letter, std::to_string(steps[k]), fmt::format("{:.2f}", state.time),
                          fmt::format("{:.4f}", all[0].center[0]), fmt::format("{:.4f}", all[0].center[2]),
                          fmt::format("{:.1f}", all[0].inclination_deg)});
    wanted.times.push_back(state.time);
  }
  report.tables.push_back(table);
  report.findings = {
      fmt::format(
          "The run {} {} of 330 steps, {} repeated shorter; smallest gap {:.4f} R_0; errors at the end: area {}, "
          "volume {} (required: below 1e-6).",
          end_of(run), last, record.retries, record.gap, scientific(record.area_error),
          scientific(record.volume_error)),
      "The paper shows no numbers for this figure: compare the sequence, kiss, roll over, part, tumble."};

  report.figure = make_figure({{trajectory, settings, {}}}, wanted, effort.options);
  report.figure->csv = csv;  // every state, not those shown alone
  report.picture_text =
      "Seen along the vorticity axis, x to the right, z up; all panels at one scale. Dots and lines move with the "
      "membrane.";
  return report;
}

}  // namespace app
