// Figures 4 and 6: whole simulations, whose scenes and trajectories are left beside the figures.
#include "figures.h"
#include "frames.h"
#include "output.h"
#include "reproduce_items.h"
#include "reproduce_plot.h"
#include "scene_file.h"
#include "scene_text.h"
#include "simulation.h"

#include "render/camera.h"
#include "sim/diagnostics.h"
#include "sim/trajectory.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>

namespace app {

namespace fs = std::filesystem;

namespace {

/// Simulates into folder/NAME.h5 and leaves the scene in folder/NAME.toml.
SimulationReport simulate_scene(const Settings& settings, const std::string& name, const Effort& effort) {
  const fs::path folder = effort.options.output;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("cannot make folder '{}': {}", folder.string(), error.message()));
  write_whole_file(folder / (name + ".toml"), write_scene(settings));
  Options options = effort.options;
  options.steps.reset();
  effort.progress.clear();
  const SimulationReport report = simulate_new(settings, folder / (name + ".h5"), options);
  if (report.interrupted) throw Interrupted();
  return report;
}

sim::TrajectoryReader open_trajectory(const std::string& name, const Effort& effort) {
  return sim::TrajectoryReader(effort.options.output / (name + ".h5"));
}

/// Largest errors of area and volume in the last step, the smallest gap and the longest step of a run.
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
  report.setting = {"Biconcave disc, ν = 0.65, area 4π, axis along the flow u_x = −0.1 (y² + z²), on the axis of the tube; κ_b = 0.01, "
                    "λ = 1, p = 8, Δt = 0.05, 800 steps. The paper does not state its flow rate.",
                    "Drawn: bdf2 with area and volume correction. Below also the paper's own scheme, backward Euler, without."};
  TextTable table{"Errors of area and volume at the end.", {"scheme", "correction", "run", "e_A", "e_V", "upsampling"}, {}};
  struct Row {
    const char *name, *scheme;
    bool correction;
  };
  for (const Row& row : {Row{"fig4", "bdf2", true}, Row{"fig4-paper", "globally-implicit", false}}) {
    const Settings changed = read({fmt::format("time.scheme={}", row.scheme), fmt::format("numerics.correction={}", row.correction)});
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
  render::FigureInput input;
  std::vector<double> state_times;
  for (std::int64_t k = 0; k < trajectory.count(); ++k) state_times.push_back(trajectory.time(k));
  render::FigureParameters wanted;
  for (const int step : {0, 100, 200, 300, 400, 600, 800}) wanted.times.push_back(step * unit);
  for (const std::size_t k : render::chosen_states(state_times, wanted))
    input.states.push_back(trajectory.state(static_cast<std::int64_t>(k)));
  report.figure = render::find_figure("cross-sections").draw(input);
  report.picture_text = "Sections with the plane y = 0, at steps 0, 100, 200, 300, 400, 600 and 800, seen by an observer who moves "
                        "with the fluid on the axis of the tube: the vesicle falls behind.";
  return report;
}

Report reproduce_two_vesicles(const Effort& effort) {
  const std::vector<std::string> shorter =
      effort.quick ? std::vector<std::string>{"time.end=0.63", "numerics.near_latitudes=12", "numerics.near_longitudes=12"}
                   : std::vector<std::string>{};
  const Settings settings = parse_scene(two_vesicles_scene, "fig6", ".", shorter);
  const SimulationReport run = simulate_scene(settings, "fig6", effort);
  const sim::TrajectoryReader trajectory = open_trajectory("fig6", effort);
  const RunRecord record = record_of(trajectory);
  Report report;
  report.title = "Figure 6: two vesicles in shear flow";
  report.setting = {"Two prolates, ν = 0.85, area 4π, long axes along x, centres ∓(1.2, 0, −0.5) (the paper's are only pictured), in the "
                    "shear flow u = χ z e_x; λ = 10, κ_b = 0.01, p = 8, bdf2, χΔt = 0.21, 330 steps, area and volume correction on.",
                    "The membranes start 0.005 R_0 apart; the near-singular rule serves all close pairs."};

  sim::Plans plans;
  const std::int64_t last = trajectory.count() - 1;
  const std::vector<int> steps = effort.quick ? std::vector<int>{0, 1, 2, 3} : std::vector<int>{0, 30, 60, 90, 120, 150, 180, 330};
  std::string csv = "step,time,vesicle,center_x,center_y,center_z,inclination_deg\n";
  for (std::int64_t k = 0; k <= last; ++k) {
    stop_if_interrupted();
    const sim::State state = trajectory.state(k);
    const std::vector<sim::VesicleMeasures> all = measures_of(plans, state);
    for (std::size_t v = 0; v < all.size(); ++v)
      csv += fmt::format("{},{:.10g},{},{:.10g},{:.10g},{:.10g},{:.6g}\n", state.step, state.time, v, all[v].center[0],
                         all[v].center[1], all[v].center[2], all[v].inclination_deg);
  }
  TextTable table{"The instants shown; x, z: centre of the first vesicle, the second is its mirror image to rounding errors.",
                  {"", "step", "χt", "x / R_0", "z / R_0", "inclination (°)"}, {}};
  struct Panel {
    Still still;
    std::string label;
    double half_width;
  };
  std::vector<Panel> panels;
  constexpr double half_height = 1.9, margin = 0.35;
  for (std::size_t k = 0; k < steps.size() && steps[k] <= last; ++k) {
    const sim::State state = trajectory.state(steps[k]);
    const std::vector<sim::VesicleMeasures> all = measures_of(plans, state);
    const std::string letter = fmt::format("({})", static_cast<char>('a' + k));
    table.rows.push_back({letter, std::to_string(steps[k]), fmt::format("{:.2f}", state.time), fmt::format("{:.4f}", all[0].center[0]),
                          fmt::format("{:.4f}", all[0].center[2]), fmt::format("{:.1f}", all[0].inclination_deg)});
    double reach = 0;
    for (const auto& point : render::summarize(state).points) reach = std::max(reach, std::abs(double(point.x)));
    panels.push_back({{state.time, sim::Vec3::Zero(), half_height, 0, 0},
                      fmt::format("{}  χt = {:.2f}", letter, state.time), reach + margin});
  }
  report.tables.push_back(table);
  report.findings = {
      fmt::format("The run {} {} of 330 steps, {} repeated shorter; smallest gap {:.4f} R_0; errors at the end: area {}, "
                  "volume {} (required: below 1e-6).",
                  end_of(run), last, record.retries, record.gap, scientific(record.area_error), scientific(record.volume_error)),
      "The paper shows no numbers for this figure: compare the sequence, kiss, roll over, part, tumble."};

  // Rows of panels at one common scale; what is left over of a row's width widens its panels.
  const std::vector<std::size_t> row_ends = effort.quick ? std::vector<std::size_t>{panels.size()}
                                                         : std::vector<std::size_t>{3, 5, 7, 8};
  constexpr double page = 510, gap = 8, title = 17, dots = 300.0 / 72;
  double widest = 0;
  for (std::size_t r = 0, k = 0; r < row_ends.size(); ++r) {
    double sum = 0;
    for (; k < std::min(row_ends[r], panels.size()); ++k) sum += 2 * panels[k].half_width;
    widest = std::max(widest, sum);
  }
  const double scale = (page - 2 * gap) / widest;  // points per length
  const double height = 2 * half_height * scale;
  struct Place {
    double left, top, width;
  };
  std::vector<Place> places;
  for (std::size_t r = 0, k = 0; r < row_ends.size(); ++r) {
    const std::size_t end = std::min(row_ends[r], panels.size());
    if (k >= end) break;
    double sum = 0;
    for (std::size_t i = k; i < end; ++i) sum += 2 * panels[i].half_width * scale;
    const double count = static_cast<double>(end - k), extra = (page - gap * (count - 1) - sum) / count;
    double left = 0;
    for (; k < end; ++k) {
      const double width = 2 * panels[k].half_width * scale + extra;
      places.push_back({left, static_cast<double>(r) * (height + title + 4), width});
      left += width + gap;
      panels[k].still.width = std::max(16, static_cast<int>(std::lround(width * dots)));
      panels[k].still.height = std::max(16, static_cast<int>(std::lround(height * dots)));
    }
  }
  std::vector<Still> stills;
  for (const Panel& panel : panels) stills.push_back(panel.still);
  const auto images = std::make_shared<const std::vector<render::Image>>(draw_stills(trajectory, settings, stills, effort.options));
  render::Figure figure;
  figure.csv = csv;
  figure.drawing = {page, places.back().top + title + height + 4, [=](cairo_t* cairo, const render::Font& font) {
                      for (std::size_t k = 0; k < places.size(); ++k) {
                        const Place& p = places[k];
                        draw_picture(cairo, (*images)[k], p.left, p.top + title, p.width, height);
                        cairo_set_source_rgb(cairo, 0.70, 0.72, 0.75);
                        cairo_set_line_width(cairo, 0.6);
                        cairo_rectangle(cairo, p.left + 0.3, p.top + title, p.width - 0.6, height);
                        cairo_stroke(cairo);
                        cairo_set_source_rgb(cairo, 0.10, 0.10, 0.12);
                        render::draw_text(cairo, font, render::label_text, p.left + 1, p.top + title - 5, panels[k].label);
                      }
                      // A bar one R_0 long in the first panel: all panels have one scale.
                      const double x = places[0].left + 8, y = places[0].top + title + height - 8;
                      cairo_rectangle(cairo, x, y - 1.6, scale, 1.6);
                      cairo_fill(cairo);
                      render::draw_text(cairo, font, render::tick_text, x + scale / 2, y - 5, "R_{0}", render::Align::centre);
                    }};
  report.figure = std::move(figure);
  report.picture_text = "Seen along the vorticity axis, x to the right, z up; all panels at one scale. Dots and lines move with the membrane.";
  return report;
}

}  // namespace app
