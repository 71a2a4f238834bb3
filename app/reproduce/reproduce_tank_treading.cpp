// Beyond the method's paper: angle and frequency of tank-treading against reduced volume, beside published points.
#include "app/figures/tank_treading.h"
#include "app/reproduce/reproduce_items.h"

#include "sim/stepping/stepper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

Report reproduce_tank_treading(const Effort& effort) {
  struct Sweep {
    double contrast;
    std::vector<double> volumes;
  };
  const std::vector<Sweep> sweeps = effort.quick
                                        ? std::vector<Sweep>{{1, {0.80, 0.95}}}
                                        : std::vector<Sweep>{{1, {0.702, 0.75, 0.80, 0.85, 0.898, 0.95, 0.974, 0.99}},
                                                             {2.7, {0.85, 0.901, 0.93, 0.96, 0.98, 0.99}},
                                                             {5.6, {0.93, 0.939, 0.95, 0.96, 0.98, 0.99}}};
  const int order = effort.quick ? 4 : 8;
  const double end = effort.quick ? 0.4 : 30, step = 0.1;
  double done = 0, all = 0;
  for (const Sweep& sweep : sweeps) all += static_cast<double>(sweep.volumes.size());
  sim::Plans plans;
  std::vector<SteadyPoint> points;
  for (const Sweep& sweep : sweeps)
    for (const double volume : sweep.volumes) {
      sim::Scene scene = sheared_prolate(order, sweep.contrast);
      scene.vesicles[0].reduced_volume = volume;
      scene.time.step = step;
      const sim::Model model = sim::make_model(scene, plans);
      sim::Dynamics dynamics = sim::initial_dynamics(model);
      while (dynamics.time < end * (1 - 1e-9)) {
        stop_if_interrupted();
        effort.progress.show((done + dynamics.time / end) / all, fmt::format("λ = {}, ν = {}", sweep.contrast, volume));
        dynamics = sim::take_step(model, dynamics, step).value().dynamics;
      }
      points.push_back(steady_point(plans, sim::evaluate(model, dynamics).value().vesicles[0], sweep.contrast, 1));
      done += 1;
    }

  Report report;
  report.title = "Tank-treading against reduced volume";
  report.setting = {
      fmt::format(
          "Prolates along x at t = 0 in the shear flow u = γ̇ z e_x, area 4π, κ_b = 0.01, p = {}, bdf2 with γ̇Δt = {}, "
          "at γ̇t = {}. Not a figure of the method's paper.",
          order, step, end),
      "Frequency: 2π over the time that a point of the membrane takes round the section y = 0."};
  TextTable table{"Published values were read from figures; in brackets their uncertainty.",
                  {"λ", "ν", "θ / π", "published θ / π", "ω / γ̇", "published ω / γ̇"},
                  {}};
  double worst_angle = 0, worst_frequency = 0;
  for (const SteadyPoint& point : points) {
    const auto published = [&](const std::vector<LiteraturePoint>& all_points, double own,
                               double& worst) -> std::string {
      for (const LiteraturePoint& l : all_points)
        if (l.viscosity_contrast == point.viscosity_contrast &&
            std::abs(l.reduced_volume - point.reduced_volume) < 1e-3) {
          worst = std::max(worst, std::abs(own - l.value));
          return fmt::format("{:.3f} ({}), {}", l.value, l.error, l.source);
        }
      return "";
    };
    table.rows.push_back({fmt::format("{}", point.viscosity_contrast), fmt::format("{:.3f}", point.reduced_volume),
                          fmt::format("{:.4f}", point.angle), published(literature_angles(), point.angle, worst_angle),
                          fmt::format("{:.4f}", point.frequency),
                          published(literature_frequencies(), point.frequency, worst_frequency)});
  }
  report.tables.push_back(table);
  report.findings = {
      fmt::format("Largest difference to a published angle {:.3f} π, to a published frequency {:.3f} γ̇. Keller and "
                  "Skalak's theory of a fixed ellipsoid (dashed in the figure) lies below where vesicles deform.",
                  worst_angle, worst_frequency)};
  render::FigureInput input;
  input.plots = tank_treading_plots(points);
  report.figure = render::find_figure("tank-treading").draw(input);
  report.picture_text =
      "Inclination and frequency of the membrane in units of the shear rate; colours tell the viscosity contrast. "
      "Rings: "
      "this program. Diamonds and squares: published. Dashes: Keller and Skalak.";
  return report;
}

}  // namespace app
