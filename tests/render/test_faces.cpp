// The box at whose faces the membranes of a periodic suspension end.
#include "render/draw/draw.h"
#include "render/scene/hidden.h"
#include "render/scene/occlusion.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace {

constexpr double pi = std::numbers::pi;

double length_of(const render::SpaceLine& line) {
  double length = 0;
  for (std::size_t k = 0; k + (line.closed ? 0 : 1) < line.points.size(); ++k)
    length += glm::distance(line.points[k], line.points[(k + 1) % line.points.size()]);
  return length;
}

double area_of(const std::vector<glm::dvec3>& triangles) {
  double area = 0;
  for (std::size_t k = 0; k < triangles.size(); k += 3)
    area += glm::length(glm::cross(triangles[k + 1] - triangles[k], triangles[k + 2] - triangles[k])) / 2;
  return area;
}

render::Mesh mesh_of(const sim::VesicleState& vesicle) {
  return render::make_mesh(std::make_shared<const render::MeshPlan>(96, 192), vesicle);
}

/// Area and length of what a face cuts of a mesh; all lines lie in the face and in the box.
std::pair<double, double> section(const render::Mesh& mesh, const render::FaceBox& box, int face) {
  const render::FaceSection found = render::face_section(mesh, box, face);
  double length = 0;
  for (const render::SpaceLine& line : found.lines) {
    length += length_of(line);
    for (const glm::dvec3& p : line.points) {
      CHECK(p[face / 2] == (face % 2 == 1 ? box.high : box.low)[face / 2]);
      CHECK(render::FaceBox{box.low - 1e-12, box.high + 1e-12}.holds(p));
    }
  }
  return {area_of(found.triangles), length};
}

render::Renderer& renderer() {
  static render::Renderer one(render::parse_gl_choice("software"));
  return one;
}

}  // namespace

TEST_CASE("a line is kept where it lies in all half spaces, and a closed one stays closed when nothing is cut") {
  const std::vector<render::HalfSpace> kept{{{1, 0, 0}, 1}, {{0, 1, 0}, 0.5}};
  const std::vector<render::SpaceLine> straight = render::parts_within({{{-1, 0, 0}, {3, 0, 0}}, false}, kept);
  REQUIRE(straight.size() == 1);
  CHECK(straight[0].points == std::vector<glm::dvec3>{{-1, 0, 0}, {1, 0, 0}});
  render::SpaceLine circle{{}, true};
  constexpr int corners = 1000;
  for (int k = 0; k < corners; ++k)
    circle.points.emplace_back(std::cos(2 * pi * k / corners), std::sin(2 * pi * k / corners), 0);
  const std::vector<render::SpaceLine> arc = render::parts_within(circle, std::vector{kept[1]});
  REQUIRE(arc.size() == 1);
  CHECK_FALSE(arc[0].closed);
  CHECK(length_of(arc[0]) == Approx(pi + 2 * std::asin(0.5)).epsilon(1e-4));  // below the height 0.5
  const std::vector<render::SpaceLine> whole =
      render::parts_within(circle, std::vector<render::HalfSpace>{{{1, 0, 0}, 2}});
  REQUIRE(whole.size() == 1);
  CHECK(whole[0].closed);
  CHECK(render::parts_within(circle, std::vector<render::HalfSpace>{{{1, 0, 0}, -2}}).empty());
}

TEST_CASE("a face cuts a sphere in a circle, and an edge and a corner of the box cut that") {
  const render::Mesh mesh = mesh_of(surfaces::sphere());
  const double r = 0.8;  // of the circle at a height of 0.6
  // Chords of the mesh: shorter than arcs by some 1e-4.
  const auto close = [](double value) { return Approx(value).epsilon(0.01); };
  for (int face = 0; face < render::FaceBox::faces; ++face) {
    INFO("face " << face);
    render::FaceBox box{glm::dvec3(-2), glm::dvec3(2)};
    (face % 2 == 1 ? box.high : box.low)[face / 2] = face % 2 == 1 ? 0.6 : -0.6;
    const auto [area, length] = section(mesh, box, face);
    CHECK(area == close(pi * r * r));
    CHECK(length == close(2 * pi * r));
    (face % 2 == 1 ? box.low : box.high)[(face / 2 + 1) % 3] = 0;  // another face goes through the middle
    if (face % 2 == 1)
      box.high[(face / 2 + 1) % 3] = 2;
    else
      box.low[(face / 2 + 1) % 3] = -2;
    const auto [half_area, half_length] = section(mesh, box, face);
    CHECK(half_area == close(pi * r * r / 2));
    CHECK(half_length == close(pi * r));
    box.low[(face / 2 + 2) % 3] = 0;  // and a third one
    const auto [quarter_area, quarter_length] = section(mesh, box, face);
    CHECK(quarter_area == close(pi * r * r / 4));
    CHECK(quarter_length == close(pi * r / 2));
    CHECK(section(mesh, {glm::dvec3(-2), glm::dvec3(2)}, face).first == 0);
  }
}

TEST_CASE("a face that cuts a biconcave disc in a ring leaves its hole open") {
  const render::Mesh mesh = mesh_of(surfaces::disc(Eigen::Matrix3d::Identity()));
  // Half of the thickness, 0.609 (1 - ...) as in surfaces::disc(): at z = 0.2 two circles about the axis.
  const auto height = [](double q) {
    return 1.191602667 * 0.5 * 1.022378509 * std::sqrt(1 - q) * (0.207 + 2.003 * q - 1.123 * q * q);
  };
  std::vector<double> radii2;
  constexpr int steps = 100000;
  for (int k = 0; k < steps; ++k) {
    const double a = k / double(steps), b = (k + 1) / double(steps);
    if ((height(a) < 0.2) != (height(b) < 0.2)) radii2.push_back(1.191602667 * 1.191602667 * a);
  }
  REQUIRE(radii2.size() == 2);
  const auto [area, length] = section(mesh, {glm::dvec3(-2), {2, 2, 0.2}}, 5);
  CHECK(area == Approx(pi * (radii2[1] - radii2[0])).epsilon(0.01));
  CHECK(length == Approx(2 * pi * (std::sqrt(radii2[0]) + std::sqrt(radii2[1]))).epsilon(0.01));
}

TEST_CASE("faces and edges in front of a box are those that its eye sees from outside") {
  const render::FaceBox box{{-1, -2, -1.5}, {1, 2, 1.5}};
  for (const char* projection : {"perspective", "orthographic"}) {
    render::ViewParameters view = surfaces::bare_view();
    view.projection = projection;
    view.camera = "three-quarter";  // from the front, a little from the left and above
    const render::Camera camera = surfaces::frame_of(surfaces::state_of({surfaces::sphere()}), view).camera;
    std::vector<bool> seen;
    for (int face = 0; face < render::FaceBox::faces; ++face) seen.push_back(render::faces_eye(box, face, camera));
    CHECK(seen == std::vector<bool>{true, false, true, false, false, true});
    int in_front = 0;
    for (const render::BoxEdge& edge : render::edges_of(box, camera)) in_front += edge.in_front;
    CHECK(in_front == 9);  // three of twelve meet in the far corner
  }
}

TEST_CASE("of a vesicle that goes through the faces each style shows what is in the box, and no more") {
  const sim::State state = surfaces::state_of({surfaces::sphere()});
  for (const char* style : {"opaque", "plain", "checker", "meridian", "outline", "ghost", "field", "cutaway"}) {
    INFO(style);
    render::ViewParameters view = surfaces::bare_view(200, 200);
    view.style = style;
    view.outline_width = 2.2;
    render::Frame frame = surfaces::painted(surfaces::frame_of(state, view), state);
    const render::Image whole = render::draw_frame(renderer(), frame);
    frame.faces = render::FaceBox{{-0.5, -3, -3}, {3, 3, 0.4}};
    const render::Image cut = render::draw_frame(renderer(), frame);
    const render::Image nothing = [&] {
      render::Frame empty = frame;
      empty.bodies.clear();
      return render::draw_frame(renderer(), empty);
    }();
    int outside = 0, changed = 0, inside = 0, seen = 0;
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 200; ++x) {
        const glm::dvec2 place((x + 0.5) / 100 - 1, 1 - (y + 0.5) / 100);
        const glm::dvec2 point = place * frame.camera.half_height;
        const double margin = 4.0 / 100 * frame.camera.half_height;  // px, for lines along the faces
        const auto differ = [&](const render::Image& a, const render::Image& b) {
          int most = 0;
          for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(a.at(x, y)[c] - b.at(x, y)[c]));
          return most > 3;
        };
        if (point.x < -0.5 - margin || point.y > 0.4 + margin) {
          ++outside;
          changed += differ(cut, nothing);
        } else if (point.x > -0.5 + margin && point.y < 0.4 - margin && glm::length(point) < 1 - 3 * margin) {
          ++inside;
          seen += !differ(cut, whole);
        }
      }
    CHECK(outside > 10000);
    CHECK(changed == 0);
    CHECK(inside > 3000);
    CHECK(seen == inside);
  }
}

TEST_CASE("a face towards the eye shows the section filled, and in it nothing of what is behind") {
  const sim::State state = surfaces::state_of({surfaces::sphere(), surfaces::sphere({0, 0.3, 0}, 0.2)});
  render::ViewParameters view = surfaces::bare_view(200, 200);
  view.style = "outline";
  view.outline_width = 2.2;
  view.line_width = 0;
  view.background = "#808080";
  render::Frame frame = surfaces::frame_of(state, view);
  frame.faces = render::FaceBox{{-3, 0, -3}, {3, 3, 3}};  // takes away the half towards the eye
  const render::Image image = render::draw_frame(renderer(), frame);
  int white = 0, all = 0;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) {
      const glm::dvec2 point = glm::dvec2((x + 0.5) / 100 - 1, 1 - (y + 0.5) / 100) * frame.camera.half_height;
      if (glm::length(point) > 0.9) continue;
      ++all;
      white += image.at(x, y)[0] == 255 && image.at(x, y)[1] == 255;
    }
  CHECK(white == all);
}

TEST_CASE("what faces cut off hides neither vesicles nor light") {
  // Seen from -y: the large sphere in front of the small one lies beyond the face.
  const sim::State state = surfaces::state_of({surfaces::sphere({0, -2, 0}, 1), surfaces::sphere({0, 1, 0}, 0.3)});
  std::vector<render::Sketch> sketches;
  for (const sim::VesicleState& v : state.vesicles) sketches.push_back(render::sketch_of(v));
  render::ViewParameters view = surfaces::bare_view();
  const render::Camera camera = surfaces::frame_of(state, view).camera;
  CHECK(render::hidden(sketches, camera, view) == std::vector<bool>{false, true});
  const render::FaceBox box{{-3, -1.5, -3}, {3, 3, 3}};
  CHECK(render::hidden(sketches, camera, view, box) == std::vector<bool>{false, false});
  const auto area = [&](const std::optional<render::FaceBox>& faces) {
    const render::Occluder occluder = render::occluder_of(sketches[0], faces);
    return std::accumulate(occluder.fine.areas.begin(), occluder.fine.areas.end(), 0.0);
  };
  CHECK(area({}) == Approx(4 * pi).epsilon(0.02));
  CHECK(area(box) == Approx(2 * pi * 0.5).epsilon(0.1));  // a cap of height 0.5; discs come in smoothly
}
