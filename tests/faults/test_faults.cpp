// Faults other than kills: full disks, closed doors, damaged and foreign files, missing helpers. Nothing is lost,
// nothing is left half-written, and one sentence says what is wrong.
#include "desk.h"
#include "render/image/image.h"
#include "sim/trajectory/trajectory.h"
#include "tests/support/catch.h"

#include <csignal>
#include <random>

#include <sys/stat.h>

using namespace faults;
using Catch::Contains;

namespace {

/// Can this process mount a file system of its own?
bool may_mount(const Desk& desk) {
  const bool may = desk.shell("mkdir -p probe && unshare -m mount -t tmpfs -o size=64k tmpfs probe").status == 0;
  if (!may) WARN("skipped: no right to mount a small file system");
  return may;
}

}  // namespace

TEST_CASE("a disk that fills up in the middle of a simulation costs no state, and the run goes on afterwards",
          "[faults]") {
  const Desk desk(scene("1000"));
  fs::create_directory(desk / "disk");
  if (!may_mount(desk)) return;
  // The whole trajectory takes some 40 MB; 3 MB are free when it starts, or the start itself would be refused.
  support::write_file(desk / "script", R"(
mount -t tmpfs -o size=200m tmpfs disk || exit 9
$T simulate s.toml -o disk/t.h5 -q 2>first & child=$!
for k in {1..1000}; do [ -e disk/t.h5 ] && break; sleep 0.01; done
dd if=/dev/zero of=disk/filler bs=64k 2>/dev/null
wait $child; echo "status $?"
cp --sparse=always disk/t.h5 stopped.h5
rm disk/filler
states=$($T info stopped.h5 | sed -n 's/^states *\([0-9]*\).*/\1/p')
$T simulate s.toml -o disk/t.h5 --resume -q --steps $((states + 20)) 2>&1; echo "status $?"
ls -A disk; cp --sparse=always disk/t.h5 continued.h5
)");
  const Outcome outcome = desk.shell("export T; unshare -m bash script");
  INFO(outcome.out << outcome.err);
  const std::string first = support::read_file(desk / "first");
  CHECK(outcome.out == "status 1\nstatus 0\nt.h5\n");
  CHECK(one_sentence(first));
  CHECK_THAT(first, Contains("t.h5") && Contains("No space left on device"));
  const sim::TrajectoryReader stopped(desk / "stopped.h5"), continued(desk / "continued.h5");
  CHECK(stopped.damaged().empty());
  CHECK(continued.damaged().empty());
  REQUIRE(continued.count() > stopped.count());
  REQUIRE(stopped.count() > 0);
  const std::int64_t last = stopped.count() - 1;
  CHECK(stopped.state(last).vesicles[0].position.values == continued.state(last).vesicles[0].position.values);
}

TEST_CASE("a disk that fills up with frames keeps those that are whole, and the same command continues", "[faults]") {
  const Desk desk(scene("3"));
  fs::create_directory(desk / "disk");
  if (!may_mount(desk)) return;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("whole"), "-q"}).status == 0);
  support::write_file(desk / "script", R"(
mount -t tmpfs -o size=64k tmpfs disk || exit 9
$T render t.h5 -o disk -q 2>first; echo "status $?"
find disk -name '*.tmp' -o -name '.*.png*' -o -name '*.lock'
ls disk/frames | wc -l; for f in disk/frames/*; do cmp $f whole/frames/${f##*/}; done
mount -o remount,size=20m disk
$T render t.h5 -o disk -q; echo "status $?"; diff -r disk whole && echo equal
)");
  const Outcome outcome = desk.shell("export T; unshare -m bash script");
  INFO(outcome.out << outcome.err);
  const std::string first = support::read_file(desk / "first");
  CHECK(one_sentence(first));
  CHECK_THAT(first, Contains("No space left on device") && Contains("the same command continues"));
  CHECK_THAT(outcome.out, Catch::StartsWith("status 1\n") && Catch::EndsWith("status 0\nequal\n"));
  const int complete = std::atoi(outcome.out.substr(9).c_str());
  CHECK((complete > 0 && complete < 31));
  CHECK(std::count(outcome.out.begin(), outcome.out.end(), '\n') == 4);  // nothing half-written was found
}

TEST_CASE("what ffmpeg says of a failure is part of the sentence about the movie, and of nothing else", "[faults]") {
  const Desk desk(scene("0.5"));
  fs::create_directory(desk / "bin");
  support::write_file(desk / "bin/ffmpeg",
                      "#!/bin/sh\ncat >/dev/null\nprintf 'no room\\033[31m\\nmore words\\n' >&2\nexit 3\n");
  fs::permissions(desk / "bin/ffmpeg", fs::perms::owner_all);
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const Outcome o = desk.with({"PATH=" + desk.file("bin") + ":/usr/bin:/bin"},
                              {"render", desk.file("t.h5"), "-o", desk.file("out"), "-q"});
  CHECK(o.status == 1);
  INFO(o.err);
  CHECK(one_sentence(o.err));
  CHECK_THAT(o.err, Contains("ffmpeg failed with exit status 3 (no room?[31m);"));
}

TEST_CASE("a file that may not grow is an error with a sentence and leaves nothing", "[faults]") {
  const Desk desk;
  Outcome o = desk.shell("ulimit -f 8; exec $T simulate s.toml -o t.h5 -q");
  CHECK(o.status == 1);
  CHECK(one_sentence(o.err));
  CHECK(desk.names().empty());
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  for (const std::string words : {"export t.h5 --vtk v", "export t.h5 --ply p", "compare a b --html h"}) {
    if (words.starts_with("compare")) {
      fs::create_directory(desk / "a");
      fs::create_directory(desk / "b");
      render::write_png(desk / "a/x.png", render::Image(40, 40, 3));
      render::Image other(40, 40, 3);
      other.pixels.assign(other.pixels.size(), 77);
      render::write_png(desk / "b/x.png", other);
    }
    o = desk.shell("ulimit -f 4; exec $T " + words + " -q");
    INFO(words << ": " << o.err);
    CHECK(o.status == (words.starts_with("compare") ? 2 : 1));
    CHECK(one_sentence(o.err));
    CHECK_THAT(o.err, Contains("File too large"));
    for (const char* folder : {"v", "p", "h"})
      if (fs::exists(desk / folder)) CHECK(desk.names(folder).empty());
  }
}

TEST_CASE("an output folder that cannot be written is told before any work is done", "[faults]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  support::write_file(desk / "taken", "a file");
  std::vector<std::string> places{desk.file("taken/x"), "/proc/tanktread"};
  if (geteuid() != 0) {
    fs::create_directory(desk / "closed");
    chmod(desk.file("closed").c_str(), 0555);
    places.push_back(desk.file("closed/x"));
  }
  for (const std::string& place : places)
    for (const std::vector<std::string>& words : {std::vector<std::string>{"run", desk.file("s.toml"), "-o", place},
                                                  {"simulate", desk.file("s.toml"), "-o", place + "/t.h5"},
                                                  {"render", desk.file("t.h5"), "-o", place},
                                                  {"figure", "time-series", desk.file("t.h5"), "-o", place + "/f"},
                                                  {"export", desk.file("t.h5"), "--csv", place + "/t.csv"},
                                                  {"export", desk.file("t.h5"), "--vtk", place},
                                                  {"export", desk.file("t.h5"), "--ply", place}}) {
      const Outcome o = desk(words);
      INFO(words[0] << " " << place << ": " << o.err);
      CHECK(o.status == 1);
      CHECK(one_sentence(o.err));
      CHECK(o.out.empty());
    }
  CHECK(desk.names() == std::set<std::string>{"t.h5", "taken"});
}

TEST_CASE("a trajectory truncated at any byte is refused whole and left as it is", "[faults]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const std::string whole = support::read_file(desk / "t.h5");
  std::mt19937 random(3);
  int cuts = 0;
  for (std::size_t size = 0; size < whole.size(); size += 1 + random() % (size < 4096 ? 40 : 400)) {
    support::write_file(desk / "cut.h5", whole.substr(0, size));
    const std::string message = support::message_of([&] { sim::TrajectoryReader reader(desk / "cut.h5"); });
    INFO(size << " of " << whole.size() << ": " << message);
    REQUIRE_THAT(message,
                 Contains("cut.h5") && (Contains("cut short") || Contains("no HDF5 file") || Contains("damaged")));
    ++cuts;
  }
  WARN(cuts << " truncations");
  support::write_file(desk / "cut.h5", whole.substr(0, whole.size() - 1));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"info", desk.file("cut.h5")},
        {"render", desk.file("cut.h5"), "-o", desk.file("out")},
        {"simulate", desk.file("s.toml"), "-o", desk.file("cut.h5"), "--resume"}}) {
    const Outcome o = desk(words);
    CHECK(o.status == 1);
    CHECK(one_sentence(o.err));
  }
  CHECK(support::read_file(desk / "cut.h5") == whole.substr(0, whole.size() - 1));
  CHECK_FALSE(fs::exists(desk / "out"));
}

TEST_CASE("a scene that changed between run and resume is refused and changes nothing", "[faults]") {
  const Desk desk;
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "-q"}).status == 0);
  const std::string before = support::read_file(desk / "out/trajectory.h5"),
                    scene = support::read_file(desk / "out/scene.toml");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", desk.file("s.toml"), "-o", desk.file("out"), "--set", "flow.rate=2"},
        {"simulate", desk.file("s.toml"), "-o", desk.file("out/trajectory.h5"), "--resume", "--set",
         "vesicle.order=5"}}) {
    const Outcome o = desk(words);
    CHECK(o.status == 1);
    CHECK(one_sentence(o.err));
    CHECK_THAT(o.err, Contains("another scene"));
  }
  CHECK(support::read_file(desk / "out/trajectory.h5") == before);
  CHECK(support::read_file(desk / "out/scene.toml") == scene);
}

TEST_CASE("a second process that would write into the same folder or file refuses", "[faults]") {
  const Desk desk(scene("100000"));
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("short.h5"), "--steps", "3", "-q"}).status == 0);
  const Desk other;  // the first one's words go elsewhere
  const pid_t first =
      support::start(other, {TANKTREAD_PROGRAM, "run", desk.file("s.toml"), "-o", desk.file("out"), "-q"});
  REQUIRE(support::wait_for(desk / "out/trajectory.h5"));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", desk.file("s.toml"), "-o", desk.file("out")},
        {"run", desk.file("s.toml"), "-o", desk.file("out"), "--force"},
        {"render", desk.file("short.h5"), "-o", desk.file("out")},
        {"render", desk.file("short.h5"), "-o", desk.file("out"), "--shard", "0/2"},
        {"simulate", desk.file("s.toml"), "-o", desk.file("out/trajectory.h5"), "--resume"},
        {"simulate", desk.file("s.toml"), "-o", desk.file("out/trajectory.h5"), "--force", "-q"}}) {
    const Outcome o = desk(words);
    INFO(words[0] << ": " << o.err);
    CHECK(o.status == 1);
    CHECK(one_sentence(o.err));
    CHECK_THAT(o.err, Contains("another process is writing"));
  }
  kill(first, SIGINT);
  CHECK(support::finish(other, first).status == 130);
  CHECK(sim::TrajectoryReader(desk / "out/trajectory.h5").damaged().empty());
  CHECK(desk.names("out") ==
        std::set<std::string>{".tanktread.files", "scene.toml", "trajectory.h5"});  // no lock is left
}

TEST_CASE("clocks that jump change neither the trajectory nor the frames", "[faults]") {
  const Desk desk(scene("5"));
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("a.h5"), "-q"}).status == 0);
  REQUIRE(desk.with(preload("jumping_clock"),
                    {"simulate", desk.file("s.toml"), "-o", desk.file("b.h5"), "-q", "--steps", "20"})
              .status == 0);
  REQUIRE(
      desk.with(preload("jumping_clock"), {"simulate", desk.file("s.toml"), "-o", desk.file("b.h5"), "-q", "--resume"})
          .status == 0);
  CHECK(support::read_file(desk / "a.h5") == support::read_file(desk / "b.h5"));
}

TEST_CASE("Ctrl-C twice ends at once and loses no state", "[faults]") {
  const Desk desk(scene("100000", ""));
  const pid_t child =
      support::start(desk, {TANKTREAD_PROGRAM, "simulate", desk.file("s.toml"), "-o", desk.file("t.h5")});
  REQUIRE(support::wait_for(desk / "t.h5"));
  usleep(100000);
  kill(child, SIGINT);
  kill(child, SIGINT);
  const Outcome o = support::finish(desk, child);
  CHECK((o.status == 130 || o.status == -SIGINT));
  const std::int64_t states = sim::TrajectoryReader(desk / "t.h5").count();
  CHECK(sim::TrajectoryReader(desk / "t.h5").damaged().empty());
  const std::string steps = std::to_string(states + 20);
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "--resume", "--steps", steps, "-q"}).status ==
          0);
  CHECK(sim::TrajectoryReader(desk / "t.h5").count() == states + 19);  // the first interval takes three steps
}

TEST_CASE("closed, full and broken standard streams cost no result", "[faults]") {
  const Desk desk;
  for (const char* streams :
       {">&-", ">&- 2>&-", "<&- >&- 2>&-", ">/dev/full", ">/dev/full 2>/dev/full", "2>&1 | true"}) {
    const Outcome o = desk.shell(std::string("$T run s.toml -o out ") + streams);
    INFO(streams);
    CHECK(desk.names("out").count("frames/000005.png") == 1);
    CHECK(sim::TrajectoryReader(desk / "out/trajectory.h5").count() == 6);
    CHECK(sim::TrajectoryReader(desk / "out/trajectory.h5").damaged().empty());
    CHECK(support::read_file(desk / "out/scene.toml").starts_with("title = "));
    fs::remove_all(desk / "out");
  }
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const Outcome full = desk.shell("$T export t.h5 --csv - >/dev/full");
  CHECK(full.status == 1);
  CHECK_THAT(full.err, Contains("cannot write to standard output") && Contains("No space left"));
}

TEST_CASE("an ffmpeg that dies in the middle costs the movie and nothing else", "[faults]") {
  const Desk desk;
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("whole"), "-q"}).status == 0);
  fs::create_directory(desk / "bin");
  for (const std::string last : {"kill -9 $$", "exit 1", "exit 0"}) {
    support::write_file(desk / "bin/ffmpeg", "#!/bin/sh\nhead -c 20000 >/dev/null\n" + last + "\n");
    fs::permissions(desk / "bin/ffmpeg", fs::perms::owner_all);
    const Outcome o = desk.with({"PATH=" + desk.file("bin") + ":/usr/bin:/bin"},
                                {"run", desk.file("s.toml"), "-o", desk.file("out"), "-q"});
    INFO(last << ": " << o.err);
    CHECK(o.status == 1);
    CHECK(one_sentence(o.err));
    CHECK_THAT(o.err, Contains("ffmpeg") && Contains("the frames are in"));
    std::set<std::string> expected = desk.names("whole");
    expected.erase("movie.mp4");
    expected.erase("frames/.movie.mp4");  // what it was made of
    CHECK(desk.names("out") == expected);
  }
  CHECK(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "-q"}).status == 0);
  CHECK(desk.names("out") == desk.names("whole"));
}

TEST_CASE("a movie and a poster of earlier pictures never pass as those of the present ones", "[faults]") {
  const Desk desk(scene("0.5", "[movie]\nposter = 0.3\n"));
  const std::vector<std::string> plain{"run", desk.file("s.toml"), "-o", desk.file("out"), "-q"};
  std::vector<std::string> outline = plain;
  outline.insert(outline.end(), {"--set", "view.style=outline"});
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("whole"), "-q", "--set", "view.style=outline"}).status ==
          0);
  const std::string movie = support::read_file(desk / "whole/movie.mp4"),
                    poster = support::read_file(desk / "whole/poster.png");
  fs::create_directory(desk / "bin");
  const auto with_ffmpeg = [&](const std::string& last) {
    support::write_file(desk / "bin/ffmpeg", "#!/bin/sh\ncat >/dev/null\n" + last + "\n");
    fs::permissions(desk / "bin/ffmpeg", fs::perms::owner_all);
    return "PATH=" + desk.file("bin") + ":/usr/bin:/bin";
  };
  const auto same_now = [&] {
    CHECK(desk(outline).status == 0);
    CHECK(support::read_file(desk / "out/movie.mp4") == movie);
    CHECK(support::read_file(desk / "out/poster.png") == poster);
  };

  REQUIRE(desk(plain).status == 0);
  REQUIRE(support::read_file(desk / "out/movie.mp4") != movie);
  CHECK(desk.with({with_ffmpeg("exit 1")}, outline).status == 1);
  CHECK(desk.names("out").count("movie.mp4") == 0);
  same_now();

  // Killed between the last frame and the end of the movie.
  fs::remove_all(desk / "out");
  REQUIRE(desk(plain).status == 0);
  std::vector<std::string> words{"/usr/bin/env", with_ffmpeg("touch " + desk.file("all-read") + "; exec sleep 1000"),
                                 TANKTREAD_PROGRAM};
  words.insert(words.end(), outline.begin(), outline.end());
  const pid_t child = support::start(desk, words);
  const bool waits = support::wait_for(desk / "all-read");
  kill(child, SIGKILL);
  CHECK(support::finish(desk, child).status == -SIGKILL);
  REQUIRE(waits);
  CHECK(desk.names("out").count("movie.mp4") == 0);
  same_now();

  // Only the movie's own settings changed, and ffmpeg fails; then a poster that has gone.
  std::vector<std::string> faster = outline;
  faster.insert(faster.end(), {"--set", "movie.frame_rate=7"});
  CHECK(desk.with({with_ffmpeg("exit 1")}, faster).status == 1);
  CHECK(desk.names("out").count("movie.mp4") == 0);
  same_now();
  fs::remove(desk / "out/poster.png");
  same_now();
}

TEST_CASE("without OpenGL libraries a run is refused before it simulates, and a simulation runs", "[faults]") {
  const Desk desk;
  const Outcome o = desk.with(preload("no_drivers"), {"run", desk.file("s.toml"), "-o", desk.file("out")});
  CHECK(o.status == 1);
  CHECK(one_sentence(o.err));
  CHECK_THAT(o.err, Contains("libegl1") && Contains("libgl1-mesa-dri") && !Contains("libosmesa"));
  CHECK(desk.names().empty());
  CHECK(desk.with(preload("no_drivers"), {"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
}

TEST_CASE("pictures do not depend on the fonts that are installed", "[faults]") {
  const Desk desk(scene("0.2", "time_stamp = true\ncaption = true\nscale_bar = true\n"));
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("a"), "-q"}).status == 0);
  fs::create_directory(desk / "home");
  REQUIRE(desk.with({"FONTCONFIG_FILE=/dev/null", "FONTCONFIG_PATH=/nonexistent", "HOME=" + desk.file("home"),
                     "XDG_DATA_HOME=/nonexistent"},
                    {"run", desk.file("s.toml"), "-o", desk.file("b"), "-q"})
              .status == 0);
  CHECK(support::read_file(desk / "a/frames/000002.png") == support::read_file(desk / "b/frames/000002.png"));
}

TEST_CASE("a locale with decimal commas changes no number that is read or written", "[faults]") {
  const Desk desk(scene("0.3", "[[figure]]\nkind = \"time-series\"\n"));
  const bool german = desk.shell("localedef -i de_DE -f UTF-8 ./de_DE.UTF-8 2>/dev/null").status <= 1 &&
                      fs::exists(desk / "de_DE.UTF-8");
  if (!german) WARN("the locale de_DE.UTF-8 cannot be made here; only LC_ALL is set");
  std::vector<std::string> commas = preload("foreign_locale");
  commas.insert(commas.end(), {"LC_ALL=de_DE.UTF-8", "LOCPATH=" + desk.path().string()});
  // The C library keeps its list of locale paths until the end, which a leak checker takes for a loss.
  commas.push_back("ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0");
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("a"), "-q"}).status == 0);
  REQUIRE(desk.with(commas, {"run", desk.file("s.toml"), "-o", desk.file("b"), "-q"}).status == 0);
  REQUIRE(desk({"export", desk.file("a/trajectory.h5"), "--csv", desk.file("a.csv")}).status == 0);
  REQUIRE(desk.with(commas, {"export", desk.file("b/trajectory.h5"), "--csv", desk.file("b.csv")}).status == 0);
  CHECK(support::read_file(desk / "a.csv") == support::read_file(desk / "b.csv"));
  for (const char* name : {"scene.toml", "trajectory.h5", "time-series.csv", "time-series.svg", "frames/000002.png"})
    CHECK(support::read_file(desk / (std::string("a/") + name)) ==
          support::read_file(desk / (std::string("b/") + name)));
  CHECK(desk.with(commas, {"compare", desk.file("a/frames"), desk.file("b/frames"), "--rmse", "0.15"}).status == 0);
}

TEST_CASE("a scene cannot send its results out of the output folder", "[faults]") {
  for (const std::string out : {"../escaped", "/tmp/escaped", "frames/000000", ".."}) {
    const Desk desk(scene("0.2", "[[figure]]\nkind = \"time-series\"\nout = \"" + out + "\"\n"));
    const Outcome o = desk({"run", desk.file("s.toml"), "-o", desk.file("out")});
    CHECK(o.status == 1);
    CHECK(one_sentence(o.err));
    CHECK_THAT(o.err, Contains("without folders"));
    CHECK(desk.names().empty());
  }
}

TEST_CASE("scenes that would break the parser are refused in one sentence", "[faults]") {
  const auto refusal = [](const std::string& text) {
    const Desk desk(text);
    const Outcome o = desk({"info", desk.file("s.toml")});
    CHECK(o.status == 1);
    CHECK(one_sentence(o.err));
    return o.err;
  };
  std::string deep = "a";
  for (int k = 0; k < 100000; ++k) deep += ".a";
  CHECK_THAT(refusal(deep + " = 1\n"), Contains("s.toml:1: a key of more than 200 parts"));
  CHECK_THAT(refusal("[" + deep + "]\n"), Contains("a key of more than 200 parts"));
  CHECK_THAT(refusal("title = " + std::string(100000, '[')), Contains("nested"));
  CHECK_THAT(refusal("\n[fl\xc3\xb6w]\n"), Contains("s.toml:2: a letter beyond ASCII"));
  CHECK_THAT(refusal("[\x1bvesicle]\n"), Contains("s.toml:1:2"));
  const Desk fine(scene("0.2", "# gr\xc3\xbc\xc3\x9f\x65\n") + "");
  CHECK(fine({"info", fine.file("s.toml")}).status == 0);
}
