// Instants of a trajectory: states between the saved ones, times of frames, and the states that a movie is planned
// from.
#pragma once

#include "app/scene/settings.h"

#include "sim/trajectory/trajectory.h"

#include <cstdint>
#include <vector>

namespace app {

/// The state at any time of a trajectory: cubic Hermite interpolation between saved states; the first and last state
/// outside.
sim::State state_at(const sim::TrajectoryReader&, double time);

/// Saved states, the first and the last among them, from which a movie is framed and the range of its field is taken:
/// a few hundred are enough.
std::vector<std::int64_t> instants_to_look_at(const sim::TrajectoryReader&);

/// Frames from time 0 to `end`. Throws std::invalid_argument when there are more than most_frames.
std::int64_t frame_count(double end, double time_per_frame);

/// Instants of the frames: those of the saved states, or every movie.time_per_frame.
std::vector<double> frame_times(const sim::TrajectoryReader&, const render::MovieParameters&);

/// Scene time from frame to frame, on average; 0 when there is only one.
double time_of_frame(const sim::TrajectoryReader&, const render::MovieParameters&);

/// Throws std::invalid_argument with a sentence for a time outside 0 to `end`, or NaN.
void require_time(double time, double end);

}  // namespace app
