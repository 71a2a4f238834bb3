// [start]: what a scene takes from the trajectory that it starts from, and what is refused.
#include "app/scene/scene_file.h"
#include "app/scene/scene_text.h"
#include "sim/trajectory/trajectory.h"
#include "tests/app/desk.h"
#include "tests/support/catch.h"

using Catch::Contains;
using commands::Desk;

namespace {

const std::string start = "[start]\nfrom = \"a.h5\"\n";
const std::string cell = "[cell]\nsize = [4, 4, 4]\n";

/// The scene without its vesicle.
std::string flow_only() {
  const std::string& all = commands::scene;
  return all.substr(0, all.find("[[vesicle]]"));
}

void simulate(const Desk& desk, const std::string& scene, const std::string& out, std::vector<std::string> more = {}) {
  support::write_file(desk.file("t.toml"), scene);
  more.insert(more.begin(), {"simulate", desk.file("t.toml"), "-o", desk.file(out), "-q"});
  const support::Outcome outcome = desk(more);
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
}

std::string refused(const Desk& desk, const std::string& scene, std::vector<std::string> more = {}) {
  support::write_file(desk.file("t.toml"), scene);
  more.insert(more.begin(), {"simulate", desk.file("t.toml"), "-o", desk.file("none.h5"), "-q"});
  const support::Outcome outcome = desk(more);
  CHECK(outcome.status == 1);
  CHECK(outcome.out.empty());
  CHECK(!std::filesystem::exists(desk.file("none.h5")));
  return outcome.err;
}

}  // namespace

TEST_CASE("a run that starts from a file needs that file only to start, and is resumed with the same bytes",
          "[start]") {
  const Desk desk;
  simulate(desk, commands::scene, "a.h5");
  const std::vector<std::string> from{"--set", "start.from=a.h5"};
  simulate(desk, commands::scene, "whole.h5", from);
  simulate(desk, commands::scene, "b.h5", {from[0], from[1], "--steps", "2"});
  simulate(desk, flow_only() + start, "lean.h5");  // the vesicle too is that of the file
  simulate(desk, commands::scene, "run/trajectory.h5", from);
  std::filesystem::remove(desk.file("a.h5"));
  simulate(desk, commands::scene, "b.h5", {from[0], from[1], "--resume"});
  CHECK(support::read_file(desk.file("b.h5")) == support::read_file(desk.file("whole.h5")));
  simulate(desk, flow_only() + start, "lean.h5", {"--resume", "--set", "time.end=0.6"});
  CHECK(sim::TrajectoryReader(desk.file("lean.h5")).time(6) == 0.6);
  CHECK_THAT(refused(desk, commands::scene, from), Contains("--set start.from=a.h5") && Contains("there is no file '"));
  CHECK(desk({"info", desk.file("whole.h5")}).status == 0);
}

TEST_CASE("the resolved scene says in which state a run starts, and is the same scene when it is read", "[start]") {
  const Desk desk;
  simulate(desk, commands::scene + cell, "a.h5");
  support::write_file(desk.file("t.toml"), flow_only() + start + cell);
  const app::Settings first = app::read_scene(desk.file("t.toml"));
  CHECK(first.scene.start.time == 0.5);
  CHECK(std::abs(*first.scene.start.strain) == Approx(0.5));  // it leans as far to either side
  CHECK(first.scene.start.checksum->size() == 16);
  REQUIRE(first.scene.vesicles.size() == 1);
  CHECK(first.scene.vesicles[0].reduced_volume == 0.9);
  const std::string resolved = app::write_scene(first);
  const app::Settings second = app::parse_scene(resolved, "resolved", "/nowhere");
  CHECK(app::write_scene(second) == resolved);
  CHECK(app::physics_differences(first.scene, second.scene).empty());
  const support::Outcome plan = desk({"simulate", desk.file("t.toml"), "--dry-run", "--set", "start.time=0.2"});
  CHECK_THAT(plan.out, Contains("# starts in the state of '") && Contains("at time 0.2\n"));
}

TEST_CASE("a start is refused with the place of the key that does not fit its file", "[start]") {
  const Desk desk;
  simulate(desk, commands::scene, "a.h5");
  const std::string good = commands::scene + start;
  CHECK_THAT(refused(desk, commands::scene + "[start]\nform = \"a.h5\"\n"),
             Contains("t.toml:15:1") && Contains("did you mean 'from'"));
  CHECK_THAT(refused(desk, commands::scene + "[start]\ntime = 1\n"),
             Contains("t.toml:15:8") && Contains("'time' is of a start 'from' a file"));
  CHECK_THAT(refused(desk, commands::scene + "[start]\nfrom = \"\"\n"), Contains("must be the name of a trajectory"));
  CHECK_THAT(refused(desk, commands::scene + "[start]\nfrom = \"t.toml\"\n"),
             Contains("t.toml:15:8") && Contains("t.toml'"));
  CHECK_THAT(refused(desk, good + "time = 0.33\n"), Contains("t.toml:16:8") && Contains("at 0.3 and 0.4"));
  CHECK_THAT(refused(desk, good + "checksum = \"0\"\n"), Contains("is another one: its checksum is "));
  CHECK_THAT(refused(desk, good + "strain = 0.1\n"), Contains("t.toml:16:10") && Contains("only a periodic [cell]"));
  CHECK_THAT(refused(desk, good + cell), Contains("t.toml:17:8") && Contains("are in unbounded fluid"));
  CHECK_THAT(refused(desk, good + "[[placement]]\ncount = 3\n"), Contains("the scene has 3 vesicles, '"));
  CHECK_THAT(refused(desk, flow_only() + start + "[[placement]]\ncount = 3\n"), Contains("leave [[placement]] out"));
  CHECK_THAT(refused(desk, good, {"--set", "vesicle.radius=2"}), Contains("vesicle 0 has the area 50.26"));
  const support::Outcome itself = desk({"simulate", desk.file("t.toml"), "-o", desk.file("a.h5"), "--force"});
  CHECK(itself.status == 1);
  CHECK_THAT(itself.err, Contains("would be replaced by the run that starts from it"));

  simulate(desk, commands::scene + cell, "c.h5");
  const std::string in_cell = commands::scene + "[start]\nfrom = \"c.h5\"\n";
  CHECK_THAT(refused(desk, in_cell), Contains("t.toml:15:8") && Contains("[cell] with size = [4, 4, 4]"));
  CHECK_THAT(refused(desk, in_cell + "[cell]\nsize = [4, 4, 5]\n"),
             Contains("t.toml:17:8") && Contains("of size [4, 4, 4], not [4, 4, 5]"));
  CHECK_THAT(refused(desk, in_cell + "time = 0.2\nstrain = 0.1\n" + cell),
             Contains("t.toml:17:10") && Contains("has the strain 0.2 at time 0.2, not 0.1"));

  std::string damaged = support::read_file(desk.file("a.h5"));
  damaged.resize(damaged.size() / 2);
  support::write_file(desk.file("a.h5"), damaged);
  CHECK_THAT(refused(desk, good), Contains("t.toml:15:8") && Contains("a.h5'"));
}

TEST_CASE("a sweep whose runs start from a file is complete without the file", "[start]") {
  const Desk desk(commands::scene + start);
  simulate(desk, commands::scene, "a.h5");
  const std::vector<std::string> command{
      "sweep", desk.file("s.toml"), "-o", desk.file("study"), "-q", "--vary", "vesicle.viscosity_contrast=1,2"};
  CHECK(desk(command).status == 0);
  const std::string table = support::read_file(desk.file("study/sweep.csv"));
  std::filesystem::remove(desk.file("a.h5"));
  const support::Outcome again = desk(command);
  INFO(again.err);
  CHECK(again.status == 0);
  CHECK(support::read_file(desk.file("study/sweep.csv")) == table);
}
