// Pictures in memory and in PNG files.
#include "render/image/image.h"

#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

#include <cmath>

#include <unistd.h>

using render::Image;

namespace {

Image pattern(int width, int height, int channels) {
  Image image(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c)
        image.at(x, y)[c] = static_cast<std::uint8_t>(7 * x + 13 * y * y + 101 * c + x * y);
  return image;
}

/// The name under which the writer of this process keeps an incomplete file.
std::string temporary_name(const std::string& name) { return "." + name + "." + std::to_string(::getpid()) + ".tmp"; }

double linear(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }
double srgb(double l) { return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055; }

}  // namespace

TEST_CASE("an even field of any value survives downsampling by 1, 2, 3 and 4") {
  for (const int factor : {1, 2, 3, 4})
    for (int value = 0; value < 256; ++value) {
      Image image(factor, factor, 4);
      std::fill(image.pixels.begin(), image.pixels.end(), static_cast<std::uint8_t>(value));
      CHECK(int(render::downsample(image, factor).pixels[0]) == value);
    }
}

TEST_CASE("downsampling averages light, not codes") {
  Image image(2, 2, 3);  // half of the samples black, half white: half the light is code 188, not 128
  for (int c = 0; c < 3; ++c) image.at(0, 0)[c] = image.at(1, 1)[c] = 255;
  CHECK(int(render::downsample(image, 2).pixels[0]) == 188);
  for (const int factor : {2, 3}) {
    const Image source = pattern(6 * factor, 5 * factor, 4);
    const Image result = render::downsample(source, factor);
    for (int y = 0; y < result.height; ++y)
      for (int x = 0; x < result.width; ++x)
        for (int c = 0; c < 3; ++c) {
          double sum = 0;
          for (int j = 0; j < factor; ++j)
            for (int i = 0; i < factor; ++i) sum += linear(source.at(factor * x + i, factor * y + j)[c] / 255.0);
          CHECK(result.at(x, y)[c] == Approx(255 * srgb(sum / factor / factor)).margin(0.95));
        }
  }
}

TEST_CASE("rows that come bottom first are put top first") {
  const Image source = pattern(8, 6, 4);
  Image flipped(8, 6, 4);
  for (int y = 0; y < 6; ++y) std::copy(source.at(0, y), source.at(0, y) + 32, flipped.at(0, 5 - y));
  CHECK(render::downsample(flipped, 2, render::RowOrder::bottom_first) == render::downsample(source, 2));
}

TEST_CASE("a size that is no multiple of the factor is refused") {
  CHECK_THROWS_AS(render::downsample(Image(5, 4, 3), 2), std::invalid_argument);
}

TEST_CASE("a PNG file gives back its pixels and its text") {
  const support::TemporaryFolder folder;
  const render::PngText text{{"time", "12.5"}, {"scene", "Zeichnung: γ̇t, λ, ν"}, {"empty", ""}};
  for (const int channels : {3, 4}) {
    const Image image = pattern(37, 23, channels);
    render::write_png(folder / "a.png", image, text);
    const render::PngFile file = render::read_png(folder / "a.png");
    CHECK(file.image == image);
    CHECK(file.text == text);
    CHECK(render::read_png_text(folder / "a.png") == text);
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
  CHECK(files == 1);  // no temporary is left
}

TEST_CASE("writing a picture twice gives the same bytes") {
  const support::TemporaryFolder folder;
  render::write_png(folder / "a.png", pattern(40, 30, 3), {{"k", "v"}});
  render::write_png(folder / "b.png", pattern(40, 30, 3), {{"k", "v"}});
  CHECK(support::read_file(folder / "a.png") == support::read_file(folder / "b.png"));
}

TEST_CASE("a damaged PNG file is refused with one sentence") {
  const support::TemporaryFolder folder;
  render::write_png(folder / "good.png", pattern(64, 64, 3), {{"time", "1"}});
  const std::string good = support::read_file(folder / "good.png");
  const auto message = [&](const std::string& bytes) {
    support::write_file(folder / "bad.png", bytes);
    return support::message_of([&] { render::read_png(folder / "bad.png"); });
  };
  CHECK_THAT(message(""), Catch::Contains("bad.png: is empty"));
  CHECK_THAT(message("P6 64 64 255 and so on"), Catch::Contains("bad.png: is not a PNG file"));
  for (const std::size_t length : {good.size() / 20, good.size() / 2, good.size() - 6, std::size_t{20}, std::size_t{9}})
    CHECK_THAT(message(good.substr(0, length)), Catch::Contains("bad.png: is damaged"));
  for (std::size_t place = 8; place < good.size(); place += 97) {  // one byte wrong anywhere
    std::string wrong = good;
    wrong[place] = static_cast<char>(wrong[place] ^ 0x55);
    const std::string text = message(wrong);
    CHECK(text.find('\n') == std::string::npos);
    if (place < good.size() - 12 && text.empty())
      CHECK(render::read_png(folder / "bad.png").image == pattern(64, 64, 3));
  }
  CHECK_THAT(support::message_of([&] { render::read_png(folder / "none.png"); }), Catch::Contains("No such file"));
}

TEST_CASE("a picture that cannot be written names path and reason and leaves nothing") {
  const support::TemporaryFolder folder;
  const Image image = pattern(8, 8, 3);
  CHECK_THAT(support::message_of([&] { render::write_png(folder / "no/such/a.png", image); }),
             Catch::Contains("no/such/a.png: cannot be written: No such file"));
  std::filesystem::create_directory(folder / "taken.png");
  CHECK_THAT(support::message_of([&] { render::write_png(folder / "taken.png", image); }),
             Catch::Contains("cannot be written"));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
  CHECK(files == 1);
}

TEST_CASE("a link that waits under the temporary name of a picture is not written through") {
  const support::TemporaryFolder folder;
  support::write_file(folder / "precious", "kept");
  std::filesystem::create_symlink(folder / "precious", folder / temporary_name("a.png"));
  render::write_png(folder / "a.png", pattern(20, 20, 3));
  CHECK(support::read_file(folder / "precious") == "kept");
  CHECK(render::read_png(folder / "a.png").image == pattern(20, 20, 3));
}
