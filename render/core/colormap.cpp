#include "render/core/colormap.h"

#include "render/core/srgb.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace render {
namespace {

constexpr double white_x = 0.95047, white_z = 1.08883;  // D65, y = 1

double code(double v) { return srgb_of(std::clamp(v, 0.0, 1.0)); }

constexpr double knee = 6.0 / 29;  // below it the cube root is a straight line
double root(double t) { return t > knee * knee * knee ? std::cbrt(t) : t / (3 * knee * knee) + 4.0 / 29; }
double cube(double f) { return f > knee ? f * f * f : 3 * knee * knee * (f - 4.0 / 29); }

std::vector<Lab> from_codes(std::initializer_list<unsigned> codes) {
  std::vector<Lab> colours;
  for (const unsigned c : codes)
    colours.push_back(to_lab({(c >> 16 & 255) / 255.0, (c >> 8 & 255) / 255.0, (c & 255) / 255.0}));
  return colours;
}

double distance(const Lab& p, const Lab& q) { return std::hypot(p.l - q.l, p.a - q.a, p.b - q.b); }

// Cubic through the points (Catmull and Rom's tangents), share 0..1. Lightness is kept straight between points.
Lab along(const ColourMapRow& map, double share) {
  const std::vector<Lab>& p = map.through;
  const auto last = static_cast<int>(p.size()) - 1;
  const double place = share * last;
  const int i = std::clamp(static_cast<int>(place), 0, last - 1);
  const double u = place - i, rest = 1 - u;
  const auto at = [&](int k) {
    if (map.kind == MapKind::cyclic) k = (k + last) % last;
    return p[static_cast<std::size_t>(std::clamp(k, 0, last))];
  };
  const Lab before = at(i - 1), from = at(i), to = map.kind == MapKind::cyclic && i + 1 == last ? p.back() : at(i + 1),
            after = at(i + 2);
  const auto cubic = [&](double p0, double p1, double p2, double p3) {
    const double m1 = (p2 - p0) / 2, m2 = (p3 - p1) / 2;
    return rest * rest * (1 + 2 * u) * p1 + u * u * (3 - 2 * u) * p2 + u * rest * (rest * m1 - u * m2);
  };
  return {rest * from.l + u * to.l, cubic(before.a, from.a, to.a, after.a), cubic(before.b, from.b, to.b, after.b)};
}

}  // namespace

Lab to_lab(const Colour& c) {
  const double r = linear_of(c.r), g = linear_of(c.g), b = linear_of(c.b);
  const double x = root((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / white_x);
  const double y = root(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
  const double z = root((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / white_z);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Colour to_srgb(const Lab& lab) {
  const double f = (lab.l + 16) / 116;
  const double x = white_x * cube(f + lab.a / 500), y = cube(f), z = white_z * cube(f - lab.b / 200);
  return {code(3.2404542 * x - 1.5371385 * y - 0.4985314 * z), code(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z),
          code(0.0556434 * x - 0.2040259 * y + 1.0572252 * z)};
}

const std::vector<ColourMapRow>& colour_maps() {
  static const std::vector<ColourMapRow> rows{
      {"viridis", "violet, green, yellow", MapKind::sequential,
       from_codes(
           {0x440154, 0x482878, 0x3e4a89, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6dcd59, 0xb4de2c, 0xfde725})},
      {"cividis", "blue, grey, yellow: the same to nearly all eyes", MapKind::sequential,
       from_codes(
           {0x00204d, 0x00336f, 0x39486b, 0x575c6d, 0x707173, 0x8a8779, 0xa69d75, 0xc4b56c, 0xe4cf5b, 0xffea46})},
      {"ember",
       "near black, red, orange, pale yellow",
       MapKind::sequential,
       {{8, 6, -6}, {22, 30, 2}, {37, 47, 28}, {53, 46, 50}, {69, 28, 60}, {84, 6, 50}, {96, -4, 22}}},
      {"grey", "black to white, without the ends", MapKind::sequential, {{12, 0, 0}, {95, 0, 0}}},
      {"blue-red",
       "blue below, white at zero, red above",
       MapKind::diverging,
       {{28, 14, -46},
        {44.5, -2, -42},
        {61, -10, -30},
        {77.5, -7, -16},
        {94, 0, 0},
        {77.5, 18, 18},
        {61, 38, 33},
        {44.5, 50, 36},
        {28, 42, 26}}},
      {"green-purple",
       "green below, white at zero, purple above",
       MapKind::diverging,
       {{28, -26, 18},
        {44.5, -32, 24},
        {61, -29, 22},
        {77.5, -16, 12},
        {94, 0, 0},
        {77.5, 15, -14},
        {61, 29, -26},
        {44.5, 40, -37},
        {28, 38, -40}}},
      {"twilight",
       "pale, blue, dark, red, pale: angles and phases",
       MapKind::cyclic,
       {{86, 0, 0},
        {72, -9, -14},
        {58, -6, -30},
        {44, 10, -40},
        {30, 22, -26},
        {44, 38, 0},
        {58, 32, 20},
        {72, 14, 16},
        {86, 0, 0}}},
  };
  return rows;
}

const ColourMapRow& find_colour_map(std::string_view name) {
  if (const ColourMapRow* row = sim::find_row(colour_maps(), name)) return *row;
  throw std::invalid_argument("unknown colour map '" + std::string(name) + "'" +
                              sim::suggestion(name, sim::row_names(colour_maps())));
}

ColourTable colour_table(const ColourMapRow& map) {
  constexpr int fine = 16 * (colour_steps - 1);
  std::vector<Lab> path;
  std::vector<double> length{0};
  for (int i = 0; i <= fine; ++i) {
    path.push_back(along(map, static_cast<double>(i) / fine));
    if (i > 0) length.push_back(length.back() + distance(path[path.size() - 2], path.back()));
  }
  ColourTable table;
  std::size_t at = 0;
  for (int i = 0; i < colour_steps; ++i) {
    const double share = static_cast<double>(i) / (colour_steps - 1);
    Lab lab = path[16 * static_cast<std::size_t>(i)];
    if (map.kind == MapKind::sequential) {  // equal steps
      while (at + 1 < length.size() && length[at + 1] < share * length.back()) ++at;
      lab = path[std::min(at + 1, path.size() - 1)];
    }
    const Colour c = to_srgb(lab);
    const double channels[3]{c.r, c.g, c.b};
    for (std::size_t k = 0; k < 3; ++k)
      table[static_cast<std::size_t>(i)][k] = static_cast<std::uint8_t>(std::lround(255 * channels[k]));
  }
  return table;
}

Colour mapped(const ColourTable& table, double share) {
  const double place = (share > 0 ? std::min(share, 1.0) : 0.0) * (colour_steps - 1);  // not a number: the low end
  const auto i = static_cast<std::size_t>(std::min(place, colour_steps - 2.0));
  const double u = place - static_cast<double>(i);
  const auto channel = [&](std::size_t k) { return ((1 - u) * table[i][k] + u * table[i + 1][k]) / 255; };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace render
