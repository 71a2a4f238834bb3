// A picture in memory: 8-bit sRGB samples, and its way to and from PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
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
    return pixels.data() + (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
                               static_cast<std::size_t>(channels);
  }
  const std::uint8_t* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
  friend bool operator==(const Image&, const Image&) = default;
};

enum class RowOrder { top_first, bottom_first };

/// Mean over factor x factor blocks, taken in linear light. Width and height must be multiples of factor.
/// The result is RGB and starts with the top row; `rows` says how the rows of the source are ordered (OpenGL: bottom
/// first).
Image downsample(const Image& source, int factor, RowOrder rows = RowOrder::top_first);

/// Where two pictures of one size differ: channels are compared as 8-bit values.
struct ImageDifference {
  int maximum = 0;             ///< largest difference of a channel
  std::int64_t above_two = 0;  ///< pixels with a channel that differs by more than 2
  double rmse = 0;             ///< root mean square over all channels, in 8-bit units
};
/// Throws std::invalid_argument when the sizes differ. Only red, green, blue count.
ImageDifference difference(const Image& a, const Image& b);
/// The rule for pictures of one scene drawn by different Mesa versions or processors: at most max(10, 2e-5 N) of the
/// N pixels differ by more than 2, and the root mean square is at most 0.15.
bool same_picture(const ImageDifference&, std::int64_t pixels);
/// |a - b| x gain, saturated: what to look at when they differ.
Image difference_image(const Image& a, const Image& b, int gain = 16);

/// Key and text of the text chunks of a PNG file; keys 1-79 Latin characters, text UTF-8.
using PngText = std::vector<std::pair<std::string, std::string>>;

/// Writes to a temporary file beside `path`, then renames: the name never shows an incomplete file.
/// Throws std::runtime_error with path and reason; the temporary file is gone then.
/// compression: zlib level 0-9; no PNG filter, which suits flat, smooth pictures best.
void write_png(const std::filesystem::path& path, const Image& image, const PngText& text = {}, int compression = 6);

struct PngFile {
  Image image;  ///< RGB, or RGBA when the file has transparency
  PngText text;
};
/// Throws std::runtime_error with one sentence: cannot be opened, is no PNG file, or is damaged (and how).
PngFile read_png(const std::filesystem::path& path);
/// The text chunks alone; the whole file is read and checked for damage all the same.
PngText read_png_text(const std::filesystem::path& path);

}  // namespace render
