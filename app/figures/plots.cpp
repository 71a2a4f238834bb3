#include "app/figures/plots.h"

#include "app/base/message.h"
#include "app/figures/motions.h"
#include "app/figures/tank_treading.h"

#include "sim/core/digits.h"
#include "sim/measures/diagnostics.h"
#include "sim/measures/rheology.h"
#include "sim/membrane/cell.h"
#include "sim/sphere/norms.h"
#include "sim/surface/dealias.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace app {

namespace {

/// Value of a series at a time: linear between its points.
double value_at(const render::Series& s, double time) {
  const auto after = std::lower_bound(s.times.begin(), s.times.end(), time);
  if (s.times.empty()) return std::nan("");
  if (after == s.times.begin()) return s.values.front();
  if (after == s.times.end()) return s.values.back();
  const auto k = static_cast<std::size_t>(after - s.times.begin());
  const double share = (time - s.times[k - 1]) / (s.times[k] - s.times[k - 1]);
  return s.values[k - 1] + share * (s.values[k] - s.values[k - 1]);
}

/// Centres in the states from a time on, with their cells.
std::vector<sim::CentresInCell> centres_from(const FigureSource& source, double from) {
  const sim::TrajectoryReader& trajectory = source.trajectory;
  sim::Plans plans;
  std::vector<sim::CentresInCell> states;
  for (std::int64_t k = 0; k < trajectory.count(); ++k) {
    if (trajectory.time(k) < from) continue;
    const sim::State state = trajectory.state(k);
    sim::CentresInCell& now = states.emplace_back();
    now.cell = *sim::cell_at(source.settings.scene, state.time);
    for (const sim::VesicleState& v : state.vesicles) now.centres.push_back(sim::measure(plans, v, 1, 1).center);
  }
  return states;
}

/// Where a mean begins: all times from there on take part.
double start_of_mean(const FigureSource& source, const std::optional<double>& from) {
  const double end = source.trajectory.time(source.trajectory.count() - 1);
  if (!from) return 2 * end / 3 * (1 - 1e-9);  // a saved state at just this time is one of them
  if (*from > end) {
    const auto [last, wanted] = sim::told_apart(end, *from, 6);
    throw std::invalid_argument(
        fmt::format("'{}' ends at t = {}: no state is left from figure.from = {} on", source.file, last, wanted));
  }
  return *from * (1 - 1e-9);
}

}  // namespace

std::vector<render::Plot> phase_plots(const std::vector<FigureSource>& sources, const render::FigureParameters& p) {
  const QuantityRow &x = find_quantity(p.abscissa), &y = find_quantity(p.ordinate);
  const SharedScales scales = shared_scales(sources);
  render::Plot plot;
  plot.x = {.label = {}, .scale = x.scale, .grid = true};
  plot.y = {.label = {}, .scale = y.scale, .grid = true};
  for (const FigureSource& source : sources) {
    const std::vector<render::Series> series = series_of(source, scales, {&x, &y}, true, Instants::dense);
    const render::Series &a = series[0], &b = series[1];
    plot.x.label = a.axis;
    plot.y.label = b.axis;
    render::Curve curve;
    curve.name = source.name;
    curve.colour = plot.curves.size();
    curve.directed = true;
    if (sources.size() > 1) {
      curve.marker = render::group_marker(curve.colour);
      curve.phase = (static_cast<double>(curve.colour) + 0.5) / static_cast<double>(sources.size());
    }
    for (std::size_t k = 0; k < a.times.size(); ++k) {
      curve.x.push_back(a.values[k]);
      curve.y.push_back(value_at(b, a.times[k]));
    }
    plot.curves.push_back(curve);
  }
  const std::size_t lines = plot.curves.size();
  for (std::size_t k = 0; k < lines; ++k) {  // where each begins
    render::Curve start;
    start.x = {plot.curves[k].x.front()};
    start.y = {plot.curves[k].y.front()};
    start.colour = k;
    start.line = false;
    start.marker = lines > 1 ? render::group_marker(k) : render::Marker::dot;
    plot.curves.push_back(start);
  }
  return {plot};
}

std::vector<render::Plot> spectra_plots(const render::FigureInput& input) {
  sim::Plans plans;
  render::Plot position;
  position.x = {.label = "degree n", .grid = true};
  position.y = {.label = "E_{n} of the position", .scale = render::Scale::logarithmic, .grid = true};
  render::Plot curvature = position;
  curvature.y.label = "E_{n} of the mean curvature";
  // By their number: instants that crowd at the start could not be told apart by their time.
  const auto last = static_cast<double>(std::max<std::size_t>(input.states.size() - 1, 1));
  constexpr std::size_t few = 4;
  constexpr double nothing = 1e-11;  // degrees that a symmetry empties
  for (const sim::State& state : input.states) {
    const sim::VesicleState& v = state.vesicles.front();
    const int p = v.position.order, q = 4 * p;
    const sim::Coefficients h = sim::mean_curvature(plans, sim::resized(v.position, q), q);
    render::Curve x, k;
    x.name = render::time_text(input, input.time_factor * state.time);
    x.instant = static_cast<double>(position.curves.size()) / last;
    x.fine = input.states.size() > few;
    x.marker = render::Marker::dot;
    k = x;
    k.marker.reset();
    k.name.clear();
    for (int n = 0; n <= q; ++n) {
      const double of_x = n <= p && n > 0 ? sim::modular_norm(v.position, n) / input.length : 0;
      const double of_h = sim::modular_norm(h, n) * input.length;
      if (of_x > nothing) x.x.push_back(n), x.y.push_back(of_x);
      if (of_h > nothing) k.x.push_back(n), k.y.push_back(of_h);
    }
    position.curves.push_back(std::move(x));
    curvature.curves.push_back(std::move(k));
  }
  int p = 0;  // an order may change
  for (const sim::State& state : input.states) p = std::max(p, state.vesicles.front().position.order);
  position.x_range = render::Range{0, 1.03 * p};
  curvature.x_range = render::Range{0, 4.1 * p};
  return {position, curvature};
}

std::vector<render::Plot> steady_plots(const std::vector<FigureSource>& sources) {
  sim::Plans plans;
  std::vector<SteadyPoint> points;
  for (const FigureSource& source : sources) {
    const sim::Scene& scene = source.settings.scene;
    if (time_unit(scene).symbol == "t") throw std::runtime_error("a figure of tank-treading needs steady shear flows");
    const sim::State last = source.trajectory.state(source.trajectory.count() - 1);
    const std::vector<VesicleMotion> motions = motions_of(source.trajectory, scene);
    for (std::size_t v = 0; v < last.vesicles.size(); ++v) {
      const std::string who = fmt::format("'{}', vesicle {}:", source.file, v);
      const sim::AxisMotion motion = motions[v].motion;
      if (motion == sim::AxisMotion::tumbling || motion == sim::AxisMotion::swinging)
        throw std::runtime_error(
            fmt::format("{} it {}, and a figure of tank-treading shows steady angles only; 'figure inclination' "
                        "shows how it turns",
                        who, text_of(motion)));
      if (motion == sim::AxisMotion::untold) tell(fmt::format("{} {}; marked as not settled", who, motions[v].why));
      points.push_back(
          steady_point(plans, last.vesicles[v], scene.vesicles[v].viscosity_contrast, time_unit(scene).factor));
      points.back().motion = motion;
    }
  }
  return tank_treading_plots(points);
}

std::vector<render::Plot> pair_plots(const std::vector<FigureSource>& sources, const render::FigureParameters& p) {
  constexpr double width = 0.1;  // of a bin, R0: a film between vesicles is some 0.1 thick
  constexpr int fewest = 10, most = 400;
  render::Plot plot;
  plot.x = {.label = "r / R_{0}", .grid = true};
  plot.y = {.label = "pair distribution g", .grid = true};
  double reach = 0;
  for (const FigureSource& source : sources) {
    const sim::Scene& scene = source.settings.scene;
    if (!scene.cell.size)
      throw std::runtime_error(fmt::format(
          "'{}' has no periodic [cell], and without one the density of pairs at random is not known", source.file));
    if (source.trajectory.layout().vesicles < 2)
      throw std::runtime_error(fmt::format("'{}' has a single vesicle, which makes no pair", source.file));
    const double length = length_of(source.trajectory), half = scene.cell.size->minCoeff() / 2;
    const int bins = std::clamp(static_cast<int>(std::lround(half / (width * length))), fewest, most);
    const sim::MeanPairs pairs =
        sim::mean_pairs(*scene.cell.size, bins, centres_from(source, start_of_mean(source, p.from)));
    render::Curve curve;
    curve.name = source.name;
    curve.csv_name = source.name.empty() ? std::string(plot.y.label) : source.name;
    curve.colour = plot.curves.size();
    curve.band = true;
    curve.error = pairs.error;
    if (sources.size() > 1) {
      curve.marker = render::group_marker(curve.colour);
      curve.phase = (static_cast<double>(curve.colour) + 0.5) / static_cast<double>(sources.size());
    }
    for (const auto& row : pairs.rows) {
      curve.x.push_back((row.from + row.to) / 2 / length);
      curve.y.push_back(row.share);
    }
    reach = std::max(reach, half / length);
    plot.curves.push_back(std::move(curve));
  }
  render::Curve one;
  one.x = {0, reach};
  one.y = {1, 1};
  one.dash = 1;
  one.guide = true;
  one.csv_name = std::string("points at random");
  plot.curves.push_back(std::move(one));
  plot.x_range = render::Range{0, reach};
  return {plot};
}

}  // namespace app
