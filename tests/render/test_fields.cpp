// Colour maps, colour bars, and that what is painted can be read off them.
#include "render/core/style.h"
#include "render/draw/draw.h"
#include "render/overlay/colour_bar.h"
#include "render/overlay/layout.h"

#include "surfaces.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using render::Image;
using sim::Vec3;

namespace {

render::Lab lab_of(const render::ColourTable& table, int i) {
  const auto& c = table[static_cast<std::size_t>(i)];
  return render::to_lab({c[0] / 255.0, c[1] / 255.0, c[2] / 255.0});
}

double distance(const render::Lab& a, const render::Lab& b) { return std::hypot(a.l - b.l, a.a - b.a, a.b - b.b); }

/// As a deuteranope sees it (Machado, Oliveira and Fernandes 2009), linear light.
render::Lab without_green(const render::ColourTable& table, int i) {
  const auto light = [](double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); };
  const auto code = [](double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; };
  const auto& c = table[static_cast<std::size_t>(i)];
  const Vec3 rgb(light(c[0] / 255.0), light(c[1] / 255.0), light(c[2] / 255.0));
  Eigen::Matrix3d m;
  m << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
  const Vec3 seen = (m * rgb).cwiseMax(0.0).cwiseMin(1.0);
  return render::to_lab({code(seen[0]), code(seen[1]), code(seen[2])});
}

constexpr int last = render::colour_steps - 1;

}  // namespace

TEST_CASE("CIELAB of known colours, there and back") {
  const render::Lab red = render::to_lab({1, 0, 0});
  CHECK(red.l == Approx(53.24).margin(0.01));
  CHECK(red.a == Approx(80.09).margin(0.02));
  CHECK(red.b == Approx(67.20).margin(0.02));
  const render::Colour c = render::to_srgb(render::to_lab({0.2, 0.5, 0.7}));
  CHECK(c.r == Approx(0.2).margin(1e-4));
  CHECK(c.g == Approx(0.5).margin(1e-4));
  CHECK(c.b == Approx(0.7).margin(1e-4));
}

TEST_CASE("sequential maps grow lighter all the way in equal steps, also to colour-blind eyes") {
  for (const render::ColourMapRow& map : render::colour_maps()) {
    if (map.kind != render::MapKind::sequential) continue;
    INFO(map.name);
    const render::ColourTable table = render::colour_table(map);
    constexpr int stride = 15;  // single steps are lost in the rounding to 8 bits
    double least = 1e9, most = 0;
    for (int i = stride; i <= last; i += stride) {
      CHECK(lab_of(table, i).l > lab_of(table, i - stride).l + 1);
      CHECK(distance(without_green(table, i), without_green(table, i - stride)) > 2);
      least = std::min(least, distance(lab_of(table, i), lab_of(table, i - stride)));
      most = std::max(most, distance(lab_of(table, i), lab_of(table, i - stride)));
    }
    CHECK(most < 1.35 * least);  // the chord of a bend is a little shorter than its arc
    CHECK(lab_of(table, last).l - lab_of(table, 0).l > 70);
  }
}

TEST_CASE("diverging maps are symmetric in lightness about a pale middle, and both arms differ to all eyes") {
  for (const render::ColourMapRow& map : render::colour_maps()) {
    if (map.kind != render::MapKind::diverging) continue;
    INFO(map.name);
    const render::ColourTable table = render::colour_table(map);
    CHECK(lab_of(table, last / 2).l > 92);
    CHECK(std::hypot(lab_of(table, last / 2).a, lab_of(table, last / 2).b) < 3);
    for (int i = 0; i < last / 2; ++i) {
      CHECK(lab_of(table, i).l == Approx(lab_of(table, last - i).l).margin(1.0));
      CHECK(lab_of(table, i + 1).l > lab_of(table, i).l - 0.5);
    }
    for (int i = 0; i < 100; i += 20) CHECK(distance(without_green(table, i), without_green(table, last - i)) > 20);
  }
}

TEST_CASE("cyclic maps end where they begin and change evenly in lightness") {
  for (const render::ColourMapRow& map : render::colour_maps()) {
    if (map.kind != render::MapKind::cyclic) continue;
    INFO(map.name);
    const render::ColourTable table = render::colour_table(map);
    CHECK(distance(lab_of(table, 0), lab_of(table, last)) < 1);
    for (int i = 0; i <= last / 2; ++i) CHECK(lab_of(table, i).l == Approx(lab_of(table, last - i).l).margin(1.0));
  }
}

TEST_CASE("a pixel of a painted sphere has the colour that the bar has at its value") {
  render::Renderer renderer(render::parse_gl_choice("software"));
  render::ViewParameters view = surfaces::bare_view(400, 400);
  view.style = "field";
  view.line_width = 0;
  view.colour_bar = true;
  for (const render::ColourMapRow& map : render::colour_maps()) {
    INFO(map.name);
    const sim::State state = surfaces::state_of({surfaces::sphere()});
    render::Frame frame = surfaces::painted(surfaces::frame_of(state, view), state);
    frame.view.colour_bar = true;
    frame.legend->colours = render::colour_table(map);
    frame.legend->low = -1.2;
    frame.legend->high = 1.5;
    const Image image = render::draw_frame(renderer, frame);
    const render::Box bar = render::lay_out(frame, render::Font()).bar;
    const double px = 200 / frame.camera.half_width;
    int compared = 0;
    for (int y = 0; y < 400; ++y)
      for (int x = 40; x < 300; ++x) {
        const double right = (x + 0.5 - 200) / px, up = (200 - y - 0.5) / px;
        if (std::hypot(right, up) > 0.85 || x >= bar.left - 2) continue;  // beyond it turns away by 60 degrees
        const int row = static_cast<int>(std::floor(bar.top + bar.height() * (1 - (up + 1.2) / 2.7)));
        const std::uint8_t *p = image.at(x, y), *q = image.at(static_cast<int>(bar.left + bar.width() / 2), row);
        for (int c = 0; c < 3; ++c) CHECK(std::abs(p[c] - q[c]) <= 4);  // one row of the bar is 1/184 of the map
        ++compared;
      }
    CHECK(compared > 20000);
  }
}

namespace {

/// A sphere of one colour, and what part of its middle is marked in grey: by 12 of 256 levels or more.
struct Painted {
  Image image;
  double grey = 0, marked = 0;
};

double grey_of(const std::uint8_t* p) { return 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2]; }

Painted paint(render::Renderer& renderer, const render::ColourMapRow& map, double value, bool dots,
              std::string_view camera = "flow-gradient") {
  render::ViewParameters view = surfaces::bare_view(400, 400);
  view.style = "field";
  view.supersampling = 2;
  view.line_width = 0;
  view.sign_dots = dots;
  view.camera = camera;
  const sim::State state = surfaces::state_of({surfaces::sphere()});
  render::Frame frame = surfaces::painted(surfaces::frame_of(state, view), state);
  std::fill(frame.bodies[0].mesh.scalar.begin(), frame.bodies[0].mesh.scalar.end(), static_cast<float>(value));
  frame.legend->colours = render::colour_table(map);
  frame.legend->mirrored = map.kind == render::MapKind::diverging;
  Painted p{render::draw_frame(renderer, frame)};
  const double clear = 255 * [&] {
    const render::Colour c = render::mapped(frame.legend->colours, (value + 1) / 2);
    return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b;
  }();
  for (int y = 120; y < 280; ++y)
    for (int x = 120; x < 280; ++x) {
      p.grey += grey_of(p.image.at(x, y)) / (160 * 160);
      p.marked += (std::abs(grey_of(p.image.at(x, y)) - clear) > 12) / (160.0 * 160);
    }
  return p;
}

}  // namespace

TEST_CASE("in grey a value below zero is told from the one above it by dots, on every diverging map") {
  render::Renderer renderer(render::parse_gl_choice("software"));
  for (const render::ColourMapRow& map : render::colour_maps())
    for (const double value : {0.15, 0.4, 0.7, 1.0}) {
      if (map.kind != render::MapKind::diverging) continue;
      INFO(map.name << " at " << value);
      const Painted above = paint(renderer, map, value, true), below = paint(renderer, map, -value, true),
                    bare = paint(renderer, map, -value, false);
      CHECK(above.grey ==
            Approx(bare.grey).margin(16));  // equal L*; the weights of grey differ a little. Hence the dots
      CHECK(bare.marked == 0);
      CHECK(above.marked == 0);
      CHECK(below.marked > 0.12);  // a full dot covers pi/16 of its cell
      CHECK(below.marked < 0.40);  // the colour between them is that of the bar
    }
}

TEST_CASE("dots of negative values stand as densely at a pole of the membrane as elsewhere, and have their colour") {
  render::Renderer renderer(render::parse_gl_choice("software"));
  const render::ColourMapRow& map = render::find_colour_map("blue-red");
  const Painted side = paint(renderer, map, -0.4, true), pole = paint(renderer, map, -0.4, true, "flow-vorticity");
  CHECK(pole.marked == Approx(side.marked).epsilon(0.15));
  const render::Colour colour = render::sign_dot_colour(render::mapped(render::colour_table(map), 0.3));
  double darkest = 255;
  for (int y = 180; y < 220; ++y)
    for (int x = 180; x < 220; ++x) darkest = std::min(darkest, grey_of(pole.image.at(x, y)));
  CHECK(
      darkest ==
      Approx(255 * (0.299 * colour.r + 0.587 * colour.g + 0.114 * colour.b)).margin(4));  // a dot is wider than a pixel
}

TEST_CASE("values beyond the range have the colour of the end, and the bar points beyond it") {
  render::Renderer renderer(render::parse_gl_choice("software"));
  render::ViewParameters view = surfaces::bare_view(300, 300);
  view.style = "field";
  view.line_width = 0;
  const sim::State state = surfaces::state_of({surfaces::sphere()});
  render::Frame frame = surfaces::painted(surfaces::frame_of(state, view), state);
  frame.legend->low = 2;
  frame.legend->high = 3;
  const Image image = render::draw_frame(renderer, frame);
  for (int c = 0; c < 3; ++c)
    CHECK(std::abs(image.at(150, 150)[c] - frame.legend->colours[0][static_cast<std::size_t>(c)]) <= 1);
}

TEST_CASE("ticks of a bar are round numbers within the range") {
  CHECK(render::bar_ticks(-1, 1) == std::vector<double>{-1, -0.5, 0, 0.5, 1});
  for (const auto& [low, high] :
       {std::pair{0.0, 7.3}, std::pair{-450.0, 450.0}, std::pair{0.003, 0.011}, std::pair{12.0, 12.5}}) {
    const std::vector<double> ticks = render::bar_ticks(low, high);
    CHECK(ticks.size() >= 3);
    CHECK(ticks.size() <= 7);
    CHECK(ticks.front() >= low - 1e-12);
    CHECK(ticks.back() <= high + 1e-9 * high);
  }
}

TEST_CASE("vesicles that follow each other have colours that grey print tells apart") {
  const auto grey = [](const render::Colour& c) { return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b; };
  for (std::size_t k = 0; k < render::body_colours().size(); ++k)
    CHECK(std::abs(grey(render::body_colour(k)) - grey(render::body_colour(k + 1))) >
          0.13);  // a third of the shading's range
}

TEST_CASE("colours are names or #rrggbb, others are answered with the nearest name") {
  CHECK(render::parse_colour("#ff8000") == render::Colour{1, 128 / 255.0, 0});
  CHECK(render::parse_colour("sky") == render::body_colour(1));
  CHECK_THAT(support::message_of([] { render::parse_colour("corall"); }), Catch::Contains("did you mean 'coral'"));
  CHECK_THAT(support::message_of([] { render::parse_colour("#ff80"); }), Catch::Contains("not #rrggbb"));
  CHECK_THAT(support::message_of([] { render::find_colour_map("viridus"); }),
             Catch::Contains("did you mean 'viridis'"));
}
