#include "compare.h"

#include "flip.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace render {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

void check_same_size(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height)
    throw std::invalid_argument(fmt::format("pictures of different size: {}x{} and {}x{}", a.width, a.height, b.width,
                                            b.height));
}

/// Channel c of a pixel; a picture without alpha is opaque.
int channel(const Image& image, const std::uint8_t* pixel, int c) { return c < image.channels ? pixel[c] : 255; }

bool counts(const Ignored& ignored, std::size_t pixel) { return ignored.empty() || ignored[pixel] == 0; }

}  // namespace

std::span<const ComparePreset> compare_presets() {
  static const std::array<ComparePreset, 3> presets{
      {{"exact", "every channel of every pixel is equal", {.channel = 0, .pixels = 0, .share = 0, .rmse = 0}},
       {"default", "equal but for rounding: other processors, other versions of the drawing libraries", {}},
       {"perceptual", "no difference that stays visible when one flips between the two (FLIP)",
        {.pixels = unlimited, .rmse = unlimited, .flip_mean = 0.05, .flip_max = 0.4}}}};
  return presets;
}

ImageDifference difference(const Image& a, const Image& b, const CompareRule& rule, const Ignored& ignored) {
  check_same_size(a, b);
  ImageDifference result;
  const int channels = std::max(a.channels, b.channels);
  std::int64_t squares = 0;
  std::size_t pixel = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x, ++pixel) {
      if (!counts(ignored, pixel)) continue;
      ++result.compared;
      const std::uint8_t *p = a.at(x, y), *q = b.at(x, y);
      int worst = 0;
      for (int c = 0; c < channels; ++c) {
        const int d = std::abs(channel(a, p, c) - channel(b, q, c));
        worst = std::max(worst, d);
        squares += d * d;
      }
      result.maximum = std::max(result.maximum, worst);
      if (worst <= rule.channel) continue;
      if (result.above++ == 0) result.left = x, result.top = y;
      result.left = std::min(result.left, x);
      result.right = std::max(result.right, x + 1);
      result.bottom = y + 1;
    }
  const double samples = static_cast<double>(channels) * static_cast<double>(result.compared);
  result.rmse = samples > 0 ? std::sqrt(static_cast<double>(squares) / samples) : 0;
  if (rule.flip_mean == unlimited && rule.flip_max == unlimited) return result;
  result.flip_mean = result.flip_max = 0;
  if (result.maximum == 0) return result;
  const std::vector<float> map = flip(a, b, rule.ppd);
  double total = 0;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (counts(ignored, i)) {
      total += static_cast<double>(map[i]);
      result.flip_max = std::max(*result.flip_max, static_cast<double>(map[i]));
    }
  result.flip_mean = total / static_cast<double>(result.compared);
  return result;
}

std::vector<std::string> objections(const ImageDifference& d, const CompareRule& rule) {
  std::vector<std::string> all;
  const double allowed = std::max(rule.pixels, std::floor(rule.share * static_cast<double>(d.compared)));
  if (static_cast<double>(d.above) > allowed)
    all.push_back(fmt::format("{} pixel{} differ{} by more than {} (allowed: {})", d.above, d.above == 1 ? "" : "s",
                              d.above == 1 ? "s" : "", rule.channel, allowed));
  if (d.rmse > rule.rmse) all.push_back(fmt::format("rmse {:.4g} (allowed: {:g})", d.rmse, rule.rmse));
  if (d.flip_mean.value_or(0) > rule.flip_mean)
    all.push_back(fmt::format("mean FLIP {:.4g} (allowed: {:g})", *d.flip_mean, rule.flip_mean));
  if (d.flip_max.value_or(0) > rule.flip_max)
    all.push_back(fmt::format("largest FLIP {:.4g} (allowed: {:g})", *d.flip_max, rule.flip_max));
  return all;
}

Image difference_image(const Image& a, const Image& b, int gain, const Ignored& ignored) {
  check_same_size(a, b);
  constexpr std::uint8_t unseen[3] = {50, 60, 90};
  Image result(a.width, a.height, 3);
  std::size_t pixel = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x, ++pixel) {
      const std::uint8_t *p = a.at(x, y), *q = b.at(x, y);
      const int alpha = std::abs(channel(a, p, 3) - channel(b, q, 3));
      for (int c = 0; c < 3; ++c)
        result.at(x, y)[c] = counts(ignored, pixel)
                                 ? static_cast<std::uint8_t>(std::min(255, gain * std::max(alpha, std::abs(p[c] - q[c]))))
                                 : unseen[c];
    }
  return result;
}

}  // namespace render
