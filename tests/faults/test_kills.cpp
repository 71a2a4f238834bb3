// kill -9 at random moments: what was reported stays, and what comes in the end is the same to the last bit.
#include "desk.h"
#include "render/image/image.h"
#include "sim/trajectory/trajectory.h"
#include "tests/support/catch.h"

#include <csignal>
#include <random>

using namespace faults;

namespace {

constexpr int wanted_kills = 50;

/// Starts the command again and again and kills it after a random time, until there have been enough kills; `check`
/// looks at what is left each time, `done` when the command came to its end, after which everything starts over.
template <class Check, class Done>
void kill_often(const Desk& desk, const std::vector<std::string>& words, int longest_ms, Check&& check, Done&& done) {
  std::mt19937 random(11);
  int kills = 0, ends = 0;
  while (kills < wanted_kills) {
    std::vector<std::string> line = words;
    line.insert(line.begin(), TANKTREAD_PROGRAM);
    const pid_t child = support::start(desk, line);
    usleep(1000 * static_cast<useconds_t>(std::uniform_int_distribution<int>(1, longest_ms)(random)));
    kill(child, SIGKILL);
    const Outcome outcome = support::finish(desk, child);
    INFO(outcome.err);
    REQUIRE((outcome.status == 0 || outcome.status == -SIGKILL));
    check();
    if (outcome.status == 0) {
      ++ends;
      done();
    } else {
      ++kills;
    }
  }
  WARN(kills << " kills, " << ends << " complete runs between them");
}

std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      all[entry.path().lexically_relative(folder).string()] = support::read_file(entry.path());
  return all;
}

/// Living processes with this word on their command lines.
int processes_naming(const std::string& word) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") == std::string::npos &&
        support::read_file(entry.path() / "cmdline").find(word) != std::string::npos)
      ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("a simulation killed fifty times loses no state and ends with the same bytes", "[faults]") {
  const Desk desk(scene("20"));
  const std::string file = desk.file("t.h5");
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("whole.h5"), "-q"}).status == 0);
  const std::string whole = support::read_file(desk / "whole.h5");
  std::int64_t least = 0;
  kill_often(
      desk, {"simulate", desk.file("s.toml"), "-o", file, "--resume", "-q"}, 250,
      [&] {
        if (!fs::exists(file)) {
          REQUIRE(least == 0);
          return;
        }
        const sim::TrajectoryReader reader(file);
        REQUIRE(reader.damaged().empty());
        REQUIRE(reader.count() >= least);  // a state that has been seen is never gone
        least = reader.count();
      },
      [&] {
        REQUIRE(support::read_file(file) == whole);
        fs::remove(file);
        least = 0;
      });
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", file, "--resume", "-q"}).status == 0);
  CHECK(support::read_file(file) == whole);
  CHECK(desk.names() == std::set<std::string>{"t.h5", "whole.h5"});
}

TEST_CASE("processes that draw shards end with the one that started them, asked or killed", "[faults]") {
  const Desk desk(scene("1"));
  constexpr std::size_t frames = 4001;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  for (const int number : {SIGTERM, SIGKILL}) {
    const std::string out = desk.file(number == SIGTERM ? "asked" : "killed");
    const pid_t child = support::start(desk, {TANKTREAD_PROGRAM, "render", desk.file("t.h5"), "-o", out, "-q", "-j",
                                              "2", "--set", "movie.time_per_frame=0.00025"});
    const bool drawing = support::wait_for(out + "/frames/000002.png") && support::wait_for(out + "/frames/000003.png");
    kill(child, number);
    CHECK(support::finish(desk, child).status == (number == SIGTERM ? 130 : -SIGKILL));
    REQUIRE(drawing);
    // One that was killed cannot wait for its children; a minute is beyond all doubt.
    for (int k = 0; number == SIGKILL && k < 6000 && processes_naming(out) > 0; ++k) usleep(10000);
    CHECK(processes_naming(out) == 0);
    std::size_t drawn = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(out + "/frames")) ++drawn;
    CHECK(drawn < frames);
  }
}

TEST_CASE("a rendering killed fifty times has no torn, missing or double frame, and the same movie in the end",
          "[faults]") {
  const Desk desk(scene("3"));
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("whole"), "-q"}).status == 0);
  const auto whole = contents(desk / "whole");
  REQUIRE(whole.size() >= 31);
  std::size_t least = 0;
  const auto finished_frames = [&] {
    std::size_t count = 0;
    if (!fs::exists(desk / "out/frames")) return count;
    for (const auto& entry : fs::directory_iterator(desk / "out/frames")) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with('.')) continue;  // being written when the kill came
      REQUIRE(support::read_file(entry.path()) == whole.at("frames/" + name));
      ++count;
    }
    return count;
  };
  kill_often(
      desk, {"render", desk.file("t.h5"), "-o", desk.file("out"), "-q"}, 300,
      [&] {
        const std::size_t count = finished_frames();
        REQUIRE(count >= least);
        least = count;
      },
      [&] {
        REQUIRE(contents(desk / "out") == whole);
        fs::remove_all(desk / "out");
        least = 0;
      });
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("out"), "-q"}).status == 0);
  CHECK(desk.names("out") == desk.names("whole"));  // nothing half-written is left either
  CHECK(contents(desk / "out") == whole);
}
