// What the rule for pictures notices: 29 small defects of two vesicles with their captions, in two sizes.
// TANKTREAD_PICTURES=FOLDER keeps the pictures; tests/studies/confusion.py makes the table of docs/ci.md of them.
#include "render/draw/draw.h"

#include "surfaces.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <functional>

using surfaces::turn;
using surfaces::Vec3;

namespace {

/// The pair of the goldens, with something a little wrong.
struct Defect {
  const char* name;
  double rotation = 0;                      ///< of the second vesicle, degrees
  double shift = 0;                         ///< of the second vesicle, radii
  double stretch = 0;                       ///< of the second vesicle along its axis, share
  double bump = 0;                          ///< of the first vesicle, share of its size
  double label = 0;                         ///< of the second vesicle's labels, degrees
  double light = 0;                         ///< share more
  void (*frame)(render::Frame&) = nullptr;  ///< what else is told to draw
  void (*paint)(render::Image&) = nullptr;  ///< what happens to the picture afterwards
  bool perceptual = false;  ///< somebody who flips between the two sees it: caught by the preset `perceptual`, too
};

sim::State pair(const Defect& d) {
  const Eigen::Matrix3d r = turn(-35, {0, 1, 0}) * turn(23, {1, 0, 0});
  const auto disc = [&](const Vec3& s) -> Vec3 {
    const double q = s.x() * s.x() + s.y() * s.y(), scale = 1.191602667;
    // A bump of 30 degrees across, where one looks at the disc.
    const Vec3 to = Vec3(0.3, -0.85, 0.4).normalized();
    const double bump = 1 + d.bump * std::exp(-(1 - s.dot(to)) / 0.034);
    return Vec3(-1.25, 0, 0.5) +
           r * (bump * scale * Vec3(s.x(), s.y(), 0.5 * 1.022378509 * s.z() * (0.207 + 2.003 * q - 1.123 * q * q)));
  };
  const Eigen::Matrix3d other = turn(66 + d.rotation, {0, 1, 0}), label = turn(d.label, {0, 0, 1});
  const auto prolate = [&](const Vec3& s) -> Vec3 {
    return Vec3(1.25 + d.shift, 0, -0.5) + other * Vec3(0.82 * s.x(), 0.82 * s.y(), 1.5 * (1 + d.stretch) * s.z());
  };
  return surfaces::state_of({surfaces::vesicle(
                                 disc, [](const Vec3& s) { return s; }, 24),
                             surfaces::vesicle(prolate, [&](const Vec3& s) -> Vec3 { return label * s; })});
}

/// Wide enough to be thinned at any size: at 360 pixels of height the default line has the least width that is drawn.
constexpr double line_width = 4;

/// Pixels of the finished picture, at a height of 1080.
double at_1080(const render::Frame& f, double pixels) { return pixels * 1080 / f.view.size[1]; }

/// Draws many of one size.
class Painter {
 public:
  Painter(int width, int height) : renderer_(gl()) {
    view_.size = {width, height};
    view_.title = true;
    view_.line_width = line_width;
    camera_ = surfaces::frame_of(pair({}), view_).camera;
    good_ = draw({}, renderer_);
  }
  const render::Image& good() const { return good_; }
  render::Image bad(const Defect& d) {
    render::Image image = good_;
    if (d.light != 0) {
      const support::TemporaryFolder shaders;
      light_otherwise(shaders / "s", d.light);
      render::Renderer renderer(gl(), shaders / "s");
      image = draw(d, renderer);
    } else if (!d.paint) {
      image = draw(d, renderer_);
    }
    if (d.paint) d.paint(image);
    return image;
  }

 private:
  static render::GlChoice gl() {
    const char* name = std::getenv("TANKTREAD_GL");
    return render::parse_gl_choice(name ? name : "software");
  }

  /// Shaders with another key light.
  static void light_otherwise(const std::filesystem::path& folder, double share) {
    std::filesystem::copy(TANKTREAD_SHADERS, folder);
    std::string text = support::read_file(folder / "light.glsl");
    const std::string key = "float key = ";
    const std::size_t at = text.find(key);
    REQUIRE(at != std::string::npos);
    const std::size_t from = at + key.size(), to = text.find(" *", from);
    text.replace(from, to - from, std::to_string(std::stod(text.substr(from, to - from)) * (1 + share)));
    support::write_file(folder / "light.glsl", text);
  }

  render::Image draw(const Defect& d, render::Renderer& renderer) const {
    render::Frame frame = surfaces::frame_of(pair(d), view_);
    // Framed by the pair as it should be, or a defect would move the camera, too.
    frame.camera = camera_;
    frame.captions.time = "γ̇t = 12.50";
    frame.captions.parameters = "Ca = 2.0   λ = 10   ν = 0.85";
    frame.captions.title = "A pair in shear flow";
    if (d.frame) d.frame(frame);
    return render::draw_frame(renderer, frame);
  }

  render::ViewParameters view_;
  render::Renderer renderer_;
  render::Camera camera_;
  render::Image good_;
};

/// Every sample becomes f(sample, x, y, channel), within 0 to 255.
template <class F>
void repaint(render::Image& image, F&& f) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        std::uint8_t& v = image.at(x, y)[c];
        v = static_cast<std::uint8_t>(
            std::clamp(static_cast<int>(std::lround(f(static_cast<double>(v), x, y, c))), 0, 255));
      }
}
/// The pixels of a rectangle, its corner at shares of the picture, change by so much towards the middle of the range.
void dot(render::Image& image, double left, double top, int width, int height, int by) {
  const int x0 = static_cast<int>(left * image.width), y0 = static_cast<int>(top * image.height);
  for (int y = y0; y < y0 + height; ++y)
    for (int x = x0; x < x0 + width; ++x)
      for (int c = 0; c < 3; ++c) {
        std::uint8_t& v = image.at(x, y)[c];
        v = static_cast<std::uint8_t>(v < 128 ? v + by : v - by);
      }
}
/// The picture moved to the right, the column on the left drawn twice.
void move_right(render::Image& image, int by) {
  const render::Image old = image;
  repaint(image, [&](double, int x, int y, int c) { return static_cast<double>(old.at(std::max(x - by, 0), y)[c]); });
}
/// What a lossy format of high quality leaves: some levels of noise in blocks of 8 x 8 pixels.
void lossy(render::Image& image) {
  repaint(image, [](double v, int x, int y, int c) { return v + ((x / 8 * 7 + y / 8 * 13 + x * y + c) % 5 - 2); });
}

using F = render::Frame;
using I = render::Image;

const Defect defects[] = {
    {.name = "one vesicle turned by 0.02 degrees", .rotation = 0.02},
    {.name = "one vesicle moved by 0.0005 radii", .shift = 5e-4},
    {.name = "one vesicle stretched by 0.02 %", .stretch = 2e-4},
    {.name = "a bump of 1 %", .bump = 0.01},
    {.name = "its labels turned by 0.02 degrees", .label = 0.02},
    {.name = "one vesicle missing", .frame = [](F& f) { f.bodies.pop_back(); }, .perceptual = true},
    {.name = "one vesicle in another colour",
     .frame = [](F& f) { f.bodies[1].colour = render::body_colour(2); },
     .perceptual = true},
    {.name = "lines 0.1 pixels wider", .frame = [](F& f) { f.view.line_width += at_1080(f, 0.1); }},
    {.name = "lines 0.1 pixels thinner", .frame = [](F& f) { f.view.line_width -= at_1080(f, 0.1); }},
    {.name = "lines 0.2 pixels thinner", .frame = [](F& f) { f.view.line_width -= at_1080(f, 0.2); }},
    {.name = "outlines missing", .frame = [](F& f) { f.view.outline_width = 0; }, .perceptual = true},
    {.name = "tracer dots missing", .frame = [](F& f) { f.view.tracers = false; }, .perceptual = true},
    {.name = "key light 1 % stronger", .light = 0.01},
    {.name = "the whole picture one level darker",
     .paint = [](I& i) { repaint(i, [](double v, int, int, int) { return v - 1; }); }},
    {.name = "red 1 % stronger",
     .paint = [](I& i) { repaint(i, [](double v, int, int, int c) { return c == 0 ? 1.01 * v : v; }); }},
    {.name = "a gamma of 1.02",
     .paint = [](I& i) { repaint(i, [](double v, int, int, int) { return 255 * std::pow(v / 255, 1.02); }); }},
    {.name = "the picture moved by one pixel", .paint = [](I& i) { move_right(i, 1); }, .perceptual = true},
    {.name = "a caption moved by one pixel",
     .frame = [](F& f) { f.captions.title = " " + f.captions.title; },
     .perceptual = true},
    {.name = "λ = 11 for λ = 10 in the caption",
     .frame = [](F& f) { f.captions.parameters = "Ca = 2.0   λ = 11   ν = 0.85"; },
     .perceptual = true},
    {.name = "12.51 for 12.50 in the time stamp",
     .frame = [](F& f) { f.captions.time = "γ̇t = 12.51"; },
     .perceptual = true},
    {.name = "a comma for a point in the caption",
     .frame = [](F& f) { f.captions.parameters = "Ca = 2,0   λ = 10   ν = 0.85"; },
     .perceptual = true},
    {.name = "a letter of the title missing",
     .frame = [](F& f) { f.captions.title = "A pair in shea flow"; },
     .perceptual = true},
    {.name = "a scale bar 1 % longer", .frame = [](F& f) { f.captions.scale_length *= 1.01; }},
    {.name = "one hot pixel", .paint = [](I& i) { dot(i, 0.7, 0.6, 1, 1, 120); }, .perceptual = true},
    {.name = "one pixel that differs by 60", .paint = [](I& i) { dot(i, 0.1, 0.4, 1, 1, 60); }},
    {.name = "a dot of 2 x 5 pixels that differ by 92",
     .paint = [](I& i) { dot(i, 0.12, 0.5, 2, 5, 92); },
     .perceptual = true},
    {.name = "a block of 8 x 8 pixels that differ by 4", .paint = [](I& i) { dot(i, 0.3, 0.7, 8, 8, 4); }},
    {.name = "a column of pixels that differ by 3", .paint = [](I& i) { dot(i, 0.5, 0, 1, i.height, 3); }},
    {.name = "the noise of a lossy format", .paint = lossy},
};
static_assert(std::size(defects) == 29);

render::CompareRule perceptual() {
  for (const render::ComparePreset& preset : render::compare_presets())
    if (preset.name == "perceptual") return preset.rule;
  throw std::logic_error("there is no preset 'perceptual'");
}

/// Folder of the pictures of one size, where they are wanted.
std::filesystem::path kept(int width, int height) {
  const char* folder = std::getenv("TANKTREAD_PICTURES");
  if (!folder) return {};
  const std::filesystem::path path =
      std::filesystem::path(folder) / (std::to_string(width) + "x" + std::to_string(height));
  std::filesystem::create_directories(path);
  return path;
}

void check_defects(int width, int height, bool painted_only) {
  Painter painter(width, height);
  const std::filesystem::path folder = kept(width, height);
  if (!folder.empty()) render::write_png(folder / "good.png", painter.good());
  CHECK(render::difference(painter.good(), painter.bad({})).maximum == 0);
  for (const Defect& defect : defects) {
    if (painted_only && !defect.paint && !defect.perceptual) continue;
    const render::Image bad = painter.bad(defect);
    if (!folder.empty()) render::write_png(folder / (std::string(defect.name) + ".png"), bad);
    const render::ImageDifference d = render::difference(painter.good(), bad);
    INFO(width << " x " << height << ", " << defect.name << ": largest " << d.maximum << ", above 2: " << d.above
               << ", rmse " << d.rmse);
    CHECK_FALSE(render::same_picture(d));
    if (!defect.perceptual) continue;
    const render::ImageDifference seen = render::difference(painter.good(), bad, perceptual());
    INFO("FLIP mean " << *seen.flip_mean << ", largest " << *seen.flip_max);
    CHECK_FALSE(render::same_picture(seen, perceptual()));
  }
}

}  // namespace

TEST_CASE("the default rule catches 29 small defects, 'perceptual' those that are seen") {
  check_defects(640, 360, false);
  check_defects(1920, 1080, true);
}

TEST_CASE("all defects at full size", "[.defects]") {
  check_defects(640, 360, false);
  check_defects(1920, 1080, false);
}

TEST_CASE("the picture without a defect as this environment draws it", "[.good]") {
  for (const auto& [width, height] : {std::pair{640, 360}, {1920, 1080}}) {
    Painter painter(width, height);
    const std::filesystem::path folder = kept(width, height);
    if (!folder.empty()) render::write_png(folder / "good.png", painter.good());
    CHECK(render::difference(painter.good(), painter.bad({})).maximum == 0);
  }
}
