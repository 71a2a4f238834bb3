// From a trajectory to frames/000000.png, ... and a movie.
#pragma once

#include "options.h"
#include "settings.h"

#include "render/image.h"
#include "sim/trajectory.h"

namespace app {

/// Instants of the frames: those of the saved states, or every movie.time_per_frame.
std::vector<double> frame_times(const sim::TrajectoryReader&, const render::MovieParameters&);

/// The scene at any instant of a trajectory: cubic (Hermite) between saved states.
sim::State state_at(const sim::TrajectoryReader&, double time);

struct FrameReport {
  std::int64_t drawn = 0;  ///< now
  std::int64_t kept = 0;   ///< complete from an earlier run of the same scene, view and program
  bool interrupted = false;
  bool movie = false;      ///< movie.mp4 is there
  std::string remark;      ///< why there is no movie
  bool movie_failed = false;  ///< ... though there is an ffmpeg; the frames are complete all the same
};

/// Draws this shard's missing frames into folder/frames and, with one shard only, the movie into folder/movie.mp4.
/// redo_movie: encode it even if it is there and no frame was drawn.
FrameReport render_frames(const sim::TrajectoryReader&, const Settings&, const std::filesystem::path& folder,
                          const Options&, bool redo_movie);

/// One instant as a panel of a figure: orthographic, without captions, `half_height` above and below `target`.
struct Still {
  double time = 0;
  sim::Vec3 target = sim::Vec3::Zero();
  double half_height = 2;
  int width = 600, height = 400;
};
std::vector<render::Image> draw_stills(const sim::TrajectoryReader&, const Settings&, const std::vector<Still>&,
                                       const Options&);

}  // namespace app
