// Pictures know no unit of length and no place: the same scene in metres, in micrometres or far from the origin looks
// the same.
#include "render/draw/draw.h"
#include "render/scene/arrow_net.h"

#include "surfaces.h"

#include "tests/support/catch.h"

#include <algorithm>

using sim::Vec3;
using surfaces::turn;

namespace {

/// A disc and a prolate with arrows of a shear flow, all times `unit`, then moved by `shift`.
render::Frame frame_in(double unit, const Vec3& shift, const std::string& style, const std::string& projection) {
  const auto moved = [&](const surfaces::Map& shape) {
    return surfaces::vesicle([=](const Vec3& s) -> Vec3 { return shift + unit * shape(s); });
  };
  const Eigen::Matrix3d tilted = turn(-35, {0, 1, 0}) * turn(23, {1, 0, 0}), lying = turn(66, {0, 1, 0});
  const sim::State state = surfaces::state_of(
      {moved([=](const Vec3& s) -> Vec3 {
         const double q = s.x() * s.x() + s.y() * s.y();
         return Vec3(-1.25, 0, 0.5) +
                tilted * (1.19 * Vec3(s.x(), s.y(), 0.51 * s.z() * (0.207 + 2.003 * q - 1.123 * q * q)));
       }),
       moved([=](const Vec3& s) -> Vec3 {
         return Vec3(1.25, 0, -0.5) + lying * Vec3(0.82, 0.82, 1.5).cwiseProduct(s);
       })});
  render::ViewParameters view;
  view.size = {240, 180};
  view.style = style;
  view.projection = projection;
  view.time_stamp = view.caption = false;
  render::Frame frame = surfaces::frame_of(state, view);
  const render::StateSummary summary = render::summarize(state);
  frame.captions.scale_length = unit;
  frame.arrows.points =
      render::arrow_points(render::frame_trajectory(std::span(&summary, 1), frame.view), summary.centroid);
  frame.arrows.velocities = sim::Matrix::Zero(frame.arrows.points.rows(), 3);
  frame.arrows.velocities.col(0) = frame.arrows.points.col(2).array() - shift.z();
  for (std::size_t v = 0; v < frame.bodies.size(); ++v) {
    for (const glm::dvec3& p : frame.bodies[v].mesh.position)
      frame.bodies[v].mesh.scalar.push_back((p.z - shift.z()) / unit);
    frame.bodies[v].cut = render::make_cut(state.vesicles[v].position, -Vec3::UnitY(), 0);
  }
  frame.legend =
      render::Legend{"z", -1, 1, render::colour_table(render::find_colour_map("viridis")), false, false, false};
  frame.view.colour_bar = false;
  return frame;
}

/// Pixels whose worst channel differs by more than `allowed`.
int different(const render::Image& a, const render::Image& b, int allowed) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  int count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); i += 3) {
    int worst = 0;
    for (std::size_t c = i; c < i + 3; ++c) worst = std::max(worst, std::abs(a.pixels[c] - b.pixels[c]));
    count += worst > allowed;
  }
  return count;
}

}  // namespace

TEST_CASE("a scene in any unit of length gives the picture of the same scene in radii") {
  render::Renderer renderer(render::parse_gl_choice("software"));
  for (const char* style : {"opaque", "ghost", "field", "cutaway", "checker"})
    for (const char* projection : {"perspective", "orthographic"}) {
      const render::Image radii = render::draw_frame(renderer, frame_in(1, Vec3::Zero(), style, projection));
      // A factor of two changes no digit, and no pixel.
      for (const double unit : {std::exp2(40)})
        CHECK(render::draw_frame(renderer, frame_in(unit, Vec3::Zero(), style, projection)) == radii);
      // Others round the last digit of coordinates anew: a sample at an edge may fall to its other side, a quarter of a
      // pixel.
      for (const double unit : {1e-12, 2.8e-6, 1e6}) {
        INFO(style << ", " << projection << ", radius " << unit);
        CHECK(different(radii, render::draw_frame(renderer, frame_in(unit, Vec3::Zero(), style, projection)), 2) <= 10);
      }
    }
}

TEST_CASE("a scene far from the origin gives the picture of the same scene at the origin") {
  render::Renderer renderer(render::parse_gl_choice("software"));
  for (const char* style : {"opaque", "ghost", "field", "cutaway"})
    for (const double unit : {1.0, 2.8e-6}) {
      const render::Image here = render::draw_frame(renderer, frame_in(unit, Vec3::Zero(), style, "perspective"));
      for (const double distance : {1e5, 1e8}) {
        INFO(style << ", " << distance << " radii of " << unit);
        const Vec3 shift = distance * unit * Vec3(1, -1, 1);
        // At 1e8 radii the positions themselves have eight digits, 1e-6 of a pixel.
        CHECK(different(here, render::draw_frame(renderer, frame_in(unit, shift, style, "perspective")), 2) <= 10);
      }
    }
}
