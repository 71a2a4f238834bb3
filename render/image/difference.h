// Comparison of two pictures: their difference, and whether it is within a rule.
#pragma once

#include "render/image/flip.h"

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

namespace render {

/// Tolerances for two pictures that count as the same. Infinite: no limit.
struct CompareRule {
  double channel = 2;   ///< a pixel differs when one of its channels differs by more, 8-bit units
  double pixels = 10;   ///< so many pixels may differ in any picture
  double share = 2e-5;  ///< ... or this share of its pixels, whichever is more
  double largest = 48;  ///< no channel may differ by more, 8-bit units
  double rmse = 0.15;   ///< root mean square over the colours, 8-bit units; alpha is added where it differs
  double flip_mean = std::numeric_limits<double>::infinity();  ///< mean of the FLIP map, 0..1
  double flip_max = std::numeric_limits<double>::infinity();   ///< its largest value
  double flip_spot = std::numeric_limits<double>::infinity();  ///< the same where the pictures differ in one spot only
  double ppd = 67;                                             ///< pixels per degree of sight that FLIP supposes
};

/// The thresholds, declared once: v(name, meaning, double&).
template <class R, class V>
requires std::same_as<std::remove_const_t<R>, CompareRule>
void visit(R& r, V&& v) {
  v("channel", "a pixel differs when one of its channels differs by more than this, of 255", r.channel);
  v("pixels", "so many pixels may differ in any picture", r.pixels);
  v("share", "or this share of its pixels, whichever is more", r.share);
  v("largest", "no channel of any pixel may differ by more than this, of 255", r.largest);
  v("rmse", "largest root mean square difference over all channels, of 255", r.rmse);
  v("flip-mean", "largest mean of the FLIP map, 0 to 1", r.flip_mean);
  v("flip-max", "largest single value of the FLIP map, 0 to 1", r.flip_max);
  v("flip-spot", "the same where all that differs lies within a 16th of the picture, as no other driver does it",
    r.flip_spot);
  v("ppd", "pixels per degree of sight that FLIP supposes", r.ppd);
}

/// Throws std::invalid_argument with one sentence: the limit `name` (of visit()) is 0 or more, and may be infinite; ppd
/// is from flip_least_ppd to flip_most_ppd.
void check_limit(std::string_view name, double value);

struct ComparePreset {
  std::string_view name, meaning;
  CompareRule rule;
};
/// exact, default, perceptual.
std::span<const ComparePreset> compare_presets();

struct ImageDifference {
  std::int64_t compared = 0;  ///< pixels compared
  double maximum = 0;      ///< largest difference of a channel, in 8-bit units; a fraction where samples have 16 bits
  std::int64_t above = 0;  ///< pixels with a channel that differs by more than the rule's
  double rmse = 0;         ///< in 8-bit units
  int left = 0, top = 0, right = 0, bottom = 0;  ///< smallest box around the pixels above; right and bottom excluded
  std::optional<double> flip_mean, flip_max;     ///< when the rule asks for them
  bool spot = false;                             ///< that box is not empty, and at most a 16th of the compared area
  std::vector<std::string> declared;             ///< phrases: what the files declare differently about their samples
};

/// Measures what the rule needs. Red, green and blue are compared, and alpha when one of the pictures has it; 16-bit
/// samples in full, except by FLIP. The declared colour space and animation are compared too. Ignored pixels are
/// excluded everywhere. `look` is called from time to time, and may throw to stop. Throws std::invalid_argument when
/// sizes differ.
ImageDifference difference(const PngFile& expected, const PngFile& actual, const CompareRule& = {}, const Ignored& = {},
                           const std::function<void()>& look = {});
/// The same for pictures in memory.
ImageDifference difference(const Image& expected, const Image& actual, const CompareRule& = {}, const Ignored& = {});

/// Violations of the rule, one phrase each; empty: the same picture.
std::vector<std::string> objections(const ImageDifference&, const CompareRule& = {});
inline bool same_picture(const ImageDifference& d, const CompareRule& rule = {}) { return objections(d, rule).empty(); }

/// |a - b| x gain, saturated, opaque, for inspection. Ignored pixels are blue-grey.
Image difference_image(const Image& a, const Image& b, int gain = 16, const Ignored& = {});

}  // namespace render
