#include "app/pictures/instants.h"

#include "render/scene/sequence.h"
#include "sim/core/digits.h"
#include "sim/membrane/cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace app {

namespace {

const double coefficient_of_one = std::sqrt(4 * std::numbers::pi);

sim::Vec3 middle_of(const sim::VesicleState& v) { return v.position.values.row(0).transpose() / coefficient_of_one; }

}  // namespace

sim::State state_at(const sim::TrajectoryReader& trajectory, double time) {
  std::int64_t low = 0, high = trajectory.count() - 1;
  while (low < high) {  // first state at or after `time`
    const std::int64_t middle = (low + high) / 2;
    if (trajectory.time(middle) < time)
      low = middle + 1;
    else
      high = middle;
  }
  sim::State after = trajectory.state(low);
  if (low == 0 || time >= after.time) return after;
  return render::interpolated(trajectory.state(low - 1), after, time);
}

sim::VesicleState moved(sim::VesicleState v, const sim::Vec3& shift) {
  const Eigen::RowVector3d change = coefficient_of_one * shift.transpose();
  v.position.values.row(0) += change;
  v.position_before.values.row(0) += change;
  return v;
}

sim::State boxed(const sim::Scene& scene, sim::State state) {
  if (!scene.cell.size) return state;
  for (sim::VesicleState& v : state.vesicles) {
    const sim::Vec3 middle = middle_of(v), shift = sim::into_box(scene, state.time, middle);
    if (shift.isZero(0)) continue;
    v = moved(std::move(v), shift);
    sim::Matrix both(2, 3);
    both << (middle + shift).transpose(), middle.transpose();
    const sim::Matrix u = sim::background_velocity(scene.flows, state.time, both);
    v.velocity.values.row(0) += coefficient_of_one * (u.row(0) - u.row(1));
  }
  return state;
}

std::vector<Shown> shown_of(const sim::Scene& scene, const render::ViewParameters& view, const sim::State& state) {
  std::vector<sim::Vec3> middles;
  for (const sim::VesicleState& vesicle : state.vesicles) middles.push_back(middle_of(vesicle));
  return shown_of(scene, view, middles, state.time);
}

std::vector<Shown> shown_of(const sim::Scene& scene, const render::ViewParameters& view,
                            const std::vector<sim::Vec3>& middles, double time) {
  std::vector<Shown> all;
  for (std::size_t v = 0; v < middles.size(); ++v) all.push_back({v, sim::Vec3::Zero()});
  const sim::CellSides sides = sim::cell_at(scene, time);
  if (!sides) return all;
  const std::vector<int>& most = view.copies;
  for (int c = -most[2]; c <= most[2]; ++c)
    for (std::size_t v = 0; v < middles.size(); ++v) {
      // A layer above leans to one side; what leaves the box there comes back on the other.
      const double length = (*sides)(0, 0), lean = c * (*sides)(0, 2);
      const double back = c == 0 ? 0 : -std::floor((middles[v][0] + lean) / length + 0.5);
      for (int b = -most[1]; b <= most[1]; ++b)
        for (int a = -most[0]; a <= most[0]; ++a)
          if (a != 0 || b != 0 || c != 0) all.push_back({v, *sides * sim::Vec3(a + back, b, c)});
    }
  return all;
}

std::vector<render::FlowLines::Line> edges_of_cell(const sim::Scene& scene) {
  std::vector<render::FlowLines::Line> edges;
  if (!scene.cell.size) return edges;
  const sim::Vec3 half = *scene.cell.size / 2;
  for (int along = 0; along < 3; ++along)
    for (const double b : {-1.0, 1.0})
      for (const double c : {-1.0, 1.0}) {
        render::FlowLines::Line& edge = edges.emplace_back();
        constexpr int parts = 24;  // each fades on its own under what lies over the picture
        for (int k = 0; k <= parts; ++k) {
          sim::Vec3 point;
          point[along] = (2.0 * k / parts - 1) * half[along];
          point[(along + 1) % 3] = b * half[(along + 1) % 3];
          point[(along + 2) % 3] = c * half[(along + 2) % 3];
          edge.points.push_back(render::to_glm(point));
        }
      }
  return edges;
}

std::vector<std::int64_t> instants_to_look_at(const sim::TrajectoryReader& trajectory) {
  const std::int64_t states = trajectory.count(), stride = std::max<std::int64_t>(1, states / 400);
  std::vector<std::int64_t> chosen;
  for (std::int64_t k = 0; k < states; k = k + 1 < states ? std::min(k + stride, states - 1) : states)
    chosen.push_back(k);
  return chosen;
}

std::int64_t frame_count(double end, double time_per_frame) {
  const double frames = std::floor(end / time_per_frame * (1 + 1e-12)) + 1;
  if (!(frames <= most_frames + 1))
    throw std::invalid_argument(fmt::format("{:.3g} frames are too many; movie.time_per_frame must be longer", frames));
  return static_cast<std::int64_t>(frames);
}

std::vector<double> frame_times(const sim::TrajectoryReader& trajectory, const render::MovieParameters& movie) {
  std::vector<double> times;
  const std::int64_t states = trajectory.count();
  if (movie.time_per_frame > 0) {
    const double end = trajectory.time(states - 1);
    const std::int64_t frames = frame_count(end, movie.time_per_frame);
    for (std::int64_t f = 0; f < frames; ++f)
      times.push_back(std::min(end, static_cast<double>(f) * movie.time_per_frame));
  } else {
    for (std::int64_t k = 0; k < states; ++k) times.push_back(trajectory.time(k));
  }
  return times;
}

double time_of_frame(const sim::TrajectoryReader& trajectory, const render::MovieParameters& movie) {
  const std::int64_t states = trajectory.count();
  if (movie.time_per_frame > 0) return movie.time_per_frame;
  return states > 1 ? trajectory.time(states - 1) / static_cast<double>(states - 1) : 0;
}

void require_time(double time, double end) {
  if (time >= 0 && time <= end * (1 + 1e-9)) return;
  const auto [last, wanted] = sim::told_apart(end, time, 6);
  throw std::invalid_argument(
      fmt::format("the trajectory goes from t = 0 to t = {}; there is no t = {}", last, wanted));
}

}  // namespace app
