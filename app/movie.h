// A movie: frames go as raw samples through a pipe into an ffmpeg child process, which writes the file.
#pragma once

#include "movie_formats.h"

#include "render/image.h"

#include <filesystem>
#include <stdexcept>

#include <sys/types.h>

namespace app {

class MovieEncoder {
 public:
  /// Starts ffmpeg for `path` (written beside it, renamed by finish()). Throws FfmpegMissing when there is none.
  MovieEncoder(const MovieFormat&, const std::filesystem::path& path, int width, int height, double frame_rate);
  MovieEncoder(const MovieEncoder&) = delete;
  MovieEncoder& operator=(const MovieEncoder&) = delete;
  /// Without finish(): ffmpeg is stopped and nothing is left.
  ~MovieEncoder();

  void add(const render::Image& rgb);
  void finish();

 private:
  std::filesystem::path path_, draft_;
  int width_, height_;
  pid_t child_ = -1;
  int pipe_ = -1;
};

struct FfmpegMissing : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace app
