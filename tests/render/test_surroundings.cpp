// What is drawn around membranes: the flow and the captions.
#include "render/core/places.h"
#include "render/draw/draw.h"
#include "render/overlay/layout.h"
#include "render/overlay/overlay.h"
#include "render/scene/arrow_net.h"

#include "surfaces.h"
#include "tests/support/catch.h"

using render::Image;
using sim::Vec3;

namespace {

bool drawn(const std::uint8_t* p) { return p[0] != 255 || p[1] != 255 || p[2] != 255; }

render::Renderer software() { return render::Renderer(render::parse_gl_choice("software")); }

}  // namespace

TEST_CASE("arrows point along the flow and none is drawn where it rests") {
  render::Renderer renderer = software();
  render::ViewParameters view = surfaces::bare_view(400, 300);
  view.flow_arrows = true;
  render::Frame frame = surfaces::frame_of(surfaces::state_of({surfaces::sphere()}), view);
  frame.bodies.clear();
  frame.arrows.points = sim::Matrix::Zero(3, 3);
  frame.arrows.points.col(2) << -0.5, 0, 0.5;
  frame.arrows.velocities = sim::Matrix::Zero(3, 3);
  frame.arrows.velocities.col(0) << -1, 0, 1;
  const Image image = render::draw_frame(renderer, frame);
  const auto extent = [&](int from, int to) {  // number of drawn px in the left and right half of a band of rows
    std::pair<int, int> sides{0, 0};
    for (int y = from; y < to; ++y)
      for (int x = 0; x < 400; ++x)
        if (drawn(image.at(x, y))) ++(x < 200 ? sides.first : sides.second);
    return sides;
  };
  const auto upper = extent(0, 130), middle = extent(130, 170), lower = extent(170, 300);
  CHECK(upper.second > upper.first);  // the head is at the right
  CHECK(lower.first > lower.second);
  CHECK(middle == std::pair<int, int>{0, 0});
  CHECK(upper.first > 20);
}

TEST_CASE("an arrow that would touch a membrane's picture is left out, one beside it is drawn") {
  render::Renderer renderer = software();
  const render::Frame without =
      surfaces::frame_of(surfaces::state_of({surfaces::sphere()}), surfaces::bare_view(400, 300));
  const auto changed = [&](double x, double y) {  // px that an arrow in the plane y changes
    render::Frame frame = without;
    frame.view.flow_arrows = true;
    frame.arrows.points = Vec3(x, y, 0).transpose();
    frame.arrows.velocities = Vec3(1, 0, 0).transpose();
    return render::difference(render::draw_frame(renderer, without), render::draw_frame(renderer, frame)).above;
  };
  CHECK(changed(1.6, 0) > 30);
  CHECK(changed(1.05, 0) == 0);
  CHECK(changed(0, 0) == 0);
  CHECK(changed(0, -3) == 0);  // before the sphere: arrows are the ground of the picture, never in front
}

TEST_CASE("a camera that follows through a resting fluid shows beads, which stay where they are") {
  render::Renderer renderer = software();
  std::vector<render::StateSummary> states;
  for (const double x : {0.0, 40.0})
    states.push_back(render::summarize(surfaces::state_of({surfaces::sphere({x, 0, 0})})));
  render::ViewParameters view = surfaces::bare_view(400, 300);
  view.flow_arrows = true;
  const auto beads = [&](const std::string& follow) {
    view.follow = follow;
    const render::Framing framing = render::frame_trajectory(states, view);
    render::Frame frame;
    frame.view = view;
    frame.camera = render::make_camera(framing, states[0].centroid);
    frame.arrows.points = render::arrow_points(framing, states[0].centroid);
    frame.arrows.velocities = sim::Matrix::Zero(frame.arrows.points.rows(), 3);
    const Image image = render::draw_frame(renderer, frame);
    int count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) count += drawn(image.at(x, y));
    return count;
  };
  CHECK(beads("always") > 200);
  CHECK(beads("never") == 0);
}

TEST_CASE("lines of the flow lie behind closed membranes, and in their place inside an opened one") {
  render::Renderer renderer = software();
  const sim::State state = surfaces::state_of({surfaces::sphere()});
  for (const bool opened : {false, true}) {
    render::ViewParameters view = surfaces::bare_view(400, 400);
    view.style = opened ? "cutaway" : "plain";
    const render::Frame without = surfaces::painted(surfaces::frame_of(state, view), state);
    render::Frame with = without;
    with.flow_lines.lines = {{{{-1.2, -0.01, 0.3}, {0, -0.01, 0.3}, {1.2, -0.01, 0.3}}, false, {}}};
    const Image a = render::draw_frame(renderer, without), b = render::draw_frame(renderer, with);
    const double px = 200 / with.camera.half_width;
    const auto changed = [&](double x, double z) {
      const int column = static_cast<int>(200 + x * px), row = static_cast<int>(200 - z * px);
      return !std::equal(a.at(column, row), a.at(column, row) + 3, b.at(column, row));
    };
    CHECK(changed(1.1, 0.3));
    CHECK(changed(-1.1, 0.3));
    CHECK(changed(0.1, 0.3) == opened);
    CHECK_FALSE(changed(1.1, 0.4));
  }
}

namespace {

/// Everything that can lie over a picture at once, with texts of any length.
render::Frame crowded(int width, int height, const std::string& title, const std::string& parameters) {
  render::Frame frame;
  frame.view = surfaces::bare_view(width, height);
  frame.view.time_stamp = frame.view.caption = frame.view.errors = frame.view.scale_bar = frame.view.title = true;
  frame.view.triad = frame.view.flow_profile = frame.view.inset = frame.view.colour_bar = true;
  frame.captions.time = "γ̇t = 1234.50·10^{−6}";
  frame.captions.parameters = parameters;
  frame.captions.errors = "error of position 1.1·10^{−3} R_{0}";
  frame.captions.note = "lines will be laid anew at γ̇t = 12.50";
  frame.captions.title = title;
  frame.captions.panel = "gradient-vorticity";
  frame.camera.half_width = 4.0 * width / height;
  frame.camera.half_height = 4;
  frame.legend.emplace().label = "σ R_{0}^{2}/κ_{b}";
  frame.legend->low = -12000;
  frame.legend->high = 12000;
  frame.legend->below = frame.legend->above = true;
  frame.inset.emplace();
  frame.profile.emplace().points = {{-render::profile_reach, 0.5}, {0, 1}, {render::profile_reach, 0.5}};
  return frame;
}

const std::string long_text = "A very long title of a scene that nobody would want to read, but somebody wrote, ∂ω/∂t";

}  // namespace

TEST_CASE("no overlay of a picture meets another or its edge, whatever the size and the texts") {
  const render::Font font;
  for (const auto& [width, height] : {std::pair{1920, 1080},
                                      {3840, 2160},
                                      {1280, 720},
                                      {640, 360},
                                      {480, 540},
                                      {320, 540},
                                      {240, 1080},
                                      {320, 180},
                                      {160, 90},
                                      {400, 400},
                                      {2000, 300}})
    for (const std::string& title : {std::string(), std::string("Slipper"), long_text})
      for (const std::string& parameters :
           {std::string("λ = 1"), std::string("Ca = 100   λ = 1, 10, 100   ν = 0.85"),
            std::string("Ca = 0.001 to 1000   Bo = 0.25 to 12   λ = 0.1 to 1000   ν = 0.65")}) {
        INFO(width << " x " << height << ", '" << title << "', '" << parameters << "'");
        const render::OverlayLayout layout = render::lay_out(crowded(width, height, title, parameters), font);
        const std::vector<render::Box> boxes = layout.boxes();
        for (std::size_t a = 0; a < boxes.size(); ++a) {
          INFO("box " << a << ": " << boxes[a].left << " " << boxes[a].top << " " << boxes[a].right << " "
                      << boxes[a].bottom);
          CHECK((boxes[a].left >= 0 && boxes[a].top >= 0 && boxes[a].right <= width && boxes[a].bottom <= height));
          for (std::size_t b = a + 1; b < boxes.size(); ++b) {
            INFO("box " << b << ": " << boxes[b].left << " " << boxes[b].top << " " << boxes[b].right << " "
                        << boxes[b].bottom);
            CHECK(render::apart(boxes[a], boxes[b]));
          }
        }
        if (width < 640 || height < 360) continue;  // there everything has room
        CHECK((layout.colour_bar && layout.inset && layout.profile && layout.triad && layout.scale_bar));
        CHECK(layout.texts.size() >= 5U + !title.empty());
      }
}

TEST_CASE("the widest vesicle leaves room for the colour bar and its numbers") {
  const render::Font font;
  const sim::State state = surfaces::state_of({surfaces::ellipsoid({3, 0.4, 0.4}, Eigen::Matrix3d::Identity())});
  for (const auto& [width, height] : {std::pair{1920, 1080}, {1200, 675}, {640, 360}, {600, 600}, {2000, 600}})
    for (const double extreme : {1.5, 0.025, 1200.0}) {
      render::ViewParameters view = surfaces::bare_view(width, height);
      view.style = "field";
      view.colour_bar = true;
      render::Frame frame = surfaces::frame_of(state, view);
      frame.legend.emplace().label = "σ R_{0}^{2}/κ_{b}";
      frame.legend->low = -extreme;
      frame.legend->high = extreme;
      const render::OverlayLayout layout = render::lay_out(frame, font);
      INFO(width << " x " << height << ", to " << extreme);
      REQUIRE(layout.colour_bar);
      double right = 0;
      for (const glm::dvec3& point : frame.bodies[0].mesh.position)
        right = std::max(right, (1 + frame.camera.picture_place(point).x) * width / 2);
      CHECK(right < layout.bar.left - 2);
      CHECK(right > 0.6 * width);
    }
}

TEST_CASE("titles of panels side by side stand alike: beside the time in all of them or above it") {
  const render::Font font;
  const auto tops = [&](const std::string& title, const std::string& widest) {
    render::Frame frame = crowded(640, 540, title, "λ = 1");
    frame.view.inset = false;
    frame.captions.widest_title = widest;
    std::vector<double> found;
    for (const render::TextPlace& text : render::lay_out(frame, font).texts)
      if (text.role == render::TextPlace::Role::time || text.role == render::TextPlace::Role::title)
        found.push_back(text.box.top);
    return found;
  };
  const std::string wide = long_text, narrow = "Slipper";
  CHECK(tops(wide, wide)[0] == tops(narrow, wide)[0]);
  CHECK(tops(wide, wide)[1] == tops(narrow, wide)[1]);
  CHECK(tops(narrow, "")[1] < tops(narrow, wide)[1]);  // alone it has room beside the time
}

TEST_CASE("what lies over a picture is drawn in its boxes") {
  const render::Font font;
  for (const auto& [width, height] : {std::pair{960, 540}, {480, 540}, {320, 180}}) {
    const render::Frame frame = crowded(width, height, long_text, "Ca = 100   λ = 1   ν = 0.85");
    const std::vector<render::Box> boxes = render::lay_out(frame, font).boxes();
    Image image(width, height, 3);
    std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{255});
    render::draw_captions(image, font, frame);
    int inside = 0, outside = 0, at_x = 0, at_y = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (!drawn(image.at(x, y))) continue;
        constexpr double round = 2.5;  // px: tails of letters, half the width of a line
        const bool held = std::any_of(boxes.begin(), boxes.end(), [&](const render::Box& b) {
          return x + 0.5 > b.left - round && x + 0.5 < b.right + round && y + 0.5 > b.top - round &&
                 y + 0.5 < b.bottom + round;
        });
        ++(held ? inside : outside);
        if (!held) at_x = x, at_y = y;
      }
    INFO(width << " x " << height << ", last outside " << at_x << ", " << at_y);
    CHECK(inside > 1000);
    CHECK(outside == 0);
  }
}

TEST_CASE("arrows are clear of a box away from it, hidden in it, and fade in between") {
  const std::vector<render::Box> boxes{{100, 100, 200, 150}};
  const std::vector<int> size{400, 300};
  const auto clear = [&](double x, double y) {
    return render::clear_of(boxes, {2 * x / size[0] - 1, 1 - 2 * y / size[1]}, size);
  };
  CHECK(clear(150, 120) == 0);
  CHECK(clear(300, 120) == 1);
  CHECK(clear(210, 120) > 0);
  CHECK(clear(210, 120) < 1);
}

TEST_CASE("captions are drawn where asked for and leave the rest alone") {
  render::Renderer renderer = software();
  render::ViewParameters view = surfaces::bare_view(480, 270);
  render::Frame frame = surfaces::frame_of(surfaces::state_of({surfaces::sphere()}), view);
  frame.captions.time = "γ̇t = 12.50";
  frame.captions.parameters = "λ = 1   ν = 0.85";
  const Image off = render::draw_frame(renderer, frame);
  frame.view.time_stamp = frame.view.caption = frame.view.scale_bar = true;
  const Image on = render::draw_frame(renderer, frame);
  int upper = 0, lower = 0, elsewhere = 0;
  for (int y = 0; y < 270; ++y)
    for (int x = 0; x < 480; ++x) {
      const bool differs = !std::equal(on.at(x, y), on.at(x, y) + 3, off.at(x, y));
      if (y < 45)
        upper += differs;
      else if (y > 240)
        lower += differs;
      else
        elsewhere += differs;
    }
  CHECK(upper > 200);
  CHECK(lower > 60);
  CHECK(elsewhere == 0);
}
