// Movie formats written by ffmpeg, one row each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace app {

struct MovieFormat {
  std::string_view name;  ///< also the extension
  std::string_view meaning;
  bool even_size;  ///< the encoder requires even widths and heights
  double fastest;  ///< most frames per second that players support; others are dropped
  std::string_view muxer;
  std::vector<std::string> encoder;                   ///< arguments of ffmpeg after the input
  std::vector<std::string> transparent_encoder = {};  ///< of frames with alpha; empty: the format has none
};
const std::vector<MovieFormat>& movie_formats();
/// In an output folder.
std::string movie_name(const MovieFormat&);
/// Throws std::invalid_argument that names the nearest known format.
const MovieFormat& find_movie_format(std::string_view name);

/// Throws std::invalid_argument with one sentence when a movie of this size, or a transparent one, cannot be made.
void check_movie(const MovieFormat&, int width, int height, bool transparent = false);

}  // namespace app
