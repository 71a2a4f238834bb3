#include "render/image/flip.h"

#include "render/core/srgb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace render {
namespace {

constexpr double pi = 3.14159265358979323846;

using Plane = std::vector<float>;
using Planes = std::array<Plane, 3>;
using Triple = std::array<float, 3>;

struct Size {
  int width, height;
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

// --- colours: linear sRGB <-> XYZ (D65), and from XYZ to YCxCz and CIELAB -----------------------------------------

// From sRGB's primaries and white; the second is the inverse of the first.
constexpr double to_xyz[3][3] = {{10135552. / 24577794, 8788810. / 24577794, 4435075. / 24577794},
                                 {2613072. / 12288897, 8788810. / 12288897, 887015. / 12288897},
                                 {1425312. / 73733382, 8788810. / 73733382, 70074185. / 73733382}};
constexpr double from_xyz[3][3] = {{3.24100323297636, -1.53739896948879, -0.498615881996363},
                                   {-0.969224252202516, 1.87592998369518, 0.0415542263400847},
                                   {0.0556394198519754, -0.20401120612391, 1.05714897718753}};

Triple times(const double (&m)[3][3], const Triple& v) {
  Triple r{};
  for (std::size_t i = 0; i < 3; ++i) r[i] = static_cast<float>(m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2]);
  return r;
}

const Triple& white() {
  static const Triple xyz = times(to_xyz, {1, 1, 1});
  return xyz;
}

Triple ycxcz_of(const Triple& rgb) {
  const Triple xyz = times(to_xyz, rgb);
  const float x = xyz[0] / white()[0], y = xyz[1] / white()[1], z = xyz[2] / white()[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}
Triple rgb_of_ycxcz(const Triple& c) {
  const float y = (c[0] + 16) / 116, x = y + c[1] / 500, z = y - c[2] / 200;
  return times(from_xyz, {x * white()[0], y * white()[1], z * white()[2]});
}

/// CIELAB with the Hunt adjustment: colours count less where it is dark.
Triple hunt_lab_of(const Triple& rgb) {
  constexpr float delta = 6.F / 29;
  const Triple xyz = times(to_xyz, rgb);
  const auto f = [](float t) { return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.F / 29; };
  const float x = f(xyz[0] / white()[0]), y = f(xyz[1] / white()[1]), z = f(xyz[2] / white()[2]);
  const float l = 116 * y - 16;
  return {l, 0.01F * l * 500 * (x - y), 0.01F * l * 200 * (y - z)};
}

/// City block in lightness, Euclid in colour.
float hyab(const Triple& a, const Triple& b) { return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }

// --- filters, all sums of products of one-dimensional ones; the border pixel continues outside ---------------------

using Kernel = std::vector<float>;  // odd length

void along_rows(const Plane& in, Plane& out, Size size, const Kernel& kernel) {
  const int radius = static_cast<int>(kernel.size() / 2), w = size.width;
  std::vector<float> padded(static_cast<std::size_t>(w + 2 * radius));
  for (int y = 0; y < size.height; ++y) {
    const float* row = in.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(w);
    for (int i = 0; i < w + 2 * radius; ++i)
      padded[static_cast<std::size_t>(i)] = row[std::clamp(i - radius, 0, w - 1)];
    float* result = out.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(w);
    std::fill(result, result + w, 0.F);
    for (std::size_t k = 0; k < kernel.size(); ++k)
      for (int x = 0; x < w; ++x) result[x] += kernel[k] * padded[static_cast<std::size_t>(x) + k];
  }
}

void along_columns(const Plane& in, Plane& out, Size size, const Kernel& kernel) {
  const int radius = static_cast<int>(kernel.size() / 2);
  const auto w = static_cast<std::size_t>(size.width);
  for (int y = 0; y < size.height; ++y) {
    float* result = out.data() + static_cast<std::size_t>(y) * w;
    std::fill(result, result + w, 0.F);
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      const int from = std::clamp(y + static_cast<int>(k) - radius, 0, size.height - 1);
      const float* row = in.data() + static_cast<std::size_t>(from) * w;
      for (std::size_t x = 0; x < w; ++x) result[x] += kernel[k] * row[x];
    }
  }
}

Plane filtered(const Plane& in, Size size, const Kernel& horizontal, const Kernel& vertical) {
  Plane half(in.size()), out(in.size());
  along_rows(in, half, size, horizontal);
  along_columns(half, out, size, vertical);
  return out;
}

/// f(distance from the centre), samples from -radius to radius.
template <class F>
Kernel sampled(int radius, F&& f) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(static_cast<float>(f(i)));
  return kernel;
}

double sum(const Kernel& k) {
  double total = 0;
  for (const float v : k) total += v;
  return total;
}

/// One channel of the contrast sensitivity: a1 sqrt(pi/b1) exp(-pi^2 d^2/b1) + the same with a2, b2; d in degrees.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity achromatic{1, 0.0047, 0, 1e-5}, red_green{1, 0.0053, 0, 1e-5},
    blue_yellow{34.1, 0.04, 13.5, 0.025};

/// Three standard deviations of the widest of these filters, for all.
int radius_of_sight(double ppd) {
  return static_cast<int>(std::ceil(3 * std::sqrt(blue_yellow.b1 / (2 * pi * pi)) * ppd));
}

Plane seen(const Plane& in, Size size, const Sensitivity& s, double ppd) {
  const int radius = radius_of_sight(ppd);
  const auto gauss = [&](double b) {
    return sampled(radius, [&](int i) { return std::exp(-pi * pi * (i / ppd) * (i / ppd) / b); });
  };
  const Kernel first = gauss(s.b1), second = gauss(s.b2);
  double w1 = s.a1 * std::sqrt(pi / s.b1), w2 = s.a2 * std::sqrt(pi / s.b2);
  const double total = w1 * sum(first) * sum(first) + w2 * sum(second) * sum(second);
  Plane out = filtered(in, size, first, first);
  for (float& v : out) v *= static_cast<float>(w1 / total);
  if (w2 == 0) return out;
  const Plane more = filtered(in, size, second, second);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += static_cast<float>(w2 / total) * more[i];
  return out;
}

/// Strength of edges and of points (lines, spots) at every pixel, from the lightness.
struct Features {
  Plane edges, points;
};

double deviation_of_edges(double ppd) {
  constexpr double width = 0.082;  // of an edge in degrees
  return 0.5 * width * ppd;
}
int radius_of_edges(double ppd) { return static_cast<int>(std::ceil(3 * deviation_of_edges(ppd))); }

Features features_of(const Plane& lightness, Size size, double ppd) {
  const double sd = deviation_of_edges(ppd);
  const int radius = radius_of_edges(ppd);
  const auto gauss = [&](int i) { return std::exp(-0.5 * i * i / (sd * sd)); };
  const Kernel plain = sampled(radius, gauss);
  Kernel slope = sampled(radius, [&](int i) { return -i * gauss(i); });
  Kernel bend = sampled(radius, [&](int i) { return (i * i / (sd * sd) - 1) * gauss(i); });
  // Positive weights of the whole filter sum to 1, negative ones to -1.
  const auto balance = [&](Kernel& kernel) {
    double positive = 0, negative = 0;
    for (const float v : kernel) (v > 0 ? positive : negative) += v;
    const double across = sum(plain);
    for (float& v : kernel) v = static_cast<float>(v / ((v > 0 ? positive : -negative) * across));
  };
  balance(slope);
  balance(bend);
  const auto strength = [&](const Kernel& kernel) {
    Plane x = filtered(lightness, size, kernel, plain);
    const Plane y = filtered(lightness, size, plain, kernel);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::hypot(x[i], y[i]);
    return x;
  };
  return {strength(slope), strength(bend)};
}

Planes ycxcz_planes(const Image& image) {
  const Size size{image.width, image.height};
  std::array<float, 256> table;
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = linear_of(static_cast<float>(i) / 255);
  Planes planes;
  for (Plane& plane : planes) plane.resize(size.pixels());
  const std::uint8_t* p = image.pixels.data();
  for (std::size_t i = 0; i < size.pixels(); ++i, p += image.channels) {
    Triple rgb{table[p[0]], table[p[1]], table[p[2]]};
    if (image.channels == 4)
      for (float& c : rgb) c = c * static_cast<float>(p[3]) / 255 + (1 - static_cast<float>(p[3]) / 255);
    const Triple c = ycxcz_of(rgb);
    for (std::size_t k = 0; k < 3; ++k) planes[k][i] = c[k];
  }
  return planes;
}

/// What is left of the colours at that distance, as Hunt-adjusted CIELAB.
Planes seen_colours(const Planes& in, Size size, double ppd) {
  Planes out{seen(in[0], size, achromatic, ppd), seen(in[1], size, red_green, ppd),
             seen(in[2], size, blue_yellow, ppd)};
  for (std::size_t i = 0; i < size.pixels(); ++i) {
    Triple rgb = rgb_of_ycxcz({out[0][i], out[1][i], out[2][i]});
    for (float& c : rgb) c = std::clamp(c, 0.F, 1.F);
    const Triple lab = hunt_lab_of(rgb);
    for (std::size_t k = 0; k < 3; ++k) out[k][i] = lab[k];
  }
  return out;
}

/// The whole map at once: some twenty planes of floating-point numbers.
std::vector<float> flip_at_once(const Image& reference, const Image& test, double ppd) {
  constexpr float qc = 0.7F, pc = 0.4F, pt = 0.95F, qf = 0.5F;
  const Size size{reference.width, reference.height};
  std::array<Planes, 2> colours;
  std::array<Features, 2> features;
  for (const std::size_t which : {0U, 1U}) {
    const Planes planes = ycxcz_planes(which == 0 ? reference : test);
    Plane lightness = planes[0];
    for (float& y : lightness) y = (y + 16) / 116;
    features[which] = features_of(lightness, size, ppd);
    colours[which] = seen_colours(planes, size, ppd);
  }
  // Colour differences up to pc of the largest one take most of the range.
  const float largest = std::pow(hyab(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), qc), knee = pc * largest;
  std::vector<float> map(size.pixels());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto at = [&](std::size_t which) {
      return Triple{colours[which][0][i], colours[which][1][i], colours[which][2][i]};
    };
    const float e = std::pow(hyab(at(0), at(1)), qc);
    const float colour = e < knee ? pt / knee * e : pt + (e - knee) / (largest - knee) * (1 - pt);
    const float feature = std::pow(std::max(std::abs(features[0].edges[i] - features[1].edges[i]),
                                            std::abs(features[0].points[i] - features[1].points[i])) /
                                       std::sqrt(2.F),
                                   qf);
    map[i] = std::min(std::pow(colour, 1 - feature), 1.F);
  }
  return map;
}

Image cut(const Image& image, const FlipTile& t) {
  Image part(t.right - t.left, t.bottom - t.top, image.channels);
  for (int y = t.top; y < t.bottom; ++y)
    std::copy(image.at(t.left, y), image.at(t.right - 1, y) + image.channels, part.at(0, y - t.top));
  return part;
}

/// Where a pixel does not count, nothing is different: what is hidden must not shine into its surroundings either.
void hide(const FlipTile& t, const Ignored& ignored, int width, Image& reference, Image& test) {
  for (int y = t.top; y < t.bottom; ++y)
    for (int x = t.left; x < t.right; ++x) {
      if (ignored[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] == 0)
        continue;
      std::uint8_t *from = reference.at(x - t.left, y - t.top), *to = test.at(x - t.left, y - t.top);
      if (reference.channels > test.channels) from[3] = 255;
      for (int c = 0; c < test.channels; ++c) to[c] = c < reference.channels ? from[c] : 255;
    }
}

/// Does a picture with alpha show the very colours of one without?
bool equal_pictures(const Image& a, const Image& b) {
  if (a.channels == b.channels) return a.pixels == b.pixels;
  const Image &three = a.channels == 3 ? a : b, &four = a.channels == 3 ? b : a;
  for (std::size_t i = 0, n = three.pixels.size() / 3; i < n; ++i)
    if (!std::equal(&three.pixels[3 * i], &three.pixels[3 * i] + 3, &four.pixels[4 * i]) ||
        four.pixels[4 * i + 3] != 255)
      return false;
  return true;
}

}  // namespace

void flip_by_tiles(const Image& reference, const Image& test, double ppd, const Ignored& ignored,
                   const FlipVisitor& visit) {
  if (reference.width != test.width || reference.height != test.height)
    throw std::invalid_argument("FLIP needs pictures of one size");
  if (!(ppd >= flip_least_ppd && ppd <= flip_most_ppd))
    throw std::invalid_argument(
        fmt::format("FLIP is defined here for {} to {} pixels per degree, not {}", flip_least_ppd, flip_most_ppd, ppd));
  // Each pixel of the map depends on its surroundings as far as the widest filter reaches: a tile is computed with so
  // much more on each side, where there is more, and gets the very bits that it would get in the whole picture.
  const int reach = std::max(radius_of_sight(ppd), radius_of_edges(ppd)), side = std::max(192, 4 * reach);
  const int width = reference.width, height = reference.height;
  for (int top = 0; top < height; top += side)
    for (int left = 0; left < width; left += side) {
      const FlipTile tile{left, top, std::min(left + side, width), std::min(top + side, height)};
      const FlipTile wide{std::max(left - reach, 0), std::max(top - reach, 0), std::min(tile.right + reach, width),
                          std::min(tile.bottom + reach, height)};
      Image before = cut(reference, wide), after = cut(test, wide);
      if (!ignored.empty()) hide(wide, ignored, width, before, after);
      const bool equal = equal_pictures(before, after);  // the map is zero then
      const std::vector<float> map = equal ? std::vector<float>() : flip_at_once(before, after, ppd);
      std::vector<float> core(static_cast<std::size_t>(tile.right - left) *
                              static_cast<std::size_t>(tile.bottom - top));
      auto out = core.begin();
      for (int y = top; y < tile.bottom && !equal; ++y) {
        const auto row =
            map.begin() + static_cast<std::ptrdiff_t>(y - wide.top) * (wide.right - wide.left) + (left - wide.left);
        out = std::copy(row, row + (tile.right - left), out);
      }
      visit(tile, core);
    }
}

std::vector<float> flip(const Image& reference, const Image& test, double ppd) {
  std::vector<float> map(static_cast<std::size_t>(reference.width) * static_cast<std::size_t>(reference.height));
  flip_by_tiles(reference, test, ppd, {}, [&](const FlipTile& tile, const std::vector<float>& part) {
    const std::ptrdiff_t columns = tile.right - tile.left;
    for (int y = tile.top; y < tile.bottom; ++y)
      std::copy_n(part.begin() + (y - tile.top) * columns, columns,
                  map.begin() + static_cast<std::ptrdiff_t>(y) * reference.width + tile.left);
  });
  return map;
}

}  // namespace render
