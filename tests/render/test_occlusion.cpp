// How much of the sky other parts of a membrane and other vesicles hide.
#include "render/scene/occlusion.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <algorithm>

using surfaces::Vec3;

namespace {

render::Mesh shaded(const sim::State& state, std::size_t self, double radius = 200) {
  std::vector<render::Sketch> sketches;
  std::vector<render::Occluder> occluders;
  for (const sim::VesicleState& v : state.vesicles) sketches.push_back(render::sketch_of(v));
  for (const render::Sketch& s : sketches) occluders.push_back(render::occluder_of(s));
  render::Mesh mesh = render::make_mesh(std::make_shared<const render::MeshPlan>(24, 48), state.vesicles[self]);
  const render::Camera camera = surfaces::frame_of(state, surfaces::bare_view()).camera;
  render::shade(mesh, self, sketches, occluders, camera, radius);
  return mesh;
}

}  // namespace

TEST_CASE("nothing hides the sky from a convex vesicle that is alone") {
  for (const Vec3& axes : {Vec3(1, 1, 1), Vec3(0.5, 0.7, 1.6)})
    for (const double radius : {20.0, 200.0})
      for (const glm::vec2& light :
           shaded(surfaces::state_of({surfaces::ellipsoid(axes, Eigen::Matrix3d::Identity())}), 0, radius).light) {
        CHECK(light.x == 1);
        CHECK(light.y == 1);
      }
}

TEST_CASE("a sphere hides its projected solid angle from a point of another") {
  // From straight below, (R / d)^2 of a sky weighted by the cosine, d the distance to the centre.
  for (const double distance : {2.4, 3.0})
    for (const double radius : {20.0, 200.0}) {
      const sim::State state = surfaces::state_of({surfaces::sphere(), surfaces::sphere({0, 0, distance}, 0.8)});
      const render::Mesh mesh = shaded(state, 0, radius);
      const float north = mesh.light[mesh.light.size() - 2].x, south = mesh.light.back().x;
      const double away = distance - 1, reach = 1.8 * 1.12;  // balls with their allowance
      const double share = 1 - glm::smoothstep(1.3 * reach, 2.2 * reach, distance);
      INFO(distance << ", " << radius);
      CHECK(static_cast<double>(north) ==
            Approx(1 - share * 0.64 / (away * away)).margin(radius < 80 ? 0.08 : 0.04));  // 66 or 264 discs
      CHECK(south == 1);
    }
}

TEST_CASE("a hollow is darker than the rim round it") {
  const render::Mesh mesh = shaded(surfaces::state_of({surfaces::disc(Eigen::Matrix3d::Identity())}), 0);
  const float hollow = mesh.light[mesh.light.size() - 2].x;  // the pole
  float rim = 0;
  for (const glm::vec2& light : mesh.light) rim = std::max(rim, light.x);
  CHECK(hollow < 0.93F);
  CHECK(rim > 0.99F);
}
