// Many vesicles: what is left out is not missed, and nothing changes by a jump.
#include "render/draw/draw.h"
#include "render/scene/detail.h"
#include "render/scene/hidden.h"

#include "surfaces.h"
#include "tests/support/catch.h"

#include <cmath>

using surfaces::Vec3;

namespace {

render::Renderer& renderer() {
  static render::Renderer one(render::parse_gl_choice("software"));
  return one;
}

std::vector<render::Sketch> sketches_of(const sim::State& state) {
  std::vector<render::Sketch> all;
  for (const sim::VesicleState& v : state.vesicles) all.push_back(render::sketch_of(v));
  return all;
}

render::ViewParameters crowd_view() {
  render::ViewParameters view = surfaces::bare_view(480, 360);
  view.projection = "perspective";
  view.supersampling = 2;
  view.outline_width = 2.2;
  return view;
}

}  // namespace

TEST_CASE("what is painted on a vesicle changes smoothly with its size, from nothing to all") {
  const render::ViewParameters view;
  const render::Detail small = render::detail_of(view, 3), large = render::detail_of(view, 300);
  CHECK(small.lines == 0);
  CHECK(small.few_lines == 0);
  CHECK(small.tracers == 0);
  CHECK(small.outline < 0.5F);
  CHECK(large.lines == 1);
  CHECK(large.tracers == 1);
  CHECK(large.outline == 1);
  render::Detail before = small;
  for (double radius = 3; radius < 300; radius *= 1.01) {  // a camera that nears by 1 % a frame
    const render::Detail now = render::detail_of(view, radius);
    for (const auto member :
         {&render::Detail::lines, &render::Detail::few_lines, &render::Detail::tracers, &render::Detail::outline}) {
      CHECK(now.*member >= before.*member);
      CHECK(now.*member - before.*member < 0.05F);
    }
    before = now;
  }
  render::ViewParameters full = view;
  full.detail = "full";
  CHECK(render::detail_of(full, 1).lines == 1);
}

TEST_CASE("the mesh of a vesicle leaves its outline by some 0.2 px at most") {
  const render::MeshLevels levels;
  for (const Vec3& axes : {Vec3(1, 1, 1), Vec3(0.6, 0.6, 2), Vec3(1.3, 1.3, 0.4)}) {
    const sim::VesicleState vesicle = surfaces::ellipsoid(axes, Eigen::Matrix3d::Identity());
    const render::Sketch sketch = render::sketch_of(vesicle);
    for (const double pixels : {2.0, 10.0, 40.0, 150.0}) {
      const auto plan = levels.choose(sketch, vesicle.position.order, pixels);
      const render::Mesh mesh = render::make_mesh(plan, vesicle);
      double worst = 0;  // how far the middle of an edge is inside of the ellipsoid, by its distance function's slope
      const std::span<const std::uint32_t> indices = plan->indices();
      for (std::size_t k = 0; k < indices.size(); k += 3) {
        const glm::dvec3 m = (mesh.position[indices[k]] + mesh.position[indices[k + 1]]) / 2.0;
        const glm::dvec3 a(axes.x(), axes.y(), axes.z());
        const double f = glm::length(m / a), slope = glm::length(m / (a * a)) / f;
        worst = std::max(worst, (1 - f) / slope);
      }
      INFO("axes " << axes.transpose() << ", " << pixels << " px, " << plan->latitudes() << " latitudes");
      CHECK(worst * pixels < 0.22);
    }
    CHECK(levels.choose(sketch, 8, 5)->indices().size() / 3 < 600);
    CHECK(levels.choose(sketch, 8, 1000) == levels.finest());
  }
}

TEST_CASE("a vesicle wholly behind another one changes no byte, and is found") {
  // Seen from -y: the small one is behind the middle of the large one, the third looks out beside it.
  const sim::State state = surfaces::state_of({surfaces::sphere({0, 0, 0}, 1), surfaces::sphere({0.3, 2, 0.2}, 0.5),
                                               surfaces::sphere({1.1, 2, 0}, 0.6), surfaces::sphere({-2.5, 1, 0}, 1)});
  const render::ViewParameters view = crowd_view();
  render::Frame frame = surfaces::frame_of(state, view);
  const std::vector<bool> hidden = render::hidden(sketches_of(state), frame.camera, view);
  CHECK(hidden == std::vector<bool>{false, true, false, false});
  const render::Image all = render::draw_frame(renderer(), frame);
  frame.vesicles = 4;
  frame.bodies.erase(frame.bodies.begin() + 1);
  CHECK(render::draw_frame(renderer(), frame) == all);
}

TEST_CASE("no vesicle of a random heap counts as hidden that is seen") {
  std::vector<sim::VesicleState> heap;
  unsigned seed = 7;
  const auto random = [&] { return ((seed = seed * 1664525 + 1013904223) >> 8) / 16777216.0 - 0.5; };
  for (int k = 0; k < 60; ++k)
    heap.push_back(surfaces::ellipsoid({0.5, 0.5, 0.8}, surfaces::turn(360 * random(), {random(), random(), 1}),
                                       {5 * random(), 16 * random(), 4 * random()}));
  const sim::State state = surfaces::state_of(heap);
  const render::ViewParameters view = crowd_view();
  render::Frame frame = surfaces::frame_of(state, view);
  const std::vector<bool> hidden = render::hidden(sketches_of(state), frame.camera, view);
  CHECK(std::count(hidden.begin(), hidden.end(), true) > 0);
  const render::Image all = render::draw_frame(renderer(), frame);
  frame.vesicles = heap.size();
  for (std::size_t k = heap.size(); k-- > 0;)
    if (hidden[k]) frame.bodies.erase(frame.bodies.begin() + static_cast<std::ptrdiff_t>(k));
  CHECK(render::draw_frame(renderer(), frame) == all);
}

TEST_CASE("a vesicle beside the picture is known to be outside, one that reaches into it is not") {
  const sim::State state = surfaces::state_of({surfaces::sphere()});
  for (const char* projection : {"perspective", "orthographic"}) {
    render::ViewParameters view = crowd_view();
    view.projection = projection;
    const render::Camera camera = surfaces::frame_of(state, view).camera;
    const double edge = camera.half_width;
    const auto at = [&](double x, double y) {
      return render::in_picture(camera, render::sketch_of(surfaces::sphere({x, y, 0}, 1)));
    };
    INFO(projection);
    CHECK(at(0, 0));
    CHECK(at(edge + 0.9, 0));
    CHECK(at(-edge - 0.9, 0));
    CHECK_FALSE(at(edge + 2.5, 0));
    CHECK_FALSE(at(-edge - 2.5, 0));
  }
}

TEST_CASE("with a depth cue what is far is nearer to the ground, and what is near keeps its colour") {
  const sim::State state = surfaces::state_of({surfaces::sphere({-1.5, -3, 0}), surfaces::sphere({1.5, 3, 0})});
  render::ViewParameters view = crowd_view();
  view.projection = "orthographic";
  view.background = "#ffffff";
  render::Frame frame = surfaces::frame_of(state, view);
  frame.bodies[1].colour = frame.bodies[0].colour;
  const auto middle = [&](double x) {
    const render::Image image = render::draw_frame(renderer(), frame);
    const glm::dvec2 p = frame.camera.picture_place({x, 0, 0});
    return static_cast<int>(image.at(static_cast<int>((p.x + 1) * 240), 180)[2]);
  };
  CHECK(std::abs(middle(-1.5) - middle(1.5)) <= 2);  // two vesicles: no cue
  const int plain = middle(1.5);
  frame.view.depth_cue = 0.8;
  CHECK(std::abs(middle(-1.5) - plain) < 12);
  CHECK(middle(1.5) > plain + 50);
  frame.view.depth_cue.reset();
  frame.vesicles = 64;
  CHECK(middle(1.5) > plain + 40);
}
