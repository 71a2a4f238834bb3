// What the rule for pictures notices: small defects of two vesicles, at 960 x 540 and in the size of our goldens.
// TANKTREAD_TABLE=FILE writes the table of docs/ci.md.
#include "render/draw.h"

#include "surfaces.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <fstream>

using surfaces::turn;
using surfaces::Vec3;

namespace {

/// The pair of the goldens, with something a little wrong.
struct Defect {
  const char* name;
  bool caught_small;          ///< also at 320 x 240
  double rotation = 0;        ///< of the second vesicle, degrees
  double stretch = 0;         ///< of the second vesicle along its axis, share
  double bump = 0;            ///< of the first vesicle, share of its size
  double label = 0;           ///< of the second vesicle's labels, degrees
  double line_width = 0;      ///< pixels more
  double light = 0;           ///< share more
};

sim::State pair(const Defect& d) {
  const Eigen::Matrix3d r = turn(-35, {0, 1, 0}) * turn(23, {1, 0, 0});
  const auto disc = [&](const Vec3& s) -> Vec3 {
    const double q = s.x() * s.x() + s.y() * s.y(), scale = 1.191602667;
    // A bump of 30 degrees across, where one looks at the disc.
    const Vec3 to = Vec3(0.3, -0.85, 0.4).normalized();
    const double bump = 1 + d.bump * std::exp(-(1 - s.dot(to)) / 0.034);
    return Vec3(-1.25, 0, 0.5) + r * (bump * scale * Vec3(s.x(), s.y(), 0.5 * 1.022378509 * s.z() * (0.207 + 2.003 * q - 1.123 * q * q)));
  };
  const Eigen::Matrix3d other = turn(66 + d.rotation, {0, 1, 0}), label = turn(d.label, {0, 0, 1});
  const auto prolate = [&](const Vec3& s) -> Vec3 {
    return Vec3(1.25, 0, -0.5) + other * Vec3(0.82 * s.x(), 0.82 * s.y(), 1.5 * (1 + d.stretch) * s.z());
  };
  return surfaces::state_of({surfaces::vesicle(disc, [](const Vec3& s) { return s; }, 24),
                             surfaces::vesicle(prolate, [&](const Vec3& s) -> Vec3 { return label * s; })});
}

render::Image picture(const Defect& d, int width, int height) {
  const support::TemporaryFolder shaders;
  if (d.light != 0) {
    std::filesystem::copy(TANKTREAD_SHADERS, shaders / "s");
    std::string text = support::read_file(shaders / "s/light.glsl");
    const std::string key = "float key = ";
    const std::size_t at = text.find(key);
    REQUIRE(at != std::string::npos);
    const std::size_t from = at + key.size(), to = text.find(" *", from);
    text.replace(from, to - from, std::to_string(std::stod(text.substr(from, to - from)) * (1 + d.light)));
    support::write_file(shaders / "s/light.glsl", text);
  }
  render::Renderer renderer(render::parse_gl_choice("software"), d.light != 0 ? shaders / "s" : std::filesystem::path());
  render::ViewParameters view;
  view.size = {width, height};
  view.time_stamp = view.caption = view.scale_bar = false;
  view.line_width += d.line_width * 1080 / height;  // pixels at a height of 1080
  // Framed by the pair as it should be, or a defect would move the camera, too.
  render::Frame frame = surfaces::frame_of(pair(d), view);
  frame.camera = surfaces::frame_of(pair({}), view).camera;
  return render::draw_frame(renderer, frame);
}

const Defect defects[] = {
    {.name = "one vesicle turned by 0.02 degrees", .caught_small = true, .rotation = 0.02},
    {.name = "one vesicle stretched by 0.02 %", .caught_small = true, .stretch = 2e-4},
    {.name = "its labels turned by 0.02 degrees", .caught_small = true, .label = 0.02},
    {.name = "a bump of 1 %", .caught_small = true, .bump = 0.01},
    {.name = "lines 0.1 pixels wider", .caught_small = false, .line_width = 0.1},  // there they have their least width
    {.name = "key light 1 % stronger", .caught_small = true, .light = 0.01},
};

}  // namespace

TEST_CASE("the rule catches small defects in a frame of 960 x 540 and in pictures of our goldens' size") {
  std::ofstream table;
  if (const char* path = std::getenv("TANKTREAD_TABLE")) table.open(path);
  for (const auto& [width, height] : {std::pair{960, 540}, {320, 240}, {160, 120}}) {
    const render::Image good = picture({}, width, height);
    const render::ImageDifference again = render::difference(good, picture({}, width, height));
    CHECK(again.maximum == 0);
    for (const Defect& defect : defects) {
      const render::Image bad = picture(defect, width, height);
      render::CompareRule rule;
      rule.flip_mean = rule.flip_max = 1;
      const render::ImageDifference d = render::difference(good, bad, rule);
      const bool caught = !render::objections(d).empty();
      INFO(width << " x " << height << ", " << defect.name << ": largest " << d.maximum << ", above 2: " << d.above << ", rmse "
                 << d.rmse);
      if (width == 960) CHECK(caught);
      if (width == 320 && defect.caught_small) CHECK(caught);
      table << "| " << defect.name << " | " << width << " × " << height << " | " << d.maximum << " | " << d.above << " | "
            << d.rmse << " | " << *d.flip_mean << " / " << *d.flip_max << " | " << (caught ? "caught" : "missed") << " |\n";
    }
  }
}
