// The range of a field that was not given follows the values that are shown.
#include "app/pictures/flow_overlays.h"
#include "app/pictures/flow_picture.h"
#include "app/pictures/painting.h"
#include "app/pictures/pictures.h"
#include "app/pictures/production.h"
#include "app/scene/scene_file.h"

#include "sim/stepping/simulate.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>

#include <string>

namespace {

/// Two spheres in shear, their surfaces `gap` apart.
render::Legend legend_of(const std::string& field, double gap, const std::string& view = "") {
  const support::TemporaryFolder folder;
  const std::string text = R"([flow]
kind = "shear"
[time]
end = 0.1
step = 0.1
[[vesicle]]
shape = "sphere"
order = 4
[[vesicle]]
shape = "sphere"
order = 4
center = [)" + std::to_string(2 + gap) +
                           ", 0, 0]\n[view]\nstyle = \"field\"\nfield = \"" + field + "\"\n" + view;
  const app::Settings settings = app::parse_scene(text, "s.toml", ".");
  const std::string file = (folder / "t.h5").string();
  sim::SimulationOptions options;
  options.trajectory = file;
  sim::simulate(settings.scene, options, {});
  return app::plan_painting(sim::TrajectoryReader(file), {0}, settings, 1).legend.value();
}

}  // namespace

TEST_CASE("the distance to the neighbour is told apart up to three radii, and farther only where nothing is nearer") {
  const render::Legend near = legend_of("neighbour-distance", 1);  // 1 to 3 of 5 radii
  CHECK(near.low <= 1);
  CHECK(near.high == 3);
  const render::Legend far = legend_of("neighbour-distance", 8);
  CHECK(far.low <= 8);
  CHECK(far.high >= 9);
  CHECK(legend_of("neighbour-distance", 1, "field_range = [0, 5]\n").high == 5);
}

TEST_CASE("pictures side by side share one range, about zero where one of them has both signs") {
  const support::TemporaryFolder folder;
  std::vector<sim::TrajectoryReader> readers;
  std::vector<app::Settings> settings;
  for (const char* flow : {"none", "shear"}) {  // a sphere at rest has no tension, one in shear has both signs
    const std::string text = std::string("[flow]\nkind = \"") + flow + R"("
[time]
end = 0.1
step = 0.1
[[vesicle]]
shape = "sphere"
order = 4
[view]
style = "field"
field = "tension"
)";
    settings.push_back(app::parse_scene(text, "s.toml", "."));
    sim::SimulationOptions options;
    options.trajectory = (folder / (std::string(flow) + ".h5")).string();
    sim::simulate(settings.back().scene, options, {});
    readers.emplace_back(options.trajectory);
  }
  for (const std::size_t first : {0U, 1U}) {
    const app::Production production =
        app::prepare_pictures({{readers[first], settings[first]}, {readers[1 - first], settings[1 - first]}});
    for (const app::ViewPanel& panel : production.panels) {
      CHECK(panel.painting.legend->mirrored);
      CHECK(panel.painting.legend->high > 1);
      CHECK(panel.painting.legend->low == -panel.painting.legend->high);
      CHECK(panel.painting.legend->colours == render::colour_table(render::find_colour_map("blue-red")));
    }
  }
}

TEST_CASE("side by side an arrow is the way of the fluid in one and the same time, however large the vesicles") {
  const support::TemporaryFolder folder;
  std::vector<sim::TrajectoryReader> readers;
  std::vector<app::Settings> settings;
  for (const auto& [rate, radius] : {std::pair{"1.0", "2.0"}, std::pair{"3.0", "1.0"}}) {
    const std::string text =
        std::string("[flow]\nkind = \"shear\"\nrate = ") + rate +
        "\n[time]\nend = 0.1\nstep = 0.1\n[[vesicle]]\nshape = \"sphere\"\norder = 4\nradius = " + radius +
        "\n[view]\nsize = [640, 360]\n";
    settings.push_back(app::parse_scene(text, "s.toml", "."));
    sim::SimulationOptions options;
    options.trajectory = (folder / (std::string(rate) + ".h5")).string();
    sim::simulate(settings.back().scene, options, {});
    readers.emplace_back(options.trajectory);
  }
  const app::Production production = app::prepare_pictures({{readers[0], settings[0]}, {readers[1], settings[1]}});
  std::vector<double> times;  // that an arrow lasts
  double longest = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const app::ViewPanel& panel = production.panels[k];
    const render::FlowArrows arrows = app::arrows_of(panel, render::summarize(readers[k].state(0)));
    times.push_back(panel.framing.half_height / arrows.reference_speed);
    longest = std::max(longest, arrows.velocities.rowwise().norm().maxCoeff() / arrows.reference_speed);
  }
  CHECK(times[0] == Approx(times[1]));
  CHECK(longest == Approx(1));
}

TEST_CASE(
    "the arrows of a trajectory that is much slower than the one beside it are longer, and its panel says by how "
    "much") {
  const support::TemporaryFolder folder;
  std::vector<sim::TrajectoryReader> readers;
  std::vector<app::Settings> settings;
  for (const char* rate : {"0.03", "1.0"}) {
    settings.push_back(app::parse_scene(std::string("[flow]\nkind = \"shear\"\nrate = ") + rate +
                                            "\n[time]\nend = 0.1\nstep = 0.1\n[[vesicle]]\nshape = \"sphere\"\n"
                                            "order = 4\n[view]\nsize = [640, 360]\n",
                                        "s.toml", "."));
    sim::SimulationOptions options;
    options.trajectory = (folder / (std::string(rate) + ".h5")).string();
    sim::simulate(settings.back().scene, options, {});
    readers.emplace_back(options.trajectory);
  }
  for (app::Settings& s : settings) s.view.views = {"flow-gradient", "along-flow"};
  const app::Production production = app::prepare_pictures({{readers[0], settings[0]}, {readers[1], settings[1]}});
  const std::vector<app::ViewPanel>& panels = production.panels;
  // 1/0.03 is 33: the round factor below is 20.
  CHECK(panels[0].captions.panel == "flow-gradient, arrows × 20");
  CHECK(panels[1].captions.panel == "along-flow, arrows × 20");
  CHECK(panels[2].captions.panel == "flow-gradient");
  for (const std::size_t k : {0U, 1U})
    CHECK(20 * panels[k].arrow_speed / panels[k].framing.half_height ==
          Approx(panels[k + 2].arrow_speed / panels[k + 2].framing.half_height));
}

namespace {

/// A sphere in a cell of three radii, in shear for a tenth of a unit of time.
app::Settings sphere_in_cell(const std::string& view) {
  return app::parse_scene(R"([flow]
kind = "shear"
[time]
end = 0.1
step = 0.1
[cell]
size = [3, 3, 3]
[[vesicle]]
shape = "sphere"
order = 4
[view]
)" + view,
                          "s.toml", ".");
}

std::string simulated(const app::Settings& settings, const support::TemporaryFolder& folder) {
  sim::SimulationOptions options;
  options.trajectory = (folder / "t.h5").string();
  sim::simulate(settings.scene, options, {});
  return options.trajectory;
}

}  // namespace

TEST_CASE("where copies of a cell fill the picture the net of arrows is finer, elsewhere it is the usual one") {
  const support::TemporaryFolder folder;
  app::Settings settings = sphere_in_cell("size = [1280, 720]\nviews = [\"flow-gradient\", \"along-flow\"]\n");
  const sim::TrajectoryReader trajectory(simulated(settings, folder));
  const auto net = [&] { return app::prepare_pictures({{trajectory, settings}}).panels.front().arrow_net; };
  CHECK(net() == 1);
  settings.view.copies = {2, 0, 2};
  CHECK(net() > 1);
}

TEST_CASE("the net of arrows is chosen from the whole movie: a crowd that opens after its start has the usual one") {
  const support::TemporaryFolder folder;
  app::Settings settings = sphere_in_cell("size = [1280, 720]\nviews = [\"flow-gradient\", \"along-flow\"]\n");
  const sim::TrajectoryReader trajectory(simulated(settings, folder));
  settings.view.copies = {2, 0, 2};
  const app::Production production = app::prepare_pictures({{trajectory, settings}});
  const app::ViewPanel& panel = production.panels.front();
  const render::StateSummary crowded = render::summarize(trajectory.state(0));
  render::StateSummary open = crowded;  // the same places, and hardly anything there
  for (glm::vec3& point : open.points) point *= 0.01F;
  std::vector<render::StateSummary> all(21, crowded);
  CHECK(app::arrow_net_of(panel, all) > 1);
  for (std::size_t k = 0; k < all.size(); ++k)
    if (k % 10 != 0) all[k] = open;
  CHECK(app::arrow_net_of(panel, all) == 1);
}

TEST_CASE("no streamline of a picture is a stub") {
  const support::TemporaryFolder folder;
  const app::Settings settings = sphere_in_cell("size = [640, 360]\nstreamlines = \"laboratory\"\n");
  const sim::TrajectoryReader trajectory(simulated(settings, folder));
  const app::ViewPanel panel = app::prepare_pictures({{trajectory, settings}}).panels.front();
  const sim::State state = trajectory.state(0);
  const render::Camera camera = render::make_camera(panel.framing, panel.framing.moment(render::summarize(state)));
  // Boxes that lie close together: between them and the edges there is room for stubs alone.
  std::vector<render::Box> boxes;
  for (int column = 0; column < 7; ++column)
    for (int row = 0; row < 2; ++row)
      boxes.push_back({30.0 + 90 * column, 40.0 + 160 * row, 80.0 + 90 * column, 160.0 + 160 * row});
  sim::Plans plans;
  const render::FlowLines lines = app::flow_lines_of(plans, panel, state, camera, boxes);
  CHECK_FALSE(lines.lines.empty());
  for (const render::FlowLines::Line& line : lines.lines) {
    double seen = 0;  // px; lines are 20 px apart
    for (std::size_t k = 1; k < line.points.size(); ++k) {
      const auto pixel = [&](std::size_t i) {
        const glm::dvec2 place = camera.picture_place(line.points[i]);
        return glm::dvec2(320 * (1 + place.x), 180 * (1 - place.y));
      };
      const glm::dvec2 a = pixel(k - 1), b = pixel(k);
      const auto outside = [](const glm::dvec2& p) { return p.x < 0 || p.x > 640 || p.y < 0 || p.y > 360; };
      if (!outside(a) && !outside(b)) seen += glm::distance(a, b);
    }
    CHECK(seen > 29);
  }
}

TEST_CASE("a shared range is that of all movies of a command, for stills and for figures, too") {
  const support::TemporaryFolder folder;
  std::vector<sim::TrajectoryReader> readers;
  std::vector<app::Settings> settings;
  for (const char* rate : {"1.0", "3.0"}) {
    const std::string text = std::string("[flow]\nkind = \"shear\"\nrate = ") + rate + R"(
[time]
end = 0.4
step = 0.1
[[vesicle]]
shape = "prolate"
reduced_volume = 0.8
axis = [1, 0, 0]
order = 6
[view]
style = "field"
field = "tension"
field_range = "shared"
)";
    settings.push_back(app::parse_scene(text, "s.toml", "."));
    sim::SimulationOptions options;
    options.trajectory = (folder / (std::string(rate) + ".h5")).string();
    sim::simulate(settings.back().scene, options, {});
    readers.emplace_back(options.trajectory);
  }
  const std::vector<app::PictureSource> both{{readers[0], settings[0]}, {readers[1], settings[1]}};
  const auto high_of = [](const app::Production& production) { return production.panels[0].painting.legend->high; };
  std::vector<double> own;
  for (const app::PictureSource& one : both) own.push_back(high_of(app::prepare_pictures({one})));
  CHECK(own[1] > own[0]);
  // Of one trajectory a still has the movie's.
  for (std::size_t k = 0; k < 2; ++k) CHECK(high_of(app::prepare_pictures({both[k]}, 0.1)) == own[k]);
  CHECK(app::shared_legend(both)->high == own[1]);
  CHECK(high_of(app::prepare_pictures(both, 0.1)) == own[1]);
  // Without the word a still has its own, and figures share nothing.
  for (app::Settings& s : settings) s.view.field_range = {};
  CHECK(high_of(app::prepare_pictures({both[1]}, 0.1)) < own[1]);
  CHECK_FALSE(app::shared_legend(both));
  // There is no range of two fields.
  for (app::Settings& s : settings) s.view.field_range.shared = true;
  settings[1].view.field = "normal-velocity";
  CHECK_THROWS_WITH(app::shared_legend(both), Catch::Contains("'tension'") && Catch::Contains("'normal-velocity'"));
  CHECK_THROWS_WITH(app::parse_scene("[flow]\nkind = \"none\"\n[time]\nend = 1\n[[vesicle]]\nshape = \"sphere\"\n"
                                     "[view]\nfield_range = \"shard\"\n",
                                     "s.toml", "."),
                    Catch::Contains("did you mean 'shared'?"));
}

TEST_CASE("dots mark what is below zero: a range that is not about zero has none") {
  const auto mirrored = [](const std::string& range) {
    return legend_of("normal-velocity", 1, "field_range = " + range + "\ncolour_map = \"blue-red\"\n").mirrored;
  };
  CHECK(mirrored("[-0.1, 0.1]"));
  CHECK_FALSE(mirrored("[-0.03, 0.08]"));
  CHECK_FALSE(mirrored("[0.01, 0.08]"));
}

namespace {

/// The bar of a still at the end, or of the movie, of a prolate in shear.
render::Legend bar_of(const std::string& range, bool still) {
  const support::TemporaryFolder folder;
  const app::Settings settings = app::parse_scene(R"([flow]
kind = "shear"
[time]
end = 1
step = 0.1
[[vesicle]]
shape = "prolate"
reduced_volume = 0.85
order = 6
[view]
style = "field"
field_range = )" + range + "\n",
                                                  "s.toml", ".");
  const std::string file = (folder / "t.h5").string();
  sim::SimulationOptions options;
  options.trajectory = file;
  sim::simulate(settings.scene, options, {});
  const sim::TrajectoryReader reader(file);
  const sim::State last = reader.state(reader.count() - 1);
  return app::plan_painting(reader, {0, reader.count() - 1}, settings, 1, still ? &last : nullptr).legend.value();
}

/// One vesicle in a fluid at rest, in any unit: what its field is painted on.
render::Legend at_rest(const std::string& field, double radius, const std::string& shape) {
  const support::TemporaryFolder folder;
  const app::Settings settings = app::parse_scene(R"([flow]
kind = "none"
[time]
end = )" + std::to_string(0.2 * radius * radius) +
                                                      "\nstep = " + std::to_string(0.1 * radius * radius) + R"(
[[vesicle]]
order = 8
shape = ")" + shape + "\"\nradius = " + std::to_string(radius) +
                                                      "\n[view]\nstyle = \"field\"\nfield = \"" + field + "\"\n",
                                                  "s.toml", ".");
  const std::string file = (folder / "t.h5").string();
  sim::SimulationOptions options;
  options.trajectory = file;
  sim::simulate(settings.scene, options, {});
  const sim::TrajectoryReader reader(file);
  return app::plan_painting(reader, {0, reader.count() - 1}, settings, radius).legend.value();
}

}  // namespace

TEST_CASE("the bar has a head where values lie beyond a range that was given, and only there") {
  // The tension at the end lies between some 90 and 270.
  const render::Legend around = bar_of("[50, 400]", true), within = bar_of("[120, 180]", true),
                       below = bar_of("[-1, 0]", true);
  CHECK_FALSE(around.below);
  CHECK_FALSE(around.above);
  CHECK(within.below);
  CHECK(within.above);
  CHECK_FALSE(below.below);
  CHECK(below.above);
  CHECK(bar_of("[-1, 0]", false).above);  // of the movie
}

TEST_CASE(
    "a still has the range of its own values, and a field with a sign is about zero on one map, whatever they are") {
  const render::Legend still = bar_of("[]", true), movie = bar_of("[]", false);
  // The tension at the end lies between some 90 and 270.
  CHECK(still.high >= 250);
  CHECK(still.high <= 300);
  CHECK(movie.high >= still.high);
  for (const render::Legend& legend : {still, movie}) {
    CHECK(legend.low == -legend.high);
    CHECK(legend.mirrored);
    CHECK(legend.colours == render::colour_table(render::find_colour_map("blue-red")));
  }
  CHECK(legend_of("membrane-speed", 1).colours == render::colour_table(render::find_colour_map("viridis")));
}

TEST_CASE("what happens at the start of a movie alone does not set its range, and the bar says that it lies beyond") {
  const support::TemporaryFolder folder;
  // A slender prolate relaxes: its membrane is soon almost at rest.
  const app::Settings settings = app::parse_scene(R"([flow]
kind = "none"
[time]
end = 8
step = 0.2
[[vesicle]]
shape = "prolate"
reduced_volume = 0.7
bending_modulus = 1
order = 8
[view]
style = "field"
field = "membrane-speed"
)",
                                                  "s.toml", ".");
  const std::string file = (folder / "t.h5").string();
  sim::SimulationOptions options;
  options.trajectory = file;
  sim::simulate(settings.scene, options, {});
  const sim::TrajectoryReader reader(file);
  std::vector<std::int64_t> all;
  for (std::int64_t k = 0; k < reader.count(); ++k) all.push_back(k);
  const auto still_of = [&](std::int64_t k) {
    const sim::State state = reader.state(k);
    return app::plan_painting(reader, all, settings, 1, &state).legend.value();
  };
  const render::Legend movie = app::plan_painting(reader, all, settings, 1).legend.value();
  const render::Legend first = still_of(0), after = still_of(reader.count() / 10);
  CHECK(movie.high <= after.high);
  CHECK(movie.high < first.high / 1.5);
  CHECK(movie.above);
}

TEST_CASE("a field that vanishes up to rounding has a range of its natural size, in any unit") {
  for (const double radius : {1.0, 100.0})
    for (const char* field : {"tension", "membrane-speed", "normal-velocity", "bending-force"}) {
      INFO(field << ", radius " << radius);
      const render::Legend legend = at_rest(field, radius, "sphere");
      // About zero, or about the field's one value; a field that cannot be negative begins at zero.
      if (std::string_view(field) == "membrane-speed")
        CHECK(legend.low == 0);
      else
        CHECK(legend.low < 0);
      CHECK(legend.high - legend.low > 0.9e-6);
    }
  const render::Legend curvature = at_rest("mean-curvature", 100, "sphere");
  CHECK(curvature.low < 1);
  CHECK(curvature.high > 1);
}

TEST_CASE("a fluid at rest has no streamlines and one colour, in any unit") {
  for (const double radius : {1.0, 1e-6, 1e6}) {
    INFO("radius " << radius);
    const support::TemporaryFolder folder;
    const app::Settings settings = app::parse_scene(fmt::format(R"([flow]
kind = "none"
[time]
end = {0}
step = {0}
[[vesicle]]
order = 6
radius = {1}
bending_modulus = {2}
)",
                                                                0.1, radius, radius * radius * radius),
                                                    "s.toml", ".");
    const std::string file = (folder / "t.h5").string();
    sim::SimulationOptions options;
    options.trajectory = file;
    sim::simulate(settings.scene, options, {});
    const sim::TrajectoryReader reader(file);
    const sim::State state = reader.state(reader.count() - 1);
    sim::Plans plans;
    render::FigureParameters parameters;
    parameters.spacing = 0.4;
    const render::FlowPicture flow =
        app::flow_picture(plans, settings.scene, state, app::flow_request(plans, state, parameters, radius));
    CHECK(flow.lines.empty());
    CHECK(flow.speed.size() > 0);
    CHECK(flow.speed.cwiseAbs().maxCoeff() == 0);
  }
}
