// From trajectories to frames/000000.png, ... and a movie, or to one still.
#pragma once

#include "app/base/options.h"
#include "app/base/owned_files.h"
#include "app/base/result_files.h"
#include "app/pictures/pictures.h"

namespace app {

struct FrameReport {
  std::int64_t drawn = 0;  ///< now
  std::int64_t kept = 0;   ///< complete already, from an earlier run of the same scene, view and program
  bool interrupted = false;
  std::filesystem::path movie;   ///< empty: none
  std::filesystem::path poster;  ///< likewise
  std::string poster_remark;     ///< why there is no poster although one was requested
  std::string remark;            ///< why there is no movie
  bool movie_failed = false;     ///< ... although ffmpeg is installed; the frames are complete anyway
};

/// Draws this shard's missing frames into folder/frames and, with one shard only, the movie beside it. Several
/// sources are drawn side by side; the movie lasts as long as the longest, the others stop at their ends. A movie
/// made from exactly the same frames at the same rate is kept. Throws, before anything is changed, when an output
/// name is taken by a file of the user.
FrameReport render_frames(const std::vector<PictureSource>&, OwnedFiles& folder, const Options&,
                          const std::optional<PlotStrip>& plots = {});

/// The picture of one instant. Throws std::invalid_argument when the trajectory does not reach it.
void render_still(const std::vector<PictureSource>&, double time, const std::filesystem::path&, ResultFiles&,
                  const Options&, const std::optional<PlotStrip>& plots = {});

/// Software OpenGL has threads of its own; the pictures do not depend on their number. For the whole process, and only
/// before anything is drawn: what the environment says already stays. 0: as many as it likes.
void limit_drawing_threads(int threads);

}  // namespace app
