#include "app/figures/phase_diagram.h"

#include "app/figures/motions.h"
#include "app/pictures/instants.h"
#include "app/scene/scene_text.h"

#include "render/scene/detail.h"
#include "render/scene/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>

namespace app {

namespace {

std::optional<double> number_in(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

/// A number of the scenes that is not the same in all.
struct Varied {
  std::string key;
  std::vector<double> values;  ///< of each scene
};

bool is_physics(const std::string& key) {
  return !key.empty() && !key.starts_with("time.") && !key.starts_with("numerics.");
}

/// "vesicle.radius" for "vesicle.0.radius"; empty for that of another vesicle.
std::string of_first_vesicle(const std::string& key) {
  constexpr std::string_view table = "vesicle.";
  if (!key.starts_with(table) || key.size() == table.size() || key[table.size()] < '0' || key[table.size()] > '9')
    return key;
  const std::size_t dot = key.find('.', table.size());
  return dot != std::string::npos && key.substr(table.size(), dot - table.size()) == "0"
             ? std::string(table) + key.substr(dot + 1)
             : "";
}

std::vector<Varied> varied_in(const std::vector<FigureSource>& sources) {
  std::vector<Varied> all;
  std::map<std::string, std::string> firsts;
  std::vector<std::map<std::string, std::string>> others(sources.size());
  std::vector<std::string> keys;  // in the order of the scenes' tables
  for (std::size_t k = 1; k < sources.size(); ++k)
    for (const SceneDifference& d : physics_differences(sources.front().settings.scene, sources[k].settings.scene)) {
      const std::string key = of_first_vesicle(d.key);
      if (!is_physics(key)) continue;
      if (firsts.try_emplace(key, d.first).second) keys.push_back(key);
      others[k][key] = d.second;
    }
  for (const std::string& key : keys) {
    Varied varied{key, {}};
    for (const std::map<std::string, std::string>& own : others) {
      const auto found = own.find(key);
      if (const std::optional<double> v = number_in(found == own.end() ? firsts[key] : found->second))
        varied.values.push_back(*v);
    }
    if (varied.values.size() == sources.size()) all.push_back(std::move(varied));
  }
  return all;
}

std::string last_word(const std::string& key) { return key.substr(key.rfind('.') + 1); }

std::string listed(const std::vector<Varied>& all) {
  std::string text;
  for (const Varied& v : all) text += (text.empty() ? "" : ", ") + v.key;
  return text;
}

const Varied& find_varied(const std::vector<Varied>& all, const std::string& name) {
  std::vector<std::string_view> known;
  for (const Varied& v : all) {
    if (v.key == name || last_word(v.key) == name) return v;
    known.push_back(v.key);
  }
  throw std::invalid_argument(
      fmt::format("figure.axes: the scenes do not differ in '{}'{}", name, sim::suggestion(name, known)));
}

std::array<const Varied*, 2> axes_of(const std::vector<Varied>& all, const std::vector<std::string>& wanted) {
  if (!wanted.empty()) {
    if (wanted.size() != 2) throw std::invalid_argument("figure.axes names two keys of the scene, or none");
    return {&find_varied(all, wanted[0]), &find_varied(all, wanted[1])};
  }
  if (all.size() == 2) return {&all[0], &all[1]};
  if (all.size() < 2)
    throw std::invalid_argument(
        all.empty() ? "a phase diagram needs trajectories whose scenes differ in two numbers; these differ in none"
                    : fmt::format("a phase diagram needs trajectories whose scenes differ in two numbers; these differ "
                                  "in {} only",
                                  all[0].key));
  throw std::invalid_argument(fmt::format("the scenes differ in {}; choose two of them by figure.axes", listed(all)));
}

/// "viscosity contrast λ" for vesicle.viscosity_contrast.
std::string label_of(const std::string& key) {
  std::string label = last_word(key);
  std::replace(label.begin(), label.end(), '_', ' ');
  const std::string symbol = symbol_of(key);
  return symbol.empty() ? label : label + " " + symbol;
}

constexpr std::array kinds{sim::AxisMotion::tank_treading, sim::AxisMotion::swinging, sim::AxisMotion::tumbling,
                           sim::AxisMotion::untold};

/// Sections of the first vesicle in the course of the last period, relative to its centre.
void add_outlines(render::DiagramPoint& point, const FigureSource& source, const VesicleMotion& motion,
                  const render::FigureParameters& parameters) {
  constexpr int instants = 6;  // of a motion that turns
  const double end = source.trajectory.time(source.trajectory.count() - 1);
  const bool turns = motion.motion == sim::AxisMotion::swinging || motion.motion == sim::AxisMotion::tumbling;
  std::vector<double> times;
  if (turns && motion.to > motion.from)
    for (int k = 0; k < instants; ++k) times.push_back(motion.from + (motion.to - motion.from) * k / instants);
  times.push_back(turns && motion.to > motion.from ? motion.from : end);
  const double length = length_of(source.trajectory);
  point.time = times.back();
  for (const double time : times) {
    const sim::State state = state_at(source.trajectory, time);
    const sim::Coefficients& position = state.vesicles.front().position;
    const render::Sketch sketch = render::sketch_of(state.vesicles.front());
    for (const glm::dvec3& p : sketch.points)
      point.reach = std::max(point.reach, glm::distance(p, sketch.centre) / length);
    std::vector<render::ClosedCurve> curves =
        render::cut(position, render::plane_of(parameters, render::volume_moments(position).centroid));
    for (render::ClosedCurve& curve : curves) curve.points /= length;
    point.outlines.push_back(std::move(curves));
  }
}

}  // namespace

render::Diagram phase_diagram(const std::vector<FigureSource>& sources, const render::FigureParameters& parameters) {
  const std::vector<Varied> varied = varied_in(sources);
  const auto [x, y] = axes_of(varied, parameters.axes);
  render::FigureParameters through_centre = parameters;
  through_centre.plane_point.clear();
  render::Diagram diagram;
  diagram.x = label_of(x->key);
  diagram.y = label_of(y->key);
  for (const sim::AxisMotion kind : kinds)
    diagram.kinds.emplace_back(kind == sim::AxisMotion::untold ? "not determined" : sim::name_of(kind));
  diagram.csv = fmt::format("{},{},motion,period,angle_mean\n", x->key, y->key);
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const VesicleMotion motion = motions_of(sources[k].trajectory, sources[k].settings.scene).front();
    render::DiagramPoint& point = diagram.points.emplace_back();
    point.x = x->values[k];
    point.y = y->values[k];
    point.kind = static_cast<std::size_t>(std::find(kinds.begin(), kinds.end(), motion.motion) - kinds.begin());
    add_outlines(point, sources[k], motion, through_centre);
    diagram.csv += fmt::format("{:.10g},{:.10g},{},{:.10g},{:.10g}\n", point.x, point.y, diagram.kinds[point.kind],
                               motion.period, motion.mean);
  }
  return diagram;
}

}  // namespace app
