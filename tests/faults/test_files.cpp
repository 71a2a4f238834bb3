// Files of other people: never overwritten, never deleted, never written through a link that lies in a folder of
// results.
#include "desk.h"
#include "render/image/image.h"
#include "sim/trajectory/trajectory.h"
#include "tests/support/catch.h"

#include <csignal>

#include <sys/stat.h>

using namespace faults;
using Catch::Contains;

namespace {

std::string digits(int number) {
  const std::string text = std::to_string(number);
  return std::string(6 - text.size(), '0') + text;
}

constexpr const char* overlapping =
    "[[vesicle]]\nshape = \"prolate\"\nreduced_volume = 0.9\norder = 4\ncenter = [0.2, 0, 0]\n";

std::string resolved_scene(const Desk& desk) {
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("made"), "-q"}).status == 0);
  const std::string text = support::read_file(desk / "made/scene.toml");
  fs::remove_all(desk / "made");
  return text;
}

void check_refused(const Outcome& o, const std::string& words) {
  INFO(o.err);
  CHECK(o.status == 1);
  CHECK(one_sentence(o.err));
  CHECK_THAT(o.err, Contains(words));
}

}  // namespace

TEST_CASE("frames and movies of somebody else are neither overwritten nor deleted, and the run is refused at once",
          "[files]") {
  const Desk desk;
  fs::create_directories(desk / "out/frames");
  for (const int k : {0, 1, 4, 10, 500}) support::write_file(desk / "out/frames" / (digits(k) + ".png"), "precious");
  support::write_file(desk / "out/movie.mp4", "holiday");
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const auto before = desk.names();
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", desk.file("s.toml"), "-o", desk.file("out")},
        {"run", desk.file("s.toml"), "-o", desk.file("out"), "--force"},
        {"render", desk.file("t.h5"), "-o", desk.file("out")},
        {"render", desk.file("t.h5"), "-o", desk.file("out"), "-j", "2"},
        {"render", desk.file("t.h5"), "-o", desk.file("out"), "--shard", "0/2"}}) {
    check_refused(desk(words), "000000.png' was not made by this program");
    CHECK(desk.names() == before);
  }
  fs::remove_all(desk / "out/frames");
  for (const std::string command : {"run s.toml", "render t.h5", "PATH=/nonexistent render t.h5"}) {
    const bool poor = command.starts_with("PATH");
    check_refused(desk.shell((poor ? "env PATH=/nonexistent $T render t.h5" : "$T " + command) + " -o out"),
                  "movie.mp4' was not made by this program");
    CHECK(desk.names("out") == std::set<std::string>{"movie.mp4"});
    CHECK(support::read_file(desk / "out/movie.mp4") == "holiday");
  }
}

TEST_CASE("what a run made is replaced by the next one, and what was changed since is not", "[files]") {
  const Desk desk(
      scene("0.3", "[movie]\nposter = 0.1\n[[figure]]\nkind = \"time-series\"\nquantities = [\"energy\"]\n"));
  const std::vector<std::string> run{"run", desk.file("s.toml"), "-o", desk.file("out"), "-q"};
  REQUIRE(desk(run).status == 0);
  const auto all = desk.names("out");
  for (const char* name :
       {"frames/000001.png", "movie.mp4", "poster.png", "time-series.csv", "time-series.svg", "scene.toml"}) {
    const std::string made = support::read_file(desk / "out" / name);
    std::string changed = made + "# mine now\n";
    support::write_file(desk / "out" / name, changed);
    for (const bool force : {false, true}) {
      std::vector<std::string> other = run;
      other.insert(other.end(), {"--set", force ? "flow.rate=2" : "view.style=outline"});
      if (force) other.push_back("--force");
      const Outcome o = desk(other);
      INFO(name << o.err);
      CHECK(o.status == 1);
      CHECK(one_sentence(o.err));
      CHECK_THAT(o.err, Contains(std::string(name) + "' has been changed since this program wrote it"));
      CHECK(support::read_file(desk / "out" / name) == changed);
      CHECK(desk.names("out") == all);
    }
    support::write_file(desk / "out" / name, made);
  }
  // Only what the list names goes.
  for (const char* mine : {"notes.txt", "frames/notes.txt", "frames/1.png", "movie.gif", "other.csv"})
    support::write_file(desk / "out" / mine, "mine");
  std::vector<std::string> other = run;
  other.insert(other.end(), {"--set", "flow.rate=2", "--set", "time.end=0.2", "--force"});
  const Outcome o = desk(other);
  INFO(o.err);
  CHECK(o.status == 0);
  for (const char* mine : {"notes.txt", "frames/notes.txt", "frames/1.png", "movie.gif", "other.csv"})
    CHECK(support::read_file(desk / "out" / mine) == "mine");
  CHECK_FALSE(fs::exists(desk / "out/frames/000003.png"));
}

TEST_CASE("a folder of an earlier version, which has no list, is continued and replaced as before", "[files]") {
  const Desk desk(
      scene("0.3", "[movie]\nposter = 0.1\n[[figure]]\nkind = \"time-series\"\nquantities = [\"energy\"]\n"));
  const std::vector<std::string> run{"run", desk.file("s.toml"), "-o", desk.file("out")};
  REQUIRE(desk(run).status == 0);
  const std::string list = support::read_file(desk / "out/.tanktread.files");
  for (const bool other_scene : {false, true}) {
    fs::remove(desk / "out/.tanktread.files");
    std::vector<std::string> words = run;
    if (other_scene) words.insert(words.end(), {"--force", "--set", "flow.rate=2"});
    const Outcome o = desk(words);
    INFO(o.err);
    CHECK(o.status == 0);
    CHECK_THAT(o.out, Contains(other_scene ? "4 frames drawn" : "0 frames drawn, 4 kept"));
    if (!other_scene) CHECK(support::read_file(desk / "out/.tanktread.files") == list);
  }
}

TEST_CASE("a scene that cannot start takes nothing away, also with --force", "[files]") {
  const Desk desk;
  const std::string text = resolved_scene(desk);
  support::write_file(desk / "overlap.toml", scene("0.5", "") + overlapping);
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "-q"}).status == 0);
  const auto before = desk.names();
  for (const std::string line :
       {"$T run overlap.toml -o out --force -q", "$T run overlap.toml -o fresh -q",
        "ulimit -f 8; $T run s.toml -o out --force -q", "ulimit -f 8; $T run s.toml -o fresh -q"}) {
    const Outcome o = desk.shell(line);
    INFO(line << ": " << o.err);
    CHECK(o.status == 1);
    CHECK(one_sentence(o.err));
    CHECK(desk.names() == before);
    CHECK_FALSE(fs::exists(desk / "fresh"));
  }
  // Somebody's only copy, run where it lies.
  fs::create_directory(desk / "d");
  const std::string edited = text + support::read_file(desk / "overlap.toml").substr(scene("0.5", "").size());
  support::write_file(desk / "d/scene.toml", edited);
  CHECK(desk.shell("cd d; $T run scene.toml -o .").status == 1);
  CHECK(support::read_file(desk / "d/scene.toml") == edited);
  CHECK(desk.names("d") == std::set<std::string>{"scene.toml"});
}

TEST_CASE("a scene that somebody wrote is never overwritten by the resolved one of another", "[files]") {
  const Desk desk;
  const std::string text = resolved_scene(desk);
  for (const std::string& mine : {"# by hand\n" + scene("0.5"), text, std::string("not a scene")})
    for (const bool force : {false, true}) {
      fs::remove_all(desk / "out");
      fs::create_directory(desk / "out");
      support::write_file(desk / "out/scene.toml", mine);
      support::write_file(desk / "out/variant.toml", scene("0.4"));
      std::vector<std::string> words{"run", desk.file("out/variant.toml"), "-o", desk.file("out")};
      if (force) words.push_back("--force");
      check_refused(desk(words), "scene.toml' was not made by this program");
      CHECK(support::read_file(desk / "out/scene.toml") == mine);
      CHECK(desk.names("out") == std::set<std::string>{"scene.toml", "variant.toml"});
    }
}

TEST_CASE("a trajectory goes where a link points, and two names of one file have one writer", "[files]") {
  const Desk desk(scene("100000"));
  fs::create_directory(desk / "disk");
  fs::create_symlink("disk/a.h5", desk / "a.h5");
  for (const char* force : {"", " --force"}) {
    REQUIRE(desk.shell(std::string("$T simulate s.toml -o a.h5 -q --steps 4") + force).status == 0);
    CHECK(fs::is_symlink(desk / "a.h5"));
    CHECK(sim::TrajectoryReader(desk / "disk/a.h5").count() == 3);  // the first interval takes three steps
  }
  const Desk other;  // the first one's words go elsewhere
  const pid_t first = support::start(
      other, {TANKTREAD_PROGRAM, "simulate", desk.file("s.toml"), "-o", desk.file("disk/a.h5"), "--resume", "-q"});
  for (int k = 0; k < 1000 && sim::TrajectoryReader(desk / "a.h5").count() == 3; ++k) usleep(10000);
  fs::create_hard_link(desk / "disk/a.h5", desk / "twin.h5");
  for (const std::string name : {"disk/a.h5", "a.h5", "twin.h5"})
    for (const std::string how : {"--resume", "--force"})
      check_refused(desk({"simulate", desk.file("s.toml"), "-o", desk.file(name), how, "-q"}),
                    "another process is writing");
  kill(first, SIGINT);
  CHECK(support::finish(other, first).status == 130);
  CHECK(desk.names() == std::set<std::string>{"a.h5", "disk/a.h5", "twin.h5"});
}

TEST_CASE("links inside a folder of results lead no write out of it", "[files]") {
  const Desk desk(
      scene("0.3", "[movie]\nposter = 0.1\n[[figure]]\nkind = \"time-series\"\nquantities = [\"energy\"]\n"));
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  support::write_file(desk / "victim", "precious");
  const auto try_all = [&](const std::string& link, const std::string& target, const std::vector<std::string>& lines) {
    for (const std::string& line : lines) {
      fs::remove_all(desk / "out");
      fs::create_directories((desk / "out" / link).parent_path());
      fs::create_symlink(target, desk / "out" / link);
      const auto before = desk.names();
      const Outcome o = desk.shell(line);
      INFO(link << " -> " << target << ", " << line << ": " << o.err);
      CHECK(o.status == 1);
      CHECK(one_sentence(o.err));
      CHECK_THAT(o.err, Contains("is a link, and links are not followed out of a folder of results"));
      CHECK(support::read_file(desk / "victim") == "precious");
      CHECK(desk.names() == before);
    }
  };
  const std::vector<std::string> both{"$T run s.toml -o out", "$T run s.toml -o out --force", "$T render t.h5 -o out"},
      run{both[0], both[1]};
  for (const char* target : {"../../victim", "../../nothing"}) try_all("frames/000000.png", target, both);
  for (const char* name : {"movie.mp4", "poster.png"}) try_all(name, "../victim", both);
  for (const char* name : {"scene.toml", "trajectory.h5", "time-series.csv"}) try_all(name, "../victim", run);
  for (const char* name : {"state-000002.vtp", "series.pvd"})
    try_all(name, "../victim", {"$T export t.h5 --vtk out", "$T export t.h5 --vtk out --force"});
  fs::create_directory(desk / "pictures");
  support::write_file(desk / "pictures/000777.png", "mine");
  try_all("frames", "../pictures", both);
  CHECK(support::read_file(desk / "pictures/000777.png") == "mine");
  // A link to a folder, given as the output, is followed.
  fs::create_directory(desk / "big");
  fs::remove_all(desk / "out");
  fs::create_symlink("big", desk / "out");
  CHECK(desk.shell("$T run s.toml -o out -q").status == 0);
  CHECK(fs::exists(desk / "big/frames/000003.png"));
}

TEST_CASE("an output that is an input, a trajectory or somebody else's file is refused", "[files]") {
  const Desk desk;
  for (const char* name : {"t.h5", "u.h5"})
    REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file(name), "-q"}).status == 0);
  fs::create_symlink("t.h5", desk / "link.h5");
  fs::create_hard_link(desk / "t.h5", desk / "twin.csv");
  fs::create_hard_link(desk / "t.h5", desk / "series.csv");
  const std::string t = support::read_file(desk / "t.h5"), u = support::read_file(desk / "u.h5"),
                    s = support::read_file(desk / "s.toml");
  for (const std::string line :
       {"export t.h5 --csv t.h5", "export t.h5 --csv u.h5", "export t.h5 --csv link.h5",
        "export link.h5 --csv twin.csv --force", "export t.h5 --csv s.toml", "render t.h5 --time 0 -o t.h5",
        "render t.h5 --time 0 -o u.h5 --force", "render t.h5 --time 0 -o s.toml",
        "figure time-series u.h5 t.h5 -o series.png", "figure time-series u.h5 t.h5 -o series --force",
        "simulate s.toml -o s.toml --force -q", "simulate s.toml -o s.toml --resume"}) {
    const Outcome o = desk.shell("$T " + line);
    INFO(line << ": " << o.err);
    CHECK(o.status == 1);
    CHECK(one_sentence(o.err));
    CHECK(support::read_file(desk / "t.h5") == t);
    CHECK(support::read_file(desk / "u.h5") == u);
    CHECK(support::read_file(desk / "s.toml") == s);
  }
  // Once its own, a table is replaced without a word; with --force also a foreign one.
  support::write_file(desk / "table.csv", "a,b\n1,2\n");
  check_refused(desk.shell("$T export t.h5 --csv table.csv"), "--force to replace it");
  CHECK(support::read_file(desk / "table.csv") == "a,b\n1,2\n");
  CHECK(desk.shell("$T export t.h5 --csv table.csv --force").status == 0);
  CHECK(desk.shell("$T export t.h5 --csv table.csv").status == 0);
  CHECK(desk.shell("$T export t.h5 --csv /dev/stdout | head -c 4").out == "step");
}

TEST_CASE("devices, drafts and locks of somebody else stay what they are", "[files]") {
  const Desk desk;
  for (const char* name : {"u.h5.tmp", "u.h5.lock", "movie.mp4.keep.tmp", ".000001.png.17.tmp"})
    support::write_file(desk / name, "mine");
  REQUIRE(desk.shell("$T simulate s.toml -o u.h5 -q --force && $T render u.h5 -q").status == 0);
  for (const char* name : {"u.h5.tmp", "u.h5.lock", "movie.mp4.keep.tmp", ".000001.png.17.tmp"})
    CHECK(support::read_file(desk / name) == "mine");
  REQUIRE(mkfifo(desk.file("pipe").c_str(), 0600) == 0);
  for (const std::string name : {"/dev/null", "pipe"}) {
    check_refused(desk.shell("$T simulate s.toml -o " + name + " --force -q"), "is not a file");
    CHECK(fs::exists(desk / name));
    CHECK_FALSE(fs::is_regular_file(desk / name));
  }
  fs::create_directory(desk / "out");
  support::write_file(desk / "out/.tanktread.lock", "mine");
  check_refused(desk.shell("$T run s.toml -o out"), ".tanktread.lock' was not made by this program");
  CHECK(support::read_file(desk / "out/.tanktread.lock") == "mine");
  fs::create_directory(desk / "other");
  support::write_file(desk / "other/.tanktread.files", "mine");
  check_refused(desk.shell("$T run s.toml -o other"), ".tanktread.files' was not made by this program");
  CHECK(support::read_file(desk / "other/.tanktread.files") == "mine");
}

TEST_CASE("two results of one name are refused in the scene", "[files]") {
  const std::string one = "[[figure]]\nkind = \"time-series\"\n",
                    again = "[[figure]]\nkind = \"overlay\"\nout = \"time-series\"\n";
  const Desk same(scene("0.2", one + one));
  check_refused(same.shell("$T run s.toml -o out"), "two figures would be called 'time-series'");
  const Desk named(scene("0.2", one + again));
  const Outcome o = named.shell("$T run s.toml -o out");
  check_refused(o, "s.toml:18:7: two figures");
  CHECK(named.names().empty());
  const Desk poster(scene("0.2", "[movie]\nposter = 0\n[[figure]]\nkind = \"overlay\"\nout = \"poster\"\n"));
  check_refused(poster.shell("$T run s.toml -o out"), "the poster of the movie is called 'poster' already");
}
