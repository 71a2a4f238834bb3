#include "render/image/difference.h"

#include "render/image/flip.h"

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
    throw std::invalid_argument(
        fmt::format("pictures of different size: {}x{} and {}x{}", a.width, a.height, b.width, b.height));
}

/// Channel c of a pixel; a picture without alpha is opaque.
int channel(const Image& image, const std::uint8_t* pixel, int c) { return c < image.channels ? pixel[c] : 255; }

bool counts(const Ignored& ignored, std::size_t pixel) { return ignored.empty() || ignored[pixel] == 0; }

}  // namespace

std::span<const ComparePreset> compare_presets() {
  static const std::array<ComparePreset, 3> presets{
      {{"exact",
        "every channel of every pixel is equal",
        {.channel = 0, .pixels = 0, .share = 0, .largest = 0, .rmse = 0}},
       {"default", "equal but for rounding: other processors, other versions of the drawing libraries", {}},
       {"perceptual",
        "no difference that stays visible when one flips between the two (FLIP)",
        {.pixels = unlimited,
         .largest = unlimited,
         .rmse = unlimited,
         .flip_mean = 0.05,
         .flip_max = 0.4,
         .flip_spot = 0.15}}}};
  return presets;
}

void check_limit(std::string_view name, double value) {
  const bool sight = name == "ppd";
  if (sight ? value >= flip_least_ppd && value <= flip_most_ppd : value >= 0) return;  // NaN is neither
  throw std::invalid_argument(
      sight ? fmt::format("{} pixels per degree are not between {} and {}", value, flip_least_ppd, flip_most_ppd)
            : fmt::format("{} is not a limit: it is 0 or more, or inf to lift it", value));
}

namespace {

/// Sample c of a pixel, where all samples have 8 bits; a picture without alpha is opaque.
struct EightBits {
  static constexpr int unit = 1;
  static int sample(const PngFile& f, std::size_t pixel, int c) {
    const auto channels = static_cast<std::size_t>(f.image.channels);
    return c < f.image.channels ? f.image.pixels[pixel * channels + static_cast<std::size_t>(c)] : 255;
  }
};
/// Where one of the pictures has 16 bits; 8 bits stand for v x 257.
struct SixteenBits {
  static constexpr int unit = 257;
  static int sample(const PngFile& f, std::size_t pixel, int c) {
    const auto at = pixel * static_cast<std::size_t>(f.image.channels) + static_cast<std::size_t>(c);
    const int upper = EightBits::sample(f, pixel, c);
    return c < f.image.channels && !f.lower_bytes.empty() ? upper * 256 + f.lower_bytes[at] : upper * 257;
  }
};

template <class Samples>
void measure_samples(const PngFile& a, const PngFile& b, const CompareRule& rule, const Ignored& ignored,
                     const std::function<void()>& look, ImageDifference& result) {
  constexpr double unit = Samples::unit;
  const int channels = std::max(a.image.channels, b.image.channels);
  std::int64_t squares = 0;
  int maximum = 0;
  std::size_t pixel = 0;
  for (int y = 0; y < a.image.height; ++y) {
    if (look) look();
    for (int x = 0; x < a.image.width; ++x, ++pixel) {
      if (!counts(ignored, pixel)) continue;
      ++result.compared;
      int worst = 0;
      for (int c = 0; c < channels; ++c) {
        const int d = std::abs(Samples::sample(a, pixel, c) - Samples::sample(b, pixel, c));
        worst = std::max(worst, d);
        squares += std::int64_t{d} * d;
      }
      maximum = std::max(maximum, worst);
      if (worst <= rule.channel * unit) continue;
      if (result.above++ == 0) result.left = x, result.top = y;
      result.left = std::min(result.left, x);
      result.right = std::max(result.right, x + 1);
      result.bottom = y + 1;
    }
  }
  result.maximum = maximum / unit;
  // Three samples a pixel, with or without alpha: a channel that is equal must not dilute what the others differ by.
  result.spot = result.above > 0 &&
                std::int64_t{16} * (result.right - result.left) * (result.bottom - result.top) <= result.compared;
  const double samples = 3 * static_cast<double>(result.compared);
  result.rmse = samples > 0 ? std::sqrt(static_cast<double>(squares) / samples) / unit : 0;
}

}  // namespace

ImageDifference difference(const PngFile& a, const PngFile& b, const CompareRule& rule, const Ignored& ignored,
                           const std::function<void()>& look) {
  check_same_size(a.image, b.image);
  ImageDifference result;
  const bool wide = !a.lower_bytes.empty() || !b.lower_bytes.empty();
  (wide ? measure_samples<SixteenBits> : measure_samples<EightBits>)(a, b, rule, ignored, look, result);
  const auto said = [](const std::string& text, const char* otherwise) { return text.empty() ? otherwise : text; };
  if (a.colours != b.colours)
    result.declared.push_back(
        fmt::format("its numbers mean {} instead of {}", said(b.colours, "sRGB"), said(a.colours, "sRGB")));
  if (a.animation != b.animation)
    result.declared.push_back(
        fmt::format("an animation: {} instead of {}", said(b.animation, "a still"), said(a.animation, "a still")));
  if (rule.flip_mean == unlimited && rule.flip_max == unlimited && rule.flip_spot == unlimited) return result;
  result.flip_mean = result.flip_max = 0;
  if (result.maximum == 0) return result;
  double total = 0;
  flip_by_tiles(a.image, b.image, rule.ppd, ignored, [&](const FlipTile& tile, const std::vector<float>& map) {
    if (look) look();
    auto value = map.begin();
    for (int y = tile.top; y < tile.bottom; ++y)
      for (int x = tile.left; x < tile.right; ++x, ++value) {
        if (!counts(ignored, static_cast<std::size_t>(y) * static_cast<std::size_t>(a.image.width) +
                                 static_cast<std::size_t>(x)))
          continue;
        total += static_cast<double>(*value);
        result.flip_max = std::max(*result.flip_max, static_cast<double>(*value));
      }
  });
  result.flip_mean = total / static_cast<double>(result.compared);
  return result;
}

ImageDifference difference(const Image& a, const Image& b, const CompareRule& rule, const Ignored& ignored) {
  PngFile expected, actual;
  expected.image = a;
  actual.image = b;
  return difference(expected, actual, rule, ignored);
}

std::vector<std::string> objections(const ImageDifference& d, const CompareRule& rule) {
  std::vector<std::string> all;
  const double allowed = std::max(rule.pixels, std::floor(rule.share * static_cast<double>(d.compared)));
  // A limit that is no number is kept by nothing.
  const auto within = [](double value, double limit) { return value <= limit; };
  if (!within(static_cast<double>(d.above), allowed))
    all.push_back(fmt::format("{} pixel{} differ{} by more than {} (allowed: {})", d.above, d.above == 1 ? "" : "s",
                              d.above == 1 ? "s" : "", rule.channel, allowed));
  if (!within(d.maximum, rule.largest))
    all.push_back(fmt::format("a pixel differs by {:.4g} (allowed: {:g})", d.maximum, rule.largest));
  if (!within(d.rmse, rule.rmse)) all.push_back(fmt::format("rmse {:.4g} (allowed: {:g})", d.rmse, rule.rmse));
  if (!within(d.flip_mean.value_or(0), rule.flip_mean))
    all.push_back(fmt::format("mean FLIP {:.4g} (allowed: {:g})", *d.flip_mean, rule.flip_mean));
  if (!within(d.flip_max.value_or(0), rule.flip_max))
    all.push_back(fmt::format("largest FLIP {:.4g} (allowed: {:g})", *d.flip_max, rule.flip_max));
  else if (d.spot && !within(d.flip_max.value_or(0), rule.flip_spot))
    all.push_back(fmt::format("largest FLIP {:.4g} in one spot (allowed: {:g})", *d.flip_max, rule.flip_spot));
  all.insert(all.end(), d.declared.begin(), d.declared.end());
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
        result.at(x, y)[c] =
            counts(ignored, pixel)
                ? static_cast<std::uint8_t>(std::min(255, gain * std::max(alpha, std::abs(p[c] - q[c]))))
                : unseen[c];
    }
  return result;
}

}  // namespace render
