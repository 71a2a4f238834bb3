// A few pictures that somebody has looked at. TANKTREAD_UPDATE_GOLDENS=1 accepts what is drawn now: look at it first.
#include "render/draw.h"

#include "surfaces.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>

using surfaces::turn;

namespace {

void check_golden(const std::string& name, const render::Frame& frame) {
  render::Renderer renderer(render::parse_gl_choice("software"));
  const render::Image actual = render::draw_frame(renderer, frame);
  const std::filesystem::path golden = std::filesystem::path(TANKTREAD_GOLDENS) / (name + ".png");
  if (const char* update = std::getenv("TANKTREAD_UPDATE_GOLDENS"); update && std::string(update) == "1") {
    render::write_png(golden, actual);
    WARN(golden.string() << " accepted: look at it");
    return;
  }
  const render::Image expected = render::read_png(golden).image;
  const render::ImageDifference d = render::difference(expected, actual);
  const bool same = render::same_picture(d, std::int64_t{actual.width} * actual.height);
  if (!same) {
    const std::filesystem::path reports = TANKTREAD_GOLDEN_REPORTS;
    std::filesystem::create_directories(reports);
    render::write_png(reports / (name + "_actual.png"), actual);
    render::write_png(reports / (name + "_difference.png"), render::difference_image(expected, actual));
  }
  INFO(name << ": largest difference " << d.maximum << ", " << d.above_two << " pixels above 2, rmse " << d.rmse << "; see "
            << TANKTREAD_GOLDEN_REPORTS);
  CHECK(same);
}

render::ViewParameters small_view() {
  render::ViewParameters view;
  view.size = {320, 240};
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
  frame.arrows.points = render::arrow_points(render::frame_trajectory(std::span(&summary, 1), frame.view), summary.centroid);
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
  check_golden("prolate_checker",
               surfaces::frame_of(surfaces::state_of({surfaces::ellipsoid({0.82, 0.82, 1.5}, turn(66, {0, 1, 0}))}), view));
}

TEST_CASE("the pair in the outline style on white looks as it did") {
  render::ViewParameters view = small_view();
  view.style = "outline";
  view.background = "white";
  view.projection = "orthographic";
  check_golden("pair_outline", surfaces::frame_of(pair(), view));
}
