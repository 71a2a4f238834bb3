// A movie: raw frames are piped into an ffmpeg child process, which writes the file.
#pragma once

#include "app/base/owned_files.h"
#include "app/tables/movie_formats.h"

#include "render/image/image.h"

#include <stdexcept>
#include <string>

#include <sys/types.h>

namespace app {

class MovieEncoder {
 public:
  /// Starts ffmpeg on a draft in the folder; finish() renames it. Throws FfmpegMissing when ffmpeg is not installed.
  MovieEncoder(const MovieFormat&, OwnedFiles& folder, int width, int height, double frame_rate,
               bool transparent = false);
  MovieEncoder(const MovieEncoder&) = delete;
  MovieEncoder& operator=(const MovieEncoder&) = delete;
  /// Without finish(): stops ffmpeg and leaves nothing behind.
  ~MovieEncoder();

  /// RGB, or RGBA of a transparent movie.
  void add(const render::Image& image);
  void finish();

 private:
  /// The first line that ffmpeg wrote of an error, in brackets; nothing without one.
  std::string complaint() const;

  OwnedFiles& folder_;
  std::string name_;
  sim::Draft draft_;
  int width_, height_, channels_;
  pid_t child_ = -1;
  int pipe_ = -1;
  int said_ = -1;  ///< what ffmpeg writes of errors
};

struct FfmpegMissing : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace app
