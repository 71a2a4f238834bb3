// The program as a user meets it: exit statuses, messages, and what is left on the disk.
#include "render/image.h"
#include "sim/trajectory.h"
#include "tests/support/program.h"

#include <catch2/catch.hpp>
#include <set>

using Catch::Contains;
using support::Outcome;
using support::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

const std::string scene = R"(title = "small"
[flow]
kind = "shear"
[time]
end = 0.5
step = 0.1
[[vesicle]]
shape = "prolate"
reduced_volume = 0.9
order = 6
[view]
size = [64, 48]
supersampling = 1
)";

/// A folder with s.toml in it.
struct Desk : TemporaryFolder {
  explicit Desk(const std::string& text = scene) { support::write_file(file("s.toml"), text); }
  std::string file(const std::string& name) const { return (path() / name).string(); }
  Outcome operator()(std::vector<std::string> words) const {
    words.insert(words.begin(), TANKTREAD_PROGRAM);
    return support::run(*this, words);
  }
  /// Names in the folder, but for those of the test itself.
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(path())) all.insert(entry.path().filename().string());
    for (const char* own : {"s.toml", "out.txt", "err.txt"}) all.erase(own);
    return all;
  }
};

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

TEST_CASE("run leaves trajectory, frames, movie and resolved scene, and a second run does nothing again", "[commands]") {
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
  CHECK(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "--steps", "1", "--set", "vesicle.order=5", "--force"}).status == 0);
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
  for (const char* change : {"vesicle.oder=3", "vesicle.viscosity_contrast=-1", "vesicle.order=1", "vesicle.reduced_volume=1.5",
                             "time.tolerance=1e-4", "flow.curvature=1", "view.size=[0, 10]", "view.size=[10]"}) {
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
  const std::vector<std::vector<std::string>> commands{{"render", desk.file("t.h5"), "-o", desk.file("x")},
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
  const Outcome outcome = desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "--dry-run", "--set", "time.end=3"});
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.out, Contains("end = 3.0") && Contains("viscosity_contrast = 1.0"));
  CHECK(desk.names().empty());
}

TEST_CASE("export writes one row per saved state and vesicle under the promised header", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const Outcome outcome = desk({"export", desk.file("t.h5"), "--csv", "-"});
  REQUIRE(outcome.status == 0);
  CHECK(outcome.out.substr(0, outcome.out.find('\n')) ==
        "step,time,vesicle,area,volume,area_error,volume_error,reduced_volume,center_x,center_y,center_z,inclination_deg,"
        "axis_1,axis_2,axis_3,energy,velocity_l2,normal_velocity_l2,tension_mean,tension_min,tension_max");
  CHECK(std::count(outcome.out.begin(), outcome.out.end(), '\n') == 7);
  CHECK(desk({"export", desk.file("t.h5"), "--csv", desk.file("t.csv")}).status == 0);
  CHECK(support::read_file(desk / "t.csv") == outcome.out);
  CHECK(desk({"export", desk.file("t.h5"), "--csv", desk.file("no/t.csv")}).status == 1);
}

TEST_CASE("render draws shards that together make the whole, and changes pictures only", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("a")}).status == 0);
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("b"), "--shard", "0/2"}).status == 0);
  CHECK_FALSE(fs::exists(desk / "b/frames/000001.png"));
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("b"), "--shard", "1/2"}).status == 0);
  CHECK(support::read_file(desk / "a/frames/000001.png") == support::read_file(desk / "b/frames/000001.png"));
  const Outcome physics = desk({"render", desk.file("t.h5"), "-o", desk.file("c"), "--set", "flow.rate=3"});
  CHECK(physics.status == 1);
  CHECK_THAT(physics.err, Contains("has been simulated already"));
  CHECK(desk({"render", desk.file("t.h5"), "-o", desk.file("c"), "--shard", "2/2"}).status == 2);
}

TEST_CASE("frames between saved states are interpolated", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "--set", "movie.time_per_frame=0.04"}).status == 0);
  CHECK(fs::exists(desk / "out/frames/000012.png"));
  CHECK_FALSE(fs::exists(desk / "out/frames/000013.png"));
}

TEST_CASE("damaged or incomplete frames are drawn again", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "-q"}).status == 0);
  const std::string whole = support::read_file(desk / "out/frames/000002.png");
  support::write_file(desk / "out/frames/000002.png", whole.substr(0, whole.size() / 2));
  fs::remove(desk / "out/frames/000004.png");
  const Outcome again = desk({"run", desk.file("s.toml"), "-o", desk.file("out")});
  CHECK_THAT(again.out, Contains("2 frames drawn, 4 kept"));
  CHECK(support::read_file(desk / "out/frames/000002.png") == whole);
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
  for (const std::string text : {"0/", "/3", "99999999999/4", "0/99999999999", "4/4", "-1/4", "1/2/3", " 0/2", "0/2 ", "", "/"}) {
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

TEST_CASE("without ffmpeg, or with a broken one, the frames are kept and a sentence says why there is no movie", "[commands]") {
  const Desk desk;
  fs::create_directory(desk / "bin");
  const auto run_with_path = [&](const std::string& path, const std::string& out) {
    return support::run(desk, {"/usr/bin/env", "PATH=" + path, TANKTREAD_PROGRAM, "run", desk.file("s.toml"), "-o", desk.file(out)});
  };
  const Outcome missing = run_with_path(desk.file("bin"), "a");
  CHECK(missing.status == 0);
  CHECK_THAT(missing.err, Contains("apt-get install ffmpeg"));
  CHECK(fs::exists(desk / "a/frames/000005.png"));
  CHECK_FALSE(fs::exists(desk / "a/movie.mp4"));

  support::write_file(desk / "bin/ffmpeg", "#!/bin/sh\nexit 3\n");
  fs::permissions(desk / "bin/ffmpeg", fs::perms::owner_all);
  const Outcome broken = run_with_path(desk.file("bin") + ":/bin", "b");
  CHECK(broken.status == 1);
  CHECK_THAT(broken.err, Contains("ffmpeg"));
  CHECK(fs::exists(desk / "b/frames/000005.png"));
  CHECK_FALSE(fs::exists(desk / "b/movie.mp4"));
  CHECK_FALSE(fs::exists(desk / "b/movie.mp4.tmp"));
}

TEST_CASE("processes draw the very frames and movie that one draws alone", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("a"), "--style", "ghost", "-j", "1"}).status == 0);
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("b"), "--style", "ghost", "-j", "3"}).status == 0);
  for (const char* name : {"frames/000000.png", "frames/000004.png", "frames/000005.png", "movie.mp4"})
    CHECK(support::read_file(desk / "a" / name) == support::read_file(desk / "b" / name));
}

TEST_CASE("every movie format is written from the same frames, with a poster where asked for", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  for (const char* format : {"mp4", "mkv", "gif", "webp"}) {
    INFO(format);
    const Outcome outcome = desk({"render", desk.file("t.h5"), "-o", desk.file("a"), "--format", format, "--set", "movie.poster=0.3"});
    CHECK(outcome.status == 0);
    CHECK(fs::file_size(desk / (std::string("a/movie.") + format)) > 100);
    if (std::string(format) != "mp4") CHECK_THAT(outcome.out, Contains("0 frames drawn, 6 kept"));
  }
  CHECK(support::read_file(desk / "a/poster.png") == support::read_file(desk / "a/frames/000003.png"));
  CHECK_THAT(desk({"render", desk.file("t.h5"), "--format", "mp5"}).err, Contains("did you mean 'mp4'?"));
}

TEST_CASE("an odd size is refused for H.264 before anything is drawn, and drawn for other formats", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const Outcome odd = desk({"render", desk.file("t.h5"), "-o", desk.file("a"), "--size", "65x48"});
  CHECK(odd.status == 1);
  CHECK_THAT(odd.err, Contains("even width and height, not 65 x 48") && Contains("66x48"));
  CHECK_FALSE(fs::exists(desk / "a"));
  CHECK(desk({"render", desk.file("t.h5"), "-o", desk.file("a"), "--size", "65x48", "--format", "mkv"}).status == 0);
  CHECK(desk({"run", desk.file("s.toml"), "-o", desk.file("r"), "--set", "view.size=[65, 48]"}).status == 1);
  CHECK_FALSE(fs::exists(desk / "r/trajectory.h5"));
}

TEST_CASE("a still is chosen by time, in any style, field and view", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const auto still = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"render", desk.file("t.h5"), "--time", "0.25", "-o", desk.file("still.png")};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = desk(words);
    INFO(outcome.err);
    CHECK(outcome.status == 0);
    return support::read_file(desk / "still.png");
  };
  std::set<std::string> pictures;
  for (const char* style : {"opaque", "ghost", "cutaway", "checker"}) pictures.insert(still({"--style", style}));
  for (const char* field : {"tension", "mean-curvature", "gaussian-curvature", "bending-force", "tension-force",
                            "normal-velocity", "membrane-speed"})
    pictures.insert(still({"--style", "field", "--set", std::string("view.field=") + field}));
  pictures.insert(still({"--set", "view.views=[\"flow-gradient\", \"three-quarter\"]"}));
  pictures.insert(still({"--set", "view.colours=[\"#336699\"]"}));
  pictures.insert(still({"--set", "view.colour_by=viscosity_contrast"}));
  pictures.insert(still({"--set", "view.inset=true", "--set", "view.triad=true", "--set", "view.flow_profile=true"}));
  pictures.insert(still({"--set", "view.orbit=90"}));
  pictures.insert(still({"--set", "view.eye=[2, -6, 3]"}));
  CHECK(pictures.size() == 17);
  CHECK_FALSE(fs::exists(desk / "frames"));
  CHECK_THAT(desk({"render", desk.file("t.h5"), "--time", "0.6"}).err, Contains("to t = 0.5"));
  CHECK_THAT(desk({"render", desk.file("t.h5"), "--style", "field", "--set", "view.field=neighbour-distance"}).err,
             Contains("two vesicles"));
  CHECK_THAT(desk({"render", desk.file("t.h5"), "--set", "view.field=tention"}).err, Contains("did you mean 'tension'?"));
  CHECK_THAT(desk({"render", desk.file("t.h5"), "--set", "view.eye=[0, 0.1, 0]"}).err, Contains("inside vesicle 0"));
}

TEST_CASE("the inset cuts what the camera follows or aims at, not the middle between the vesicles", "[commands]") {
  // Between these two, in the plane of their common centroid, there is only fluid.
  std::string text = scene;
  text.replace(text.find("order = 6\n"), 10, "order = 6\ncenter = [0, -3, 0]\n[[vesicle]]\nshape = \"sphere\"\norder = 6\ncenter = [0, 3, 0]\n");
  const Desk desk(text + "inset = true\n");
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q", "--steps", "0"}).status == 0);
  const auto coloured = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"render", desk.file("t.h5"), "--time", "0", "-o", desk.file("still.png"), "--size", "320x240"});
    const Outcome outcome = desk(words);
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const render::Image image = render::read_png(desk / "still.png").image;
    int count = 0;
    for (int y = 10; y < 50; ++y)  // within the box
      for (int x = 255; x < 300; ++x) count += image.at(x, y)[2] > image.at(x, y)[0] + 20 || image.at(x, y)[0] > image.at(x, y)[2] + 20;
    return count;
  };
  CHECK(coloured({"--set", "view.target=[0, 0, 0]"}) == 0);
  CHECK(coloured({"--set", "view.target=[0, 3, 0]"}) > 100);
  CHECK(coloured({"--set", "view.follow=vesicle", "--set", "view.follow_vesicle=1"}) > 100);
  CHECK(coloured({"--set", "view.follow=vesicle", "--set", "view.follow_vesicle=0"}) > 100);
}

TEST_CASE("two trajectories stand side by side, the shorter one at rest at its end", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("a.h5"), "-q"}).status == 0);
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("b.h5"), "-q", "--set", "time.end=0.3"}).status == 0);
  const Outcome outcome = desk({"render", desk.file("a.h5"), desk.file("b.h5"), "-o", desk.file("both"), "--size", "128x48"});
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  CHECK(fs::exists(desk / "both/frames/000005.png"));
}

TEST_CASE("a full disk ends with one sentence; frames made before are kept, none is half written", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("a"), "--size", "320x240", "--shard", "0/3"}).status == 0);
  const std::string before = support::read_file(desk / "a/frames/000000.png");
  // A limit on the size of files stands for the disk.
  const Outcome full = support::run(
      desk, {"/bin/sh", "-c", "trap '' XFSZ; ulimit -f 4; exec \"$@\"", "sh", TANKTREAD_PROGRAM, "render", desk.file("t.h5"),
             "-o", desk.file("a"), "--size", "320x240", "--format", "mkv"});
  CHECK(full.status == 1);
  CHECK_THAT(full.err, Contains("File too large") && Contains("complete in") && Contains("continues"));
  CHECK(support::read_file(desk / "a/frames/000000.png") == before);
  CHECK_FALSE(fs::exists(desk / "a/frames/000001.png"));
  for (const auto& entry : fs::directory_iterator(desk / "a/frames")) CHECK(entry.path().extension() == ".png");
}

TEST_CASE("before and after material lines are laid anew the pictures say so", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const sim::TrajectoryReader reader(desk.file("t.h5"));
  const auto changed = [&](std::int64_t k) {
    sim::State state = reader.state(k);
    if (state.time > 0.29) {
      state.vesicles[0].labels_laid = 1;
      state.vesicles[0].labels_laid_time = 0.3;
    }
    return state;
  };
  {
    sim::TrajectoryWriter writer =
        sim::TrajectoryWriter::create(desk.file("u.h5"), reader.layout(), reader.header(), changed(0), reader.resume_payload());
    for (std::int64_t k = 1; k < reader.count(); ++k) writer.append(changed(k));
  }
  // 1.2 seconds at half a frame a second and 0.1 a frame: 0.06 before and after.
  for (const auto& [time, told] : {std::pair{"0.1", false}, std::pair{"0.26", true}, std::pair{"0.34", true}, std::pair{"0.42", false}}) {
    INFO(time);
    for (const char* name : {"t", "u"})
      REQUIRE(desk({"render", desk.file(std::string(name) + ".h5"), "--time", time, "-o", desk.file(std::string(name) + ".png"),
                    "--size", "320x180", "--set", "movie.frame_rate=0.5"})
                  .status == 0);
    CHECK((desk({"compare", desk.file("t.png"), desk.file("u.png")}).status != 0) == told);
  }
}
