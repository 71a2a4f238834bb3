// The outline lies on the membrane: between the two there is no ground, whatever their sizes.
#include "render/draw/depth_order.h"
#include "render/draw/draw.h"

#include "surfaces.h"

#include "tests/support/catch.h"

#include <cmath>

using sim::Vec3;
using surfaces::turn;

namespace {

/// Distance of a point from an ellipse about the origin, below 0 inside: from its support function, h(u) = max over the
/// ellipse of x . u, whose square is u^T m u.
double beyond(const Eigen::Matrix2d& m, const Eigen::Vector2d& x) {
  double most = -1e300;
  constexpr int directions = 240;  // finds the largest to 1e-4
  for (int k = 0; k < directions; ++k) {
    const double angle = 2 * std::acos(-1.0) * k / directions;
    const Eigen::Vector2d u(std::cos(angle), std::sin(angle));
    most = std::max(most, x.dot(u) - std::sqrt(u.dot(m * u)));
  }
  return most;
}

}  // namespace

TEST_CASE("no ground is seen within the outline's width of an ellipsoid") {
  render::Renderer renderer(render::parse_gl_choice("software"));
  const Eigen::Matrix3d oblique = turn(33, {0, 1, 0}) * turn(40, {1, 0, 0.3});
  for (const Vec3& axes : {Vec3(1, 1, 1), Vec3(0.6, 0.6, 2), Vec3(1.3, 1.3, 0.12), Vec3(0.25, 1.5, 1)})
    for (const double zoom : {1.0, 0.2, 0.05})  // bodies 170, 35 and 9 px long
      for (const double px : {1.0, 2.2, 8.0, 20.0}) {
        render::ViewParameters view = surfaces::bare_view(240, 240);
        view.supersampling = 2;
        view.detail = "full";  // as wide as asked for, however small the body
        view.zoom = zoom;
        view.outline_width = 1080.0 / 240 * px / 2;  // px / 2 of this picture
        const render::Frame frame = surfaces::frame_of(surfaces::state_of({surfaces::ellipsoid(axes, oblique)}), view);
        const render::Image image = render::draw_frame(renderer, frame);
        // Seen along y, x to the right and z up: the shadow of the ellipsoid is the ellipse of the matrix R A^2 R^T
        // without y.
        const double unit = 120 / frame.camera.half_height;
        const Eigen::Matrix3d full = oblique * axes.cwiseAbs2().asDiagonal() * oblique.transpose();
        Eigen::Matrix2d m;
        m << full(0, 0), full(0, 2), full(2, 0), full(2, 2);
        m *= unit * unit;
        int ground = 0;
        for (int y = 0; y < 240; ++y)
          for (int x = 0; x < 240; ++x) {
            // Whole pixels only: their corners are 0.71 px from the middle; the mesh stays 0.1 px inside of the
            // surface.
            if (beyond(m, {x + 0.5 - 120, 120 - y - 0.5}) > px / 2 - 0.85) continue;
            const std::uint8_t* p = image.at(x, y);
            ground += p[0] > 245 && p[1] > 245 && p[2] > 245;
          }
        INFO("axes " << axes.transpose() << ", zoom " << zoom << ", outline " << px / 2 << " px");
        CHECK(ground == 0);
      }
}

TEST_CASE("an outline of the usual width needs few triangles more than those at the contour") {
  const render::Frame frame = surfaces::frame_of(surfaces::state_of({surfaces::sphere()}), surfaces::bare_view());
  const render::Mesh& mesh = frame.bodies[0].mesh;
  const std::size_t all = mesh.plan->indices().size();
  CHECK(render::rim_triangles(mesh, frame.camera, 0.01).size() <
        2 * all / 5);                                                     // 5 px of 1080; the net is dense at its poles
  CHECK(render::rim_triangles(mesh, frame.camera, 2).size() >= all / 2);  // wider than the body: all back faces
}

TEST_CASE("the distance from the contour is that of a sphere's points from its edge, and large beyond the reach") {
  const render::Frame frame = surfaces::frame_of(surfaces::state_of({surfaces::sphere()}), surfaces::bare_view());
  const render::Mesh& mesh = frame.bodies[0].mesh;
  const double unit = 240, radius = unit / frame.camera.half_height, reach = 20;
  const std::vector<float> distance = render::contour_distances(mesh, frame.camera, unit, reach);
  for (std::size_t k = 0; k < distance.size(); ++k) {
    const glm::dvec2 place = frame.camera.picture_place(mesh.position[k]) * unit;
    const double expected = radius - glm::length(place);
    // To a sample: the contour is a polygon, whose pieces are handed on from vertex to vertex.
    if (expected < reach - 1)
      CHECK(static_cast<double>(distance[k]) == Approx(expected).margin(1));
    else
      CHECK(static_cast<double>(distance[k]) >= reach - 1);
  }
}

TEST_CASE("a membrane that is nearly edge-on without turning over is not blackened") {
  // A deep bowl seen from above: its wall is steep, and nowhere vertical but at the edge.
  const auto bowl = [](const Vec3& s) -> Vec3 {
    const double q = s.x() * s.x() + s.y() * s.y();
    return {s.x(), -3.0 * (1 - q) * (1 - q) + 0.4 * s.z(), s.y()};
  };
  render::ViewParameters view = surfaces::bare_view(240, 240);
  view.supersampling = 2;
  view.style = "ghost";
  view.line_width = 0;
  view.outline_width = 1080.0 / 240 * 2;
  render::Renderer renderer(render::parse_gl_choice("software"));
  const render::Frame frame = surfaces::frame_of(surfaces::state_of({surfaces::vesicle(
                                                     bowl, [](const Vec3& s) { return s; }, 8)}),
                                                 view);
  const render::Image image = render::draw_frame(renderer, frame);
  const double radius = 120 / frame.camera.half_height;
  int inner = 0, black = 0;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 240; ++x) {
      if (std::hypot(x + 0.5 - 120, y + 0.5 - 120) > radius - 8) continue;
      ++inner;
      black += image.at(x, y)[0] < 90;
    }
  CHECK(inner > 5000);
  CHECK(black == 0);
}
