#include "app/tables/movie_formats.h"

#include "sim/core/catalogue.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

namespace app {

const std::vector<MovieFormat>& movie_formats() {
  constexpr double any = std::numeric_limits<double>::infinity();
  static const std::vector<MovieFormat> rows{
      {"mp4",
       "H.264, plays everywhere; needs even sizes",
       true,
       any,
       "mp4",
       // Players expect 4:2:0 and the colour matrix of HD.
       {"-vf", "scale=out_color_matrix=bt709:out_range=tv", "-colorspace", "bt709", "-color_primaries", "bt709",
        "-color_trc", "bt709", "-c:v", "libx264", "-preset", "veryfast", "-crf", "18", "-pix_fmt", "yuv420p",
        "-movflags", "+faststart"}},
      {"mkv",
       "FFV1, lossless: the very pixels of the frames, for archives and for cutting",
       false,
       any,
       "matroska",
       {"-c:v", "ffv1", "-level", "3", "-g", "1", "-slices", "4", "-pix_fmt", "bgr0"},
       {"-c:v", "ffv1", "-level", "3", "-g", "1", "-slices", "4", "-pix_fmt", "bgra"}},
      {"gif",
       "at most 960 px wide and 25 frames a second, 256 colours a frame, for pages and chats",
       false,
       25,
       "gif",
       {"-filter_complex",
        "scale='min(960,iw)':-1:flags=lanczos,split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:"
        "dither=bayer:bayer_scale=4",
        "-loop", "0"}},
      {"webp",
       "animated WebP, at most 1280 px wide and 60 frames a second: smaller and better than gif where it is understood",
       false,
       60,
       "webp",
       {"-vf", "scale='min(1280,iw)':-1:flags=lanczos", "-c:v", "libwebp_anim", "-quality", "88", "-compression_level",
        "4", "-loop", "0"},
       {"-vf", "scale='min(1280,iw)':-1:flags=lanczos", "-c:v", "libwebp_anim", "-pix_fmt", "yuva420p", "-quality",
        "88", "-compression_level", "4", "-loop", "0"}},
      {"webm",
       "VP9, for browsers; keeps transparency",
       false,
       any,
       "webm",
       {"-c:v", "libvpx-vp9", "-crf", "20", "-b:v", "0", "-pix_fmt", "yuv420p"},
       {"-c:v", "libvpx-vp9", "-crf", "20", "-b:v", "0", "-pix_fmt", "yuva420p", "-auto-alt-ref", "0"}},
      {"mov",
       "ProRes 4444, large and nearly lossless, for programs that cut films; keeps transparency",
       false,
       any,
       "mov",
       {"-c:v", "prores_ks", "-profile:v", "4444", "-vendor", "apl0", "-pix_fmt", "yuv444p10le"},
       {"-c:v", "prores_ks", "-profile:v", "4444", "-vendor", "apl0", "-alpha_bits", "16", "-pix_fmt", "yuva444p10le"}},
      {"apng",
       "animated PNG, lossless; keeps transparency",
       false,
       any,
       "apng",
       {"-c:v", "apng", "-pred", "mixed", "-plays", "0", "-pix_fmt", "rgb24"},
       {"-c:v", "apng", "-pred", "mixed", "-plays", "0", "-pix_fmt", "rgba"}},
  };
  return rows;
}

std::string movie_name(const MovieFormat& format) { return fmt::format("movie.{}", format.name); }

const MovieFormat& find_movie_format(std::string_view name) {
  if (const MovieFormat* row = sim::find_row(movie_formats(), name)) return *row;
  throw std::invalid_argument("unknown format '" + std::string(name) + "'" +
                              sim::suggestion(name, sim::row_names(movie_formats())));
}

void check_movie(const MovieFormat& format, int width, int height, bool transparent) {
  if (transparent && format.transparent_encoder.empty()) {
    std::string able;
    for (const MovieFormat& row : movie_formats())
      if (!row.transparent_encoder.empty()) able += (able.empty() ? "" : ", ") + std::string(row.name);
    throw std::invalid_argument(
        fmt::format("{} has no transparency: give --format one of {}, or another view.background", format.name, able));
  }
  if (!format.even_size || (width % 2 == 0 && height % 2 == 0)) return;
  throw std::invalid_argument(
      fmt::format("{} (H.264) needs an even width and height, not {} x {}: give --size {}x{}, or "
                  "--format mkv, gif or webp",
                  format.name, width, height, width + width % 2, height + height % 2));
}

}  // namespace app
