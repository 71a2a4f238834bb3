// Where pictures are seen from, and how a movie is framed.
#include "render/core/places.h"
#include "render/overlay/panels.h"
#include "render/scene/arrow_net.h"

#include "surfaces.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace {

glm::vec3 projected(const render::Camera& camera, const glm::dvec3& p) {
  const glm::vec4 clip = camera.clip(p);
  return glm::vec3(clip) / clip.w;
}

std::vector<render::StateSummary> drifting(double distance, int states = 20) {
  std::vector<render::StateSummary> all;
  for (int k = 0; k < states; ++k)
    all.push_back(render::summarize(surfaces::state_of({surfaces::sphere({distance * k / (states - 1), 0, 0.3})})));
  return all;
}

}  // namespace

TEST_CASE("the flow-gradient camera has x to the right and z up, seen from -y") {
  const auto states = drifting(0, 2);
  const render::Camera camera = render::make_camera(render::frame_trajectory(states, {}), states[0].centroid);
  const glm::vec3 centre = projected(camera, {0, 0, 0.3});
  CHECK(centre.x == Approx(0).margin(1e-5));
  CHECK(centre.y == Approx(0).margin(1e-5));
  CHECK(projected(camera, {0.5, 0, 0.3}).x > 0.05);
  CHECK(projected(camera, {0, 0, 0.8}).y > 0.05);
  CHECK(projected(camera, {0, -1, 0.3}).z < projected(camera, {0, 1, 0.3}).z);
}

TEST_CASE("every camera of the catalogue is a right-handed orthonormal frame") {
  for (const render::CameraRow& row : render::cameras()) {
    INFO(row.name);
    const glm::dmat3 axes(row.axes.right, row.axes.up, row.axes.back);
    const glm::dmat3 difference = glm::transpose(axes) * axes - glm::dmat3(1);
    for (int k = 0; k < 3; ++k) CHECK(glm::length(difference[k]) < 1e-12);
    CHECK(glm::determinant(axes) == Approx(1));
  }
}

TEST_CASE("all points of all states lie inside the picture, in every camera and projection") {
  for (const render::CameraRow& row : render::cameras())
    for (const char* projection : {"perspective", "orthographic"})
      for (const double drift : {0.0, 2.0, 60.0}) {
        render::ViewParameters view;
        view.camera = row.name;
        view.projection = projection;
        const auto states = drifting(drift);
        const render::Framing framing = render::frame_trajectory(states, view);
        double furthest = 0;
        for (const render::StateSummary& state : states) {
          const render::Camera camera = render::make_camera(framing, state.centroid);
          for (std::size_t k = 0; k < state.points.size(); ++k) {
            const glm::vec3 p = projected(camera, state.point(k));
            furthest = std::max({furthest, std::abs(double(p.x)), std::abs(double(p.y))});
            CHECK(std::abs(p.z) < 1);
          }
        }
        INFO(row.name << " " << projection << " drift " << drift);
        CHECK(furthest < 0.9);
        CHECK(furthest > 0.7);  // and the picture is filled
      }
}

TEST_CASE("the camera stays until the drift exceeds half of what is seen at once, then follows") {
  CHECK_FALSE(render::frame_trajectory(drifting(0.9), {}).follows);
  CHECK(render::frame_trajectory(drifting(2), {}).follows);
  render::ViewParameters never;
  never.follow = "never";
  CHECK_FALSE(render::frame_trajectory(drifting(10), never).follows);
  render::ViewParameters always;
  always.follow = "always";
  const auto states = drifting(1);
  const render::Framing framing = render::frame_trajectory(states, always);
  CHECK(framing.follows);
  CHECK(glm::distance(render::make_camera(framing, glm::dvec3(5, 6, 7)).target, {5, 6, 7}) < 1e-2);
}

TEST_CASE("a fixed camera gives one and the same matrix for every frame") {
  const auto states = drifting(0.8);
  const render::Framing framing = render::frame_trajectory(states, {});
  CHECK(render::make_camera(framing, states.front().centroid).view ==
        render::make_camera(framing, states.back().centroid).view);
}

TEST_CASE("arrows of a following camera stay at rest in space") {
  const auto states = drifting(40, 41);
  const render::Framing framing = render::frame_trajectory(states, {});
  REQUIRE(framing.follows);
  const sim::Matrix a = render::arrow_points(framing, glm::dvec3(10, 0, 0.3)),
                    b = render::arrow_points(framing, glm::dvec3(10.1, 0, 0.3));
  int common = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < b.rows(); ++j) common += (a.row(i) - b.row(j)).norm() < 1e-9;
  CHECK(common > 0.7 * static_cast<double>(a.rows()));
}

TEST_CASE("arrows stand in the coordinate plane that faces the camera, inside the picture and clear of the captions") {
  const auto states = drifting(0.8);
  for (const auto& [name, axis] : {std::pair{"flow-gradient", 1}, std::pair{"three-quarter", 1},
                                   std::pair{"flow-vorticity", 2}, std::pair{"gradient-vorticity", 0}})
    for (const char* projection : {"perspective", "orthographic"}) {
      INFO(name << " " << projection);
      render::ViewParameters view;
      view.camera = name;
      view.projection = projection;
      const render::Framing framing = render::frame_trajectory(states, view);
      const render::Camera camera = render::make_camera(framing, states[0].centroid);
      const sim::Matrix points = render::arrow_points(framing, states[0].centroid);
      CHECK(points.rows() >= 20);
      CHECK(points.rows() <= 60);
      for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const glm::dvec2 place = camera.picture_place(render::to_glm(points.row(i)));
        CHECK(points(i, axis) == Approx(camera.target[axis]).margin(1e-9));
        CHECK(std::max(std::abs(place.x), std::abs(place.y)) < 0.95);
        CHECK(render::clear_of_captions(place) == 1);
      }
    }
}

TEST_CASE("an unknown camera is refused with the nearest known word") {
  CHECK_THAT(support::message_of([] { render::find_camera("flow-gradiant"); }),
             Catch::Contains("did you mean 'flow-gradient'"));
}

namespace {

/// Two spheres that stay where they are while time passes.
std::vector<render::StateSummary> pair_at_rest() {
  std::vector<render::StateSummary> all;
  for (int k = 0; k <= 10; ++k) {
    sim::State state = surfaces::state_of({surfaces::sphere({-1.5, 0, 0}), surfaces::sphere({1.5, 0, 0})});
    state.time = k;
    all.push_back(render::summarize(state));
  }
  return all;
}

}  // namespace

TEST_CASE("an orbiting camera goes round the z axis at its rate and keeps everything in the picture") {
  render::ViewParameters view;
  view.orbit = 36;
  const auto states = pair_at_rest();
  const render::Framing framing = render::frame_trajectory(states, view);
  for (const render::StateSummary& state : states) {
    const render::Camera camera = render::make_camera(framing, framing.moment(state));
    const glm::dvec3 d = camera.eye - camera.target;
    const double angle = glm::radians(36 * state.time);
    CHECK(d.x / glm::length(d) == Approx(std::sin(angle)).margin(1e-9));  // from -y, counter-clockwise seen from above
    CHECK(d.y / glm::length(d) == Approx(-std::cos(angle)).margin(1e-9));
    for (std::size_t k = 0; k < state.points.size(); ++k) {
      const glm::vec3 p = projected(camera, state.point(k));
      CHECK(std::max(std::abs(p.x), std::abs(p.y)) < 0.9F);
    }
  }
}

TEST_CASE("arrows keep their plane while the camera goes round, and fade where they are seen edge on") {
  render::ViewParameters view;
  view.orbit = 9;
  const auto states = pair_at_rest();
  const render::Framing framing = render::frame_trajectory(states, view);
  CHECK(render::arrows_shown(framing, {glm::dvec3(0), 0}) == 1);
  CHECK(render::arrows_shown(framing, {glm::dvec3(0), 10}) == 0);  // 90 degrees
  for (const double time : {0.0, 3.0, 6.0}) {
    const sim::Matrix points = render::arrow_points(framing, {glm::dvec3(0), time});
    CHECK(points.rows() > 0);
    CHECK((points.col(1).array() - points(0, 1)).abs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("two key frames at one time are refused") {
  const std::vector<render::KeyFrameParameters> keys{{1, 0, 0, 1}, {1, 90, 0, 1}};
  const auto states = pair_at_rest();
  CHECK_THAT(support::message_of([&] { render::frame_trajectory(states, {}, keys); }), Catch::Contains("same time"));
}

TEST_CASE("key frames are met, with rest at the ends and without overshoot between") {
  const std::vector<render::CameraKey> keys{{1, 0, 0, 1}, {3, 90, 20, 2}, {4, 100, 20, 1}};
  for (const render::CameraKey& key : keys) {
    CHECK(render::camera_at(keys, key.time).azimuth == Approx(key.azimuth));
    CHECK(render::camera_at(keys, key.time).zoom == Approx(key.zoom));
  }
  CHECK(render::camera_at(keys, 0).azimuth == 0);
  CHECK(render::camera_at(keys, 9).azimuth == 100);
  CHECK(render::camera_at(keys, 1.001).azimuth < 0.01);
  double before = 0;
  for (double t = 1; t <= 4; t += 0.05) {
    const render::CameraKey now = render::camera_at(keys, t);
    CHECK(now.azimuth >= before - 1e-9);
    CHECK(now.elevation <= 20 + 1e-9);
    before = now.azimuth;
  }
  // smooth: slopes from both sides of a key agree
  const auto slope = [&](double t, double h) {
    return (render::camera_at(keys, t + h).azimuth - render::camera_at(keys, t).azimuth) / h;
  };
  CHECK(slope(3, 1e-5) == Approx(slope(3, -1e-5)).epsilon(1e-3));
  CHECK(render::camera_at({}, 5).zoom == 1);
}

TEST_CASE("a camera that follows one vesicle keeps it in the middle") {
  render::ViewParameters view;
  view.follow = "vesicle";
  view.follow_vesicle = 1;
  const auto states = pair_at_rest();
  const render::Framing framing = render::frame_trajectory(states, view);
  const render::Camera camera = render::make_camera(framing, framing.moment(states[0]));
  CHECK(projected(camera, {1.5, 0, 0}).x == Approx(0).margin(1e-5));
  CHECK(projected(camera, {1.5, 0, 1}).y > 0.3F);
  view.follow_vesicle = 2;
  CHECK_THAT(support::message_of([&] { render::frame_trajectory(states, view); }), Catch::Contains("from 0 to 1"));
}

TEST_CASE("a camera placed by eye and target stands there and looks there") {
  render::ViewParameters view;
  view.eye = sim::Vec3(3, -9, 4);
  view.target = sim::Vec3(1.5, 0, 0);
  const auto states = pair_at_rest();
  const render::Framing framing = render::frame_trajectory(states, view);
  const render::Camera camera = render::make_camera(framing, framing.moment(states[0]));
  CHECK(glm::distance(camera.eye, {3, -9, 4}) < 1e-9);
  CHECK(projected(camera, {1.5, 0, 0}).x == Approx(0).margin(1e-5));
  CHECK(projected(camera, {1.5, 0, 1}).y > 0);
  CHECK_NOTHROW(render::check_framing(framing, states));
}

TEST_CASE("views that show nothing, and eyes inside a vesicle, are told in a sentence") {
  const auto states = pair_at_rest();
  const auto complaint = [&](const sim::Vec3& eye, const sim::Vec3& target) {
    render::ViewParameters view;
    view.eye = eye;
    view.target = target;
    return support::message_of([&] { render::check_framing(render::frame_trajectory(states, view), states); });
  };
  CHECK_THAT(complaint({0, -20, 0}, {0, -40, 0}), Catch::Contains("shows nothing"));
  CHECK_THAT(complaint({1.6, 0.2, 0}, {0, 0, 0}), Catch::Contains("inside vesicle 1"));
  CHECK_THAT(complaint({1, 2, 0}, {1, 2, 0}), Catch::Contains("same point"));
  CHECK_THAT(complaint({0, 0, 9}, {0, 0, 0}), Catch::Contains("view.up"));
}

TEST_CASE("panels divide a picture evenly") {
  CHECK(render::panel_columns(1, 1920, 1080) == 1);
  CHECK(render::panel_columns(2, 1920, 1080) == 2);
  CHECK(render::panel_columns(4, 1920, 1080) == 2);
  CHECK(render::panel_columns(2, 1080, 1920) == 1);
}
