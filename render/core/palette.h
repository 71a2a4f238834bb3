// Colours: of vesicles, of curves in figures, of everything drawn around them. sRGB, 0..1, safe for colour-blind
// viewers.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace render {

struct Colour {
  double r = 0, g = 0, b = 0;
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// Membranes, in the order of the scene's vesicles. Any two are told apart with every kind of colour blindness: the
/// worst pair differs by 15 (CIEDE2000).
struct ColourRow {
  std::string_view name;
  std::string_view meaning;
  Colour colour;
};
inline const std::vector<ColourRow>& body_colours() {
  static const std::vector<ColourRow> rows{
      {"coral", "#d66d4f", {0xd6 / 255.0, 0x6d / 255.0, 0x4f / 255.0}},
      {"sky", "#b6c5f6", {0xb6 / 255.0, 0xc5 / 255.0, 0xf6 / 255.0}},
      {"jade", "#55b791", {0x55 / 255.0, 0xb7 / 255.0, 0x91 / 255.0}},
      {"amber", "#efc962", {0xef / 255.0, 0xc9 / 255.0, 0x62 / 255.0}},
      {"umber", "#6d5c4f", {0x6d / 255.0, 0x5c / 255.0, 0x4f / 255.0}},
      {"rose", "#b687aa", {0xb6 / 255.0, 0x87 / 255.0, 0xaa / 255.0}},
      {"lilac", "#7f64b8", {0x7f / 255.0, 0x64 / 255.0, 0xb8 / 255.0}},
      {"slate", "#ddd7d9", {0xdd / 255.0, 0xd7 / 255.0, 0xd9 / 255.0}},
  };
  return rows;
}
inline Colour body_colour(std::size_t vesicle) { return body_colours()[vesicle % body_colours().size()].colour; }
/// A name of body_colours(), or "#rrggbb". Throws std::invalid_argument that names the nearest known name.
Colour parse_colour(std::string_view text);

/// Interpolates between equidistant stops, from the first (0) to the last (1); clamped beyond them.
Colour between(std::span<const Colour> stops, double share);

/// Okabe and Ito's colours, for curves on white; without yellow.
inline constexpr std::array<Colour, 7> curve_colours{{
    {0.000, 0.447, 0.698},
    {0.835, 0.369, 0.000},
    {0.000, 0.620, 0.451},
    {0.800, 0.475, 0.655},
    {0.902, 0.624, 0.000},
    {0.337, 0.706, 0.914},
    {0.000, 0.000, 0.000},
}};
constexpr Colour curve_colour(std::size_t curve) { return curve_colours[curve % curve_colours.size()]; }

inline constexpr Colour tracer_bright{1.00, 0.84, 0.25};
inline constexpr Colour tracer_dark{0.13, 0.20, 0.31};
inline constexpr Colour ink{0.13, 0.15, 0.19};  ///< text on pictures
inline constexpr Colour note_ink{0.70, 0.30, 0.08};
inline constexpr Colour soft_ink{0.36, 0.40, 0.46};  ///< captions
inline constexpr Colour flow_line_colour{0.50, 0.56, 0.65};
inline constexpr Colour arrow_colour{0.80, 0.835, 0.88};
inline constexpr Colour ground_top{0.985, 0.988, 0.993};
inline constexpr Colour ground_bottom{0.885, 0.905, 0.935};
inline constexpr Colour white{1, 1, 1};

}  // namespace render
