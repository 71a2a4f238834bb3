#include "sim/stepping/saved_start.h"

#include "sim/core/checksum.h"
#include "sim/measures/diagnostics.h"
#include "sim/sphere/norms.h"
#include "sim/stepping/evaluate.h"
#include "sim/surface/shapes.h"
#include "sim/trajectory/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

/// Of the saved state at a time, which must be one.
std::int64_t state_at_time(const TrajectoryReader& file, const std::string& path, double time) {
  constexpr double rounding = 1e-9;
  std::int64_t after = 0;
  while (after < file.count() && file.time(after) < time * (1 - rounding)) ++after;
  if (after < file.count() && file.time(after) <= time * (1 + rounding)) return after;
  std::string nearest;
  if (after > 0) nearest = fmt::format("{:.10g}", file.time(after - 1));
  if (after < file.count()) nearest += fmt::format("{}{:.10g}", nearest.empty() ? "" : " and ", file.time(after));
  throw std::runtime_error(fmt::format("'{}' has no state at time {}; the nearest {} {}", path, time,
                                       nearest.find(' ') == std::string::npos ? "is at" : "are at", nearest));
}

/// Of the shape that a scene gives a vesicle; 0: it does not say.
struct GivenSize {
  double area = 0, volume = 0;
};
GivenSize size_in_scene(Plans& plans, VesicleParameters v, int order) {
  if (v.shape != "file") {
    v.order = order;  // that of the state: what another order changes is no other vesicle
    const Measures m = measures(measured_geometry(plans, initial_position(v)));
    return {m.area, m.volume};
  }
  GivenSize size;
  if (v.area) size.area = *v.area;
  if (v.radius) size.area = 4 * std::numbers::pi * *v.radius * *v.radius;
  if (size.area > 0 && v.reduced_volume)
    size.volume = *v.reduced_volume * std::pow(size.area, 1.5) / (6 * std::sqrt(std::numbers::pi));
  return size;
}

}  // namespace

std::string state_checksum(const State& state) {
  Checksum sum;
  for (const VesicleState& v : state.vesicles)
    for (const Matrix* m : {&v.position.values, &v.labels.values, &v.tracers})
      sum.add({reinterpret_cast<const char*>(m->data()), std::size_t(m->size()) * sizeof(double)});
  return sum.text();
}

SavedStart read_start(const StartParameters& start) {
  const std::string& path = start.from.value();
  const TrajectoryReader file(path);
  if (file.count() == 0) throw std::runtime_error(fmt::format("'{}' has no state to start from", path));
  SavedStart saved;
  saved.state = file.state(start.time ? state_at_time(file, path, *start.time) : file.count() - 1);
  saved.checksum = state_checksum(saved.state);
  if (start.checksum && *start.checksum != saved.checksum)
    throw std::runtime_error(fmt::format("the state at time {} of '{}' is another one: its checksum is {}",
                                         saved.state.time, path, saved.checksum));
  return saved;
}

std::optional<State> start_state(const Scene& scene, const Ranks& ranks) {
  if (!scene.start.from) return std::nullopt;
  State state;
  if (ranks.first()) state = read_start(scene.start).state;
  from_first(ranks, state, [](Parcel& parcel, State& all) { transfer(parcel, all); });
  return state;
}

std::optional<SceneObjection> start_objection(Plans& plans, const Scene& scene, const State& state) {
  const std::string from = scene.start.from.value_or("");
  if (scene.vesicles.size() != state.vesicles.size())
    return SceneObjection{
        "start", "from",
        fmt::format("the scene has {} vesicle{}, '{}' has {}; leave [[vesicle]] and [[placement]] out "
                    "to take those of the file",
                    scene.vesicles.size(), scene.vesicles.size() == 1 ? "" : "s", from, state.vesicles.size())};
  constexpr double same = 0.01;  // runs without numerics.correction drift
  for (std::size_t k = 0; k < state.vesicles.size(); ++k) {
    GivenSize given;
    try {
      given = size_in_scene(plans, scene.vesicles[k], state.vesicles[k].position.order);
    } catch (const std::exception& error) {
      return SceneObjection{"vesicle", "shape", error.what()};
    }
    Measures there;
    try {
      there = measures(measured_geometry(plans, state.vesicles[k].position));
    } catch (const std::domain_error& error) {
      return SceneObjection{"start", "from", fmt::format("vesicle {} of '{}': {}", k, from, error.what())};
    }
    if (!(there.area > 0 && there.volume > 0))
      return SceneObjection{"start", "from", fmt::format("vesicle {} of '{}' encloses no volume", k, from)};
    for (const auto& [what, here, other] :
         {std::tuple{"area", given.area, there.area}, std::tuple{"volume", given.volume, there.volume}})
      if (here > 0 && !(std::abs(here - other) <= same * other))
        return SceneObjection{
            "start", "from",
            fmt::format("vesicle {} has the {} {:.6g} in the scene and {:.6g} in '{}'; leave [[vesicle]] and "
                        "[[placement]] out to take those of the file",
                        k, what, here, other, from)};
  }
  return std::nullopt;
}

double cut_off(const Coefficients& x, int order) { return tail_share(x, order + 1); }

std::string cut_warning(const Scene& scene, const State& from, std::span<const Coefficients> positions) {
  constexpr double worth_a_word = 1e-8;
  std::size_t worst = 0, lower = 0;
  double most = 0;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const double lost = cut_off(from.vesicles[k].position, positions[k].order);
    lower += lost > worth_a_word ? 1U : 0U;
    if (lost > most) most = lost, worst = k;
  }
  if (lower == 0) return {};
  return fmt::format("order {} cuts off {:.2g} of its radius from the shape of vesicle {} in '{}', of order {}{}",
                     positions[worst].order, most, worst, scene.start.from.value_or(""),
                     from.vesicles[worst].position.order,
                     lower > 1 ? fmt::format(", and less from {} others", lower - 1) : std::string());
}

}  // namespace sim
