// The viscosity of suspensions in sheared periodic cells, from the dilute limit to a volume fraction of 0.4.
#include "app/validate/validations.h"

#include "sim/measures/rheology.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace app {

namespace {

constexpr double reduced_volume = 0.9;

Changes in_cube(double side, int count, double contrast) {
  return {fmt::format("cell.size=[{0}, {0}, {0}]", side), fmt::format("placement.count={}", count),
          fmt::format("vesicle.viscosity_contrast={}", contrast)};
}

double relative_viscosity(Trials& trials, const Trial& trial, std::int64_t number) {
  const sim::Scene& scene = trial.settings.scene;
  const sim::State state = trial.trajectory.state(number);
  std::vector<sim::VesicleMeasures> vesicles;
  std::vector<sim::Vec3> centres;
  for (const sim::VesicleState& v : state.vesicles) {
    vesicles.push_back(sim::measure(trials.plans(), v, 1, 1));
    centres.push_back(vesicles.back().center);
  }
  return sim::suspension_measures(scene, vesicles, sim::flow_measures(trials.plans(), scene, state), centres)
      .relative_viscosity;
}

struct Mean {
  double value = 0, spread = 0;  ///< one standard deviation
};
Mean mean_of(const std::vector<double>& values) {
  Mean m;
  for (const double v : values) m.value += v / static_cast<double>(values.size());
  for (const double v : values) m.spread += std::pow(v - m.value, 2) / static_cast<double>(values.size());
  m.spread = std::sqrt(m.spread);
  return m;
}

/// What many vesicles in a cell do to its viscosity.
struct Crowd {
  Mean viscosity;  ///< over time
  double gap = std::numeric_limits<double>::infinity();
};
Crowd crowd(Trials& trials, double fraction, double contrast, int seed) {
  constexpr int count = 16;
  const double side = std::cbrt(count * reduced_volume * 4 * std::numbers::pi / 3 / fraction);
  const Trial trial =
      trials.run("crowd", in_cube(rounded(side, 4), count, contrast) +
                              Changes{fmt::format("placement.seed={}", seed), "placement.orientation=\"random\""});
  std::vector<double> values;
  for (std::int64_t k = trial.trajectory.count() / 2; k < trial.trajectory.count(); ++k)
    values.push_back(relative_viscosity(trials, trial, k));
  Crowd result{mean_of(values)};
  for (const sim::StepRecord& step : trial.trajectory.steps()) result.gap = std::min(result.gap, step.gap);
  return result;
}

/// Intrinsic viscosity of one vesicle in unbounded fluid, and what cells make of it.
double dilute(Trials& trials, Section& s, double contrast) {
  const Changes same{"vesicle.order=8",
                     fmt::format("vesicle.viscosity_contrast={}", contrast),
                     fmt::format("vesicle.reduced_volume={}", reduced_volume),
                     "vesicle.bending_modulus=0.1",
                     "vesicle.axis=[1, 0, 0]",
                     "time.end=6"};
  const double unbounded = trials.last_flow(trials.run("tank-treading", same)).intrinsic_viscosity;
  std::vector<std::pair<double, double>> found;  // over the volume fraction
  for (const double side : {8.0, 12.0}) {
    const Trial trial = trials.run("crowd", in_cube(side, 1, contrast));
    const double fraction = reduced_volume * 4 * std::numbers::pi / 3 / std::pow(side, 3);
    found.emplace_back(fraction, (relative_viscosity(trials, trial, trial.trajectory.count() - 1) - 1) / fraction);
    s.note(fmt::format("λ = {}: (η_r − 1)/φ of one vesicle in a cube of side {}, φ = {:.5f}", contrast, side, fraction),
           fmt::format("{:.4f}", found.back().second));
  }
  const auto [far, thin] = found[1];
  const double slope = (found[0].second - thin) / (found[0].first - far);
  s.check(fmt::format("λ = {}: the same, extended to φ = 0, beside [η] in unbounded fluid", contrast),
          thin - slope * far, rounded(unbounded, 4), 0.002);
  return unbounded;
}

}  // namespace

Section validate_crowds(Trials& trials) {
  Section s{
      "Relative viscosity η_r of vesicles (ν = 0.9, κ_b = 0.1, p = 8) in cubes that shear with the flow. One vesicle "
      "in "
      "a cube: (η_r − 1)/φ, extended to φ = 0 by a line through two sizes, is the intrinsic viscosity [η] of one "
      "vesicle in unbounded fluid; 0.002 is left to the next order of φ. Sixteen vesicles, placed and turned at random "
      "by three seeds, up to a strain of 6: every run must come to its end, membranes kept apart by a repulsion of "
      "60 μγ̇ exp(−h / 0.05 R₀), and η_r, its mean over strains 3 to 6, must lie above the dilute 1 + [η]φ and "
      "grow with φ, by more than what seeds differ by. ± is one standard deviation over time for a seed, over seeds "
      "for their mean. Sixteen vesicles over such a strain are no steady suspension: at φ = 0.4 seeds differ most."};
  s.checks();
  const std::vector<double> contrasts{1, 5}, fractions{0.1, 0.2, 0.3, 0.4};
  std::map<double, double> intrinsic;
  for (const double contrast : contrasts) intrinsic[contrast] = dilute(trials, s, contrast);
  s.table({"λ", "φ", "seed 1", "seed 2", "seed 3", "η_r", "1 + [η]φ", "least gap", ""});
  render::Plot plot;
  plot.x = {.label = "volume fraction φ", .grid = true};
  plot.y = {.label = "relative viscosity η_{r}", .grid = true};
  std::size_t colour = 0;
  for (const double contrast : contrasts) {
    std::vector<double> x, y, line;
    double before = 1;
    for (const double fraction : fractions) {
      std::vector<std::string> cells{fmt::format("{}", contrast), fmt::format("{}", fraction)};
      std::vector<double> seeds;
      double gap = std::numeric_limits<double>::infinity();
      for (const int seed : {1, 2, 3}) {
        const Crowd one = crowd(trials, fraction, contrast, seed);
        cells.push_back(fmt::format("{:.3f} ± {:.3f}", one.viscosity.value, one.viscosity.spread));
        seeds.push_back(one.viscosity.value);
        gap = std::min(gap, one.gap);
        x.push_back(fraction);
        y.push_back(one.viscosity.value);
      }
      const Mean all = mean_of(seeds);
      const double thin = 1 + intrinsic[contrast] * fraction;
      cells.push_back(fmt::format("{:.3f} ± {:.3f}", all.value, all.spread));
      cells.push_back(fmt::format("{:.3f}", thin));
      cells.push_back(fmt::format("{:.3f}", gap));
      cells.push_back(s.verdict(all.value - all.spread > thin && all.value - all.spread > before));
      before = all.value;
      s.row(cells);
    }
    const std::vector<double> ends{0, fractions.back()};
    for (const double end : ends) line.push_back(1 + intrinsic[contrast] * end);
    plot.curves.push_back(point_curve(fmt::format("λ = {}, three seeds", contrast), x, y, colour,
                                      colour == 0 ? render::Marker::ring : render::Marker::diamond));
    plot.curves.push_back(line_curve(fmt::format("λ = {}: 1 + [η]φ", contrast), ends, line, colour, 1));
    ++colour;
  }
  s.figure = panels({plot});
  s.caption = "Relative viscosity over the volume fraction: points are runs of 16 vesicles, lines the dilute limit.";
  return s;
}

}  // namespace app
