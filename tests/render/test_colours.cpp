// The colours of vesicles, as people see them who lack one kind of cone.
#include "render/core/palette.h"
#include "render/core/srgb.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;

Vector times(const Matrix& m, const Vector& v) {
  Vector r{};
  for (std::size_t i = 0; i < 3; ++i) r[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return r;
}

struct Sight {
  const char* name;
  Matrix seen;  ///< of linear RGB: Machado, Oliveira and Fernandes 2009, severity 1
};
constexpr std::array<Sight, 4> sights{{
    {"all cones", {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
    {"protanopia",
     {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}}},
    {"deuteranopia",
     {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}}},
    {"tritanopia",
     {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}},
}};

/// CIELAB, D65.
Vector lab(const render::Colour& c, const Matrix& seen) {
  constexpr Matrix xyz{
      {{0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}}};
  Vector rgb = times(seen, {render::linear_of(c.r), render::linear_of(c.g), render::linear_of(c.b)});
  for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
  const Vector white = times(xyz, {1, 1, 1}), here = times(xyz, rgb);
  Vector f{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = here[i] / white[i];
    f[i] = t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

/// CIEDE2000.
double difference(const Vector& p, const Vector& q) {
  constexpr double degree = std::numbers::pi / 180;
  const double mean = (std::hypot(p[1], p[2]) + std::hypot(q[1], q[2])) / 2, m7 = std::pow(mean, 7);
  const double g = 0.5 * (1 - std::sqrt(m7 / (m7 + std::pow(25.0, 7))));
  const auto hue = [&](const Vector& v) {
    const double h = std::atan2(v[2], (1 + g) * v[1]) / degree;
    return h < 0 ? h + 360 : h;
  };
  const double c1 = std::hypot((1 + g) * p[1], p[2]), c2 = std::hypot((1 + g) * q[1], q[2]), h1 = hue(p), h2 = hue(q);
  double turn = h2 - h1, h = (h1 + h2) / 2;
  if (std::abs(h1 - h2) > 180) {
    turn += turn > 0 ? -360 : 360;
    h += h < 180 ? 180 : -180;
  }
  const double l = (p[0] + q[0]) / 2 - 50, c = (c1 + c2) / 2, c7 = std::pow(c, 7);
  const double t = 1 - 0.17 * std::cos((h - 30) * degree) + 0.24 * std::cos(2 * h * degree) +
                   0.32 * std::cos((3 * h + 6) * degree) - 0.20 * std::cos((4 * h - 63) * degree);
  const double dl = (q[0] - p[0]) / (1 + 0.015 * l * l / std::sqrt(20 + l * l)), dc = (c2 - c1) / (1 + 0.045 * c),
               dh = 2 * std::sqrt(c1 * c2) * std::sin(turn / 2 * degree) / (1 + 0.015 * c * t);
  const double bend =
      std::sin(60 * std::exp(-std::pow((h - 275) / 25, 2)) * degree) * 2 * std::sqrt(c7 / (c7 + std::pow(25.0, 7)));
  return std::sqrt(dl * dl + dc * dc + dh * dh - bend * dc * dh);
}

}  // namespace

TEST_CASE("CIEDE2000 gives the differences that Sharma, Wu and Dalal 2005 publish") {
  CHECK(difference({50, 2.6772, -79.7751}, {50, 0, -82.7485}) == Approx(2.0425).margin(1e-4));
  CHECK(difference({50, 2.5, 0}, {73, 25, -18}) == Approx(27.1492).margin(1e-4));
  CHECK(difference({2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}) == Approx(0.9082).margin(1e-4));
}

TEST_CASE("the colours of eight vesicles are told apart with every kind of colour blindness") {
  for (const Sight& sight : sights) {
    double worst = 1e9;
    for (std::size_t a = 0; a < render::body_colours().size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        worst = std::min(worst,
                         difference(lab(render::body_colour(a), sight.seen), lab(render::body_colour(b), sight.seen)));
    INFO(sight.name);
    CHECK(worst >= 15);
  }
}
