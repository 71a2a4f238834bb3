// The program as a user meets it: exit statuses, messages, and what is left on the disk.
#include "desk.h"
#include "sim/core/digits.h"
#include "sim/trajectory/trajectory.h"
#include "tests/support/catch.h"

using Catch::Contains;
using commands::Desk;
using commands::scene;
using support::Outcome;
namespace fs = std::filesystem;

namespace {

std::string lengthened(const std::string& end) {
  std::string text = scene;
  return text.replace(text.find("end = 0.5"), 9, "end = " + end);
}

void check_same_states(const std::string& a, const std::string& b) {
  const sim::TrajectoryReader x(a), y(b);
  REQUIRE(x.count() == y.count());
  for (std::int64_t k = 0; k < x.count(); ++k) {
    const sim::State p = x.state(k), q = y.state(k);
    REQUIRE(p.time == q.time);
    REQUIRE(p.vesicles[0].position.values == q.vesicles[0].position.values);
    REQUIRE(p.vesicles[0].velocity.values == q.vesicles[0].velocity.values);
    REQUIRE(p.vesicles[0].tension.values == q.vesicles[0].tension.values);
    REQUIRE(p.vesicles[0].labels.values == q.vesicles[0].labels.values);
    REQUIRE(p.vesicles[0].tracers == q.vesicles[0].tracers);
  }
  const auto steps = x.steps(), others = y.steps();
  REQUIRE(steps.size() == others.size());
  for (std::size_t k = 0; k < steps.size(); ++k) REQUIRE(steps[k].vesicles[0].energy == others[k].vesicles[0].energy);
}

}  // namespace

TEST_CASE("run leaves trajectory, frames, movie and resolved scene, and a second run does nothing again",
          "[commands]") {
  const Desk desk;
  const Outcome first = desk({"run", desk.file("s.toml"), "-o", desk.file("out")});
  INFO(first.err);
  REQUIRE(first.status == 0);
  CHECK(first.err.empty());
  CHECK(fs::exists(desk / "out/trajectory.h5"));
  CHECK(fs::exists(desk / "out/scene.toml"));
  CHECK(fs::exists(desk / "out/frames/000005.png"));
  CHECK_FALSE(fs::exists(desk / "out/frames/000006.png"));
  CHECK_THAT(first.out, Contains("6 frames drawn, 0 kept"));
  const Outcome second = desk({"run", desk.file("s.toml"), "-o", desk.file("out")});
  CHECK(second.status == 0);
  CHECK_THAT(second.out, Contains("0 frames drawn, 6 kept") && Contains("finished before"));
  const Outcome restyled = desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "--set", "view.style=outline"});
  CHECK(restyled.status == 0);
  CHECK_THAT(restyled.out, Contains("6 frames drawn, 0 kept") && Contains("finished before"));
}

TEST_CASE("the same scene gives the same frames and movie twice, with one and two threads", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("a"), "-j", "1"}).status == 0);
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("b"), "-j", "2"}).status == 0);
  check_same_states(desk.file("a/trajectory.h5"), desk.file("b/trajectory.h5"));
  for (const char* name : {"frames/000000.png", "frames/000005.png", "movie.mp4"})
    if (fs::exists(desk.path() / "a" / name))
      CHECK(support::read_file(desk.path() / "a" / name) == support::read_file(desk.path() / "b" / name));
}

TEST_CASE("an output folder of another scene is refused without --force", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "--steps", "1", "-q"}).status == 0);
  const Outcome other = desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "--set", "vesicle.order=5"});
  CHECK(other.status == 1);
  CHECK_THAT(other.err, Contains("belongs to another scene") && Contains("--force"));
  CHECK(
      desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "--steps", "1", "--set", "vesicle.order=5", "--force"})
          .status == 0);
}

TEST_CASE("run does not overwrite the scene that it was given", "[commands]") {
  const Desk desk;
  support::write_file(desk / "scene.toml", "# mine\n" + scene);
  const Outcome outcome = desk({"run", desk.file("scene.toml"), "-o", desk.path().string(), "--steps", "1"});
  CHECK(outcome.status == 1);
  CHECK_THAT(outcome.err, Contains("would overwrite"));
  CHECK(support::read_file(desk / "scene.toml") == "# mine\n" + scene);
}

TEST_CASE("wrong scenes end with one sentence, status 1 and nothing written", "[commands]") {
  const Desk desk;
  for (const char* change :
       {"vesicle.oder=3", "vesicle.viscosity_contrast=-1", "vesicle.order=1", "vesicle.reduced_volume=1.5",
        "time.tolerance=1e-7", "flow.curvature=1", "view.size=[0, 10]", "view.size=[10]"}) {
    for (const char* command : {"run", "simulate"}) {
      const Outcome outcome = desk({command, desk.file("s.toml"), "-o", desk.file("x"), "--set", change});
      INFO(command << ' ' << change << ": " << outcome.err);
      CHECK(outcome.status == 1);
      CHECK(outcome.out.empty());
      CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
      CHECK(desk.names().empty());
    }
  }
  const Outcome missing = desk({"run", desk.file("none.toml"), "-o", desk.file("x")});
  CHECK(missing.status == 1);
  CHECK_THAT(missing.err, Contains("none.toml") && Contains("no such scene"));
  CHECK(desk.names().empty());
}

TEST_CASE("errors in a scene file name file, line and column", "[commands]") {
  std::string text = scene;
  text.replace(text.find("order = 6"), 9, "order = 1");
  const Desk desk(text);
  const Outcome outcome = desk({"run", desk.file("s.toml"), "-o", desk.file("x")});
  CHECK(outcome.status == 1);
  CHECK(outcome.err == "tanktread: " + desk.file("s.toml") + ":10:9: 'order' must be at least 2, at most 64, not 1\n");
}

TEST_CASE("unreadable trajectories end with one sentence and status 1", "[commands]") {
  const Desk desk;
  support::write_file(desk / "t.h5", "nonsense");
  const std::vector<std::vector<std::string>> commands{
      {"render", desk.file("t.h5"), "-o", desk.file("x")},
      {"export", desk.file("t.h5"), "--csv", desk.file("x")},
      {"figure", "overlay", desk.file("t.h5"), "-o", desk.file("x")},
      {"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "--resume"}};
  for (const auto& words : commands) {
    const Outcome outcome = desk(words);
    INFO(words[0] << ": " << outcome.err);
    CHECK(outcome.status == 1);
    CHECK_THAT(outcome.err, Contains("t.h5"));
    CHECK(desk.names() == std::set<std::string>{"t.h5"});
  }
  CHECK(support::read_file(desk / "t.h5") == "nonsense");
}

TEST_CASE("simulate refuses an existing file, continues it, and says when it is finished", "[commands]") {
  const Desk desk;
  const std::string file = desk.file("t.h5");
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", file, "--steps", "2"}).status == 0);
  const Outcome refused = desk({"simulate", desk.file("s.toml"), "-o", file});
  CHECK(refused.status == 1);
  CHECK_THAT(refused.err, Contains("--resume") && Contains("--force"));
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", file, "--resume"}).status == 0);
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("whole.h5")}).status == 0);
  check_same_states(file, desk.file("whole.h5"));
  const Outcome again = desk({"simulate", desk.file("s.toml"), "-o", file, "--resume"});
  CHECK(again.status == 0);
  CHECK_THAT(again.out, Contains("finished before"));
  const Outcome other = desk({"simulate", desk.file("s.toml"), "-o", file, "--resume", "--set", "flow.rate=2"});
  CHECK(other.status == 1);
  CHECK_THAT(other.err, Contains("another scene"));
  CHECK(desk.names() == std::set<std::string>{"t.h5", "whole.h5"});
}

TEST_CASE("a finished simulation goes on to a later end, and is then the one that went there at once", "[commands]") {
  std::string text = scene;
  // The steps do not depend on the end then: it is a saved time without rounding.
  text.replace(text.find("end = 0.5\nstep = 0.1"), 20, "end = 0.625\nstep = 0.125\nsave_every = 0.125");
  const Desk desk(text);
  const std::string file = desk.file("t.h5");
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("whole.h5"), "-q"}).status == 0);
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", file, "--set", "time.end=0.375", "-q"}).status == 0);
  REQUIRE(sim::TrajectoryReader(file).count() == 4);
  const Outcome on = desk({"simulate", desk.file("s.toml"), "-o", file, "--resume"});
  CHECK(on.status == 0);
  CHECK_THAT(on.out, Contains("6 states, to time 0.625"));
  const bool same = support::read_file(file) == support::read_file(desk / "whole.h5");
  CHECK(same);
  // A shorter one is not gone back to.
  const Outcome back = desk({"simulate", desk.file("s.toml"), "-o", file, "--resume", "--set", "time.end=0.4"});
  CHECK(back.status == 1);
  CHECK_THAT(back.err, Contains("beyond time.end = 0.4") && Contains("--force"));
}

TEST_CASE("a continued simulation saves at the multiples of save_every that it is given", "[commands]") {
  const Desk desk;
  const std::string file = desk.file("t.h5");
  const auto simulate = [&](const char* end, const char* every) {
    const Outcome outcome =
        desk({"simulate", desk.file("s.toml"), "-o", file, "--resume", "-q", "--set", "vesicle.order=4", "--set",
              std::string("time.end=") + end, "--set", std::string("time.save_every=") + every});
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
  };
  simulate("0.5", "0.2");
  simulate("0.9", "0.2");  // 0.5 was the end, no multiple
  simulate("1.5", "0.3");
  const sim::TrajectoryReader reader(file);
  const double times[] = {0, 0.2, 0.4, 0.5, 0.6, 0.8, 0.9, 1.2, 1.5};
  REQUIRE(reader.count() == 9);
  for (int k = 0; k < 9; ++k) CHECK(reader.time(k) == Approx(times[k]).epsilon(1e-14));
  CHECK(reader.damaged().empty());
  CHECK_THAT(reader.header().scene, Contains("end = 1.5") && Contains("save_every = 0.3"));
  CHECK(reader.steps().size() >= 15);  // each start takes some shorter ones
}

TEST_CASE("run goes on to a later end in the same folder", "[commands]") {
  const Desk desk;
  const auto run = [&](const char* end) {
    return desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "--set", std::string("time.end=") + end});
  };
  REQUIRE(run("0.2").status == 0);
  const Outcome longer = run("0.4");
  INFO(longer.err);
  CHECK(longer.status == 0);
  CHECK(sim::TrajectoryReader(desk.file("out/trajectory.h5")).count() == 5);
  CHECK(fs::exists(desk / "out/frames/000004.png"));
  CHECK_THAT(support::read_file(desk / "out/scene.toml"), Contains("end = 0.4"));
  const std::string scene_there = support::read_file(desk / "out/scene.toml");
  const Outcome shorter = run("0.3");
  CHECK(shorter.status == 1);
  CHECK_THAT(shorter.err, Contains("beyond time.end = 0.3"));
  CHECK(support::read_file(desk / "out/scene.toml") == scene_there);
}

TEST_CASE("a scene that is another one is told by the keys that differ, with both values", "[commands]") {
  const Desk desk;
  const std::string file = desk.file("t.h5");
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", file, "-q", "--steps", "1"}).status == 0);
  const Outcome other = desk({"simulate", desk.file("s.toml"), "-o", file, "--resume", "--set", "flow.rate=2", "--set",
                              "time.end=7", "--set", "numerics.label_order=30"});
  CHECK(other.status == 1);
  CHECK_THAT(
      other.err,
      Contains("belongs to another scene: flow.rate is 1.0 there and 2.0 here, time.end is 0.5 there and 7.0 here, "
               "numerics.label_order is \"auto\" there and 30 here; give another -o, or --force"));
  const Outcome more =
      desk({"simulate", desk.file("s.toml"), "-o", file, "--resume", "--set",
            "vesicle=[{shape=\"sphere\", order=6}, {shape=\"sphere\", center=[3.0, 0.0, 0.0], order=6}]"});
  CHECK(more.status == 1);
  CHECK_THAT(more.err, Contains("vesicle.0.shape is \"prolate\" there and \"sphere\" here") && Contains("more keys"));
}

TEST_CASE("a warning that was given is not given again after a resume: the bytes stay the same", "[commands]") {
  const Desk desk(
      "[flow]\nkind = \"none\"\n[time]\nend = 0.2\n[[vesicle]]\nshape = \"prolate\"\nreduced_volume = 0.85\norder = "
      "6\n");
  const auto simulate = [&](const char* name, std::vector<std::string> more) {
    std::vector<std::string> words{"simulate", desk.file("s.toml"), "-o",    desk.file(name),
                                   "-q",       "--resume",          "--set", "numerics.tail_warning=0.01"};
    words.insert(words.end(), more.begin(), more.end());
    REQUIRE(desk(words).status == 0);
  };
  simulate("a.h5", {});
  simulate("b.h5", {"--steps", "7"});
  simulate("b.h5", {});
  const sim::TrajectoryReader reader(desk.file("a.h5"));
  CHECK_FALSE((reader.notes().empty() && reader.header().warnings.empty()));
  const bool same = support::read_file(desk / "a.h5") == support::read_file(desk / "b.h5");
  CHECK(same);
}

TEST_CASE("zero steps evaluate the initial state only", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "--steps", "0"}).status == 0);
  const sim::TrajectoryReader reader(desk.file("t.h5"));
  CHECK(reader.count() == 1);
  CHECK(reader.steps().empty());
  CHECK(reader.state(0).vesicles[0].velocity.values.norm() > 0);
}

TEST_CASE("a simulation killed again and again and resumed equals an uninterrupted one", "[commands]") {
  const Desk desk(lengthened("12"));
  const std::string file = desk.file("t.h5");
  int kills = 0;
  for (int attempt = 0; attempt < 200; ++attempt) {
    std::vector<std::string> words{TANKTREAD_PROGRAM, "simulate", desk.file("s.toml"), "-o", file, "--resume", "-q"};
    const pid_t child = support::start(desk, words);
    usleep(static_cast<useconds_t>(30000 + 9000 * (attempt % 13)));
    kill(child, SIGKILL);
    const Outcome outcome = support::finish(desk, child);
    INFO(outcome.err);
    REQUIRE((outcome.status == 0 || outcome.status == -SIGKILL));
    if (outcome.status == 0) break;
    ++kills;
  }
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", file, "--resume"}).status == 0);
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("whole.h5")}).status == 0);
  INFO(kills << " kills");
  check_same_states(file, desk.file("whole.h5"));
}

TEST_CASE("Ctrl-C finishes the step, saves, and ends with status 130", "[commands]") {
  const Desk desk(lengthened("10000"));
  const std::string file = desk.file("t.h5");
  const pid_t child = support::start(desk, {TANKTREAD_PROGRAM, "simulate", desk.file("s.toml"), "-o", file});
  REQUIRE(support::wait_for(file));
  usleep(200000);
  kill(child, SIGINT);
  const Outcome outcome = support::finish(desk, child);
  CHECK(outcome.status == 130);
  CHECK_THAT(outcome.err, Contains("interrupted") && Contains("--resume"));
  CHECK(desk.names() == std::set<std::string>{"t.h5"});
  CHECK(sim::TrajectoryReader(file).damaged().empty());
}

TEST_CASE("a dry run prints a scene and writes nothing", "[commands]") {
  const Desk desk;
  const Outcome outcome =
      desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "--dry-run", "--set", "time.end=3"});
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.out, Contains("end = 3.0") && Contains("viscosity_contrast = 1.0"));
  CHECK(desk.names().empty());
}

TEST_CASE("export writes one row per saved state and vesicle under the promised header", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const Outcome outcome = desk({"export", desk.file("t.h5"), "--csv", "-"});
  REQUIRE(outcome.status == 0);
  CHECK(
      outcome.out.substr(0, outcome.out.find('\n')) ==
      "step,time,vesicle,area,volume,area_error,volume_error,reduced_volume,center_x,center_y,center_z,inclination_deg,"
      "axis_1,axis_2,axis_3,energy,velocity_l2,normal_velocity_l2,tension_mean,tension_min,tension_max,stresslet_xx,"
      "stresslet_yy,stresslet_zz,stresslet_xy,stresslet_xz,stresslet_yz,intrinsic_viscosity,normal_stress_1,normal_"
      "stress_2,"
      "center_velocity_x,center_velocity_y,center_velocity_z,migration,inclination_rate,frequency");
  CHECK(std::count(outcome.out.begin(), outcome.out.end(), '\n') == 7);
  CHECK(desk({"export", desk.file("t.h5"), "--csv", desk.file("t.csv")}).status == 0);
  CHECK(support::read_file(desk / "t.csv") == outcome.out);
  CHECK(desk({"export", desk.file("t.h5"), "--csv", desk.file("no/t.csv")}).status == 1);
}

TEST_CASE("export and info tell the motion of each vesicle, or why it cannot be told", "[commands]") {
  const Desk desk;
  const auto shown = [&](std::vector<std::string> changes) {
    std::vector<std::string> words{"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q", "--force"};
    for (const std::string& change : changes) words.insert(words.end(), {"--set", change});
    REQUIRE(desk(words).status == 0);
    const Outcome table = desk({"export", desk.file("t.h5"), "--motion", "-"});
    REQUIRE(table.status == 0);
    CHECK(
        table.out.starts_with("vesicle,motion,period,from,to,angle_mean,angle_min,angle_max,frequency,"
                              "intrinsic_viscosity,normal_stress_1,normal_stress_2,migration\n0,"));
    return table.out.substr(table.out.find('\n')) + desk({"info", desk.file("t.h5")}).out;
  };
  const auto lasting = [](double end) { return "time.end=" + std::to_string(end); };
  CHECK_THAT(shown({}), Contains("0,untold,nan") && Contains("motion     untold: too short a run"));
  CHECK_THAT(shown({lasting(12), "vesicle.axis=[0.9,0,0.4]"}),
             Contains("0,tank-treading,nan,8,12") && Contains("motion     tank-treading at "));
  CHECK_THAT(shown({lasting(14), "vesicle.viscosity_contrast=20"}),
             Contains("0,tumbling,") && Contains("motion     tumbling, period ") && Contains("(half turn "));
  CHECK_THAT(shown({"flow.kind=none"}), Contains("motion     untold: there is no steady shear flow"));
  std::string round = commands::scene;
  round.replace(round.find("shape"), round.find("order") - round.find("shape"), "shape = \"sphere\"\n");
  support::write_file(desk / "s.toml", round);
  CHECK_THAT(shown({}), Contains("motion     untold: it is round"));
  CHECK_THAT(desk({"export", desk.file("t.h5"), "--motion", "-", "--time", "0"}).err, Contains("leave out --time"));
}

TEST_CASE("figure writes four files", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  for (const char* kind : {"cross-sections", "time-series"}) {
    const Outcome outcome = desk({"figure", kind, desk.file("t.h5"), "-o", desk.file(std::string(kind) + ".pdf")});
    INFO(outcome.err);
    CHECK(outcome.status == 0);
    for (const char* extension : {".png", ".svg", ".pdf", ".csv"})
      CHECK(fs::file_size(desk / (std::string(kind) + extension)) > 0);
  }
  CHECK_THAT(desk({"figure", "overlai", desk.file("t.h5")}).err, Contains("did you mean 'overlay'?"));
}

TEST_CASE("info, list, --version and mistakes on the command line answer", "[commands]") {
  const Desk desk;
  CHECK_THAT(desk({"--version"}).out, Contains("tanktread 0."));
  CHECK_THAT(desk({"list"}).out, Contains("flows") && Contains("parameters"));
  CHECK_THAT(desk({"list", "flows"}).out, Contains("poiseuille") && Contains("curvature"));
  CHECK_THAT(desk({"list", "flow"}).err, Contains("did you mean 'flows'?"));
  CHECK_THAT(desk({"rnu"}).err, Contains("did you mean 'run'?"));
  CHECK_THAT(desk({"info", desk.file("s.toml")}).out, Contains("flow shear"));
  CHECK(desk({"info", desk.file("none")}).status == 1);
  CHECK(desk({"run"}).status == 2);
  CHECK(desk({"run", desk.file("s.toml"), "--setp", "3"}).status == 2);
  CHECK_THAT(desk({"render", "x.h5", "--gl", "vulkan"}).err, Contains("osmesa"));
  CHECK(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  CHECK_THAT(desk({"info", desk.file("t.h5")}).out, Contains("states     6") && Contains("area_error"));
}

TEST_CASE("a shard or a size of half a number, or of one beyond all bounds, is refused", "[commands]") {
  const Desk desk;
  for (const std::string text :
       {"0/", "/3", "99999999999/4", "0/99999999999", "4/4", "-1/4", "1/2/3", " 0/2", "0/2 ", "", "/"}) {
    const Outcome o = desk({"render", desk.file("none.h5"), "--shard", text});
    INFO(text << ": " << o.err);
    CHECK(o.status != 0);
    CHECK_THAT(o.err, Contains("'" + text + "' is not i/n with 0 <= i < n"));
  }
  CHECK_THAT(desk({"render", desk.file("none.h5"), "--shard", "3/4"}).err, Contains("none.h5"));
  for (const std::string text : {"64x", "x48", "99999999999x48", "64x48x2", "64", "64 x48"}) {
    const Outcome o = desk({"render", desk.file("none.h5"), "--size", text});
    INFO(text << ": " << o.err);
    CHECK(o.status != 0);
    CHECK_THAT(o.err, Contains("'" + text + "' is not WIDTHxHEIGHT"));
  }
}

TEST_CASE("export writes the state nearest to a time, and refuses times that the trajectory does not reach",
          "[commands]") {
  const Desk desk;
  const std::string file = desk.file("t.h5");
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", file, "-q"}).status == 0);
  const std::string all = desk({"export", file, "--csv", "-"}).out;
  const std::string one = desk({"export", file, "--csv", "-", "--time", "0.32"}).out;
  REQUIRE(std::count(one.begin(), one.end(), '\n') == 2);
  const std::string header = all.substr(0, all.find('\n') + 1);
  CHECK(one.substr(0, header.size()) == header);
  CHECK_THAT(one, Contains(",0.3"));
  CHECK_THAT(all, Contains(one.substr(header.size())));  // the very row of the whole table
  REQUIRE(desk({"export", file, "--vtk", desk.file("v"), "--ply", desk.file("p"), "--latitudes", "4", "--time", "0.32"})
              .status == 0);
  std::set<std::string> meshes;
  for (const char* folder : {"v", "p"})
    for (const auto& entry : fs::directory_iterator(desk / folder))
      if (entry.path().filename().string().front() != '.') meshes.insert(entry.path().filename().string());
  CHECK(meshes == std::set<std::string>{"state-000003.vtp", "series.pvd", "vesicle-0-000003.ply"});
  for (const char* time : {"0.6", "-0.1", "nan", "inf"}) {
    const Outcome refused = desk({"export", file, "--csv", desk.file("x.csv"), std::string("--time=") + time});
    INFO(time);
    CHECK(refused.status == 1);
    CHECK_THAT(refused.err, Contains("from t = 0 to t = 0.5; there is no t = " + std::string(time)));
    CHECK_FALSE(fs::exists(desk / "x.csv"));
  }
}

TEST_CASE("a poster beyond the end is refused, and a run that ended before its own says that there is none",
          "[commands]") {
  const Desk desk(scene + "[movie]\nposter = 0.4\n");
  const Outcome early = desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "--steps", "4"});
  CHECK(early.status == 0);
  CHECK_THAT(early.err, Contains("there is no poster: it is to show t = 0.4, and the trajectory ends at t = 0.2"));
  CHECK_FALSE(fs::exists(desk / "out/poster.png"));
  const std::string file = desk.file("out/trajectory.h5");
  CHECK(desk({"render", file, "-o", desk.file("again")}).status == 0);
  const Outcome refused = desk({"render", file, "-o", desk.file("other"), "--set", "movie.poster=0.3"});
  CHECK(refused.status == 1);
  CHECK_THAT(refused.err, Contains("movie.poster: the trajectory goes from t = 0 to t = 0.2; there is no t = 0.3"));
  CHECK_FALSE(fs::exists(desk / "other"));
  CHECK(desk({"render", file, "-o", desk.file("other"), "--set", "movie.poster=0.1"}).status == 0);
  CHECK(fs::exists(desk / "other/poster.png"));
}

TEST_CASE("a warning of resolution shows a share and a bound that differ", "[commands]") {
  const auto texts = sim::told_apart(15.004, 15);
  CHECK(texts.first == "15.004");
  CHECK(texts.second == "15");
  CHECK(sim::told_apart(15.2, 15).first == "15.2");
  CHECK(sim::told_apart(0.1 + 0.2, 0.3).first != sim::told_apart(0.1 + 0.2, 0.3).second);  // neighbours
  const Desk desk;  // the bound just below the share that the shape has
  const Outcome coarse =
      desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "--steps", "0", "--set", "vesicle.order=4",
            "--set", "vesicle.reduced_volume=0.7", "--set", "numerics.tail_warning=1e-9"});
  const std::string share =
      coarse.err.substr(coarse.err.find('(') + 1, coarse.err.find(" % of") - coarse.err.find('(') - 1);
  INFO(coarse.err);
  REQUIRE(coarse.err.find(" % of") != std::string::npos);
  const double rounded = std::stod(share) / 100;  // to three digits
  for (const double bound : {rounded * (1 - 1e-3), rounded}) {
    const Outcome warned = desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "--force", "--steps", "0",
                                 "--set", "vesicle.order=4", "--set", "vesicle.reduced_volume=0.7", "--set",
                                 "numerics.tail_warning=" + std::to_string(bound)});
    const std::size_t at = warned.err.find("bound ");
    if (at == std::string::npos) continue;  // the share was rounded up
    const std::string limit = warned.err.substr(at + 6, warned.err.find(" %)") - at - 6);
    CHECK(warned.err.find("(" + limit + " % of") == std::string::npos);
  }
}

TEST_CASE("the help of a command says what its options do there", "[commands]") {
  const Desk desk;
  const auto help = [&](const char* command) {
    std::string text = desk({command, "--help"}).out, plain;  // lines are broken
    for (const char c : text)
      if (c != ' ' && c != '\n')
        plain += c;
      else if (!plain.empty() && plain.back() != ' ')
        plain += ' ';
    return plain;
  };
  CHECK_THAT(help("run"), Contains("threads (default: numerics.threads") && !Contains("processes"));
  CHECK_THAT(help("render"), Contains("processes that draw the frames (default: 1)") && !Contains("time.end"));
  CHECK_THAT(help("export"), Contains("only the saved state nearest to this time"));
  CHECK_THAT(help("figure"), Contains("the files, without .png"));
}
