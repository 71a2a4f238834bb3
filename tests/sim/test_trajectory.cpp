// The trajectory file: what goes in comes out, and nothing that was reported is ever lost.
#include "sim/trajectory/trajectory.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <random>

using namespace sim;
using support::message_of;
using support::TemporaryFolder;

namespace {

Coefficients coefficients(int order, int fields, double seed) {
  Coefficients c{order, Matrix(coefficient_count(order), fields)};
  for (Eigen::Index j = 0; j < fields; ++j)
    for (Eigen::Index i = 0; i < c.values.rows(); ++i)
      c.values(i, j) = std::sin(seed + 0.37 * double(i) + 1.9 * double(j));
  return c;
}

/// State k of a run that can be computed at once, two vesicles of different order.
State state(int k) {
  State s{k * 10, 0.1 * k, {}};
  for (int v = 0; v < 2; ++v) {
    const int order = v == 0 ? 4 : 6;
    const double seed = k + 0.1 * v;
    VesicleState w{coefficients(order, 3, seed),
                   coefficients(order, 3, seed + 1),
                   coefficients(order, 1, seed + 2),
                   coefficients(12, 3, seed + 3),
                   Matrix::Random(14, 3),
                   coefficients(order, 3, seed + 4),
                   coefficients(order, 3, seed + 5),
                   coefficients(order, 3, seed + 6),
                   k,
                   v,
                   seed};
    for (int i = 0; i < 14; ++i)
      for (int j = 0; j < 3; ++j) w.tracers(i, j) = std::cos(seed + i + 0.3 * j);
    s.vesicles.push_back(w);
  }
  return s;
}

StepRecord record(int step) {
  StepRecord r{double(step), 0.01 * step, 0.01, 7, 1e-11, 0, 0.5, 3, 1e-6, {}};
  r.vesicles = {{1e-9 * step, 2, 3, 4, 5, 6, 0}, {7, 8, 9, 10, 11, 12, double(step)}};
  return r;
}

std::vector<double> payload(int k) { return {double(k), 0.5 * k, -1.0 * k}; }

TrajectoryLayout layout(int states, int steps = 8) { return {2, 6, 12, 14, states, steps, 4}; }
const TrajectoryHeader header{"title = \"test\"\n[time]\nend = 1.0\n", "0.1.0", "g++", {"under-resolved"}};

bool same(const Coefficients& a, const Coefficients& b) { return a.order == b.order && a.values == b.values; }
bool same(const State& a, const State& b) {
  bool equal = a.step == b.step && a.time == b.time && a.vesicles.size() == b.vesicles.size();
  for (std::size_t v = 0; equal && v < a.vesicles.size(); ++v) {
    const VesicleState &x = a.vesicles[v], &y = b.vesicles[v];
    equal = same(x.position, y.position) && same(x.velocity, y.velocity) && same(x.tension, y.tension) &&
            same(x.labels, y.labels) && x.tracers == y.tracers && same(x.position_before, y.position_before) &&
            same(x.velocity_before, y.velocity_before) && same(x.sliding, y.sliding) && x.relabelled == y.relabelled &&
            x.labels_laid == y.labels_laid && x.labels_laid_time == y.labels_laid_time;
  }
  return equal;
}

/// States 1..last with 10 steps each; reports k on fd after the append has returned.
void write_states(TrajectoryWriter& writer, int last, int fd) {
  for (int k = static_cast<int>(writer.resume_payload().at(0)) + 1; k <= last; ++k) {
    for (int step = 10 * k - 9; step <= 10 * k; ++step) {
      const StepRecord one[] = {record(step)};
      writer.append_steps(one);
    }
    writer.append(state(k));
    if (fd >= 0 && write(fd, &k, sizeof k) != sizeof k) _exit(3);
    writer.write_resume(payload(k));
  }
}

TrajectoryWriter written(const std::filesystem::path& path, int states, int capacity) {
  TrajectoryWriter writer = TrajectoryWriter::create(path, layout(capacity), header, state(0), payload(0));
  write_states(writer, states - 1, -1);
  return writer;
}

}  // namespace

TEST_CASE("a trajectory gives back what was written, bit for bit", "[trajectory]") {
  const TemporaryFolder folder;
  const auto path = folder / "t.h5";
  written(path, 5, 5);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator()) == 1);
  const TrajectoryReader reader(path);
  CHECK(reader.count() == 5);
  CHECK(reader.header().scene == header.scene);
  CHECK(reader.header().program == "0.1.0");
  CHECK(reader.header().build == "g++");
  CHECK(reader.header().warnings == header.warnings);
  for (int k = 0; k < 5; ++k) {
    CHECK(same(reader.state(k), state(k)));
    CHECK(reader.time(k) == state(k).time);
  }
  const std::vector<StepRecord> steps = reader.steps();
  REQUIRE(steps.size() == 40);
  CHECK(steps[7].step == 8);
  CHECK(steps[7].vesicles[1].relabelled == 8);
  CHECK(steps[7].vesicles[0].area_error == 1e-9 * 8);
  CHECK(reader.resume_payload() == payload(4));
  CHECK(reader.damaged().empty());
  CHECK_THAT(message_of([&] { reader.state(5); }), Catch::Contains("has states 0 to 4, not 5"));
}

TEST_CASE("a trajectory grows when more states, steps or resume numbers come than were expected", "[trajectory]") {
  const TemporaryFolder folder;
  const auto path = folder / "t.h5";
  TrajectoryWriter writer = written(path, 40, 3);
  TrajectoryReader reader(path);
  writer.note("a remark");
  writer.note("a remark");
  writer.write_resume(std::vector<double>(100, 2.5));
  CHECK(reader.refresh() == 40);
  CHECK(reader.notes() == std::vector<std::string>{"a remark"});
  CHECK(reader.resume_payload() == std::vector<double>(100, 2.5));
  CHECK(reader.steps().size() == 390);
  for (int k = 0; k < 40; ++k) CHECK(same(reader.state(k), state(k)));
}

TEST_CASE("a trajectory makes room for higher orders and keeps what is in it", "[trajectory]") {
  const TemporaryFolder folder;
  const auto path = folder / "t.h5";
  TrajectoryLayout room = layout(8);
  room.order = 9;
  room.label_order = 20;
  {
    TrajectoryWriter writer = written(path, 3, 8);
    TrajectoryReader reader(path);
    writer.make_room(layout(8));  // there is
    CHECK(reader.layout().order == 6);
    writer.make_room(room);
    State higher = state(3);
    higher.vesicles[1].position = coefficients(9, 3, 1);
    CHECK_THROWS(writer.append(higher));  // its other fields are not
    higher = state(3);
    for (Coefficients* c :
         {&higher.vesicles[1].position, &higher.vesicles[1].velocity, &higher.vesicles[1].position_before,
          &higher.vesicles[1].velocity_before, &higher.vesicles[1].sliding})
      *c = coefficients(9, 3, 7);
    higher.vesicles[1].tension = coefficients(9, 1, 8);
    higher.vesicles[1].labels = coefficients(20, 3, 9);
    writer.append(higher);
    CHECK(reader.refresh() == 4);
    CHECK(reader.layout().order == 9);
    CHECK(reader.layout().label_order == 20);
    for (int k = 0; k < 3; ++k) CHECK(same(reader.state(k), state(k)));
    CHECK(same(reader.state(3), higher));
    CHECK(reader.damaged().empty());
    CHECK(reader.steps().size() == 20);
    CHECK(reader.resume_payload() == payload(2));
  }
  // A damaged state stays one.
  const TemporaryFolder other;
  const auto damaged = other / "t.h5";
  written(damaged, 3, 8);
  std::string bytes = support::read_file(damaged);
  const double x = state(1).vesicles[0].position.values(3, 1);
  const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(&x), sizeof x));
  REQUIRE(at != std::string::npos);
  bytes[at + 3] = char(bytes[at + 3] ^ 1);
  support::write_file(damaged, bytes);
  TrajectoryWriter writer = TrajectoryWriter::resume(damaged);
  writer.make_room(room);
  const TrajectoryReader reader(damaged);
  CHECK(reader.damaged() == std::vector<std::int64_t>{1});
  CHECK(same(reader.state(0), state(0)));
  CHECK(same(reader.state(2), state(2)));
  CHECK_THAT(message_of([&] { reader.state(1); }), Catch::Contains("damaged"));
}

TEST_CASE("the bytes of a finished file do not tell how often and how long resume records were before",
          "[trajectory]") {
  const TemporaryFolder folder;
  const std::vector<double> last{9, 8, 7};
  const auto finished = [&](const char* name, const std::vector<std::vector<double>>& before) {
    TrajectoryLayout room = layout(2);
    room.resume = 50;
    TrajectoryWriter writer = TrajectoryWriter::create(folder / name, room, header, state(0), payload(0));
    for (const std::vector<double>& record : before) writer.write_resume(record);
    writer.finish_resume(last, 0);
    CHECK(writer.resume_payload() == last);
    return support::read_file(folder / name);
  };
  const std::string bytes = finished("a.h5", {});
  CHECK(finished("b.h5", {std::vector<double>(50, 1.5)}) == bytes);
  CHECK(finished("c.h5", {std::vector<double>(20, 1.5), std::vector<double>(40, 2.5), {1}}) == bytes);
}

TEST_CASE("a reader follows a trajectory that is being written", "[trajectory]") {
  const TemporaryFolder folder;
  TrajectoryWriter writer = written(folder / "t.h5", 2, 3);
  TrajectoryReader reader(folder / "t.h5");
  CHECK(reader.count() == 2);
  for (int k = 2; k < 20; ++k) {
    writer.append(state(k));
    CHECK(reader.refresh() == k + 1);
    CHECK(same(reader.state(k), state(k)));
  }
}

TEST_CASE("a second writer of the same trajectory is refused", "[trajectory]") {
  const TemporaryFolder folder;
  const TrajectoryWriter writer = written(folder / "t.h5", 2, 3);
  std::filesystem::create_symlink("t.h5", folder / "link.h5");
  std::filesystem::create_hard_link(folder / "t.h5", folder / "twin.h5");
  for (const char* name : {"t.h5", "link.h5", "twin.h5"}) {
    CHECK_THAT(message_of([&] { TrajectoryWriter::resume(folder / name); }),
               Catch::Contains("another process is writing"));
    CHECK_THAT(message_of([&] { written(folder / name, 1, 2); }), Catch::Contains("another process is writing"));
  }
  CHECK(std::filesystem::is_symlink(folder / "link.h5"));
}

TEST_CASE("a trajectory is written through a link and takes the place of no foreign file", "[trajectory]") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "disk");
  std::filesystem::create_symlink("disk/t.h5", folder / "t.h5");
  for (int k = 1; k < 3; ++k) {  // to nothing, then to a trajectory
    written(folder / "t.h5", k, 4);
    CHECK(std::filesystem::is_symlink(folder / "t.h5"));
    CHECK(TrajectoryReader(folder / "disk/t.h5").count() == k);
  }
  support::write_file(folder / "thesis.pdf", "precious");
  support::write_file(folder / "u.h5.lock", "mine");
  support::write_file(folder / "u.h5.tmp", "mine");
  support::write_file(folder / "u.h5", "");  // as mktemp leaves it
  CHECK_THAT(message_of([&] { written(folder / "thesis.pdf", 1, 2); }),
             Catch::Contains("is not a trajectory of this program"));
  CHECK_THAT(message_of([&] { written("/dev/null", 1, 2); }), Catch::Contains("is not a file"));
  written(folder / "u.h5", 1, 2);
  CHECK(support::read_file(folder / "thesis.pdf") == "precious");
  CHECK(support::read_file(folder / "u.h5.lock") == "mine");
  CHECK(support::read_file(folder / "u.h5.tmp") == "mine");
  CHECK(std::filesystem::is_character_file("/dev/null"));
}

TEST_CASE("what cannot be made ready leaves the trajectory that was there, and no draft", "[trajectory]") {
  const TemporaryFolder folder;
  const auto path = folder / "t.h5";
  written(path, 2, 3);
  const std::string before = support::read_file(path);
  const auto refuse = [] { throw std::runtime_error("not today"); };
  CHECK(message_of([&] { TrajectoryWriter::create(path, layout(3), header, state(0), payload(0), refuse); }) ==
        "not today");
  CHECK(support::read_file(path) == before);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator()) == 1);
}

TEST_CASE("kill -9 at any instant loses no reported state, and the run goes on from there", "[trajectory]") {
  const TemporaryFolder folder;
  const auto path = folder / "t.h5";
  const int states = 400;
  std::mt19937 random(5);
  int kills = 0, reported = -1;
  while (kills < 40) {
    int pipes[2];
    REQUIRE(pipe(pipes) == 0);
    const pid_t child = fork();
    if (child == 0) {
      close(pipes[0]);
      try {
        auto writer = std::filesystem::exists(path)
                          ? TrajectoryWriter::resume(path)
                          : TrajectoryWriter::create(path, layout(5), header, state(0), payload(0));
        write_states(writer, states, pipes[1]);
      } catch (...) {
        _exit(2);
      }
      _exit(0);
    }
    close(pipes[1]);
    usleep(static_cast<useconds_t>(std::uniform_int_distribution<int>(300, 12000)(random)));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    for (int k = 0; read(pipes[0], &k, sizeof k) == sizeof k;) reported = std::max(reported, k);
    close(pipes[0]);
    REQUIRE_FALSE((WIFEXITED(status) && WEXITSTATUS(status) != 0));
    ++kills;
    if (!std::filesystem::exists(path)) {
      REQUIRE(reported < 0);
      continue;
    }
    const TrajectoryReader reader(path);
    REQUIRE(reader.count() > reported);
    REQUIRE(reader.damaged().empty());
    if (reader.count() > states) {
      std::filesystem::remove(path);
      reported = -1;
    }
  }
  if (!std::filesystem::exists(path)) written(path, 2, 5);
  {
    auto writer = TrajectoryWriter::resume(path);
    write_states(writer, states, -1);
  }
  const TrajectoryReader reader(path);
  REQUIRE(reader.count() == states + 1);
  for (int k = 0; k <= states; ++k) REQUIRE(same(reader.state(k), state(k)));
  const std::vector<StepRecord> steps = reader.steps();
  REQUIRE(steps.size() == 10 * states);
  for (int s = 0; s < 10 * states; ++s) REQUIRE(steps[std::size_t(s)].step == s + 1);
}

TEST_CASE("a killed and resumed trajectory has the same bytes as an uninterrupted one", "[trajectory]") {
  const TemporaryFolder folder;
  written(folder / "a.h5", 9, 9);
  { TrajectoryWriter w = written(folder / "b.h5", 4, 9); }
  TrajectoryWriter again = TrajectoryWriter::resume(folder / "b.h5");
  write_states(again, 8, -1);
  CHECK(support::read_file(folder / "a.h5") == support::read_file(folder / "b.h5"));
}

TEST_CASE("truncated, foreign and missing trajectories are told in one sentence", "[trajectory]") {
  const TemporaryFolder folder;
  const auto path = folder / "t.h5";
  CHECK_THAT(message_of([&] { TrajectoryReader r(path); }), Catch::Contains("No such file"));
  written(path, 5, 5);
  const std::string bytes = support::read_file(path);
  for (const double share : {0.0, 0.00001, 0.001, 0.1, 0.5, 0.9, 0.9999}) {
    support::write_file(path, bytes.substr(0, static_cast<std::size_t>(share * double(bytes.size()))));
    const std::string message = message_of([&] { TrajectoryReader r(path); });
    CHECK_THAT(message, Catch::Contains("cut short") || Catch::Contains("damaged") || Catch::Contains("no HDF5 file"));
    CHECK_THAT(message, Catch::Contains("t.h5"));
    CHECK_FALSE(message_of([&] { TrajectoryWriter::resume(path); }).empty());
  }
  support::write_file(path, "hello\n");
  CHECK_THAT(message_of([&] { TrajectoryReader r(path); }), Catch::Contains("is no HDF5 file"));
  CHECK_THAT(message_of([&] { TrajectoryReader r(folder.path()); }), Catch::Contains("is not a file"));
}

TEST_CASE("no flipped bit passes unnoticed or crashes the reader", "[trajectory]") {
  const TemporaryFolder folder;
  const auto path = folder / "t.h5";
  written(path, 5, 5);
  const std::string bytes = support::read_file(path);
  std::mt19937 random(7);
  int refused = 0, named = 0;
  for (int flip = 0; flip < 300; ++flip) {
    std::string damaged = bytes;
    const std::size_t range = flip % 2 ? bytes.size() : 6000;  // data and metadata
    const std::size_t byte = std::uniform_int_distribution<std::size_t>(0, range - 1)(random);
    damaged[byte] = static_cast<char>(damaged[byte] ^ (1 << (flip % 8)));
    support::write_file(path, damaged);
    try {
      const TrajectoryReader reader(path);
      const auto broken = reader.damaged();
      named += !broken.empty();
      for (std::int64_t k = 0; k < reader.count(); ++k)
        if (std::find(broken.begin(), broken.end(), k) == broken.end())
          REQUIRE(same(reader.state(k), state(static_cast<int>(k))));
      REQUIRE(reader.count() >= 4);
    } catch (const std::runtime_error& error) {
      ++refused;
      REQUIRE_THAT(error.what(), Catch::Contains("t.h5"));
    }
  }
  CHECK(refused > 0);
  CHECK(named > 0);
}

TEST_CASE("a full disk is an error that keeps every reported state", "[trajectory]") {
  const TemporaryFolder folder;
  const auto path = folder / "t.h5";
  int pipes[2];
  REQUIRE(pipe(pipes) == 0);
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);  // write() then fails with EFBIG, as it does with ENOSPC
    TrajectoryWriter writer = TrajectoryWriter::create(path, layout(4), header, state(0), payload(0));
    const rlimit limit{600000, 600000};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string message = message_of([&] { write_states(writer, 100000, pipes[1]); });
    _exit(message.find("t.h5") != std::string::npos ? 7 : 1);
  }
  close(pipes[1]);
  int reported = 0;
  for (int k = 0; read(pipes[0], &k, sizeof k) == sizeof k;) reported = k;
  close(pipes[0]);
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 7);
  CHECK(reported > 3);
  {
    const TrajectoryReader reader(path);
    CHECK(reader.count() == reported + 1);
    CHECK(reader.damaged().empty());
  }
  auto writer = TrajectoryWriter::resume(path);
  write_states(writer, reported + 5, -1);
  CHECK(writer.count() == reported + 6);
}

TEST_CASE("a state that does not fit the trajectory is refused", "[trajectory]") {
  const TemporaryFolder folder;
  TrajectoryWriter writer = written(folder / "t.h5", 1, 2);
  State few = state(1);
  few.vesicles.pop_back();
  CHECK_THAT(message_of([&] { writer.append(few); }), Catch::Contains("1 vesicles"));
  State large = state(1);
  large.vesicles[1].position = coefficients(7, 3, 0);
  CHECK_FALSE(message_of([&] { writer.append(large); }).empty());
  CHECK(writer.count() == 1);
}
