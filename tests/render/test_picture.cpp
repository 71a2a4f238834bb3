// What is drawn of membranes, measured against geometry.
#include "render/core/paint.h"
#include "render/core/style.h"
#include "render/draw/draw.h"

#include "surfaces.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

#include <numbers>
#include <set>

using render::Image;
using sim::Vec3;
using surfaces::turn;

namespace {

bool drawn(const std::uint8_t* p) { return p[0] != 255 || p[1] != 255 || p[2] != 255; }

struct Silhouette {
  double area = 0;      // length^2
  double x = 0, y = 0;  // centroid, px
};

Silhouette silhouette(const Image& image, const render::Camera& camera) {
  Silhouette s;
  double count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (drawn(image.at(x, y))) {
        count += 1;
        s.x += x + 0.5;
        s.y += y + 0.5;
      }
  const double pixel = 2 * camera.half_width / image.width;
  s.area = count * pixel * pixel;
  s.x /= count;
  s.y /= count;
  return s;
}

double brightness(const std::uint8_t* p) { return (p[0] + p[1] + p[2]) / 765.0; }

/// Mean brightness of image / reference over pixels between two distances from a place.
double relative_brightness(const Image& image, const Image& reference, double cx, double cy, double from, double to) {
  double a = 0, b = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double r = std::hypot(x + 0.5 - cx, y + 0.5 - cy);
      if (r < from || r >= to) continue;
      a += brightness(image.at(x, y));
      b += brightness(reference.at(x, y));
    }
  return a / b;
}

render::Renderer software() { return render::Renderer(render::parse_gl_choice("software")); }

}  // namespace

TEST_CASE("the silhouette of a sphere has the area of its disc and its centre in the middle") {
  render::Renderer renderer = software();
  const render::Frame frame =
      surfaces::frame_of(surfaces::state_of({surfaces::sphere({3, -2, 1}, 1.7)}), surfaces::bare_view());
  const Silhouette s = silhouette(render::draw_frame(renderer, frame), frame.camera);
  CHECK(s.area == Approx(std::numbers::pi * 1.7 * 1.7).epsilon(1.5e-3));
  CHECK(s.x == Approx(240).margin(0.25));
  CHECK(s.y == Approx(240).margin(0.25));
}

TEST_CASE("the silhouette of an ellipsoid has the area of its projection") {
  render::Renderer renderer = software();
  const Vec3 a(1.5, 0.9, 0.6);
  for (const render::CameraRow& row : render::cameras()) {
    INFO(row.name);
    const Eigen::Matrix3d r = turn(37, {1, 2, -1});
    render::ViewParameters view = surfaces::bare_view();
    view.camera = row.name;
    const render::Frame frame = surfaces::frame_of(surfaces::state_of({surfaces::ellipsoid(a, r)}), view);
    const Vec3 d = r.transpose() * render::to_sim(row.axes.back);  // line of sight in the ellipsoid's axes
    const double exact =
        std::numbers::pi * Vec3(a.y() * a.z() * d.x(), a.x() * a.z() * d.y(), a.x() * a.y() * d.z()).norm();
    CHECK(silhouette(render::draw_frame(renderer, frame), frame.camera).area == Approx(exact).epsilon(2e-3));
  }
}

TEST_CASE("along a parallel of a sphere the meridians lie where they must") {
  render::Renderer renderer = software();
  render::ViewParameters view = surfaces::bare_view(960, 960);
  const render::Frame plain = surfaces::frame_of(surfaces::state_of({surfaces::sphere()}), view);
  render::Frame lined = plain;
  lined.view.style = "opaque";
  const Image a = render::draw_frame(renderer, plain), b = render::draw_frame(renderer, lined);
  const double px = 480 / plain.camera.half_width, z = 0.13;  // 7.5 degrees above the equator: between two parallels
  const int row = static_cast<int>(480 - z * px);
  std::vector<double> places;
  for (int x = 0; x < 960;) {
    double weight = 0, sum = 0;
    for (; x < 960 && brightness(a.at(x, row)) - brightness(b.at(x, row)) > 0.04; ++x) {
      const double dark = brightness(a.at(x, row)) - brightness(b.at(x, row));
      weight += dark;
      sum += dark * (x + 0.5);
    }
    if (weight > 0)
      places.push_back(sum / weight);
    else
      ++x;
  }
  REQUIRE(places.size() == 11);  // 24 meridians: every 15 degrees from -75 to 75, the ones at +-90 lie on the contour
  for (int k = -5; k <= 5; ++k) {
    const double exact = 480 + px * std::sqrt(1 - z * z) * std::sin(k * std::numbers::pi / 12);
    CHECK(places[static_cast<std::size_t>(k + 5)] == Approx(exact).margin(1.0));
  }
}

TEST_CASE("lines do not clot at a pole") {
  render::Renderer renderer = software();
  render::ViewParameters view = surfaces::bare_view(600, 600);
  view.camera = "flow-vorticity";  // looks onto the pole theta = 0
  view.supersampling = 2;
  for (const double stretch : {0.3, 1.0, 2.0}) {
    const render::Frame plain =
        surfaces::frame_of(surfaces::state_of({surfaces::ellipsoid({1, 1, stretch}, turn(0, {0, 0, 1}))}), view);
    render::Frame lined = plain;
    lined.view.style = "opaque";
    const Image a = render::draw_frame(renderer, plain), b = render::draw_frame(renderer, lined);
    INFO("stretch " << stretch);
    const double near = relative_brightness(b, a, 300, 300, 0, 12), ring = relative_brightness(b, a, 300, 300, 12, 40),
                 body = relative_brightness(b, a, 300, 300, 40, 200);
    CHECK(near > 0.72);  // the dot itself and four lines
    CHECK(ring > 0.90);
    CHECK(body > 0.90);
    CHECK(body < 0.985);  // there are lines
  }
}

TEST_CASE("lines belong to the material: another parametrisation draws the same picture without a seam") {
  render::Renderer renderer = software();
  render::ViewParameters view = surfaces::bare_view(400, 400);
  view.style = "opaque";
  view.supersampling = 2;
  const Vec3 axes(1.3, 0.8, 0.9);
  const render::Camera camera =
      surfaces::frame_of(surfaces::state_of({surfaces::ellipsoid(axes, turn(0, {0, 0, 1}))}), view).camera;
  const auto picture = [&](const Eigen::Matrix3d& r) {
    // the same points with the same labels, reached by parameters that are turned by r
    render::Frame frame = surfaces::frame_of(
        surfaces::state_of({surfaces::vesicle([&](const Vec3& s) -> Vec3 { return axes.cwiseProduct(r * s); },
                                              [&](const Vec3& s) -> Vec3 { return r * s; })}),
        view);
    frame.camera = camera;
    return render::draw_frame(renderer, frame);
  };
  const Image front = picture(turn(-90, {0, 0, 1}));  // the mesh's first column faces the viewer
  for (const Eigen::Matrix3d& r : {turn(20, {0, 0, 1}), turn(90, {1, 0, 0}), turn(63, {1, -2, 3})}) {
    const render::ImageDifference d = render::difference(front, picture(r));
    INFO("max " << d.maximum << " above two " << d.above << " rmse " << d.rmse);
    CHECK(d.rmse < 1.2);  // contours are polygons of other points: a few pixels there
    CHECK(d.above < 0.012 * 400 * 400);
  }
  view.lines = "grid";
  CHECK(render::difference(front, picture(turn(63, {1, -2, 3}))).rmse > 5);
}

TEST_CASE("the nearer vesicle hides the farther one") {
  render::Renderer renderer = software();
  const auto count_blue = [&](double y) {
    const render::Frame frame = surfaces::frame_of(
        surfaces::state_of({surfaces::sphere(), surfaces::sphere({0, y, 0}, 0.5)}), surfaces::bare_view(200, 200));
    const Image image = render::draw_frame(renderer, frame);
    int blue = 0;
    for (int yy = 0; yy < 200; ++yy)
      for (int x = 0; x < 200; ++x) blue += image.at(x, yy)[2] > image.at(x, yy)[0] + 10;
    return blue;
  };
  CHECK(count_blue(3) == 0);  // behind, seen from -y
  CHECK(count_blue(-3) > 1000);
}

TEST_CASE("tracer dots are round on a sphere, in the two colours, and only on the side that is seen") {
  render::Renderer renderer = software();
  render::ViewParameters view = surfaces::bare_view(600, 600);
  view.tracers = true;
  const render::Frame frame = surfaces::frame_of(surfaces::state_of({surfaces::sphere()}), view);
  render::Frame without = frame;
  without.view.tracers = false;
  const Image a = render::draw_frame(renderer, frame), b = render::draw_frame(renderer, without);
  const double px = 300 / frame.camera.half_width;
  double count = 0, cx = 0, cz = 0, xx = 0, zz = 0;
  for (int y = 0; y < 600; ++y)
    for (int x = 0; x < 600; ++x) {
      const double dx = (x + 0.5 - 300) / px, dz = (300 - y - 0.5) / px;
      if (std::hypot(dx, dz) > 0.2) continue;  // the dot at -y, which faces the viewer
      const std::uint8_t *p = a.at(x, y), *q = b.at(x, y);
      if (std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]) < 30) continue;
      count += 1;
      cx += dx;
      cz += dz;
      xx += dx * dx;
      zz += dz * dz;
    }
  const double radius = 0.62 * 0.088;  // of a dark dot
  CHECK(count / (px * px) == Approx(std::numbers::pi * radius * radius).epsilon(0.06));
  CHECK(cx / count == Approx(0).margin(2e-3));
  CHECK(cz / count == Approx(0).margin(2e-3));
  CHECK(xx / zz == Approx(1).epsilon(0.02));
  CHECK(a.at(300, 300)[2] > a.at(300, 300)[0]);  // -y: x + y + z < 0, the dark blue one
  for (int k = 0; k < 14; ++k) {
    const Vec3 s = surfaces::dots().row(k);
    CHECK(render::tracer_is_bright(k) == (s.sum() > 0));
  }
}

TEST_CASE("supersampling changes contours, not areas of even colour") {
  render::Renderer renderer = software();
  render::Frame frame = surfaces::frame_of(surfaces::state_of({surfaces::sphere()}), surfaces::bare_view(200, 200));
  const Image one = render::draw_frame(renderer, frame);
  frame.view.supersampling = 3;
  const Image three = render::draw_frame(renderer, frame);
  for (int y = 70; y < 130; ++y)
    for (int x = 70; x < 130; ++x) CHECK(std::abs(one.at(x, y)[0] - three.at(x, y)[0]) <= 2);
}

TEST_CASE("the contour of a sphere is a line of the width asked for, and its edges are shaded") {
  render::Renderer renderer = software();
  render::ViewParameters view = surfaces::bare_view(540, 540);
  view.style = "outline";
  view.line_width = 0;
  view.supersampling = 2;
  view.outline_width = 8;  // at 1080: 4 px here
  const render::Frame frame = surfaces::frame_of(surfaces::state_of({surfaces::sphere()}), view);
  const Image image = render::draw_frame(renderer, frame);
  double darkest = 1, ink = 0;
  std::set<int> shades;
  const auto light = [](int s) { return std::pow((s / 255.0 + 0.055) / 1.055, 2.4); };
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 540; ++x) {
      darkest = std::min(darkest, light(image.at(x, y)[0]));
      ink += 1 - light(image.at(x, y)[0]);
      shades.insert(image.at(x, y)[0]);
    }
  const double px = 270 / frame.camera.half_width, width = ink / (1 - darkest) / (2 * std::numbers::pi * px);
  CHECK(width > 3.9);
  CHECK(width < 5.0);          // on the inside a sample more, where it fades
  CHECK(shades.size() > 20U);  // white, dark, and three between come from 2 x 2 samples alone
}

TEST_CASE("ghosts of full opacity are the opaque picture: triangles are drawn in the order of depth") {
  render::Renderer renderer = software();
  // Overlapping in depth, biconcave, and two membranes that nearly touch, seen obliquely.
  const std::vector<sim::State> states{
      surfaces::state_of({surfaces::disc(turn(-35, {0, 1, 0}) * turn(50, {1, 0, 0}), {-0.5, 0.8, 0.2}),
                          surfaces::ellipsoid({0.82, 0.82, 1.5}, turn(66, {0, 1, 0}), {0.4, -0.9, 0})}),
      surfaces::state_of({surfaces::sphere({-0.505, -0.85, 0}), surfaces::sphere({0.505, 0.878, 0})})};
  for (const sim::State& state : states) {
    render::ViewParameters view = surfaces::bare_view(640, 480);
    view.projection = "perspective";
    view.camera = "three-quarter";
    view.style = "opaque";
    const Image solid = render::draw_frame(renderer, surfaces::frame_of(state, view));
    view.style = "ghost";
    view.opacity = 1;
    const Image ghost = render::draw_frame(renderer, surfaces::frame_of(state, view));
    int wrong = 0, covered = 0;
    for (std::size_t k = 0; k < solid.pixels.size(); k += 3) {
      covered += solid.pixels[k] != 255 || solid.pixels[k + 1] != 255 || solid.pixels[k + 2] != 255;
      bool differs = false;
      for (std::size_t c = k; c < k + 3; ++c) differs = differs || std::abs(solid.pixels[c] - ghost.pixels[c]) > 2;
      wrong += differs;
    }
    INFO(wrong << " of " << covered);
    CHECK(covered > 30000);
    CHECK(wrong < covered / 1000);  // single pixels where two triangles of one rim share a depth
  }
}

TEST_CASE("a cut shows the inside, its rim lies on the plane, and nothing of the near half is left") {
  render::Renderer renderer = software();
  render::ViewParameters view = surfaces::bare_view(480, 480);
  view.style = "cutaway";
  view.outline_width = 2;
  const sim::State state = surfaces::state_of({surfaces::sphere()});
  const render::Frame frame = surfaces::painted(surfaces::frame_of(state, view), state);
  REQUIRE(frame.bodies[0].cut->edges.size() == 1);
  for (const glm::dvec3& p : frame.bodies[0].cut->edges[0]) {
    CHECK(p.y == Approx(0).margin(1e-9));
    CHECK(glm::length(p) == Approx(1).margin(1e-9));
  }
  const Image cut = render::draw_frame(renderer, frame);
  const double px = 240 / frame.camera.half_width;
  // The bowl is seen from inside: light from above falls on its lower part.
  const auto at = [&](double x, double z) {
    return brightness(cut.at(static_cast<int>(240 + x * px), static_cast<int>(240 - z * px)));
  };
  CHECK(at(0, -0.6) > at(0, 0.6) + 0.05);
  const Silhouette s = silhouette(cut, frame.camera);
  CHECK(std::sqrt(s.area / std::numbers::pi) * px == Approx(px + 4).margin(2.5));  // a disc, and half the rim's width
  // Seen along the plane, the far half stands alone.
  render::Frame aside = frame;
  aside.view.camera = "gradient-vorticity";
  const render::StateSummary summary = render::summarize(state);
  aside.camera = render::make_camera(render::frame_trajectory(std::span(&summary, 1), aside.view), summary.centroid);
  CHECK(silhouette(render::draw_frame(renderer, aside), aside.camera).area ==
        Approx(std::numbers::pi / 2).epsilon(0.05));
}

TEST_CASE("arrows along the line of sight are rings of their own size: with a dot towards the viewer, a cross away") {
  render::Renderer renderer = software();
  render::ViewParameters view = surfaces::bare_view(600, 300);
  view.supersampling = 2;
  view.flow_arrows = true;
  const sim::State state = surfaces::state_of({surfaces::sphere()});
  render::Frame frame = surfaces::frame_of(state, view);
  frame.bodies.clear();
  const double half = frame.camera.half_height, px = 150 / half;
  // The eye is at y < 0. The second arrow has half the speed of the first.
  frame.arrows.points = sim::Matrix{{-0.8 * half, 0, 0}, {0.8 * half, 0, 0}};
  frame.arrows.velocities = sim::Matrix{{0, -1, 0}, {0, 0.5, 0}};
  const Image image = render::draw_frame(renderer, frame);
  const Image ground = [&] {
    render::Frame empty = frame;
    empty.view.flow_arrows = false;
    return render::draw_frame(renderer, empty);
  }();
  // Shares of the radius, right and up, in the four quarters.
  const auto inked = [&](double middle, double radius, double right, double up) {
    int count = 0;
    for (const double sx : {-1.0, 1.0})
      for (const double sy : {-1.0, 1.0}) {
        const int x = static_cast<int>(std::floor(300 + middle * px + sx * right * radius * px)),
                  y = static_cast<int>(std::floor(150 - sy * up * radius * px));
        count += brightness(image.at(x, y)) < brightness(ground.at(x, y)) - 0.1;
      }
    return count;
  };
  // The header of draw.h: a ring of 0.16 of the arrow's length.
  const double first = 0.16 * render::longest_arrow * half, second = first / 2;
  const double diagonal = 1 / std::numbers::sqrt2;
  for (const auto& [middle, radius] : {std::pair{-0.8 * half, first}, std::pair{0.8 * half, second}}) {
    CHECK(inked(middle, radius, diagonal, diagonal) == 4);
    CHECK(inked(middle, radius, 1.5, 0) == 0);  // nothing of an arrow seen from its tip
    CHECK(inked(middle, radius, 1.2, 1.2) == 0);
    CHECK(inked(middle, radius, 0.05, 0.05) == 4);  // the dot, or where the arms meet
  }
  CHECK(inked(-0.8 * half, first, 0.6 * diagonal, 0.6 * diagonal) == 0);  // between dot and ring
  CHECK(inked(0.8 * half, second, 0.6 * diagonal, 0.6 * diagonal) == 4);  // on the arms of the cross
  CHECK(inked(0.8 * half, second, 0.6, 0) == 0);                          // between them
}

TEST_CASE("every style of the catalogue draws its own picture") {
  render::Renderer renderer = software();
  std::vector<Image> pictures;
  for (const render::StyleRow& row : render::styles()) {
    render::ViewParameters view = surfaces::bare_view(200, 150);
    view.style = row.name;
    view.outline_width = 2.2;
    const sim::State state = surfaces::state_of({surfaces::disc(turn(60, {1, 0, 0}))});
    pictures.push_back(render::draw_frame(renderer, surfaces::painted(surfaces::frame_of(state, view), state)));
    for (std::size_t k = 0; k + 1 < pictures.size(); ++k)
      CHECK(render::difference(pictures[k], pictures.back()).rmse > 1);
  }
  CHECK_THAT(support::message_of([] { render::find_style("opaqe"); }), Catch::Contains("did you mean 'opaque'"));
}
