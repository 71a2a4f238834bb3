#include "app/pictures/instants.h"

#include "render/scene/sequence.h"
#include "sim/core/digits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace app {

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
