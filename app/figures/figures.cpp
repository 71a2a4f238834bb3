#include "app/figures/figures.h"

#include "app/pictures/captions.h"
#include "app/base/message.h"
#include "app/pictures/pictures.h"
#include "app/tables/quantities.h"
#include "app/pictures/flow_picture.h"
#include "app/figures/tank_treading.h"

#include "render/scene/surface.h"
#include "sim/surface/dealias.h"
#include "sim/measures/diagnostics.h"
#include "sim/sphere/norms.h"
#include "sim/suspension/velocity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace app {

namespace {

/// Area radius of the first vesicle.
double length_of(const sim::TrajectoryReader& trajectory) {
  sim::Plans plans;
  return std::sqrt(sim::measure(plans, trajectory.state(0).vesicles.front(), 1, 1).area / sim::default_area);
}

/// What the curves of several trajectories share: a scale that one of them lacks is used for none.
struct Scales {
  TimeUnit time;
  bool rate = true, bending = true;
};
Scales shared_scales(const std::vector<FigureSource>& sources) {
  Scales s{time_unit(sources.front().settings.scene), true, true};
  for (const FigureSource& source : sources) {
    const sim::Scene& scene = source.settings.scene;
    s.rate = s.rate && time_unit(scene).symbol != TimeUnit{}.symbol;
    for (const sim::VesicleParameters& v : scene.vesicles) s.bending = s.bending && v.bending_modulus > 0;
  }
  if (!s.rate) s.time = {};
  return s;
}

/// Measures of one trajectory, taken once for all the quantities that are asked for.
class Measurements {
 public:
  Measurements(const FigureSource& source, const Scales& scales)
      : source_(source), scales_(scales), time_factor_(scales.rate ? time_unit(source.settings.scene).factor : 1),
        length_(length_of(source.trajectory)) {}

  /// A series a curve and vesicle; of the first vesicle and curve only, without names, when `single`.
  std::vector<render::Series> series(const QuantityRow& row, bool single) {
    std::vector<render::Series> all;
    const int vesicles = row.per_vesicle && !single ? source_.trajectory.layout().vesicles : 1;
    for (int v = 0; v < vesicles; ++v) {
      const QuantityUnits units = units_of(static_cast<std::size_t>(v));
      const std::size_t first = all.size();
      const std::size_t curves = single ? 1 : row.curves.size();
      for (std::size_t c = 0; c < curves; ++c) {
        std::string name = curves > 1 ? row.curves[c] : "";
        const auto add = [&](const std::string& word) { name += (name.empty() ? "" : ", ") + word; };
        if (vesicles > 1) add(fmt::format("vesicle {}", v));
        if (!source_.name.empty()) add(source_.name);
        render::Series one{name, axis_label(row, units), {}, {}, row.scale, {}, v % 2 == 1, {}};  // dashed: where two agree, both are seen
        if (vesicles > 1 && curves > 1 && source_.name.empty()) {  // colours tell the curves, dashes the vesicles
          one.colour = c;
          one.legend = v == 0 ? row.curves[c] : "";
        }
        all.push_back(std::move(one));
      }
      const auto put = [&](double time, const std::vector<double>& values) {
        for (std::size_t c = 0; c < curves; ++c) {
          all[first + c].times.push_back(time_factor_ * time);
          all[first + c].values.push_back(values[c]);
        }
      };
      if (row.of_step) {
        for (const sim::StepRecord& record : steps())
          put(record.time, row.of_step(record, static_cast<std::size_t>(v), units));
      } else {
        const auto& states = measures();
        for (std::size_t k = 0; k < states.size(); ++k)
          put(times_[k], row.of_state(states[k][static_cast<std::size_t>(v)], units));
      }
      if (row.differentiate)
        for (std::size_t c = first; c < all.size(); ++c) differentiate(all[c]);
    }
    return all;
  }

 private:
  QuantityUnits units_of(std::size_t vesicle) const {
    const sim::Scene& scene = source_.settings.scene;
    return {length_, scales_.rate ? time_factor_ : 0, scales_.bending ? scene.vesicles[vesicle].bending_modulus : 0};
  }
  const std::vector<sim::StepRecord>& steps() {
    if (steps_.empty()) steps_ = source_.trajectory.steps();
    return steps_;
  }
  const std::vector<std::vector<VesicleSample>>& measures() {
    if (!measures_.empty()) return measures_;
    std::vector<double> area, volume;
    for (std::int64_t k = 0; k < source_.trajectory.count(); ++k) {
      const sim::State state = source_.trajectory.state(k);
      times_.push_back(state.time);
      measures_.emplace_back();
      for (std::size_t v = 0; v < state.vesicles.size(); ++v) {
        if (k == 0) {
          const sim::VesicleMeasures initial = sim::measure(plans_, state.vesicles[v], 1, 1);
          area.push_back(initial.area);
          volume.push_back(initial.volume);
        }
        sim::VesicleState relative = state.vesicles[v];
        relative.velocity.values.row(0) -= std::sqrt(sim::default_area) * sim::centroid_velocity(plans_, relative).transpose();
        VesicleSample sample{sim::measure(plans_, relative, area[v], volume[v])};
        const Eigen::Matrix3d m = render::volume_moments(state.vesicles[v].position).second;
        const double mean = (m(0, 0) + m(2, 2)) / 2, half = std::hypot((m(0, 0) - m(2, 2)) / 2, m(0, 2));
        const double l = std::sqrt(mean + half), b = std::sqrt(mean - half);
        sample.deformation = (l - b) / (l + b);
        measures_.back().push_back(sample);
        double& angle = measures_.back().back().inclination_deg;
        if (k > 0) angle = unwrapped(angle, measures_[measures_.size() - 2][v].inclination_deg);
      }
    }
    return measures_;
  }
  /// Central differences, one-sided at the ends.
  static void differentiate(render::Series& s) {
    const std::vector<double> values = s.values;
    const std::size_t n = values.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t a = i > 0 ? i - 1 : 0, b = std::min(i + 1, n - 1);
      s.values[i] = b > a ? (values[b] - values[a]) / (s.times[b] - s.times[a]) : std::nan("");
    }
  }

  const FigureSource& source_;
  Scales scales_;
  double time_factor_, length_;
  sim::Plans plans_;
  std::vector<double> times_;
  std::vector<std::vector<VesicleSample>> measures_;  ///< state, vesicle
  std::vector<sim::StepRecord> steps_;
};

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

std::vector<render::Plot> phase_plots(const std::vector<FigureSource>& sources, const render::FigureParameters& p) {
  const QuantityRow &x = find_quantity(p.abscissa), &y = find_quantity(p.ordinate);
  const Scales scales = shared_scales(sources);
  render::Plot plot{{"", x.scale, true, true}, {"", y.scale, true, true}, {}, {}, {}, {}};
  for (const FigureSource& source : sources) {
    Measurements measurements(source, scales);
    const render::Series a = measurements.series(x, true).front(), b = measurements.series(y, true).front();
    plot.x.label = a.axis;
    plot.y.label = b.axis;
    render::Curve curve;
    curve.name = source.name;
    curve.colour = plot.curves.size();
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
    start.marker = render::Marker::dot;
    plot.curves.push_back(start);
  }
  return {plot};
}

/// Spectra of position and curvature, a curve an instant.
std::vector<render::Plot> spectra_plots(const render::FigureInput& input) {
  sim::Plans plans;
  render::Plot position{{"degree n", render::Scale::linear, true, true}, {"E_{n} of the position", render::Scale::logarithmic, true, true},
                        {}, {}, {}, {}};
  render::Plot curvature = position;
  curvature.y.label = "E_{n} of the mean curvature";
  const double first = input.states.front().time, span = std::max(input.states.back().time - first, 1e-300);
  constexpr double nothing = 1e-11;  // degrees that a symmetry empties
  for (const sim::State& state : input.states) {
    const sim::VesicleState& v = state.vesicles.front();
    const int p = v.position.order, q = 4 * p;
    const sim::Coefficients h = sim::mean_curvature(plans, sim::resized(v.position, q), q);
    render::Curve x, k;
    x.name = render::time_text(input, input.time_factor * state.time);
    x.instant = (state.time - first) / span;
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
  const int p = input.states.front().vesicles.front().position.order;
  position.x_range = render::Range{0, static_cast<double>(p)};
  curvature.x_range = render::Range{0, 4.0 * p};
  return {position, curvature};
}

/// Motion of each vesicle over the whole trajectory.
std::vector<Motion> motions_of(const FigureSource& source) {
  const double rate = time_unit(source.settings.scene).factor;
  std::vector<double> times;
  std::vector<std::vector<double>> angles(static_cast<std::size_t>(source.trajectory.layout().vesicles));
  for (std::int64_t k = 0; k < source.trajectory.count(); ++k) {
    const sim::State state = source.trajectory.state(k);
    times.push_back(rate * state.time);
    for (std::size_t v = 0; v < state.vesicles.size(); ++v) {
      const double angle = sim::inclination(render::volume_moments(state.vesicles[v].position).second) * 180 / std::numbers::pi;
      angles[v].push_back(angles[v].empty() ? angle : unwrapped(angle, angles[v].back()));
    }
  }
  std::vector<Motion> all;
  for (const std::vector<double>& of_one : angles) all.push_back(motion_of(times, of_one));
  return all;
}

std::vector<render::Plot> steady_plots(const std::vector<FigureSource>& sources) {
  sim::Plans plans;
  std::vector<SteadyPoint> points;
  for (const FigureSource& source : sources) {
    const sim::Scene& scene = source.settings.scene;
    if (time_unit(scene).symbol == "t")
      throw std::runtime_error("a figure of tank-treading needs steady shear flows");
    const sim::State last = source.trajectory.state(source.trajectory.count() - 1);
    const std::vector<Motion> motions = motions_of(source);
    for (std::size_t v = 0; v < last.vesicles.size(); ++v) {
      const std::string who = fmt::format("'{}', vesicle {}:", source.file, v);
      if (motions[v] == Motion::tumbling || motions[v] == Motion::swinging)
        throw std::runtime_error(fmt::format("{} it {}, and a figure of tank-treading shows steady angles only; 'figure inclination' "
                                             "shows how it turns", who, text_of(motions[v])));
      if (motions[v] == Motion::untold)
        tell(fmt::format("{} too short a run to tell whether it tank-treads, swings or tumbles; marked as not settled", who));
      points.push_back(steady_point(plans, last.vesicles[v], scene.vesicles[v].viscosity_contrast, time_unit(scene).factor));
      points.back().motion = motions[v];
    }
  }
  return tank_treading_plots(points);
}

void add_stills(render::FigureInput& input, const FigureSource& source, const Options& options) {
  Settings settings = source.settings;
  settings.view.supersampling = std::max(settings.view.supersampling, 3);
  input.camera = settings.view.camera;
  const double pixels = render::dots_per_inch(input.parameters) / 72;
  std::vector<Still> stills;
  const render::Sheet sheet = render::sheet_layout(input);
  for (std::size_t k = 0; k < sheet.panels.size(); ++k) {
    const render::SheetPanel& p = sheet.panels[k];
    stills.push_back({input.states[k].time, p.target, p.half_height, std::max(16, static_cast<int>(std::lround(p.width * pixels))),
                      std::max(16, static_cast<int>(std::lround(p.height * pixels)))});
  }
  input.stills = draw_stills(source.trajectory, settings, stills, options);
}

void add_flow(render::FigureInput& input, const FigureSource& source) {
  sim::Plans plans;
  const sim::Scene& scene = source.settings.scene;
  const TimeUnit unit = time_unit(scene);
  input.flow = flow_picture(plans, scene, input.states.front(),
                            flow_request(plans, input.states.front(), input.parameters, input.length));
  const std::string speed = input.parameters.frame == "vesicle" ? "in-plane |u − U|" : "in-plane |u|";
  if (unit.symbol != "t") {
    input.flow.speed_factor = 1 / (unit.factor * input.length);
    input.flow.speed_label = speed + " / γ̇R_{0}";
  } else {
    input.flow.speed_label = speed;
  }
}

}  // namespace

bool takes_several(std::string_view kind) {
  return kind == "time-series" || kind == "phase" || kind == "tank-treading";
}

render::Figure make_figure(const std::vector<FigureSource>& sources, const render::FigureParameters& parameters,
                           const Options& options) {
  const render::FigureRow& kind = render::find_figure(parameters.kind);
  const FigureSource& first = sources.front();
  const sim::TrajectoryReader& trajectory = first.trajectory;
  render::FigureInput input;
  input.parameters = parameters;
  const TimeUnit unit = time_unit(first.settings.scene);
  input.time_symbol = unit.symbol;
  input.time_factor = unit.factor;
  input.length = length_of(trajectory);
  const Scales scales = shared_scales(sources);
  std::vector<double> times;
  for (std::int64_t k = 0; k < trajectory.count(); ++k) times.push_back(trajectory.time(k));
  const auto take = [&](const std::vector<std::size_t>& chosen) {
    for (const std::size_t k : chosen) input.states.push_back(trajectory.state(static_cast<std::int64_t>(k)));
  };
  switch (kind.needs) {
    case render::FigureNeeds::series:
      input.time_factor = 1;  // the series bring their own
      input.time_symbol = scales.time.symbol;
      for (const FigureSource& source : sources) {
        Measurements measurements(source, scales);
        for (const std::string& name : parameters.quantities)
          for (render::Series& series : measurements.series(find_quantity(name), false)) input.series.push_back(std::move(series));
      }
      break;
    case render::FigureNeeds::plots:
      if (kind.name == "phase") {
        input.plots = phase_plots(sources, parameters);
      } else if (kind.name == "spectra") {
        take(render::chosen_states(times, parameters));
        input.plots = spectra_plots(input);
      } else {
        input.plots = steady_plots(sources);
      }
      break;
    case render::FigureNeeds::all_states:
      for (std::size_t k = 0; k < times.size(); ++k) take({k});
      break;
    case render::FigureNeeds::instants: take(render::chosen_states(times, parameters)); break;
    case render::FigureNeeds::stills:
      take(render::chosen_states(times, parameters));
      add_stills(input, first, options);
      break;
    case render::FigureNeeds::flow:
      if (parameters.times.empty()) take({times.size() - 1});
      else take({render::chosen_states(times, parameters).front()});
      add_flow(input, first);
      break;
  }
  return kind.draw(input);
}

std::vector<std::filesystem::path> draw_figure(const std::vector<FigureSource>& sources,
                                               const render::FigureParameters& parameters, const std::filesystem::path& stem,
                                               const sim::FileWriter& write, const Options& options) {
  return render::write_figure(make_figure(sources, parameters, options), stem, {}, write);
}

}  // namespace app
