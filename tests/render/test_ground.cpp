// The ground behind the vesicles: its colours, and none at all.
#include "render/core/ground.h"
#include "render/core/srgb.h"
#include "render/draw/draw.h"

#include "surfaces.h"
#include "tests/support/catch.h"

#include <cmath>

using Catch::Contains;

namespace {

double luma(const render::Colour& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

render::Image drawn(const std::string& background, const std::string& style, int supersampling, bool outlined = true) {
  render::ViewParameters view;
  view.size = {160, 120};
  view.supersampling = supersampling;
  view.background = background;
  view.style = style;
  view.flow_arrows = view.scale_bar = false;
  if (!outlined) view.outline_width = 0;
  const sim::State state = surfaces::state_of(
      {surfaces::disc(surfaces::turn(50, {1, 0, 0}), {-0.7, 0, 0}), surfaces::sphere({1, 0.5, 0}, 0.8)});
  render::Frame frame = surfaces::painted(surfaces::frame_of(state, view), state);
  frame.captions.time = "t = 1";
  static render::Renderer renderer(render::parse_gl_choice("software"));
  return render::draw_frame(renderer, frame);
}

}  // namespace

TEST_CASE("what is written on a ground contrasts with it") {
  for (const char* name : {"gradient", "white", "dark", "transparent", "#000000", "#ffffff", "#203050", "#d0d8e0"}) {
    const render::Ground ground = render::ground_of(name);
    const render::Inks inks = render::inks_on(ground);
    INFO(name);
    for (const render::Colour& under : {ground.top, ground.bottom}) {
      CHECK(std::abs(luma(inks.text) - luma(under)) > 0.5);
      CHECK(std::abs(luma(inks.soft) - luma(under)) > 0.4);
    }
  }
  CHECK_THROWS_WITH(render::ground_of("drak"), Contains("'drak' is no known ground") && Contains("mean 'dark'?"));
  CHECK_THROWS_WITH(render::ground_of("#12345"), Contains("#rrggbb"));
}

TEST_CASE("a ground of one colour is that colour to the bit") {
  const render::Image image = drawn("#203050", "opaque", 2);
  const std::uint8_t* corner = image.at(159, 119);
  CHECK(corner[0] == 0x20);
  CHECK(corner[1] == 0x30);
  CHECK(corner[2] == 0x50);
}

TEST_CASE("a transparent picture laid on white in linear light is the picture on white") {
  for (const bool outlined : {false, true})
    for (const char* style : {"opaque", "cutaway", "outline"}) {
      const render::Image white = drawn("white", style, 2, outlined), clear = drawn("transparent", style, 2, outlined);
      REQUIRE(clear.channels == 4);
      int partly = 0, worst = 0;
      for (int y = 0; y < clear.height; ++y)
        for (int x = 0; x < clear.width; ++x) {
          if (x < 60 && y < 20) continue;  // text, which Cairo mixes as it is encoded
          const std::uint8_t *p = clear.at(x, y), *q = white.at(x, y);
          const double alpha = p[3] / 255.0;
          partly += p[3] > 0 && p[3] < 255;
          for (int c = 0; c < 3; ++c) {
            const double laid = render::srgb_of(alpha * render::linear_of(p[c] / 255.0) + 1 - alpha);
            worst = std::max(worst, static_cast<int>(std::lround(std::abs(255 * laid - q[c]))));
          }
        }
      INFO(style << ", outlined: " << outlined);
      CHECK(clear.at(0, 119)[3] == 0);
      CHECK(clear.at(100, 60)[3] == 255);
      CHECK(partly > 50);
      // The outermost samples of outlines and rims are blended, as they are encoded.
      CHECK(worst <= (outlined || std::string_view(style) == "cutaway" ? 60 : 4));
    }
}

TEST_CASE("nothing of an empty ground gets into the colours of a transparent picture") {
  // One sample of four is red and whole, one red and half there, as it is blended over nothing.
  render::Image samples(2, 2, 4);
  const std::uint8_t red[] = {200, 0, 0, 255}, half[] = {100, 0, 0, 128};
  std::copy_n(red, 4, samples.at(0, 0));
  std::copy_n(half, 4, samples.at(1, 1));
  const render::Image pixel = render::downsample_transparent(samples, 2);
  CHECK(std::abs(pixel.at(0, 0)[0] - 200) <= 1);
  CHECK(pixel.at(0, 0)[1] == 0);
  CHECK(std::abs(pixel.at(0, 0)[3] - (255 + 128) / 4) <= 1);
}
