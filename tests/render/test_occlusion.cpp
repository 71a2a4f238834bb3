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

TEST_CASE("what a neighbour hides depends on the place on the membrane, not on where its poles lie") {
  // Two spheres: by symmetry only the angle from the line of their centres counts. The first has its poles on that
  // line, and across it.
  const sim::VesicleState neighbour = surfaces::sphere({0, 0, 2.4}, 0.9);
  std::vector<double> known;
  for (const double degrees : {0.0, 90.0}) {
    const Eigen::Matrix3d turned = surfaces::turn(degrees, {1, 0, 0});
    const sim::VesicleState own = surfaces::vesicle([&](const Vec3& s) -> Vec3 { return turned * s; });
    const render::Mesh mesh = shaded(surfaces::state_of({own, neighbour}), 0);
    std::vector<double> means;
    for (const double cosine : {0.924, 0.707, 0.383, -0.259}) {  // of rings of the mesh
      double low = 1, high = 0, sum = 0;
      int count = 0;
      for (std::size_t k = 0; k < mesh.position.size(); ++k) {
        if (std::abs(mesh.position[k].z - cosine) > 0.04) continue;
        const double open = mesh.light[k].x;
        low = std::min(low, open);
        high = std::max(high, open);
        sum += open;
        ++count;
      }
      INFO(degrees << ", " << cosine << ": " << low << " to " << high);
      REQUIRE(count > 5);
      CHECK(high - low < 0.1);  // the band, and 264 discs
      means.push_back(sum / count);
    }
    CHECK(means[0] < means[1] - 0.02);
    CHECK(means[1] < means[2]);
    CHECK(means[3] > 0.995);
    if (known.empty()) known = means;
    for (std::size_t k = 0; k < means.size(); ++k) CHECK(means[k] == Approx(known[k]).margin(0.02));
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
