// Colours: of vesicles, of curves in figures, of everything drawn around them. sRGB, 0..1, safe for colour-blind eyes.
#pragma once

#include <array>
#include <cstddef>

namespace render {

struct Colour {
  double r = 0, g = 0, b = 0;
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// Membranes, in the order of the scene's vesicles; neighbours differ in hue and in lightness.
inline constexpr std::array<Colour, 8> body_colours{{
    {0.89, 0.50, 0.42},  // coral
    {0.47, 0.66, 0.86},  // sky
    {0.93, 0.76, 0.40},  // amber
    {0.35, 0.68, 0.58},  // bluish green
    {0.72, 0.55, 0.78},  // lilac
    {0.62, 0.66, 0.72},  // slate
    {0.84, 0.62, 0.70},  // rose
    {0.55, 0.48, 0.40},  // umber
}};
constexpr Colour body_colour(std::size_t vesicle) { return body_colours[vesicle % body_colours.size()]; }

/// Okabe and Ito's colours, for curves on white; yellow left out.
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

inline constexpr Colour tracer_bright{0.95, 0.36, 0.22};
inline constexpr Colour tracer_dark{0.13, 0.20, 0.31};
inline constexpr Colour ink{0.13, 0.15, 0.19};       ///< text on pictures
inline constexpr Colour soft_ink{0.36, 0.40, 0.46};  ///< captions
inline constexpr Colour arrow_colour{0.80, 0.835, 0.88};
inline constexpr Colour ground_top{0.985, 0.988, 0.993};
inline constexpr Colour ground_bottom{0.885, 0.905, 0.935};
inline constexpr Colour white{1, 1, 1};

}  // namespace render
