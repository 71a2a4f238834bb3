// A few pictures that somebody has looked at. The test house.goldens compares the same by `tanktread compare`. To
// accept what is drawn now, look at it first: docs/ci.md.
#include "render/draw/draw.h"
#include "render/scene/arrow_net.h"

#include "surfaces.h"
#include "tests/support/catch.h"

#include <cstdlib>
#include <filesystem>

using surfaces::turn;

namespace {

/// Leaves the picture in TANKTREAD_GOLDENS_MADE (the environment's, or the build's), where `tanktread compare` finds
/// it, and judges it by the same rule.
void check_golden(const std::string& name, const render::Frame& frame) {
  render::Renderer renderer(render::parse_gl_choice("software"));
  const render::Image actual = render::draw_frame(renderer, frame);
  const char* elsewhere = std::getenv("TANKTREAD_GOLDENS_MADE");
  const std::filesystem::path golden = std::filesystem::path(TANKTREAD_GOLDENS) / (name + ".png"),
                              made = elsewhere ? elsewhere : TANKTREAD_GOLDENS_MADE;
  std::filesystem::create_directories(made);
  render::write_png(made / (name + ".png"), actual);
  const render::ImageDifference d = render::difference(render::read_png(golden).image, actual);
  const std::vector<std::string> objections = render::objections(d);
  INFO(name << ": largest difference " << d.maximum << ", " << d.above << " pixels above 2, rmse " << d.rmse
            << "; look at it with: tanktread compare " << TANKTREAD_GOLDENS << " " << made << " --html DIR");
  CHECK(objections.empty());
}

render::ViewParameters small_view() {
  render::ViewParameters view;
  view.size = {320, 240};
  view.colour_bar = false;
  view.time_stamp = view.caption = view.scale_bar = false;  // text depends on the versions of Cairo and FreeType
  return view;
}

sim::State pair() {
  return surfaces::state_of({surfaces::disc(turn(-35, {0, 1, 0}) * turn(23, {1, 0, 0}), {-1.25, 0, 0.5}),
                             surfaces::ellipsoid({0.82, 0.82, 1.5}, turn(66, {0, 1, 0}), {1.25, 0, -0.5})});
}

}  // namespace

TEST_CASE("the pair in the opaque style with arrows looks as it did") {
  render::Frame frame = surfaces::frame_of(pair(), small_view());
  const render::StateSummary summary = render::summarize(pair());
  frame.arrows.points =
      render::arrow_points(render::frame_trajectory(std::span(&summary, 1), frame.view), summary.centroid);
  frame.arrows.velocities = sim::Matrix::Zero(frame.arrows.points.rows(), 3);
  frame.arrows.velocities.col(0) = frame.arrows.points.col(2);
  check_golden("pair_opaque", frame);
}

TEST_CASE("a disc seen from three quarters in the meridian style looks as it did") {
  render::ViewParameters view = small_view();
  view.camera = "three-quarter";
  view.style = "meridian";
  check_golden("disc_meridian", surfaces::frame_of(surfaces::state_of({surfaces::disc(turn(25, {0, 1, 0}))}), view));
}

TEST_CASE("a prolate in the checker style looks as it did") {
  render::ViewParameters view = small_view();
  view.style = "checker";
  view.camera = "three-quarter";
  check_golden(
      "prolate_checker",
      surfaces::frame_of(surfaces::state_of({surfaces::ellipsoid({0.82, 0.82, 1.5}, turn(66, {0, 1, 0}))}), view));
}

TEST_CASE("the pair in the ghost style looks as it did") {
  render::ViewParameters view = small_view();
  view.style = "ghost";
  view.camera = "three-quarter";
  check_golden("pair_ghost", surfaces::frame_of(pair(), view));
}

TEST_CASE("ghosts one behind the other look as they did") {
  render::ViewParameters view = small_view();
  view.style = "ghost";
  view.background = "white";
  const sim::State state =
      surfaces::state_of({surfaces::disc(turn(-35, {0, 1, 0}) * turn(50, {1, 0, 0}), {-0.5, 0.8, 0.2}),
                          surfaces::ellipsoid({0.82, 0.82, 1.5}, turn(66, {0, 1, 0}), {0.4, -0.9, 0})});
  check_golden("ghosts_in_depth", surfaces::frame_of(state, view));
}

TEST_CASE("the pair in the field style looks as it did") {
  render::ViewParameters view = small_view();
  view.style = "field";
  check_golden("pair_field", surfaces::painted(surfaces::frame_of(pair(), view), pair()));
}

TEST_CASE("the pair painted about zero, with dots below it, looks as it did") {
  render::ViewParameters view = small_view();
  view.style = "field";
  render::Frame frame = surfaces::painted(surfaces::frame_of(pair(), view), pair());
  frame.legend->colours = render::colour_table(render::find_colour_map("blue-red"));
  frame.legend->mirrored = true;
  check_golden("pair_signs", frame);
}

TEST_CASE("the pair in the cutaway style looks as it did") {
  render::ViewParameters view = small_view();
  view.style = "cutaway";
  view.camera = "three-quarter";
  check_golden("pair_cutaway", surfaces::painted(surfaces::frame_of(pair(), view), pair()));
}

TEST_CASE("vesicles cut at the faces of a cell look as they did") {
  render::ViewParameters view = small_view();
  view.camera = "three-quarter";
  const sim::State state =
      surfaces::state_of({surfaces::disc(turn(-35, {0, 1, 0}) * turn(50, {1, 0, 0}), {-1.0, -0.9, 0.6}),
                          surfaces::ellipsoid({0.82, 0.82, 1.5}, turn(66, {0, 1, 0}), {0.9, -0.2, -0.5}),
                          surfaces::ellipsoid({0.6, 0.6, 0.9}, turn(-40, {0, 1, 0}), {1.1, -1.0, 1.1}),
                          surfaces::sphere({-1, 1, -1}, 0.7)});
  render::Frame frame = surfaces::frame_of(state, view);
  frame.faces = render::FaceBox{{-1.5, -1.3, -1.4}, {1.5, 1.3, 1.4}};
  check_golden("cell_faces", frame);
}

TEST_CASE("the pair in the outline style on white looks as it did") {
  render::ViewParameters view = small_view();
  view.style = "outline";
  view.background = "white";
  view.projection = "orthographic";
  check_golden("pair_outline", surfaces::frame_of(pair(), view));
}
