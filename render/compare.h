// Two pictures side by side: how far they differ, and whether a rule lets that pass.
#pragma once

#include "image.h"

#include <limits>
#include <optional>
#include <span>
#include <string_view>

namespace render {

/// What may differ between two pictures that count as the same. Infinite: no limit.
struct CompareRule {
  double channel = 2;       ///< a pixel differs when one of its channels differs by more, 8-bit units
  double pixels = 10;       ///< so many pixels may differ in any picture
  double share = 2e-5;      ///< ... or this share of its pixels, whichever is more
  double rmse = 0.15;       ///< root mean square over all channels, 8-bit units
  double flip_mean = std::numeric_limits<double>::infinity();  ///< mean of the FLIP map, 0..1
  double flip_max = std::numeric_limits<double>::infinity();   ///< its largest value
  double ppd = 67;          ///< pixels per degree of sight that FLIP supposes
};

/// The thresholds, declared once: v(name, meaning, double&).
template <class R, class V>
  requires std::same_as<std::remove_const_t<R>, CompareRule>
void visit(R& r, V&& v) {
  v("channel", "a pixel differs when one of its channels differs by more than this, of 255", r.channel);
  v("pixels", "so many pixels may differ in any picture", r.pixels);
  v("share", "or this share of its pixels, whichever is more", r.share);
  v("rmse", "largest root mean square difference over all channels, of 255", r.rmse);
  v("flip-mean", "largest mean of the FLIP map, 0 to 1", r.flip_mean);
  v("flip-max", "largest single value of the FLIP map, 0 to 1", r.flip_max);
  v("ppd", "pixels per degree of sight that FLIP supposes", r.ppd);
}

struct ComparePreset {
  std::string_view name, meaning;
  CompareRule rule;
};
/// exact, default, perceptual.
std::span<const ComparePreset> compare_presets();

/// Pixels that do not count: width x height, not zero where ignored; empty: all count.
using Ignored = std::vector<std::uint8_t>;

struct ImageDifference {
  std::int64_t compared = 0;  ///< pixels that counted
  int maximum = 0;            ///< largest difference of a channel
  std::int64_t above = 0;     ///< pixels with a channel that differs by more than the rule's
  double rmse = 0;            ///< over all channels, in 8-bit units
  int left = 0, top = 0, right = 0, bottom = 0;  ///< smallest box around the pixels above; right and bottom excluded
  std::optional<double> flip_mean, flip_max;     ///< when the rule asks for them
};

/// Measures what the rule needs. Red, green, blue count, and alpha when one of the pictures has it.
/// Throws std::invalid_argument when sizes differ.
ImageDifference difference(const Image& expected, const Image& actual, const CompareRule& = {}, const Ignored& = {});

/// What the rule objects to, one phrase each; empty: the same picture.
std::vector<std::string> objections(const ImageDifference&, const CompareRule& = {});
inline bool same_picture(const ImageDifference& d, const CompareRule& rule = {}) { return objections(d, rule).empty(); }

/// |a - b| x gain, saturated, opaque: what to look at when they differ. Ignored pixels are blue-grey.
Image difference_image(const Image& a, const Image& b, int gain = 16, const Ignored& = {});

}  // namespace render
