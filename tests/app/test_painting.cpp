// The range of a field that was not given follows the values of the whole movie.
#include "app/fields.h"
#include "app/pictures.h"
#include "app/scene_file.h"

#include "sim/simulate.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

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
center = [)" + std::to_string(2 + gap) + ", 0, 0]\n[view]\nstyle = \"field\"\nfield = \"" + field + "\"\n" + view;
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

TEST_CASE("dots mark what is below zero: a range that is not about zero has none") {
  const auto mirrored = [](const std::string& range) {
    return legend_of("normal-velocity", 1, "field_range = " + range + "\ncolour_map = \"blue-red\"\n").mirrored;
  };
  CHECK(mirrored("[-0.1, 0.1]"));
  CHECK_FALSE(mirrored("[-0.03, 0.08]"));
  CHECK_FALSE(mirrored("[0.01, 0.08]"));
}
