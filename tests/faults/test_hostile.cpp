// Files that somebody else has made or changed: each is refused in one sentence, or read for what it is.
#include "desk.h"
#include "sim/stepping/dynamics.h"
#include "sim/surface/geometry.h"
#include "sim/trajectory/attributes.h"
#include "sim/trajectory/trajectory_datasets.h"
#include "sim/trajectory/trajectory_file.h"
#include "tests/support/hostile_hdf5.h"

#include <sys/stat.h>

#include <fmt/format.h>
#include <cmath>
#include <csignal>
#include <limits>
#include <numbers>
#include "tests/support/catch.h"

using namespace faults;
using Catch::Contains;
using support::message_of;

namespace {

/// Of the changes of files at which a run is stopped; the sanitizers take their time to start it. 1 takes minutes.
#ifdef __SANITIZE_ADDRESS__
constexpr long every = 13;
#else
constexpr long every = 3;
#endif

/// One whole trajectory of 11 states for all tests.
const Desk& original() {
  static const Desk desk(scene("1"));
  static const Outcome outcome = desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"});
  REQUIRE(outcome.status == 0);
  return desk;
}

void copy_original(const fs::path& to) {
  fs::copy_file(original().file("t.h5"), to, fs::copy_options::overwrite_existing);
}

/// The file with edits that HDF5 makes in it.
template <class Edit>
void edit(const fs::path& path, Edit&& change) {
  const support::H5Quiet quiet;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(file >= 0);
  change(file);
  H5Fclose(file);
}

/// A number of a dataset, 8 bytes, and all checksums as if the program had written it.
void set_word(const fs::path& path, const std::string& dataset, std::uint64_t at, std::uint64_t value) {
  const sim::file::Descriptor file(path, true);
  const sim::file::Map map = sim::file::map(file).value();
  file.write(map.at(dataset).offset + 8 * at, &value, 8);
  const auto rows = map.at("checksum").rows;
  for (std::uint64_t row = 0; row < rows; ++row) {
    std::uint64_t sum = 0;
    file.read(map.at("checksum").offset + 8 * row, &sum, 8);
    if (sum == 0) continue;
    std::vector<std::byte> bytes;
    for (const sim::rows::Column& column : sim::rows::state_columns(map.layout)) {
      const sim::file::Place& place = map.at(column.name);
      bytes.resize(bytes.size() + place.row_bytes);
      file.read(place.offset + row * place.row_bytes, bytes.data() + bytes.size() - place.row_bytes, place.row_bytes);
    }
    sum = sim::rows::checksum(row, bytes);
    file.write(map.at("checksum").offset + 8 * row, &sum, 8);
  }
}
void set_number(const fs::path& path, const std::string& dataset, std::uint64_t at, double value) {
  set_word(path, dataset, at, std::bit_cast<std::uint64_t>(value));
}

/// Another resume record in both slots, with checksums that fit.
void set_record(const fs::path& path, const std::vector<double>& numbers) {
  const sim::file::Descriptor file(path, true);
  const sim::file::Map map = sim::file::map(file).value();
  const sim::file::Place &resume = map.at("resume"), &heads = map.at("resume_head");
  REQUIRE(8 * numbers.size() <= resume.row_bytes);
  for (std::uint64_t slot = 0; slot < 2; ++slot) {
    std::uint64_t head[3] = {};
    file.read(heads.offset + 24 * slot, head, sizeof head);
    head[1] = numbers.size();
    head[2] = sim::rows::checksum(head[0], std::as_bytes(std::span(numbers)));
    file.write(resume.offset + slot * resume.row_bytes, numbers.data(), 8 * numbers.size());
    file.write(heads.offset + 24 * slot, head, sizeof head);
  }
}

/// All that opens a trajectory: each refuses it in one sentence that names it, and leaves it as it was.
void check_refused_everywhere(const Desk& desk, const std::string& name, const std::string& words) {
  const std::string file = desk.file(name), before = support::read_file(file);
  const std::vector<std::vector<std::string>> commands{{"info", file},
                                                       {"render", file, "-o", desk.file("x")},
                                                       {"figure", "time-series", file, "-o", desk.file("x")},
                                                       {"export", file, "--csv", desk.file("x")},
                                                       {"simulate", desk.file("s.toml"), "-o", file, "--resume"}};
  for (const auto& command : commands) {
    const Outcome outcome = desk(command);
    INFO(command[0] << " " << name << ": " << outcome.status << " " << outcome.err);
    CHECK(outcome.status == 1);
    CHECK(one_sentence(outcome.err));
    CHECK_THAT(outcome.err, Contains(name) && Contains(words));
  }
  CHECK(support::read_file(file) == before);
}

}  // namespace

TEST_CASE("an attribute of another type or extent is refused before a byte of it is copied", "[hostile]") {
  const support::TemporaryFolder folder;
  const fs::path path = folder / "t.h5";
  copy_original(path);
  std::vector<std::string> names;
  edit(path, [&](hid_t file) { names = support::names_of_attributes(file); });
  REQUIRE(names.size() == 13);
  int kinds = 0;
  for (const std::string& name : names)
    for (int kind = 0; kind < 6; ++kind) {
      copy_original(path);
      edit(path, [&](hid_t file) {
        const hsize_t one[] = {1}, eight[] = {8}, many[] = {7000};
        const hid_t type = kind == 1   ? support::text_of_bytes(H5T_VARIABLE)
                           : kind == 2 ? support::text_of_bytes(9)
                           : kind == 3 ? H5Tarray_create2(H5T_STD_I64LE, 1, eight)
                           : kind == 4 ? H5Tcopy(H5T_IEEE_F64LE)
                                       : H5Tcopy(H5T_STD_I64LE);
        const hid_t space = kind == 0   ? H5Screate_simple(1, eight, nullptr)
                            : kind == 2 ? H5Screate_simple(1, many, nullptr)
                            : kind == 5 ? H5Screate_simple(1, one, nullptr)
                                        : H5Screate(H5S_SCALAR);
        support::replace_attribute(file, name, type, space);
        H5Tclose(type);
        H5Sclose(space);
      });
      const std::string message = message_of([&] { sim::TrajectoryReader reader(path); });
      INFO(name << " " << kind << ": " << message);
      CHECK_THAT(message, Contains("t.h5"));
      // Too large to be held in an object's header, it is not there at all.
      CHECK_THAT(message, Contains("is damaged: " + name) || Contains("not a Tanktread trajectory"));
      ++kinds;
    }
  CHECK(kinds == 78);
}

TEST_CASE("an array in the place of a number is told as damage by every command", "[hostile]") {
  const Desk desk(scene("1"));
  copy_original(desk.file("array.h5"));
  edit(desk.file("array.h5"), [](hid_t file) {
    const hsize_t eight[] = {8};
    const hid_t space = H5Screate_simple(1, eight, nullptr);
    support::replace_attribute(file, "format", H5T_STD_I64LE, space);
    H5Sclose(space);
  });
  check_refused_everywhere(desk, "array.h5", "is damaged");
}

TEST_CASE("a trajectory is written with all its attributes in the header of the root, however many warnings",
          "[hostile]") {
  const Desk desk(scene("1"));
  copy_original(desk.file("t.h5"));
  const sim::TrajectoryReader one(desk.file("t.h5"));
  sim::TrajectoryHeader header = one.header();
  for (int k = 0; k < 2000; ++k) header.warnings.push_back(fmt::format("vesicle {} is a little too coarse", k));
  sim::TrajectoryWriter::create(desk.file("many.h5"), one.layout(), header, one.state(0), one.resume_payload());
  for (const char* name : {"t.h5", "many.h5"}) {
    edit(desk.file(name), [](hid_t file) { CHECK(support::bytes_of_attribute_heap(file) == 0); });
    const sim::file::Descriptor file(desk.file(name), false);
    CHECK_FALSE(sim::file::Attributes(file).dense());
    const std::string bytes = support::read_file(desk / name);
    for (const char* part : {"OHDR", "OCHK", "FRHP", "BTHD"}) CHECK(bytes.rfind(part) + 4 < sim::file::metadata_bytes);
  }
  const std::vector<std::string> kept = sim::TrajectoryReader(desk.file("many.h5")).header().warnings;
  REQUIRE(kept.size() > 100);
  CHECK(kept.front() == header.warnings.front());
  CHECK(kept.back() == fmt::format("and {} more", header.warnings.size() - (kept.size() - 1)));
}

namespace {

void set_text(hid_t file, const char* name, std::size_t bytes) {
  const hid_t type = support::text_of_bytes(bytes), space = H5Screate(H5S_SCALAR);
  support::replace_attribute(file, name, type, space);
  H5Tclose(type);
  H5Sclose(space);
}

/// The original as earlier versions would have stored it: HDF5 moves all attributes into a heap when one is too large
/// for a header. That one, and one of 5000 bytes, lie outside the heap, which is of several blocks.
void make_dense(const fs::path& path) {
  copy_original(path);
  edit(path, [](hid_t file) {
    set_text(file, "remarks", 70000);
    set_text(file, "build", 5000);
    set_text(file, "warnings", 3000);
    CHECK(support::bytes_of_attribute_heap(file) > 0);
  });
}

}  // namespace

TEST_CASE("attributes in a heap of their own, as earlier versions left them, are read as well", "[hostile]") {
  const support::TemporaryFolder folder;
  const fs::path path = folder / "t.h5";
  const auto is_dense = [](const fs::path& file) {
    return sim::file::Attributes(sim::file::Descriptor(file, false)).dense();
  };
  const fs::path native = fs::path(TANKTREAD_CORPUS) / "trajectory" / "native.h5";  // of version 0.1.0
  CHECK(is_dense(native));
  CHECK(sim::TrajectoryReader(native).header().warnings.size() == 1);
  make_dense(path);
  CHECK(is_dense(path));
  const sim::TrajectoryHeader before = sim::TrajectoryReader(original().file("t.h5")).header();
  const sim::TrajectoryReader reader(path);
  CHECK(reader.header().build == std::string(5000, 'A'));
  CHECK(reader.header().warnings == std::vector<std::string>{std::string(3000, 'A')});
  CHECK(reader.header().program == before.program);
  CHECK(reader.header().scene == before.scene);
  CHECK(reader.damaged().empty());
}

TEST_CASE("a trajectory of an earlier format is read, without what it does not know, and is not continued",
          "[hostile]") {
  const auto [name, format] = GENERATE(table<const char*, int>({{"first-format.h5", 1}, {"second-format.h5", 2}}));
  const Desk desk;
  const fs::path earlier = fs::path(TANKTREAD_CORPUS) / "trajectory" / name;
  const sim::TrajectoryReader reader(earlier);
  CHECK(reader.layout().format == format);
  REQUIRE(reader.count() == 2);
  CHECK(reader.damaged().empty());
  const sim::VesicleState v = reader.state(1).vesicles[0];
  CHECK(v.sliding.values.isZero(0) == (format == 1));
  CHECK(v.sliding.values.rows() == v.position.values.rows());
  const sim::Basis basis(v.position.order, sim::measure_order(v.position.order));
  CHECK(sim::area_volume(basis, v.position).area == Approx(4 * std::numbers::pi).epsilon(1e-9));
  const std::vector<sim::StepRecord> steps = reader.steps();
  CHECK(steps.size() == (format == 1 ? 1 : 8));
  CHECK(steps.back().time == 0.1);
  CHECK(steps.back().order == (format == 1 ? 0 : 2));
  CHECK(steps.back().vesicles[0].area_error == Approx(0).margin(1e-12));
  CHECK(steps.back().vesicles[0].degree == 0);
  fs::copy_file(earlier, desk / "t.h5");
  const std::string before = support::read_file(desk / "t.h5");
  support::write_file(desk / "own.toml", reader.header().scene);
  const Outcome outcome =
      desk({"simulate", desk.file("own.toml"), "-o", desk.file("t.h5"), "--resume", "-q", "--set", "time.end=0.3"});
  INFO(outcome.err);
  CHECK(outcome.status == 1);
  CHECK(one_sentence(outcome.err));
  CHECK_THAT(outcome.err, Contains("cannot be resumed"));
  CHECK(support::read_file(desk / "t.h5") == before);
}

TEST_CASE("no flipped bit in a heap of attributes and its index passes unnoticed", "[hostile]") {
  const support::TemporaryFolder folder;
  const fs::path path = folder / "t.h5";
  make_dense(path);
  const std::string whole = support::read_file(path);
  const std::size_t added = support::read_file(original() / "t.h5").size();
  int flips = 0;
  for (const char* part : {"FRHP", "FHIB", "FHDB", "BTHD", "BTLF"}) {
    INFO(part);
    REQUIRE(whole.find(part, added) != whole.npos);
    for (std::size_t from = added; (from = whole.find(part, from)) != whole.npos; ++from)
      for (std::size_t at = from; at < from + 38; ++at, ++flips) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        support::write_file(path, damaged);
        INFO("byte " << at - from);
        const std::string message = message_of([&] { sim::TrajectoryReader r(path); });
        CHECK_THAT(message, Contains("t.h5"));
      }
  }
  CHECK(flips > 200);
}

TEST_CASE("attributes of the user stay readable in hundreds; more are told with the way out", "[hostile]") {
  const Desk desk(scene("1"));
  const auto add = [&](const char* name, int remarks) {
    copy_original(desk.file(name));
    edit(desk.file(name), [&](hid_t file) {
      set_text(file, "long remark", 70000);
      const hid_t space = H5Screate(H5S_SCALAR);
      for (int k = 0; k < remarks; ++k)
        support::replace_attribute(file, fmt::format("remark {}", k), H5T_STD_I64LE, space);
      H5Sclose(space);
    });
  };
  for (const int remarks : {16, 20, 200}) {
    add("some.h5", remarks);
    const sim::TrajectoryReader reader(desk.file("some.h5"));
    CHECK(reader.count() == 11);
    const sim::file::Attributes all(sim::file::Descriptor(desk.file("some.h5"), false));
    for (int k = 0; k < remarks; ++k) CHECK(all.number(fmt::format("remark {}", k).c_str()) == 0x4141414141414141);
  }
  add("many.h5", 2000);
  check_refused_everywhere(desk, "many.h5", "'h5repack' can make a plain copy");
}

TEST_CASE("datasets that lie elsewhere, and links that lead elsewhere, are refused and not followed", "[hostile]") {
  const Desk desk(scene("1"));
  const std::string pipe = desk.file("pipe");
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);  // whoever opens it never comes back
  using support::Storage;
  for (const std::string& name : support::names_of_datasets())
    for (int kind = 0; kind < 9; ++kind) {
      const bool group = name == "steps";
      if (group && kind >= 4) continue;
      copy_original(desk.file("t.h5"));
      edit(desk.file("t.h5"), [&](hid_t file) {
        if (kind < 4) return support::replace_link(file, name, kind, pipe);
        const hid_t old = H5Dopen2(file, name.c_str(), H5P_DEFAULT), type = H5Dget_type(old), space = H5Dget_space(old);
        H5Dclose(old);
        support::replace_dataset(file, name, type, space, static_cast<Storage>(kind - 4), pipe);
        H5Tclose(type);
        H5Sclose(space);
      });
      const std::string message = message_of([&] { sim::TrajectoryReader(desk.file("t.h5")).damaged(); });
      INFO(name << " " << kind << ": " << message);
      // A dataset of the same type, extent and storage is one; so is one that HDF5 made without any room.
      const bool contiguous = kind == 4;
      if (!contiguous) CHECK_THAT(message, Contains("is damaged"));
    }
  copy_original(desk.file("link.h5"));
  edit(desk.file("link.h5"), [&](hid_t file) { support::replace_link(file, "time", 0, pipe); });
  check_refused_everywhere(desk, "link.h5", "is damaged: time");
}

TEST_CASE("random edits of a trajectory by HDF5 are refused in one sentence or read without harm", "[hostile]") {
  const support::TemporaryFolder folder;
  const fs::path path = folder / "t.h5";
  support::Random random(3);
  int refused = 0;
  for (int k = 0; k < 300; ++k) {
    copy_original(path);
    edit(path, [&](hid_t file) { support::hostile_edit(file, "/nonexistent", random); });
    try {
      const sim::TrajectoryReader reader(path);
      for (std::int64_t s = 0; s < reader.count(); ++s) reader.state(s);
      reader.steps();
      sim::deserialised(reader.resume_payload(), reader.layout());
    } catch (const std::runtime_error& error) {
      ++refused;
      CHECK(*error.what() != '\0');
    }
  }
  CHECK(refused > 200);
}

TEST_CASE("named pipes, devices and folders are refused when they are opened", "[hostile]") {
  const Desk desk(scene("1"));
  REQUIRE(::mkfifo(desk.file("pipe").c_str(), 0600) == 0);
  for (const std::string& name : {desk.file("pipe"), std::string("/dev/zero"), desk.path().string()}) {
    const std::vector<std::vector<std::string>> commands{{"info", name},
                                                         {"run", name, "-o", desk.file("x")},
                                                         {"render", name, "-o", desk.file("x")},
                                                         {"figure", "time-series", name, "-o", desk.file("x")},
                                                         {"export", name, "--csv", desk.file("x")},
                                                         {"simulate", name, "-o", desk.file("x")}};
    for (const auto& command : commands) {
      const Outcome outcome = desk(command);
      INFO(command[0] << " " << name << ": " << outcome.err);
      CHECK(outcome.status == 1);
      CHECK(one_sentence(outcome.err));
    }
  }
  for (const char* tables :
       {"shape = \"file\"\nfile = \"pipe\"\n", "shape = \"file\"\nfile = \"/dev/zero\"\n",
        "shape = \"prolate\"\nreduced_volume = 0.9\n[placement]\nkind = \"file\"\nfile = \"pipe\"\n"}) {
    support::write_file(desk / "shape.toml",
                        "[flow]\nkind = \"shear\"\n[time]\nend = 1\n[[vesicle]]\norder = 4\n" + std::string(tables));
    const Outcome outcome = desk({"simulate", desk.file("shape.toml"), "-o", desk.file("x")});
    INFO(tables << ": " << outcome.err);
    CHECK(outcome.status == 1);
    CHECK_THAT(outcome.err, Contains("not a file") || Contains("there is no file"));
  }
  CHECK_FALSE(fs::exists(desk / "x"));
}

TEST_CASE("a resume record whose checksum fits is read as strictly as a state", "[hostile]") {
  const sim::TrajectoryReader reader(original().file("t.h5"));
  const std::vector<double> whole = reader.resume_payload();
  const sim::Dynamics d = sim::deserialised(whole, reader.layout());
  CHECK(sim::serialised(d) == whole);
  // Every number that is a count or a size, and some others, in turn made what it cannot be.
  int forged = 0, accepted = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    const double is = whole[at];
    const bool count = is != 0 && is == std::floor(is);
    if (!count && at % 29 != 0) continue;
    for (const double value : {-1.0, 0.5, 1e6, 1e18, 1e300, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity(), is + 1, is - 1}) {
      std::vector<double> numbers = whole;
      numbers[at] = value;
      ++forged;
      try {
        const sim::Dynamics read = sim::deserialised(numbers, reader.layout());
        ++accepted;
        CHECK(sim::serialised(read) == numbers);
        for (const sim::VesicleDynamics& v : read.vesicles) {
          sim::visit(v, []<class Member>(sim::Part, const Member& member) {
            if constexpr (std::is_same_v<Member, sim::Coefficients>)
              CHECK(member.values.rows() == sim::coefficient_count(member.order));
          });
          for (const sim::PastLevel& level : v.history.levels)
            CHECK(level.position.values.rows() == sim::coefficient_count(level.position.order));
        }
      } catch (const std::runtime_error&) {
      }
    }
  }
  CHECK(forged > 500);
  CHECK(forged - accepted > 400);
  // Cut anywhere, in memory that ends there.
  int refused = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<double> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    refused += !message_of([&] { sim::deserialised(part, reader.layout()); }).empty();
  }
  CHECK(refused == static_cast<int>(whole.size()));
  std::vector<double> longer = whole;
  longer.push_back(0);
  CHECK_THROWS_AS(sim::deserialised(longer, reader.layout()), std::runtime_error);
}

TEST_CASE("a forged resume record ends --resume with one sentence, and the file stays", "[hostile]") {
  const Desk desk(scene("1"));
  const sim::TrajectoryReader reader(original().file("t.h5"));
  const sim::TrajectoryLayout& layout = reader.layout();
  const sim::Dynamics whole = sim::deserialised(reader.resume_payload(), layout);
  using Change = void (*)(sim::Dynamics&);
  const Change changes[] = {
      [](sim::Dynamics& d) { d.vesicles[0].history.levels.at(0).position.order = 1'000'000; },
      [](sim::Dynamics& d) { d.vesicles[0].position.order = 1'000'000; },
      [](sim::Dynamics& d) {
        d.vesicles[0].history.levels.at(0).position = {1, sim::Matrix::Zero(4, 3)};
      },
      [](sim::Dynamics& d) { d.vesicles[0].upsampling = 1000; },
      [](sim::Dynamics& d) { d.vesicles[0].position.values(0, 0) = std::numeric_limits<double>::quiet_NaN(); },
      [](sim::Dynamics& d) { d.vesicles[0].tracers.resize(0, 3); },
      [](sim::Dynamics& d) { d.dt_limit = 1e-300; },
      [](sim::Dynamics& d) { d.dt_limit = 0; },
      [](sim::Dynamics& d) { d.time = 0.35; },
      [](sim::Dynamics& d) { d.step = 2; },
      [](sim::Dynamics& d) { d.saves = 1; },
      [](sim::Dynamics& d) { d.vesicles.clear(); }};
  int number = 0;
  for (const Change change : changes) {
    copy_original(desk.file("t.h5"));
    sim::Dynamics d = whole;
    change(d);
    set_record(desk.file("t.h5"), sim::serialised(d));
    const std::string before = support::read_file(desk / "t.h5");
    const Outcome outcome =
        desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "--resume", "-q", "--set", "time.end=2"});
    INFO("change " << number++ << ": " << outcome.err);
    CHECK(outcome.status == 1);
    CHECK(one_sentence(outcome.err));
    CHECK_THAT(outcome.err, Contains("cannot be resumed: its resume record is damaged"));
    CHECK(support::read_file(desk / "t.h5") == before);
  }
}

TEST_CASE("info tells what it knows of a trajectory whose last state is damaged, and which state that is",
          "[hostile]") {
  const support::TemporaryFolder folder;
  const fs::path path = folder / "t.h5";
  copy_original(path);
  const Outcome whole = original()({"info", path.string()});
  CHECK_THAT(whole.out, Contains("errors     position") && Contains("double layer of rigid motions"));
  {
    const sim::file::Descriptor file(path, true);
    const sim::file::Place place = sim::file::map(file)->at("position");
    const double wrong = 7;
    file.write(place.offset + 10 * place.row_bytes, &wrong, sizeof wrong);
  }
  const Outcome outcome = original()({"info", path.string()});
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.out, Contains("damaged    state 10") && Contains("errors     position") && Contains("[time]"));
  CHECK_THAT(outcome.out, !Contains("double layer"));
}

TEST_CASE("a state whose checksum fits but whose numbers do not is told as damaged", "[hostile]") {
  const support::TemporaryFolder folder;
  const fs::path path = folder / "t.h5";
  constexpr double inf = std::numeric_limits<double>::infinity();
  const std::uint64_t row = 3;
  struct Forgery {
    const char* dataset;
    std::uint64_t value;
  };
  for (const auto& [dataset, value] : {Forgery{"order", 24},
                                       {"order", 5},
                                       {"label_order", 25},
                                       {"order", ~std::uint64_t{0}},
                                       {"position", std::bit_cast<std::uint64_t>(inf)},
                                       {"tension", std::bit_cast<std::uint64_t>(1e200)},
                                       {"tracers", std::bit_cast<std::uint64_t>(std::nan(""))},
                                       {"relabelled", ~std::uint64_t{0}}}) {
    copy_original(path);
    std::uint64_t width = 0;
    {
      const sim::file::Descriptor file(path, false);
      width = sim::file::map(file)->at(dataset).row_bytes / 8;
    }
    set_word(path, dataset, row * width, value);
    const sim::TrajectoryReader reader(path);
    INFO(dataset << " " << value);
    CHECK(reader.damaged().empty());  // the checksum fits
    CHECK_THAT(message_of([&] { reader.state(3); }), Contains("state 3") && Contains("is damaged"));
    CHECK(message_of([&] { reader.state(2); }).empty());
  }
  copy_original(path);
  set_number(path, "time", 4, 0.1);
  CHECK_THAT(message_of([&] { sim::TrajectoryReader reader(path); }),
             Contains("state 4") && Contains("its time is not later"));
}

TEST_CASE("a scene that is not that of the states is told by every command that reads both", "[hostile]") {
  const Desk desk(scene("1"));
  copy_original(desk.file("t.h5"));
  {
    // Two vesicles in the states, one in the scene.
    const sim::TrajectoryReader one(desk.file("t.h5"));
    sim::TrajectoryLayout layout = one.layout();
    layout.vesicles = 2;
    sim::State state = one.state(0);
    state.vesicles.push_back(state.vesicles.front());
    sim::TrajectoryWriter::create(desk.file("two.h5"), layout, one.header(), state, one.resume_payload());
  }
  for (const auto& command : std::vector<std::vector<std::string>>{
           {"render", desk.file("two.h5"), "-o", desk.file("x")},
           {"figure", "time-series", desk.file("two.h5"), "-o", desk.file("x")},
           {"simulate", desk.file("s.toml"), "-o", desk.file("two.h5"), "--resume"}}) {
    const Outcome outcome = desk(command);
    INFO(command[0] << ": " << outcome.err);
    CHECK(outcome.status == 1);
    CHECK_THAT(outcome.err, Contains("its scene has 1 vesicles, its states have 2"));
  }
}

TEST_CASE("control characters from files reach neither a terminal nor a comment", "[hostile]") {
  const std::string escape = "a\\u001b]0;x\\u0007\\nsecond = 1\\r\\u009b31m";
  std::string text = scene("0.3");
  text.replace(text.find("small"), 5, escape);
  const Desk desk(text);
  const auto harmless = [](const std::string& shown) {
    return std::none_of(shown.begin(), shown.end(),
                        [](char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f; }) &&
           shown.find("\xc2\x9b") == std::string::npos;
  };
  const Outcome dry = desk({"run", desk.file("s.toml"), "-o", desk.file("x"), "--dry-run"});
  REQUIRE(dry.status == 0);
  CHECK(harmless(dry.out));
  // What is printed is a scene, and the same one.
  support::write_file(desk / "dry.toml", dry.out);
  const Outcome again = desk({"run", desk.file("dry.toml"), "-o", desk.file("x"), "--dry-run"});
  CHECK(again.status == 0);
  CHECK(again.out == dry.out);
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  {
    sim::TrajectoryWriter writer = sim::TrajectoryWriter::resume(desk.file("t.h5"));
    writer.note("a note\x1b[2J\nand more");
  }
  const Outcome info = desk({"info", desk.file("t.h5")});
  CHECK(info.status == 0);
  CHECK(harmless(info.out));
  CHECK_THAT(info.out, Contains("a note?[2J?and more"));
  const std::string odd = desk.file("no\x1b]0;x\nfile");
  const Outcome missing = desk({"info", odd});
  CHECK(missing.status == 1);
  CHECK(one_sentence(missing.err));
  CHECK(harmless(missing.err));
  support::write_file(desk / "out.toml", scene("0.3") + "[[figure]]\nkind = \"time-series\"\nout = \"x\\u001b[31m\"\n");
  const Outcome out = desk({"run", desk.file("out.toml"), "-o", desk.file("x"), "--dry-run"});
  CHECK(out.status == 1);
  CHECK_THAT(out.err, Contains("control characters"));
}

TEST_CASE("files of other kinds, empty ones and beginnings are called what they are", "[hostile]") {
  const Desk desk(scene("1"));
  copy_original(desk.file("t.h5"));
  const std::string whole = support::read_file(desk / "t.h5");
  support::write_file(desk / "empty", "");
  support::write_file(desk / "five", whole.substr(0, 5));
  support::write_file(desk / "cut", whole.substr(0, whole.size() / 2));
  const auto said = [&](std::vector<std::string> words) {
    const Outcome outcome = desk(std::move(words));
    CHECK(outcome.status == 1);
    CHECK(one_sentence(outcome.err));
    return outcome.err;
  };
  CHECK_THAT(said({"info", desk.file("empty")}), Contains("is empty"));
  CHECK_THAT(said({"run", desk.file("empty"), "-o", desk.file("x")}), Contains("is empty"));
  CHECK_THAT(said({"render", desk.file("empty"), "-o", desk.file("x")}), Contains("it is empty"));
  CHECK_THAT(said({"info", desk.file("five")}), Contains("is cut short: only 5 bytes"));
  CHECK_THAT(said({"info", desk.file("cut")}), Contains("is cut short: only"));
  CHECK_THAT(said({"run", desk.file("t.h5"), "-o", desk.file("x")}),
             Contains("is a trajectory") && Contains("not a scene"));
}

TEST_CASE("a run killed at any change of a file ends with the bytes of an uninterrupted one", "[hostile]") {
  const Desk desk(scene("0.2"));
  const auto simulate = [&](const std::string& name) {
    return std::vector<std::string>{"simulate", desk.file("s.toml"), "-o", desk.file(name), "--resume", "-q"};
  };
  std::vector<std::string> counting = preload("failing_files");
  counting.push_back("TANKTREAD_FAIL_COUNT=" + desk.file("count"));
  REQUIRE(desk.with(counting, simulate("whole.h5")).status == 0);
  const long changes = std::stol(support::read_file(desk / "count"));
  const std::string whole = support::read_file(desk / "whole.h5");
  REQUIRE(changes > 60);
  for (const char* how : {"kill", "torn"})
    for (long at = 1; at <= changes; at += every * (how == std::string("torn") ? 3 : 1)) {
      std::vector<std::string> killing = preload("failing_files");
      killing.push_back(fmt::format("TANKTREAD_FAIL_AT={}", at));
      killing.push_back(fmt::format("TANKTREAD_FAIL_HOW={}", how));
      INFO(how << " at change " << at << " of " << changes);
      // The clock renews the resume record between steps now and then: a few changes more or less.
      const int status = desk.with(killing, simulate("t.h5")).status;
      REQUIRE((status == -SIGKILL || (status == 0 && at > changes - 20)));
      const Outcome again = desk(simulate("t.h5"));
      INFO(again.err);
      REQUIRE(again.status == 0);
      REQUIRE(support::read_file(desk / "t.h5") == whole);
      REQUIRE(desk.names() == std::set<std::string>{"count", "t.h5", "whole.h5"});
      fs::remove(desk / "t.h5");
    }
}

TEST_CASE("a change of a file that fails once is told, and never crashes or passes", "[hostile]") {
  const Desk desk(scene("0.1"));
  const std::vector<std::string> simulate{"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "--resume", "-q"};
  std::vector<std::string> counting = preload("failing_files");
  counting.push_back("TANKTREAD_FAIL_COUNT=" + desk.file("count"));
  REQUIRE(desk.with(counting, simulate).status == 0);
  const long changes = std::stol(support::read_file(desk / "count"));
  const std::string whole = support::read_file(desk / "t.h5");
  fs::remove(desk / "t.h5");
  for (long at = 1; at <= changes; at += every) {
    std::vector<std::string> failing = preload("failing_files");
    failing.push_back(fmt::format("TANKTREAD_FAIL_AT={}", at));
    failing.push_back("TANKTREAD_FAIL_HOW=once");
    const Outcome outcome = desk.with(failing, simulate);
    INFO("failure at change " << at << " of " << changes << ": " << outcome.err);
    if (outcome.status == 0 && at > changes - 20) break;
    REQUIRE(outcome.status == 1);
    CHECK(one_sentence(outcome.err));
    CHECK_THAT(outcome.err, Contains("t.h5") && Contains("No space left on device"));
    REQUIRE(desk(simulate).status == 0);
    REQUIRE(support::read_file(desk / "t.h5") == whole);
    REQUIRE(desk.names() == std::set<std::string>{"count", "t.h5"});
    fs::remove(desk / "t.h5");
  }
}

TEST_CASE("no file of the fuzz corpus harms the program, whatever opens it", "[hostile]") {
  const Desk desk(scene("1"));
  const char* const pipe =
      "/tmp/tanktread-fuzz-pipe";  // some of the corpus lead there; whoever opens it never comes back
  const bool made = ::mkfifo(pipe, 0600) == 0;
  int runs = 0;
  const auto harmless = [&](std::vector<std::string> words) {
    Outcome outcome = desk(words);
    ++runs;
    // HDF5 takes a refused allocation well, and the sanitizers only mention it, a line each time.
    for (std::size_t at;
         (at = outcome.err.find("WARNING: AddressSanitizer failed to allocate")) != std::string::npos;) {
      const std::size_t first = at == 0 ? 0 : outcome.err.rfind('\n', at) + 1;
      outcome.err.erase(first, outcome.err.find('\n', at) - first + 1);
    }
    INFO(words[0] << " " << words[1] << ": " << outcome.status << " " << outcome.err);
    // The sanitizers' own status is 1, too; they say more than a sentence.
    CHECK((outcome.status == 0 || (outcome.status == 1 && one_sentence(outcome.err))));
    CHECK(outcome.err.find("Sanitizer") == std::string::npos);
    CHECK(outcome.err.find("runtime error") == std::string::npos);
  };
  std::vector<fs::path> trajectories, scenes, shapes, pictures;
  const fs::path corpus = TANKTREAD_CORPUS;
  for (const auto& [folder, list] :
       {std::pair{"trajectory", &trajectories}, {"scene", &scenes}, {"shape", &shapes}, {"png", &pictures}})
    for (const auto& entry : fs::directory_iterator(corpus / folder)) list->push_back(entry.path());
  REQUIRE((trajectories.size() > 2 && scenes.size() > 10 && shapes.size() > 1 && pictures.size() > 5));
  for (const fs::path& file : trajectories) {
    harmless({"info", file.string()});
    harmless({"export", file.string(), "--csv", "-"});
    harmless({"export", file.string(), "--vtk", desk.file("vtk"), "--latitudes", "4"});
    harmless({"figure", "time-series", file.string(), "-o", desk.file("f"), "-q"});
    harmless({"figure", "cross-sections", file.string(), "-o", desk.file("f"), "-q"});
    harmless({"render", file.string(), "--time", "0", "-o", desk.file("s.png"), "-q", "--size", "64x48"});
    fs::copy_file(file, desk / "t.h5", fs::copy_options::overwrite_existing);
    fs::permissions(desk / "t.h5", fs::perms::owner_write, fs::perm_options::add);
    harmless({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "--resume", "-q", "--steps", "3"});
  }
  for (const fs::path& file : scenes) {
    harmless({"info", file.string()});
    harmless({"run", file.string(), "-o", desk.file("x"), "--dry-run"});
    harmless({"info", desk.file("s.toml"), "--set", support::read_file(file).substr(0, 2000)});
  }
  for (const fs::path& file : shapes) {
    support::write_file(desk / "shape.toml",
                        "[flow]\nkind = \"shear\"\n[time]\nend = 0.1\n[[vesicle]]\norder = 4\nshape = \"file\"\n"
                        "file = \"" +
                            file.string() + "\"\n");
    harmless({"simulate", desk.file("shape.toml"), "-o", desk.file("shape.h5"), "--force", "-q", "--steps", "1"});
  }
  for (const fs::path& file : pictures) {
    harmless({"info", file.string()});
    harmless({"compare", file.string(), file.string()});
  }
  CHECK(runs > 60);
  if (made) fs::remove(pipe);
}
