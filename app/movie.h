// A movie: frames go as raw samples through a pipe into an ffmpeg child process, which writes the file.
#pragma once

#include "movie_formats.h"
#include "owned_files.h"

#include "render/image.h"

#include <stdexcept>
#include <string>

#include <sys/types.h>

namespace app {

class MovieEncoder {
 public:
  /// Starts ffmpeg on a draft in the folder; finish() gives it its name. Throws FfmpegMissing when there is none.
  MovieEncoder(const MovieFormat&, OwnedFiles& folder, int width, int height, double frame_rate);
  MovieEncoder(const MovieEncoder&) = delete;
  MovieEncoder& operator=(const MovieEncoder&) = delete;
  /// Without finish(): ffmpeg is stopped and nothing is left.
  ~MovieEncoder();

  void add(const render::Image& rgb);
  void finish();

 private:
  OwnedFiles& folder_;
  std::string name_;
  sim::Draft draft_;
  int width_, height_;
  pid_t child_ = -1;
  int pipe_ = -1;
};

struct FfmpegMissing : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace app
