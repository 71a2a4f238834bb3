// A picture in memory, 8-bit sRGB samples, and reading and writing PNG files.
#pragma once

#include "sim/core/result_file.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace render {

/// height x width x channels bytes, top row first, rows contiguous; values are sRGB-encoded, alpha (if any) is linear.
struct Image {
  int width = 0, height = 0;
  int channels = 3;  ///< 3: RGB, 4: RGBA
  std::vector<std::uint8_t> pixels;

  Image() = default;
  Image(int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}
  std::uint8_t* at(int x, int y) {
    return pixels.data() +
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels);
  }
  const std::uint8_t* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
  friend bool operator==(const Image&, const Image&) = default;
};

enum class RowOrder { top_first, bottom_first };

/// Mean over factor x factor blocks, taken in linear light. Width and height must be multiples of factor. The result
/// is RGB and starts with the top row; `rows`: order of the rows of the source (OpenGL: bottom first).
Image downsample(const Image& source, int factor, RowOrder rows = RowOrder::top_first);
/// The same for RGBA samples whose colour is premultiplied by alpha as it is encoded, as OpenGL blends them over
/// nothing. The result is RGBA, not premultiplied: alpha is the mean of those of the samples, the colour their mean
/// weighted by alpha, so that nothing of the empty ground is in it.
Image downsample_transparent(const Image& source, int factor, RowOrder rows = RowOrder::top_first);

/// Key and text of the text chunks of a PNG file; keys 1-79 Latin characters, text UTF-8.
using PngText = std::vector<std::pair<std::string, std::string>>;

/// Throws std::runtime_error with path and reason. compression: zlib level 0-9; no PNG filter, which is best for
/// flat, smooth pictures. dots_per_inch: recorded physical resolution; 0: none.
inline constexpr int default_compression = 6;
void write_png(const std::filesystem::path& path, const Image& image, const PngText& text = {},
               int compression = default_compression, double dots_per_inch = 0,
               const sim::FileWriter& write = sim::write_file);

/// The bytes of such a file.
std::string png_bytes(const Image& image, const PngText& text = {}, int compression = default_compression,
                      double dots_per_inch = 0);

struct PngFile {
  Image image;  ///< RGB, or RGBA when the file has transparency
  PngText text;
  std::vector<std::uint8_t> lower_bytes;  ///< of 16-bit samples, whose upper bytes are the image; else empty
  std::string
      colours;  ///< other than sRGB, the file declares its samples to be this: "gamma 1", "ICC profile 'P3' (12ab34cd)"
  std::string animation;  ///< number of frames and their checksum; empty: a still
};
/// Throws std::runtime_error with one sentence: cannot be opened, is not a PNG file (with its actual format), is
/// larger than 1 GiB when unpacked, or is damaged (and how). No memory is allocated for a size that the file's length
/// cannot contain. `look` is called from time to time, and may throw to stop.
PngFile read_png(const std::filesystem::path& path, const std::function<void()>& look = {});
/// From the bytes of a file; `name` is for messages.
PngFile png_from(std::string_view bytes, const std::filesystem::path& name);
/// The same from an open file, which is left open; `name` is for messages.
PngFile read_png(std::FILE* file, const std::filesystem::path& name, const std::function<void()>& look = {});
/// Memory of the picture in bytes according to its header; 0 without a valid header.
std::uint64_t png_memory(const std::filesystem::path& path);
/// Only the text chunks; the whole file is still read and checked for damage.
PngText read_png_text(const std::filesystem::path& path);

}  // namespace render
