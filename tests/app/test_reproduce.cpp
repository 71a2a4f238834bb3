// The tables and figures of the paper, at their quickest: each runs, writes its files, and says what is true.
#include "app/reproduce/reproduce_items.h"
#include "app/scene/scene_file.h"
#include "app/scene/scene_text.h"
#include "sim/sphere/basis.h"
#include "sim/surface/shapes.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

#include <cmath>
#include <set>

using Catch::Contains;
namespace fs = std::filesystem;

namespace {

struct Bench {
  support::TemporaryFolder folder;
  app::Options options;
  app::ResultFiles files{{}, false};
  app::Progress progress{"test", true};
  Bench() {
    options.output = folder.path();
    options.quiet = true;
    options.quick = true;
  }
  app::Effort effort() { return {true, false, options, files, progress}; }
};

double leading_number(const std::string& cell) { return std::stod(cell); }

}  // namespace

TEST_CASE("every item of the paper runs quickly and writes its files", "[reproduce]") {
  const std::string item =
      GENERATE("table2", "table3", "table4", "table5", "fig2", "fig3", "fig4", "fig5", "fig6", "tank-treading");
  const support::TemporaryFolder folder;
  const std::string out = (folder / "r").string();
  const support::Outcome outcome = support::run(folder, {TANKTREAD_PROGRAM, "reproduce", item, "--quick", "-o", out});
  INFO(item << ": " << outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.err, !Contains("stopped"));
  CHECK_THAT(outcome.out, Contains("paper") || Contains("Figure"));
  std::vector<std::string> endings{".md", ".csv"};
  if (!item.starts_with("table")) endings.insert(endings.end(), {".png", ".svg", ".pdf"});
  for (const std::string& ending : endings) {
    INFO(ending);
    CHECK(fs::file_size(fs::path(out) / (item + ending)) > 30);
  }
  const std::string page = support::read_file(fs::path(out) / (item + ".md"));
  CHECK_THAT(page, Contains("`tanktread reproduce " + item + " --quick`"));
  for (const auto& entry : fs::directory_iterator(out)) CHECK(entry.path().extension() != ".tmp");
}

TEST_CASE("an unknown item is refused with the nearest known one", "[reproduce]") {
  const support::TemporaryFolder folder;
  const support::Outcome wrong = support::run(folder, {TANKTREAD_PROGRAM, "reproduce", "tabel3"});
  CHECK(wrong.status == 1);
  CHECK_THAT(wrong.err, Contains("table3"));
  const support::Outcome none = support::run(folder, {TANKTREAD_PROGRAM, "reproduce"});
  CHECK(none.status == 0);
  CHECK_THAT(none.out, Contains("table2") && Contains("fig6"));
}

TEST_CASE("a reproduction replaces its own files and nobody else's", "[reproduce]") {
  const support::TemporaryFolder folder;
  const fs::path out = folder / "r";
  const auto reproduce = [&](std::vector<std::string> more) {
    std::vector<std::string> words{TANKTREAD_PROGRAM, "reproduce", "fig3", "--quick", "-q", "-o", out.string()};
    words.insert(words.end(), more.begin(), more.end());
    return support::run(folder, words);
  };
  fs::create_directories(out);
  support::write_file(out / "fig3.csv", "mine");
  const support::Outcome refused = reproduce({});
  CHECK(refused.status == 1);
  CHECK_THAT(refused.err, Contains("fig3.csv") && Contains("--force"));
  CHECK(support::read_file(out / "fig3.csv") == "mine");
  REQUIRE(reproduce({"--force"}).status == 0);
  const std::string table = support::read_file(out / "fig3.csv");
  CHECK(table != "mine");
  CHECK(reproduce({}).status == 0);
  CHECK(support::read_file(out / "fig3.csv") == table);
  // A trajectory of somebody else, which no list can name.
  support::write_file(out / "fig6.h5", "mine");
  const support::Outcome other =
      support::run(folder, {TANKTREAD_PROGRAM, "reproduce", "fig6", "--quick", "-q", "-o", out.string()});
  CHECK(other.status == 1);
  CHECK_THAT(other.err, Contains("fig6.h5"));
  CHECK(support::read_file(out / "fig6.h5") == "mine");
}

TEST_CASE("an interrupted reproduction says what it leaves", "[reproduce]") {
  const support::TemporaryFolder folder;
  const std::string out = (folder / "r").string();
  const pid_t child = support::start(folder, {TANKTREAD_PROGRAM, "reproduce", "fig6", "--quick", "-q", "-o", out});
  const bool simulating = support::wait_for(folder / "r/fig6.h5");
  kill(child, SIGINT);
  const support::Outcome outcome = support::finish(folder, child);
  REQUIRE(simulating);
  CHECK(outcome.status == 130);
  CHECK_THAT(outcome.err,
             Contains("interrupted in fig6; none of its tables and figures is written, the simulation is in '" + out +
                      "/fig6.h5' as far as it went"));
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(out)) names.insert(entry.path().filename().string());
  CHECK(names == std::set<std::string>{".tanktread.files", "fig6.h5", "fig6.toml"});
}

TEST_CASE("the double layer converges as required", "[reproduce]") {
  Bench bench;
  const app::Report report = app::reproduce_double_layer(bench.effort());
  const auto& rows = report.tables.at(0).rows;
  REQUIRE(rows.size() == 2);  // p = 8, 12
  CHECK(leading_number(rows[0][1]) <= 1e-3);
  CHECK(leading_number(rows[0][2]) <= 2 * 8.1e-6);
  CHECK(leading_number(rows[0][3]) <= 2 * 1.0e-2);
  CHECK(leading_number(rows[0][4]) <= 4e-3);
  CHECK(leading_number(rows[1][2]) <= 2 * 3.7e-8);
  CHECK(leading_number(rows[1][3]) <= 2 * 2.0e-3);
}

TEST_CASE("P_19,2 and P_64,1 are nearly P_4,1 on seven nodes", "[reproduce]") {
  // By an independent evaluation: correlations 1 - 1.63001e-3 and 1 - 1.58741e-3 in the rule's inner product.
  Bench bench;
  const app::Report report = app::reproduce_aliasing(bench.effort());
  const auto& deviations = report.tables.at(0).rows.back();
  CHECK(leading_number(deviations[2]) == Approx(std::sqrt(1 - std::pow(1 - 1.63001e-3, 2))).epsilon(2e-3));
  CHECK(leading_number(deviations[3]) == Approx(std::sqrt(1 - std::pow(1 - 1.58741e-3, 2))).epsilon(2e-3));
}

TEST_CASE("the three-lobed shape has exactly the radius it names", "[reproduce]") {
  sim::VesicleParameters v = app::reference_shapes().at(3).parameters;
  v.order = 8;
  v.axis = sim::Vec3::UnitZ();
  const sim::Coefficients x = sim::initial_position(v);
  sim::Matrix directions(2, 3);
  directions << 1, 0, 0, 0.5, std::sqrt(0.75), 0;  // on the equator: cos 3f = 1 and -1
  const sim::Matrix at = sim::sample_points(x, directions);
  CHECK(at.row(0).norm() / at.row(1).norm() == Approx(1.3 / 0.7).epsilon(1e-12));
}

TEST_CASE("the scenes of the figures are those in scenes/", "[reproduce]") {
  const fs::path scenes = TANKTREAD_SCENES;
  const app::Settings file = app::read_scene(scenes / "two-vesicles.toml");
  const app::Settings own = app::parse_scene(app::two_vesicles_scene, "fig6", ".");
  CHECK(app::physics_hash(file.scene) == app::physics_hash(own.scene));
}

TEST_CASE("tables are written for people, Markdown and spreadsheets", "[reproduce]") {
  const app::TextTable table{"A caption.", {"ν", "b"}, {{"1", "x|y"}, {"22", "p, q"}}};
  CHECK(app::plain_text(table) == "A caption.\n  ν   b\n  1   x|y\n  22  p, q\n");
  CHECK(app::markdown_text(table) == "A caption.\n\n| ν | b |\n|---|---|\n| 1 | x\\|y |\n| 22 | p, q |\n");
  CHECK(app::csv_text(table) == "ν,b\n1,x|y\n22,\"p, q\"\n");
  CHECK(app::scientific(8.13e-6) == "8.1e-6");
  CHECK(app::scientific(0.21) == "2.1e-1");
}
