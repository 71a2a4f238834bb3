// Colour maps for fields: a catalogue by kind. Each is a curve through a few colours in CIELAB, where equal steps
// look equally large; sequential maps have uniform steps, diverging and cyclic ones are symmetric in lightness.
#pragma once

#include "render/core/palette.h"

#include "sim/core/catalogue.h"

#include <array>
#include <cstdint>
#include <vector>

namespace render {

enum class MapKind {
  sequential,  ///< from low to high: lightness increases throughout
  diverging,   ///< zero, in the middle, is the lightest
  cyclic       ///< ends with its first colour
};

/// CIE 1976 L*, a*, b* under D65.
struct Lab {
  double l = 0, a = 0, b = 0;
};
Lab to_lab(const Colour& srgb);
/// Clipped to the sRGB gamut.
Colour to_srgb(const Lab& lab);

struct ColourMapRow {
  std::string_view name;
  std::string_view meaning;
  MapKind kind;
  std::vector<Lab> through;  ///< evenly spaced along the map
};
const std::vector<ColourMapRow>& colour_maps();
/// Throws std::invalid_argument that names the nearest known map.
const ColourMapRow& find_colour_map(std::string_view name);

/// The map for bodies and colour bars: RGB, entry i is the colour at i/255; sRGB values are interpolated between
/// entries.
inline constexpr int colour_steps = 256;
using ColourTable = std::array<std::array<std::uint8_t, 3>, colour_steps>;
ColourTable colour_table(const ColourMapRow& map);
/// share: 0..1 along the map, clamped.
Colour mapped(const ColourTable& table, double share);

}  // namespace render
