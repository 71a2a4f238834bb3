// kill -9 at every operation that changes a file, and at random moments, upon every command that writes: the next run
// of the same command leaves the very bytes of one that was never killed, and nothing else.
//
// TANKTREAD_KILLS sets how many kills there are in all; a few minutes' worth without it (docs/faults.md has the long
// form).
#include "desk.h"
#include "render/image/image.h"
#include "tests/support/catch.h"

#include <csignal>
#include <cstdlib>
#include <random>
#include <sstream>

using namespace faults;

namespace {

using Contents = std::map<std::string, std::string>;

Contents contents(const fs::path& folder) {
  Contents all;
  if (!fs::exists(folder)) return all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    all[entry.path().lexically_relative(folder).string()] =
        entry.is_regular_file() ? support::read_file(entry.path()) : "a folder";
  return all;
}

std::string difference(const Contents& a, const Contents& b) {
  std::string text;
  for (const auto& [name, bytes] : a)
    if (!b.contains(name))
      text += name + " is missing\n";
    else if (b.at(name) != bytes)
      text += name + " differs\n";
  for (const auto& [name, bytes] : b)
    if (!a.contains(name)) text += name + " is left over\n";
  return text;
}

/// Processes that were started by one that was killed may still be ending.
void wait_until_gone(const fs::path& work) {
  for (int k = 0; k < 6000; ++k) {
    bool found = false;
    for (const auto& entry : fs::directory_iterator("/proc")) {
      std::error_code gone;
      found = found || fs::read_symlink(entry.path() / "cwd", gone) == work;
    }
    if (!found) return;
    usleep(10000);
  }
  FAIL("processes are left");
}

struct Tried {
  std::string name;
  int share;                                        ///< of all kills, percent
  std::vector<std::string> words;                   ///< the command, in the folder `work`
  std::function<void(const fs::path& work)> begin;  ///< what is there before
};

int wanted_kills() {
  const char* text = std::getenv("TANKTREAD_KILLS");
  return text ? std::atoi(text) : 50;
}

void copy_into(const fs::path& from, const fs::path& to) { fs::copy(from, to, fs::copy_options::recursive); }

/// A run of the command in `work`, with variables; the status.
int run_in(const Desk& desk, const Tried& tried, std::vector<std::string> variables, int kill_after_us = -1) {
  std::vector<std::string> line{"/usr/bin/env", "-C", desk.file("work")};
  line.insert(line.end(), variables.begin(), variables.end());
  line.push_back(TANKTREAD_PROGRAM);
  line.insert(line.end(), tried.words.begin(), tried.words.end());
  const pid_t child = support::start(desk, line);
  if (kill_after_us >= 0) {
    usleep(static_cast<useconds_t>(kill_after_us));
    kill(child, SIGKILL);
  }
  return support::finish(desk, child).status;
}

void kill_everywhere(const Desk& desk, const Tried& tried) {
  const fs::path work = desk / "work";
  const auto begin = [&] {
    fs::remove_all(work);
    fs::create_directories(work);
    tried.begin(work);
  };
  begin();
  const auto started = std::chrono::steady_clock::now();
  REQUIRE(run_in(desk, tried, {}) == 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  const Contents whole = contents(work);
  begin();
  std::vector<std::string> counting = preload("killed_at");
  counting.push_back("COUNT_TO=" + desk.file("count"));
  fs::remove(desk / "count");
  REQUIRE(run_in(desk, tried, counting) == 0);
  REQUIRE(difference(whole, contents(work)).empty());  // nothing depends on the time of day
  long operations = 0;                                 // of the process that has most
  std::istringstream counts(support::read_file(desk / "count"));
  for (long n = 0; counts >> n;) operations = std::max(operations, n);
  REQUIRE(operations > 5);

  std::mt19937 random(7);
  const int wanted = std::max(3, wanted_kills() * tried.share / 100);
  int kills = 0, by_operation = 0, ends = 0;
  // Every operation in turn as far as the kills reach, spread evenly; each chain of up to three kills ends with a whole
  // run.
  for (int k = 0; kills < wanted; ++k) {
    begin();
    std::string history;
    for (int links = 0; links < 3 && kills < wanted; ++links) {
      const bool timed = random() % 4 == 0;
      int status = 0;
      if (timed) {
        const int after = std::uniform_int_distribution<int>(0, static_cast<int>(1.1e6 * seconds))(random);
        status = run_in(desk, tried, {}, after);
        history += "after " + std::to_string(after) + " us; ";
      } else {
        const long at = 1 + (links == 0 ? (static_cast<long>(by_operation) * 7919) % operations
                                        : static_cast<long>(random() % static_cast<unsigned long>(operations)));
        const char* how = std::array{"before", "torn", "after"}[random() % 3];
        std::vector<std::string> variables = preload("killed_at");
        variables.push_back("KILL_AT=" + std::to_string(at));
        variables.push_back(std::string("KILL_HOW=") + how);
        status = run_in(desk, tried, variables);
        history += std::string(how) + " operation " + std::to_string(at) + "; ";
      }
      wait_until_gone(work);
      if (status == 0) {
        ++ends;
        break;
      }
      ++kills;
      by_operation += !timed;
      if (status != -SIGKILL) {  // a process of its own was killed: it says so
        INFO(tried.name << ": " << history << support::read_file(desk / "err.txt"));
        REQUIRE(status == 1);
      }
    }
    const int status = run_in(desk, tried, {});
    INFO(tried.name << ": " << history << support::read_file(desk / "err.txt"));
    REQUIRE(status == 0);
    const std::string wrong = difference(whole, contents(work));
    REQUIRE(wrong == "");
  }
  WARN(tried.name << ": " << kills << " kills, " << by_operation << " of them at one of " << operations
                  << " operations, " << ends << " runs that came to their end before");
}

/// A folder with a scene s.toml and its trajectory t.h5.
struct Workshop : Desk {
  Workshop() : Desk(scene("0.4", "[movie]\nposter = 0.2\n[[figure]]\nkind = \"cross-sections\"\npanels = 2\n")) {
    REQUIRE((*this)({"simulate", file("s.toml"), "-o", file("t.h5"), "-q"}).status == 0);
  }
  auto with(const std::string& name) const {
    return [this, name](const fs::path& work) { copy_into(*this / name, work / name); };
  }
};

}  // namespace

TEST_CASE("a run, killed anywhere, leaves in the end what it would have left at once", "[faults][kills]") {
  const Workshop desk;
  kill_everywhere(desk, {"run", 35, {"run", "s.toml", "-o", "out", "-q"}, desk.with("s.toml")});
}

TEST_CASE("a run over earlier results, killed anywhere, leaves in the end what it would have left at once",
          "[faults][kills]") {
  const Workshop desk;
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "-q", "--set", "flow.rate=2"}).status == 0);
  kill_everywhere(desk, {"run --force", 15, {"run", "s.toml", "-o", "out", "-q", "--force"}, [&](const fs::path& work) {
                           copy_into(desk / "s.toml", work / "s.toml");
                           copy_into(desk / "out", work / "out");
                         }});
}

TEST_CASE("a rendering by processes, killed anywhere, leaves in the end what it would have left at once",
          "[faults][kills]") {
  const Workshop desk;
  kill_everywhere(desk, {"render -j 2", 15, {"render", "t.h5", "-o", "out", "-q", "-j", "2"}, desk.with("t.h5")});
}

TEST_CASE("a figure that was killed anywhere is in the end what it would have been at once", "[faults][kills]") {
  const Workshop desk;
  kill_everywhere(desk, {"figure", 10, {"figure", "time-series", "t.h5", "-q", "-o", "series"}, desk.with("t.h5")});
}

TEST_CASE("an export that was killed anywhere leaves in the end what it would have left at once", "[faults][kills]") {
  const Workshop desk;
  kill_everywhere(desk, {"export",
                         15,
                         {"export", "t.h5", "-q", "--csv", "t.csv", "--vtk", "v", "--ply", "p", "--latitudes", "6"},
                         desk.with("t.h5")});
}

TEST_CASE("baselines whose renewal was killed anywhere are in the end what they would have been at once",
          "[faults][kills]") {
  const Workshop desk;
  kill_everywhere(
      desk, {"compare --update", 10, {"compare", "expected", "actual", "-q", "--update"}, [](const fs::path& work) {
               for (const char* folder : {"expected", "actual"}) fs::create_directories(work / folder / "deep");
               render::Image image(24, 16, 3);
               for (const std::string name : {"a.png", "b.png", "deep/c.png", "deep/d.png"}) {
                 render::write_png(work / "actual" / name, image);
                 for (auto& value : image.pixels) value = static_cast<std::uint8_t>(value + 60);
                 if (name != "deep/d.png") render::write_png(work / "expected" / name, image);
               }
             }});
}
