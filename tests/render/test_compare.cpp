// When two pictures are the same, by the rule for our own goldens and by FLIP.
#include "render/image/difference.h"
#include "render/image/flip.h"

#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

#include <sys/stat.h>

#include <cmath>
#include <limits>
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

TEST_CASE("a single pixel that differs much breaks the limit of the largest difference only") {
  const Image a = noise(1000, 1000, 2);
  CHECK(render::same_picture(render::difference(a, changed(a, 1, 48))));
  CHECK(render::objections(render::difference(a, changed(a, 1, 49))) ==
        std::vector<std::string>{"a pixel differs by 49 (allowed: 48)"});
  CHECK_FALSE(render::same_picture(render::difference(a, changed(a, 10, 92))));
}

TEST_CASE("a limit that is no number lets nothing pass, and is refused where it is given") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Image red = even(64, 48, 255, 0, 0), blue = even(64, 48, 0, 0, 255);
  render::CompareRule rule;
  rule.channel = 0;
  rule.pixels = rule.share = rule.rmse = rule.largest = rule.flip_mean = rule.flip_max = nan;
  CHECK(render::objections(render::difference(red, blue, rule), rule).size() >= 4);
  render::visit(rule, [&](std::string_view name, std::string_view, const double&) {
    CHECK_THROWS_AS(render::check_limit(name, nan), std::invalid_argument);
    CHECK_THROWS_AS(render::check_limit(name, -1), std::invalid_argument);
    if (name != "ppd") CHECK_NOTHROW(render::check_limit(name, inf));
  });
  for (const double ppd : {nan, inf, 0.0, 1.0, 9.9, 1001.0, 1e9}) {
    CHECK_THROWS_AS(render::check_limit("ppd", ppd), std::invalid_argument);
    CHECK_THROWS_AS(render::flip(red, blue, ppd), std::invalid_argument);
  }
  for (const double ppd : {render::flip_least_ppd, render::flip_most_ppd})
    CHECK(mean(render::flip(red, blue, ppd)) > 0.5);
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
    for (std::size_t c = 0; c < 3; ++c)
      with_alpha.pixels[std::size_t(4 * i) + c] = opaque.pixels[std::size_t(3 * i) + c];
    with_alpha.pixels[std::size_t(4 * i) + 3] = 255;
  }
  CHECK(render::same_picture(render::difference(opaque, with_alpha)));
  // A channel that is equal does not dilute the others.
  const Image other = changed(opaque, 7, 9);
  CHECK(render::difference(other, with_alpha).rmse == render::difference(other, opaque).rmse);
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
  CHECK(of(even(40, 30, 0, 0, 0), even(40, 30, 255, 255, 255)) ==
        Approx(expected).margin(1e-4));  // the white point of the colours by hand has five digits
  // Two greys: L = 116 cbrt(Y) - 16 with Y = ((v + 0.055) / 1.055)^2.4.
  const auto lightness = [](int v) { return 116 * std::cbrt(std::pow((v / 255.0 + 0.055) / 1.055, 2.4)) - 16; };
  const double step = std::pow(lightness(140) - lightness(120), 0.7);
  CHECK(of(even(40, 30, 120, 120, 120), even(40, 30, 140, 140, 140)) ==
        Approx(0.95 * step / (0.4 * m)).margin(1e-4));  // the white point of the colours by hand has five digits
}

TEST_CASE("FLIP in tiles is FLIP of the whole, bit by bit, and zero where nothing is near") {
  // Wider than a tile in both directions; what differs lies across the corner of four.
  const Image a = noise(450, 430, 11);
  Image b = a;
  for (int y = 180; y < 200; ++y)
    for (int x = 185; x < 195; ++x) b.at(x, y)[1] ^= 0x80;
  const std::vector<float> whole = render::flip(a, b);
  // The same place, in pictures that are cut so that it lies within one tile.
  const auto part = [](const Image& image) {
    Image result(150, 150, 3);
    for (int y = 0; y < 150; ++y) std::copy_n(image.at(110, 110 + y), 450, result.at(0, y));
    return result;
  };
  const std::vector<float> cut = render::flip(part(a), part(b));
  for (int y = 30; y < 120; ++y)  // beyond the reach of the cut's own borders
    for (int x = 30; x < 120; ++x)
      REQUIRE(cut[static_cast<std::size_t>(y * 150 + x)] == whole[static_cast<std::size_t>((y + 110) * 450 + x + 110)]);
  CHECK(whole[static_cast<std::size_t>(190 * 450 + 190)] > 0);
  CHECK(whole[static_cast<std::size_t>(190 * 450 + 300)] == 0);
  CHECK(whole[static_cast<std::size_t>(20 * 450 + 20)] == 0);
}

TEST_CASE("what is ignored does not shine into FLIP of its surroundings") {
  const Image a = even(80, 60, 120, 130, 140);
  Image b = a;
  render::Ignored ignored(4800);
  for (int y = 20; y < 40; ++y)
    for (int x = 20; x < 40; ++x) {
      b.at(x, y)[0] = 255;
      ignored[static_cast<std::size_t>(y * 80 + x)] = 1;
    }
  b.at(70, 50)[0] = 121;  // or nothing would be computed at all
  render::CompareRule rule;
  rule.flip_mean = 1;
  const double seen = *render::difference(a, b, rule, ignored).flip_max;
  b = a;
  b.at(70, 50)[0] = 121;
  CHECK(seen == *render::difference(a, b, rule).flip_max);
}

TEST_CASE("in one spot 'perceptual' allows less than all over the picture") {
  render::CompareRule rule;
  for (const render::ComparePreset& p : render::compare_presets())
    if (p.name == "perceptual") rule = p.rule;
  const Image a = even(200, 150, 200, 200, 200);
  const auto with_dots = [&](std::initializer_list<std::pair<int, int>> places) {
    Image image = a;
    for (const auto& [x, y] : places)
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = 100;
    return image;
  };
  const render::ImageDifference one = render::difference(a, with_dots({{50, 40}}), rule),
                                all_over = render::difference(a, with_dots({{20, 20}, {180, 130}}), rule);
  CHECK((one.spot && !all_over.spot));
  CHECK((*one.flip_max > rule.flip_spot && *all_over.flip_max < rule.flip_max));
  CHECK_FALSE(render::same_picture(one, rule));
  CHECK(render::same_picture(all_over, rule));
}

namespace {

/// A chunk with its checksum, after the header of a file.
std::string with_chunk(std::string file, const std::string& type, const std::string& data) {
  const auto word = [](std::uint32_t v) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(v >> shift);
    return text;
  };
  std::uint32_t crc = 0xffffffffU;
  for (const char c : type + data) {
    crc ^= static_cast<unsigned char>(c);
    for (int k = 0; k < 8; ++k) crc = crc & 1U ? 0xedb88320U ^ (crc >> 1) : crc >> 1;
  }
  return file.insert(33, word(static_cast<std::uint32_t>(data.size())) + type + data + word(~crc));
}

/// Without the chunks of one type.
std::string without(std::string file, const std::string& type) {
  const std::size_t at = file.find(type);
  REQUIRE(at != std::string::npos);
  const std::size_t length = static_cast<unsigned char>(file[at - 1]);  // they are short
  return file.erase(at - 4, length + 12);
}

}  // namespace

TEST_CASE("what a file declares of its colours and frames is compared with its samples") {
  using namespace std::string_literals;
  const std::string srgb = render::png_bytes(even(8, 8, 200, 100, 50));
  const std::string plain = without(without(without(srgb, "sRGB"), "gAMA"), "cHRM");
  const auto said = [](const std::string& a, const std::string& b) {
    const auto all = render::objections(render::difference(render::png_from(a, "a"), render::png_from(b, "b")));
    return all.empty() ? std::string() : all.front();
  };
  CHECK(said(plain, srgb).empty());                                        // no word means sRGB
  CHECK(said(plain, with_chunk(plain, "gAMA", "\0\0\xb1\x8f"s)).empty());  // 1/2.2
  const std::string linear = with_chunk(plain, "gAMA", "\0\x01\x86\xa0"s);
  CHECK(said(srgb, linear) == "its numbers mean gamma 1 instead of sRGB");
  CHECK(said(linear, plain) == "its numbers mean sRGB instead of gamma 1");
  CHECK(said(linear, linear).empty());
  CHECK_THAT(said(plain, with_chunk(plain, "iCCP", "P3\x1b\0\0 ..."s)), Catch::Contains("ICC profile 'P3?'"));
  const std::string movie = with_chunk(plain, "acTL", "\0\0\0\2\0\0\0\0"s);
  CHECK_THAT(said(plain, movie), Catch::StartsWith("an animation: 2 frames") && Catch::EndsWith("instead of a still"));
  CHECK(said(movie, movie).empty());
  CHECK_FALSE(said(movie, with_chunk(movie, "fdAT", "\0\0\0\1xy"s)).empty());
}

TEST_CASE("samples of 16 bits count with their lower bytes") {
  render::PngFile a;
  a.image = even(20, 10, 100, 120, 140);
  render::PngFile b = a, eight = a;
  a.lower_bytes.assign(600, 100);
  b.lower_bytes = a.lower_bytes;
  CHECK(render::difference(a, b).maximum == 0);
  b.lower_bytes[31] = 99;
  const render::CompareRule exact = render::compare_presets()[0].rule;
  const render::ImageDifference d = render::difference(a, b, exact);
  CHECK(d.maximum == Approx(1 / 257.0));
  CHECK(d.above == 1);
  CHECK_FALSE(render::same_picture(d, exact));
  CHECK(render::same_picture(render::difference(a, b)));
  // 8 bits v are v x 257 in 16.
  b.image = eight.image;
  for (std::size_t i = 0; i < 600; ++i) b.lower_bytes[i] = b.image.pixels[i];
  CHECK(render::difference(eight, b, exact).maximum == 0);
  b.lower_bytes[0] ^= 1;
  CHECK(render::difference(eight, b, exact).above == 1);
}

namespace {

/// A file of grey samples; `rows` are what is compressed, here by storing it.
std::string grey_file(int width, int height, int bits, bool interlaced, const std::string& rows) {
  using namespace std::string_literals;
  const auto chunk = [](const std::string& type, const std::string& data) {
    return with_chunk(std::string(33, ' '), type, data).substr(33);
  };
  const auto bytes = [](std::initializer_list<int> values) {
    std::string text;
    for (const int v : values) text += static_cast<char>(v);
    return text;
  };
  std::uint32_t low = 1, high = 0;
  for (const char c : rows) low = (low + static_cast<unsigned char>(c)) % 65521, high = (high + low) % 65521;
  const int size = static_cast<int>(rows.size()), l = static_cast<int>(low), h = static_cast<int>(high);
  REQUIRE(size < 65536);
  const std::string stored =
      "\x78\x01\x01"s + bytes({size, size >> 8, ~size, ~size >> 8}) + rows + bytes({h >> 8, h, l >> 8, l});
  return "\x89PNG\r\n\x1a\n"s +
         chunk("IHDR", bytes({0, 0, width >> 8, width, 0, 0, height >> 8, height, bits, 0, 0, 0, interlaced})) +
         chunk("IDAT", stored) + chunk("IEND", "");
}

}  // namespace

TEST_CASE("the PNG reader keeps the lower bytes of 16 bits") {
  using namespace std::string_literals;
  const render::PngFile file = render::png_from(grey_file(2, 1, 16, false, "\0\x12\x34\xab\xcd"s), "wide");
  CHECK(file.image.pixels == std::vector<std::uint8_t>{0x12, 0x12, 0x12, 0xab, 0xab, 0xab});
  CHECK(file.lower_bytes == std::vector<std::uint8_t>{0x34, 0x34, 0x34, 0xcd, 0xcd, 0xcd});
}

TEST_CASE("the PNG reader puts an interlaced picture together") {
  // First column, first row and the steps of Adam7's passes.
  constexpr int passes[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
  const int width = 21, height = 407;  // more rows than are read at a time
  const auto value = [](int x, int y) { return static_cast<std::uint8_t>(7 * x + 31 * y + x * y); };
  std::string rows;
  for (const auto& [left, top, across, down] : passes)
    for (int y = top; y < height; y += down) {
      rows += '\0';  // no filter
      for (int x = left; x < width; x += across) rows += static_cast<char>(value(x, y));
    }
  const Image image = render::png_from(grey_file(width, height, 8, true, rows), "interlaced").image;
  REQUIRE((image.width == width && image.height == height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) REQUIRE(int(image.at(x, y)[0]) == int(value(x, y)));
}

TEST_CASE("a picture of another format is called what it is, and no pipe is waited for") {
  const support::TemporaryFolder folder;
  const auto message = [&](const std::string& bytes) {
    support::write_file(folder / "x.png", bytes);
    return support::message_of([&] { render::read_png(folder / "x.png"); });
  };
  using namespace std::string_literals;
  CHECK_THAT(message("\xff\xd8\xff\xe0\0\x10JFIF"s), Catch::EndsWith("x.png: is not a PNG file but a JPEG picture"));
  CHECK_THAT(message("RIFF\0\0\0\0WEBPVP8 "s), Catch::EndsWith("a WebP picture"));
  CHECK_THAT(message("version https://git-lfs.github.com/spec/v1\noid sha256:0\n"), Catch::Contains("'git lfs pull'"));
  REQUIRE(mkfifo((folder / "pipe.png").c_str(), 0600) == 0);
  CHECK_THAT(support::message_of([&] { render::read_png(folder / "pipe.png"); }),
             Catch::Contains("is a pipe or a device"));
  CHECK_THAT(support::message_of([&] { render::read_png(folder.path()); }), Catch::Contains("is a folder"));
  CHECK(render::png_memory(folder / "pipe.png") == 0);
}

TEST_CASE("FLIP sees an edge more than an even change, and less from further away") {
  const Image grey = even(120, 80, 128, 128, 128);
  Image line = grey;
  for (int y = 0; y < 80; ++y)
    for (int c = 0; c < 3; ++c) line.at(60, y)[c] = 100;
  const std::vector<float> near = render::flip(grey, line, 67), far = render::flip(grey, line, 200);
  CHECK(largest(near) > largest(render::flip(grey, even(120, 80, 127, 127, 127))));
  CHECK(largest(far) < largest(near));
  CHECK(near[60 + 120 * 40] == Approx(near[60 + 120 * 20]));               // along the line
  CHECK(near[50 + 120 * 40] == Approx(near[70 + 120 * 40]).margin(1e-5));  // on both sides
  CHECK(near[5] == 0);                                                     // where there is nothing
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
