// Sweeps: the points of a grid, shares of the work, and the command as a user meets it.
#include "app/base/share.h"
#include "app/sweep/grid.h"
#include "desk.h"
#include "tests/support/catch.h"

#include <cstdlib>
#include <map>

using app::read_axis;
using Catch::Contains;
using commands::Desk;
using support::Outcome;
using Words = std::vector<std::string>;

namespace {

std::string complaint(const std::string& axis) {
  try {
    read_axis(axis);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

/// The variables of schedulers, given for a scope and taken away after it.
struct Environment {
  explicit Environment(const std::map<std::string, std::string>& given) {
    for (const char* name : names) ::unsetenv(name);
    for (const auto& [name, value] : given) ::setenv(name.c_str(), value.c_str(), 1);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  ~Environment() {
    for (const char* name : names) ::unsetenv(name);
  }
  static constexpr const char* names[] = {"SLURM_ARRAY_TASK_ID",
                                          "SLURM_ARRAY_TASK_COUNT",
                                          "SLURM_ARRAY_TASK_MIN",
                                          "OMPI_COMM_WORLD_RANK",
                                          "OMPI_COMM_WORLD_SIZE",
                                          "PMI_RANK",
                                          "PMI_SIZE",
                                          "SLURM_PROCID",
                                          "SLURM_STEP_NUM_TASKS",
                                          "SLURM_ARRAY_TASK_MAX",
                                          "SLURM_ARRAY_TASK_STEP"};
};

const std::string quick = R"(title = "quick"
[flow]
kind = "shear"
[time]
end = 0.4
[[vesicle]]
shape = "prolate"
reduced_volume = 0.9
order = 4
[numerics]
tail_warning = 1.0
)";

}  // namespace

TEST_CASE("ranges have the values that arithmetic gives them, both ends included", "[sweep]") {
  CHECK(read_axis("a.b=1:12:1").values.size() == 12);
  CHECK(read_axis("a.b=0:0.5:0.1").values == Words{"0", "0.1", "0.2", "0.3", "0.4", "0.5"});
  CHECK(read_axis("a.b=3:1:-1").values == Words{"3", "2", "1"});
  CHECK(read_axis("a.b=1:2:0.6").values == Words{"1", "1.6"});
  CHECK(read_axis("a.b=1:1000:*10").values == Words{"1", "10", "100", "1000"});
  CHECK(read_axis("a.b=1e-3:1e-5:*0.1").values == Words{"0.001", "0.0001", "1e-05"});
  CHECK(read_axis("a.b=2:2:1").values == Words{"2"});
  CHECK(read_axis("a.b=prolate, 1:2:1,[1,0,0],\"x,y\"").values == Words{"prolate", "1", "2", "[1,0,0]", "\"x,y\""});
}

TEST_CASE("ranges without an end and values without a meaning are refused", "[sweep]") {
  CHECK_THAT(complaint("a.b"), Contains("is not KEY=VALUES"));
  CHECK_THAT(complaint("a.b=1:2"), Contains("'1:2' is no range"));
  CHECK_THAT(complaint("a.b=1:2:-1"), Contains("never gets from 1 to 2"));
  CHECK_THAT(complaint("a.b=1:2:0"), Contains("never gets from 1 to 2"));
  CHECK_THAT(complaint("a.b=0:2:*2"), Contains("passes zero"));
  CHECK_THAT(complaint("a.b=1:1e9:1"), Contains("more than 10000"));
  CHECK_THAT(complaint("a.b=1:3:1,2"), Contains("2 comes twice"));
  CHECK_THAT(complaint("a.b=1,,2"), Contains("a value is missing"));
}

TEST_CASE("a grid has all combinations once, each with a name of its own", "[sweep]") {
  const std::vector<app::SweepAxis> axes{read_axis("vesicle.0.radius=1,2"), read_axis("vesicle.1.radius=1,2,3"),
                                         read_axis("vesicle.shape=prolate,oblate")};
  const std::vector<app::SweepPoint> points = points_of(axes);
  CHECK(points.size() == 12);
  std::set<std::vector<std::string>> values;
  std::set<std::string> names;
  for (const app::SweepPoint& point : points) {
    values.insert(point.values);
    names.insert(point.name);
  }
  CHECK(values.size() == 12);
  CHECK(names.size() == 12);
  CHECK(points[3].name == "vesicle.0.radius-1_vesicle.1.radius-2_shape-oblate");
  const std::vector<app::SweepPoint> alike = app::points_of({read_axis("a.b=\"x y\",\"x/y\"")});
  const std::vector<app::SweepPoint> turned = app::points_of({read_axis("a.b=\"x/y\",\"x y\"")});
  CHECK(alike[0].name == turned[1].name);  // whatever their order
  CHECK(alike[0].name != alike[1].name);
  CHECK_THROWS_WITH(app::points_of({axes[0], axes[0]}), Contains("is there twice"));
  CHECK_THROWS_WITH(app::points_of({read_axis("a.b=1:200:1"), read_axis("a.c=1:200:1")}), Contains("at most 10000"));
}

TEST_CASE("the share of the work is that of the array's task and of the rank", "[sweep]") {
  const auto share = [](const std::map<std::string, std::string>& given) {
    const Environment environment(given);
    try {
      const app::Share found = app::share_of_environment();
      return std::to_string(found.index) + "/" + std::to_string(found.count);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
  };
  const std::map<std::string, std::string> task{
      {"SLURM_ARRAY_TASK_ID", "6"}, {"SLURM_ARRAY_TASK_COUNT", "4"}, {"SLURM_ARRAY_TASK_MIN", "4"}};
  const std::map<std::string, std::string> rank{{"OMPI_COMM_WORLD_RANK", "1"}, {"OMPI_COMM_WORLD_SIZE", "3"}};
  CHECK_THAT(share({}), Contains("neither a rank"));
  CHECK(share(task) == "2/4");
  CHECK(share(rank) == "1/3");
  CHECK(share({{"PMI_RANK", "0"}, {"PMI_SIZE", "2"}}) == "0/2");
  CHECK(share({{"SLURM_PROCID", "1"}, {"SLURM_STEP_NUM_TASKS", "2"}}) == "1/2");
  std::map<std::string, std::string> both = task;
  both.insert(rank.begin(), rank.end());
  CHECK(share(both) == "7/12");
  std::map<std::string, std::string> array{{"SLURM_ARRAY_TASK_ID", "9"},
                                           {"SLURM_ARRAY_TASK_COUNT", "3"},
                                           {"SLURM_ARRAY_TASK_MIN", "1"},
                                           {"SLURM_ARRAY_TASK_MAX", "9"},
                                           {"SLURM_ARRAY_TASK_STEP", "4"}};
  CHECK(share(array) == "2/3");
  array["SLURM_ARRAY_TASK_STEP"] = "1";  // 1,2,9
  CHECK_THAT(share(array), Contains("not evenly spaced"));
}

TEST_CASE("a sweep makes the trajectories that simulate makes, however it is divided, and one table", "[sweep]") {
  const Desk desk(quick);
  const Words how{"--vary", "vesicle.viscosity_contrast=1,5", "--vary", "vesicle.reduced_volume=0.8,0.9", "-q"};
  const auto sweep = [&](const std::string& folder, const Words& more) {
    Words words{"sweep", desk.file("s.toml"), "-o", desk.file(folder)};
    words.insert(words.end(), how.begin(), how.end());
    words.insert(words.end(), more.begin(), more.end());
    return desk(words);
  };
  REQUIRE(sweep("a", {"-j", "2"}).status == 0);
  REQUIRE(sweep("b", {"--shard", "1/3"}).status == 0);
  CHECK(!std::filesystem::exists(desk.file("b/sweep.csv")));
  REQUIRE(sweep("b", {}).status == 0);
  const std::string run = "viscosity_contrast-5_reduced_volume-0.9/trajectory.h5";
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-q", "-o", desk.file("alone.h5"), "--set",
                "vesicle.viscosity_contrast=5", "--set", "vesicle.reduced_volume=0.9"})
              .status == 0);
  const std::string alone = support::read_file(desk.file("alone.h5"));
  CHECK(support::read_file(desk.file("a/" + run)) == alone);
  CHECK(support::read_file(desk.file("b/" + run)) == alone);
  const std::string table = support::read_file(desk.file("a/sweep.csv"));
  CHECK(std::count(table.begin(), table.end(), '\n') == 5);
  CHECK_THAT(table, Contains("\n5,0.9,0,finished,0.4,untold"));
  CHECK(support::read_file(desk.file("b/sweep.csv")) == table);
  CHECK_THAT(support::read_file(desk.file("a/sweep.md")), Contains("--vary 'vesicle.viscosity_contrast=1,5'"));
  CHECK(std::filesystem::exists(desk.file("a/phase-diagram.pdf")));
  // Again: nothing is simulated, the files are the program's own.
  CHECK(sweep("a", {}).status == 0);
  const Outcome other =
      desk({"sweep", desk.file("s.toml"), "-o", desk.file("a"), "--vary", "vesicle.viscosity_contrast=1,5", "--vary",
            "vesicle.reduced_volume=0.8,0.9", "--set", "flow.rate=2"});
  CHECK(other.status == 1);
  CHECK_THAT(other.err, Contains("belongs to another scene: flow.rate is 1.0 there and 2.0 here"));
}

TEST_CASE("a run of a sweep that stops is told and keeps its place in the table", "[sweep]") {
  const Desk desk(quick);
  // A value that the scene refuses: nothing is simulated at all.
  const Outcome bad =
      desk({"sweep", desk.file("s.toml"), "-o", desk.file("o"), "--vary", "vesicle.reduced_volume=0.9,2"});
  CHECK(bad.status == 1);
  CHECK_THAT(bad.err, Contains("--vary vesicle.reduced_volume=2: 'reduced_volume' must be above 0, at most 1, not 2"));
  CHECK(desk.names().empty());
  const Outcome stopped = desk({"sweep", desk.file("s.toml"), "-o", desk.file("o"), "-j", "2", "--vary",
                                "flow.rate=1,1e5", "--set", "time.step=0.1", "--set", "numerics.step_retries=0"});
  CHECK(stopped.status == 1);
  CHECK_THAT(stopped.err, Contains("rate-1e5 stopped at t = 0"));
  CHECK_THAT(support::read_file(desk.file("o/sweep.csv")), Contains("\n1e5,0,stopped,0,"));
}

TEST_CASE("scenes that a sweep would make twice are refused, and one that cannot start keeps its place", "[sweep]") {
  const Desk desk(quick);
  const auto said = [&](Words words) {
    words.insert(words.begin(), {"sweep", desk.file("s.toml"), "-o", desk.file("o")});
    return desk(words).err;
  };
  CHECK_THAT(said({"--vary", "vesicle.viscosity_contrast=1,1.0"}), Contains("have one scene"));
  CHECK_THAT(said({"--vary", "flow.0.rate=1,2", "--vary", "flow.rate=1,3"}), Contains("one key overrides another"));
  CHECK_THAT(said({"--vary", "flow.rate=1,2", "--set", "flow.rate=3"}), Contains("are the same key"));
  CHECK_THAT(said({"--vary", "flow.rate=1,2", "--quantities", "shape-distance"}), Contains("is for converge"));
  CHECK(desk.names().empty());
  // A second vesicle that overlaps the first at one of two places.
  support::write_file(desk.file("s.toml"),
                      quick + "[[vesicle]]\nshape = \"prolate\"\nreduced_volume = 0.9\norder = 4\n");
  for (const char* jobs : {"1", "2"}) {
    const Outcome bad = desk({"sweep", desk.file("s.toml"), "-o", desk.file(jobs), "-j", jobs, "--vary",
                              "vesicle.1.center=[0,0,0.1],[0,0,5]"});
    CHECK(bad.status == 1);
    CHECK_THAT(bad.err, Contains("overlap") && Contains("1 of 2 runs could not be made"));
    const std::string table = support::read_file(desk.file(std::string(jobs) + "/sweep.csv"));
    CHECK_THAT(table, Contains("missing") && Contains("vesicles 0 and 1 overlap") && Contains("finished"));
  }
}

TEST_CASE("a forced sweep replaces what is there of another scene, however many processes there are", "[sweep]") {
  const Desk desk(quick);
  const auto sweep = [&](const std::string& folder, const Words& more) {
    Words words{
        "sweep", desk.file("s.toml"), "-q", "-o", desk.file(folder), "--vary", "vesicle.viscosity_contrast=1,5"};
    words.insert(words.end(), more.begin(), more.end());
    return desk(words).status;
  };
  REQUIRE(sweep("a", {}) == 0);
  REQUIRE(sweep("b", {"--set", "flow.rate=2"}) == 0);
  REQUIRE(sweep("a", {"--set", "flow.rate=2", "--force", "-j", "2"}) == 0);
  CHECK(support::read_file(desk.file("a/sweep.csv")) == support::read_file(desk.file("b/sweep.csv")));
}
