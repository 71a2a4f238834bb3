// When two pictures are the same, by the rule for our own goldens and by FLIP.
#include "render/compare.h"
#include "render/flip.h"

#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using render::Image;

namespace {

Image even(int width, int height, int red, int green, int blue) {
  Image image(width, height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<std::uint8_t>(i % 3 == 0 ? red : i % 3 == 1 ? green : blue);
  return image;
}

Image noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  Image image(width, height, 3);
  for (std::uint8_t& v : image.pixels) v = static_cast<std::uint8_t>(random());
  return image;
}

/// `count` pixels from the left in the middle row with one channel moved by `by`.
Image changed(Image image, int count, int by) {
  for (int i = 0; i < count; ++i) {
    std::uint8_t& v = image.at(i % image.width, image.height / 2 + i / image.width)[1];
    v = static_cast<std::uint8_t>(v < 128 ? v + by : v - by);
  }
  return image;
}

double mean(const std::vector<float>& map) {
  double total = 0;
  for (const float v : map) total += static_cast<double>(v);
  return total / static_cast<double>(map.size());
}
float largest(const std::vector<float>& map) { return *std::max_element(map.begin(), map.end()); }

}  // namespace

TEST_CASE("ten pixels may differ in a small picture and a share of 2e-5 in a large one") {
  const Image small = noise(100, 100, 1), large = noise(1000, 1000, 2);
  CHECK(render::same_picture(render::difference(small, small)));
  CHECK(render::same_picture(render::difference(small, changed(small, 10, 3))));
  CHECK_FALSE(render::same_picture(render::difference(small, changed(small, 11, 3))));
  CHECK(render::same_picture(render::difference(large, changed(large, 20, 40))));
  CHECK_FALSE(render::same_picture(render::difference(large, changed(large, 21, 40))));
  const auto objections = render::objections(render::difference(small, changed(small, 11, 3)));
  REQUIRE(objections.size() == 1);
  CHECK(objections[0] == "11 pixels differ by more than 2 (allowed: 10)");
}

TEST_CASE("a difference of two everywhere breaks the limit of the root mean square only") {
  const Image grey = even(64, 64, 100, 100, 100), lighter = even(64, 64, 101, 101, 101);
  const render::ImageDifference d = render::difference(grey, lighter);
  CHECK(d.above == 0);
  CHECK(d.rmse == Approx(1));
  CHECK(render::objections(d) == std::vector<std::string>{"rmse 1 (allowed: 0.15)"});
}

TEST_CASE("the difference tells how much, how many and where") {
  const Image a = even(50, 40, 10, 20, 30);
  Image b = a;
  b.at(7, 5)[0] = 14;
  b.at(30, 21)[2] = 130;
  b.at(12, 39)[1] = 22;  // by two: allowed
  const render::ImageDifference d = render::difference(a, b);
  CHECK(d.compared == 2000);
  CHECK(d.maximum == 100);
  CHECK(d.above == 2);
  CHECK((d.left == 7 && d.top == 5 && d.right == 31 && d.bottom == 22));
  CHECK(d.rmse == Approx(std::sqrt((16 + 10000 + 4) / 6000.0)));
  CHECK(int(render::difference_image(a, b).at(7, 5)[0]) == 64);
  CHECK(int(render::difference_image(a, b).at(30, 21)[2]) == 255);
  CHECK_THROWS_AS(render::difference(a, Image(40, 50, 3)), std::invalid_argument);
}

TEST_CASE("ignored pixels do not count") {
  const Image a = noise(40, 30, 3);
  Image b = a;
  render::Ignored ignored(1200);
  for (int y = 4; y < 9; ++y)
    for (int x = 10; x < 20; ++x) {
      b.at(x, y)[0] ^= 0x80;
      ignored[static_cast<std::size_t>(40 * y + x)] = 1;
    }
  CHECK(render::difference(a, b).above == 50);
  const render::ImageDifference d = render::difference(a, b, {}, ignored);
  CHECK((d.above == 0 && d.maximum == 0 && d.compared == 1150));
  b.at(20, 4)[0] ^= 0x80;
  CHECK(render::difference(a, b, {}, ignored).above == 1);
}

TEST_CASE("transparency counts when one of the pictures has it") {
  const Image opaque = even(20, 20, 200, 100, 50);
  Image with_alpha(20, 20, 4);
  for (int i = 0; i < 400; ++i) {
    for (std::size_t c = 0; c < 3; ++c) with_alpha.pixels[std::size_t(4 * i) + c] = opaque.pixels[std::size_t(3 * i) + c];
    with_alpha.pixels[std::size_t(4 * i) + 3] = 255;
  }
  CHECK(render::same_picture(render::difference(opaque, with_alpha)));
  for (int i = 0; i < 400; ++i) with_alpha.pixels[std::size_t(4 * i) + 3] = 128;
  CHECK(render::difference(opaque, with_alpha).above == 400);
}

TEST_CASE("the preset 'exact' forgives nothing, 'perceptual' what nobody sees") {
  const auto rule = [](std::string_view name) {
    for (const render::ComparePreset& p : render::compare_presets())
      if (p.name == name) return p.rule;
    throw std::runtime_error("no preset");
  };
  const Image a = even(100, 80, 120, 130, 140);
  const Image one = changed(a, 1, 1);
  CHECK(render::same_picture(render::difference(a, one)));
  CHECK_FALSE(render::same_picture(render::difference(a, one, rule("exact")), rule("exact")));
  // One step of 255 everywhere is not seen, though its root mean square is 1.
  const Image lighter = even(100, 80, 121, 131, 141);
  CHECK_FALSE(render::same_picture(render::difference(a, lighter)));
  CHECK(render::same_picture(render::difference(a, lighter, rule("perceptual")), rule("perceptual")));
  // A dark spot of 6 x 6 pixels is.
  Image spot = a;
  for (int y = 30; y < 36; ++y)
    for (int x = 30; x < 36; ++x) spot.at(x, y)[0] = spot.at(x, y)[1] = spot.at(x, y)[2] = 20;
  CHECK_FALSE(render::same_picture(render::difference(a, spot, rule("perceptual")), rule("perceptual")));
}

TEST_CASE("FLIP is zero for equal pictures, symmetric, and within 0 and 1") {
  const Image a = noise(60, 50, 5), b = noise(60, 50, 6);
  CHECK(largest(render::flip(a, a)) == 0);
  const std::vector<float> there = render::flip(a, b), back = render::flip(b, a);
  for (std::size_t i = 0; i < there.size(); ++i) {
    REQUIRE(there[i] == Approx(back[i]).margin(1e-6));
    REQUIRE((there[i] >= 0 && there[i] <= 1));
  }
}

// On even pictures the filters do nothing and the features vanish, so that the paper's equations can be done by hand:
// (Per pixel ours differs from the authors' own program by less than 1e-4: docs/ci.md.)
// E = 0.95 e / (0.4 m) up to e = 0.4 m and 0.95 + 0.05 (e - 0.4 m) / (0.6 m) above, e = HyAB^0.7, m = e(green, blue).
TEST_CASE("FLIP of even pictures is what the paper's equations give by hand") {
  const auto of = [](const Image& a, const Image& b) { return mean(render::flip(a, b)); };
  const Image green = even(40, 30, 0, 255, 0), blue = even(40, 30, 0, 0, 255);
  CHECK(of(green, blue) == Approx(1).margin(1e-6));  // by definition of m
  // HyAB(green, blue) with L, 0.01 L a, 0.01 L b: green 87.737, -86.183, 83.179; blue 32.297, 79.188, -107.860.
  const double l1 = 87.7347, l2 = 32.2970, a1 = -86.1827 * l1 / 100, b1 = 83.1793 * l1 / 100, a2 = 79.1875 * l2 / 100,
               b2 = -107.8602 * l2 / 100;
  const double m = std::pow(l1 - l2 + std::hypot(a1 - a2, b1 - b2), 0.7);
  const double e = std::pow(100.0, 0.7);  // black and white differ in lightness alone
  const double expected = 0.95 + 0.05 * (e - 0.4 * m) / (0.6 * m);
  INFO("expected " << expected);
  CHECK(of(even(40, 30, 0, 0, 0), even(40, 30, 255, 255, 255)) == Approx(expected).margin(1e-4));  // the white point of the colours by hand has five digits
  // Two greys: L = 116 cbrt(Y) - 16 with Y = ((v + 0.055) / 1.055)^2.4.
  const auto lightness = [](int v) { return 116 * std::cbrt(std::pow((v / 255.0 + 0.055) / 1.055, 2.4)) - 16; };
  const double step = std::pow(lightness(140) - lightness(120), 0.7);
  CHECK(of(even(40, 30, 120, 120, 120), even(40, 30, 140, 140, 140)) == Approx(0.95 * step / (0.4 * m)).margin(1e-4));  // the white point of the colours by hand has five digits
}

TEST_CASE("FLIP sees an edge more than an even change, and less from further away") {
  const Image grey = even(120, 80, 128, 128, 128);
  Image line = grey;
  for (int y = 0; y < 80; ++y)
    for (int c = 0; c < 3; ++c) line.at(60, y)[c] = 100;
  const std::vector<float> near = render::flip(grey, line, 67), far = render::flip(grey, line, 200);
  CHECK(largest(near) > largest(render::flip(grey, even(120, 80, 127, 127, 127))));
  CHECK(largest(far) < largest(near));
  CHECK(near[60 + 120 * 40] == Approx(near[60 + 120 * 20]));      // along the line
  CHECK(near[50 + 120 * 40] == Approx(near[70 + 120 * 40]).margin(1e-5));  // on both sides
  CHECK(near[5] == 0);                                            // where there is nothing
}

TEST_CASE("no header makes the PNG reader take memory that the file cannot fill") {
  const support::TemporaryFolder folder;
  render::write_png(folder / "small.png", Image(8, 8, 3));
  std::string bytes = support::read_file(folder / "small.png");
  // Width and height of the header, and its checksum, for 30000 x 30000 pixels.
  const unsigned char header[] = {0x00, 0x00, 0x75, 0x30, 0x00, 0x00, 0x75, 0x30, 0x08, 0x02, 0x00, 0x00, 0x00};
  for (std::size_t i = 0; i < sizeof header; ++i) bytes[16 + i] = static_cast<char>(header[i]);
  std::uint32_t crc = 0xffffffffU;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= static_cast<unsigned char>(bytes[i]);
    for (int k = 0; k < 8; ++k) crc = crc & 1U ? 0xedb88320U ^ (crc >> 1) : crc >> 1;
  }
  crc = ~crc;
  for (std::size_t k = 0; k < 4; ++k) bytes[29 + k] = static_cast<char>(crc >> (24 - 8 * k));
  support::write_file(folder / "large.png", bytes);
  CHECK_THAT(support::message_of([&] { render::read_png(folder / "large.png"); }),
             Catch::Contains("cannot hold 30000 x 30000 pixels"));
}
