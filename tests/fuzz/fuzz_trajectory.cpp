// Trajectory files: header and layout as HDF5 tells them, then every row. Checksums of the metadata are made to fit
// after each mutation, or hardly any would get beyond them; those of states, steps and resume records for half of the
// inputs. Besides bytes, types, extents, storage and links of a whole trajectory are changed by HDF5 itself.
#include "sim/stepping/dynamics.h"
#include "sim/trajectory/file_blocks.h"
#include "sim/trajectory/trajectory_file.h"
#include "support.h"
#include "tests/support/hostile_hdf5.h"
#include "tests/support/temporary_folder.h"

#include <sys/stat.h>

#include <cstring>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

/// Links lead to a pipe that nobody writes into: a reader that opens it hangs.
const std::string pipe_path = "/tmp/tanktread-fuzz-pipe";

std::uint32_t metadata_checksum(const std::uint8_t* bytes, std::size_t length) {
  return sim::file::metadata_checksum({reinterpret_cast<const char*>(bytes), length});
}

void seal(std::vector<std::uint8_t>& file, std::size_t from, std::size_t length) {
  if (from + length + 4 > file.size() || length == 0) return;
  const std::uint32_t sum = metadata_checksum(file.data() + from, length);
  for (std::size_t i = 0; i < 4; ++i) file[from + length + i] = static_cast<std::uint8_t>(sum >> (8 * i));
}

/// Superblock 2 and first chunks of object headers of version 2.
void seal_metadata(std::vector<std::uint8_t>& file) {
  if (file[8] >= 2) seal(file, 0, 44);
  for (std::size_t at = 48; at + 16 < file.size() && at < (1U << 17); ++at) {
    if (std::memcmp(file.data() + at, "OHDR", 4) != 0) continue;
    const std::uint8_t flags = file[at + 5];
    const std::size_t start = 6 + (flags & 0x20 ? 16U : 0U) + (flags & 0x10 ? 4U : 0U),
                      width = std::size_t{1} << (flags & 3);
    std::uint64_t size = 0;
    for (std::size_t i = 0; i < width && at + start + i < file.size(); ++i)
      size |= std::uint64_t{file[at + start + i]} << (8 * i);
    if (size < file.size()) seal(file, at, start + width + size);
  }
}

/// Checksums of rows and resume records that fit whatever the rows hold.
void seal_records(const std::filesystem::path& path) {
  namespace file = sim::file;
  namespace rows = sim::rows;
  const file::Descriptor descriptor(path, true);
  const std::optional<file::Map> map = file::map(descriptor);
  if (!map) return;
  const auto word = [&](const char* name, std::uint64_t at) {
    std::uint64_t value = 0;
    descriptor.read(map->at(name).offset + 8 * at, &value, 8);
    return value;
  };
  const auto put = [&](const char* name, std::uint64_t at, std::uint64_t value) {
    descriptor.write(map->at(name).offset + 8 * at, &value, 8);
  };
  constexpr std::uint64_t most_rows = 50, most_bytes = 1 << 20;
  const auto seal_rows = [&](const std::vector<rows::Column>& columns, const char* checksums) {
    for (std::uint64_t row = 0; row < std::min(most_rows, map->at(checksums).rows); ++row) {
      if (word(checksums, row) == 0) continue;
      std::vector<std::byte> bytes;
      for (const rows::Column& column : columns) {
        const file::Place& place = map->at(column.name);
        if (bytes.size() + place.row_bytes > most_bytes) return;
        bytes.resize(bytes.size() + place.row_bytes);
        descriptor.read(place.offset + row * place.row_bytes, bytes.data() + bytes.size() - place.row_bytes,
                        place.row_bytes);
      }
      put(checksums, row, rows::checksum(row, bytes));
    }
  };
  seal_rows(rows::state_columns(map->layout), "checksum");
  seal_rows(rows::step_columns(map->layout), "steps/checksum");
  const file::Place& resume = map->at("resume");
  for (std::uint64_t slot = 0; slot < 2; ++slot) {
    const std::uint64_t size = word("resume_head", 3 * slot + 1);
    if (8 * size > std::min(resume.row_bytes, most_bytes) || size > most_bytes) continue;
    std::vector<std::byte> bytes(8 * size);
    descriptor.read(resume.offset + slot * resume.row_bytes, bytes.data(), bytes.size());
    put("resume_head", 3 * slot + 2, rows::checksum(word("resume_head", 3 * slot), bytes));
  }
}

sim::Coefficients coefficients(int order, int fields) {
  sim::Coefficients c{order, sim::Matrix(sim::coefficient_count(order), fields)};
  for (Eigen::Index i = 0; i < c.values.size(); ++i) c.values.data()[i] = 1.0 / double(i + 1);
  return c;
}

/// A small whole trajectory, made by the program's own writer.
std::vector<std::uint8_t> whole_trajectory() {
  const support::TemporaryFolder folder;
  const auto x = coefficients(2, 3);
  sim::State state{0, 0, {{x, x, coefficients(2, 1), coefficients(4, 3), sim::Matrix::Ones(2, 3), x, x, x, 0, 0, 0}}};
  sim::StepRecord record{1, 0.1, 0.1, 7, 1e-11, 0, 0.5, 2, 1e-5, {sim::VesicleStep{}}};
  {
    const sim::TrajectoryHeader header{"title = \"small\"\n", "0", "g++", {"a warning"}};
    sim::TrajectoryWriter writer = sim::TrajectoryWriter::create(folder / "t.h5", {1, 2, 4, 2, 4, 4, 40}, header, state,
                                                                 std::vector<double>(30, 1.0));
    state.step = 1;
    state.time = 0.1;
    writer.append(state, std::span(&record, 1));
    writer.note("a note");
    writer.write_resume(std::vector<double>(30, 2.0));
  }
  const std::string bytes = support::read_file(folder / "t.h5");
  return {bytes.begin(), bytes.end()};
}

/// The same with edits that HDF5 makes in memory.
std::vector<std::uint8_t> edited(const std::vector<std::uint8_t>& whole, support::Random& random) {
  const support::H5Quiet quiet;
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, 4096, false);
  H5Pset_file_image(access, const_cast<std::uint8_t*>(whole.data()), whole.size());
  const hid_t file = H5Fopen("memory", H5F_ACC_RDWR, access);
  H5Pclose(access);
  if (file < 0) std::abort();
  for (unsigned edits = 1 + random() % 3; edits > 0; --edits) support::hostile_edit(file, pipe_path, random);
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  std::vector<std::uint8_t> bytes;
  if (const ssize_t size = H5Fget_file_image(file, nullptr, 0); size > 0) {
    bytes.resize(static_cast<std::size_t>(size));
    H5Fget_file_image(file, bytes.data(), bytes.size());
  }
  H5Fclose(file);
  return bytes;
}

}  // namespace

namespace {

const std::vector<std::uint8_t>& whole() {
  static const std::vector<std::uint8_t> bytes = whole_trajectory();
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  ::mkfifo(pipe_path.c_str(), 0600);
  // A target that refuses everything finds nothing.
  std::vector<std::uint8_t> input = whole();
  seal_metadata(input);
  if (input != whole()) fuzz::broken("sealing changes nothing that is whole");
  const fuzz::MemoryFile file(input.data(), input.size());
  seal_records(file.path());
  const sim::TrajectoryReader reader(file.path());
  if (reader.count() != 2 || !reader.damaged().empty() || reader.state(1).time != 0.1 || reader.steps().size() != 1 ||
      reader.resume_payload().back() != 2)
    fuzz::broken("a whole trajectory is read");
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  support::Random random(seed);
  if (random() % 2 != 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::vector<std::uint8_t> bytes = random() % 4 == 0 ? whole() : edited(whole(), random);
  if (bytes.empty() || bytes.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::copy(bytes.begin(), bytes.end(), data);
  // Half of them are changed byte by byte as well.
  return random() % 2 == 0 ? bytes.size() : LLVMFuzzerMutate(data, bytes.size(), max_size);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  std::vector<std::uint8_t> input(bytes, bytes + size);
  if (size > 48) seal_metadata(input);
  const fuzz::MemoryFile file(input.data(), input.size());
  if (metadata_checksum(bytes, size) % 2 == 0) fuzz::accepted([&] { seal_records(file.path()); });
  fuzz::accepted([&] {
    const sim::TrajectoryReader reader(file.path());
    const auto damaged = reader.damaged();
    for (std::int64_t k = 0; k < reader.count(); ++k)
      fuzz::accepted([&] {
        const sim::State state = reader.state(k);
        for (const sim::VesicleState& v : state.vesicles)
          for (const sim::Coefficients* c :
               {&v.position, &v.velocity, &v.tension, &v.labels, &v.position_before, &v.velocity_before, &v.sliding})
            if (c->values.rows() != sim::coefficient_count(c->order) || !c->values.allFinite())
              fuzz::broken("an accepted state is finite and of its orders");
      });
    fuzz::accepted([&] { reader.steps(); });
    reader.notes();
    fuzz::accepted([&] { sim::deserialised(reader.resume_payload(), reader.layout()); });
  });
  return 0;
}
