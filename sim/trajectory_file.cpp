#include "trajectory_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace sim::file {

namespace {

// More than any simulation has: a file that says otherwise is damaged, and takes no memory.
constexpr std::uint64_t largest_text = 16 << 20, largest_row = std::uint64_t{4} << 30;

constexpr const char content_mark[] = "tanktread trajectory";
constexpr std::string_view signature = "\211HDF\r\n\032\n";

__extension__ using Wide = unsigned __int128;  // products of sizes cannot overflow

/// An HDF5 identifier and the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {
    if (id_ < 0) throw std::runtime_error("HDF5 refused a call");
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { if (id_ >= 0) close_(id_); }
  operator hid_t() const { return id_; }
  void close() { if (close_(std::exchange(id_, -1)) < 0) throw std::runtime_error("HDF5 could not close the file"); }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

enum class Kind { real, integer, text };

struct Dataset {
  std::string name, meaning;
  Kind kind = Kind::real;
  std::vector<hsize_t> shape;     ///< rows first; empty: one number
  std::uint64_t text_bytes = 0;   ///< of one string

  std::uint64_t rows() const { return shape.empty() ? 1 : shape.front(); }
  std::uint64_t row_bytes() const {
    std::uint64_t size = kind == Kind::text ? text_bytes : 8;
    for (std::size_t i = 1; i < shape.size(); ++i) size *= shape[i];
    return size;
  }
};

/// All datasets, small ones first: a truncated file then keeps its index.
std::vector<Dataset> datasets(const TrajectoryLayout& layout, std::uint64_t scene_bytes) {
  const auto states = static_cast<hsize_t>(layout.states), steps = static_cast<hsize_t>(layout.steps);
  std::vector<Dataset> all{
      {"count", "number of saved states; rows from here on are unused", Kind::integer, {}},
      {"steps/count", "number of step records", Kind::integer, {}},
      {"notes_count", "number of notes", Kind::integer, {}},
      {"resume_head", "per slot: number of the writing, numbers used, crc32 of both and of these", Kind::integer, {2, 3}},
      {"checksum", "2^32 + crc32 of row number and row", Kind::integer, {states}},
      {"steps/checksum", "2^32 + crc32 of row number and row", Kind::integer, {steps}},
      {"scene", "the resolved scene", Kind::text, {}, std::max<std::uint64_t>(scene_bytes, 1)},
      {"notes", "remarks made during the run", Kind::text, {note_rows}, note_bytes}};
  const auto add = [&all](const std::vector<rows::Column>& columns, hsize_t count) {
    for (const rows::Column& column : columns) {
      Dataset d{column.name, column.meaning, column.integer ? Kind::integer : Kind::real, {count}};
      d.shape.insert(d.shape.end(), column.shape.begin(), column.shape.end());
      all.push_back(std::move(d));
    }
  };
  add(rows::step_columns(layout), steps);
  all.push_back({"resume", "what the stepper needs to continue, two slots", Kind::real,
                 {2, static_cast<hsize_t>(layout.resume)}});
  add(rows::state_columns(layout), states);
  return all;
}

hid_t text_type(std::uint64_t bytes) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, bytes);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

void write_text(hid_t object, const char* name, const std::string& text) {
  const Handle type(text_type(std::max<std::size_t>(text.size(), 1)), H5Tclose);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(attribute, type, text.c_str());
}

void write_number(hid_t object, const char* name, std::int64_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name, H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(attribute, H5T_NATIVE_INT64, &value);
}

std::string read_text(hid_t object, const char* name) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) throw std::runtime_error("a text attribute");
  if (H5Tget_size(type) > largest_text) throw std::runtime_error("a text attribute");
  std::string text(H5Tget_size(type), '\0');
  if (H5Aread(attribute, type, text.data()) < 0) throw std::runtime_error("a text attribute");
  text.resize(std::strlen(text.c_str()));
  return text;
}

std::int64_t read_number(hid_t object, const char* name) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  std::int64_t value = 0;
  if (H5Aread(attribute, H5T_NATIVE_INT64, &value) < 0) throw std::runtime_error("a number attribute");
  return value;
}

/// The layout's sizes as attributes: v(name, number).
template <class L, class V>
void visit_layout(L& layout, V&& v) {
  v("vesicles", layout.vesicles);
  v("highest_order", layout.order);
  v("highest_label_order", layout.label_order);
  v("tracers_per_vesicle", layout.tracers);
  v("state_rows", layout.states);
  v("step_rows", layout.steps);
  v("resume_numbers", layout.resume);
}

/// HDF5's own words for the innermost error.
std::string hdf5_reason() {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
    auto& words = *static_cast<std::string*>(text);
    if (words.empty() && error->desc) words = error->desc;
    return 0;
  }, &reason);
  H5Eclear2(H5E_DEFAULT);
  return reason.empty() ? "no reason given" : reason;
}

[[noreturn]] void fail(std::string_view what, const std::filesystem::path& path, int number) {
  throw std::runtime_error(fmt::format("cannot {} '{}': {}", what, path.string(), std::strerror(number)));
}

std::uint64_t scene_checksum(const std::string& scene) {
  return rows::checksum(scene.size(), std::as_bytes(std::span(scene)));
}

Wide total_bytes(const std::vector<Dataset>& all) {
  Wide bytes = 0;
  for (const Dataset& d : all) bytes += static_cast<Wide>(d.rows()) * d.row_bytes();
  return bytes;
}

void check_space(const std::filesystem::path& path, Wide bytes) {
  if (bytes >> 62) throw std::runtime_error(fmt::format("trajectory '{}' would be too large for any disk", path.string()));
  struct statvfs disk{};
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (statvfs(folder.c_str(), &disk) != 0) return;
  const double needed = static_cast<double>(bytes);
  const double available = static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
  if (needed > available)
    throw std::runtime_error(fmt::format("trajectory '{}' will take {:.3g} GB and only {:.3g} GB are free in '{}'",
                                         path.string(), needed * 1e-9, available * 1e-9, folder.string()));
}

constexpr std::uint64_t metadata_bytes = 65536;  // of HDF5, at the head of the file

/// The file as HDF5 makes it, with all datasets allocated and nothing in them but the scene.
void create_with_hdf5(const std::filesystem::path& draft, const std::vector<Dataset>& all, const TrajectoryLayout& layout,
                      const TrajectoryHeader& header) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  try {
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation, false);  // or the root group carries the time of day
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_file_locking(access, false, true);  // the draft is locked already
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);  // checksummed metadata, no consistency flags
    H5Pset_meta_block_size(access, metadata_bytes);                // all of it at the head of the file
    Handle h5(H5Fcreate(draft.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose);

    write_number(h5, "format", trajectory_format);
    write_text(h5, "content", content_mark);
    write_text(h5, "program", header.program);
    write_text(h5, "build", header.build);
    std::string warnings;
    for (const std::string& w : header.warnings) warnings += (warnings.empty() ? "" : "\n") + w;
    write_text(h5, "warnings", warnings);
    visit_layout(layout, [&](const char* name, auto value) { write_number(h5, name, value); });
    write_number(h5, "scene_checksum", static_cast<std::int64_t>(scene_checksum(header.scene)));

    const Handle group_creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    H5Pset_obj_track_times(group_creation, false);
    const Handle group(H5Gcreate2(h5, "steps", H5P_DEFAULT, group_creation, H5P_DEFAULT), H5Gclose);
    for (const Dataset& d : all) {
      const Handle plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      H5Pset_layout(plan, H5D_CONTIGUOUS);
      H5Pset_alloc_time(plan, H5D_ALLOC_TIME_EARLY);
      H5Pset_fill_time(plan, H5D_FILL_TIME_NEVER);
      H5Pset_obj_track_times(plan, false);
      const Handle type(d.kind == Kind::text   ? text_type(d.text_bytes)
                        : d.kind == Kind::real ? H5Tcopy(H5T_IEEE_F64LE) : H5Tcopy(H5T_STD_U64LE), H5Tclose);
      const Handle space(d.shape.empty() ? H5Screate(H5S_SCALAR)
                                         : H5Screate_simple(static_cast<int>(d.shape.size()), d.shape.data(), nullptr),
                         H5Sclose);
      const Handle dataset(H5Dcreate2(h5, d.name.c_str(), type, space, H5P_DEFAULT, plan, H5P_DEFAULT), H5Dclose);
      write_text(dataset, "meaning", d.meaning);
      if (d.name == "scene" && !header.scene.empty() &&
          H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, header.scene.data()) < 0)
        throw std::runtime_error("scene");
    }
    h5.close();
  } catch (const std::runtime_error&) {
    throw std::runtime_error(hdf5_reason());
  }
}

/// Makes sure that what HDF5 will write can be written: a write that fails, on a full disk for one, crashes libhdf5 1.10.
void try_to_write(int file, std::uint64_t file_bytes, std::uint64_t first_bytes) {
  if (::ftruncate(file, static_cast<off_t>(file_bytes)) != 0) throw errno;
  const std::vector<char> zeros(65536);
  for (std::uint64_t at = 0; at < first_bytes; at += zeros.size())
    if (const ssize_t done = ::pwrite(file, zeros.data(), zeros.size(), static_cast<off_t>(at));
        done != static_cast<ssize_t>(zeros.size()))
      throw done < 0 ? errno : ENOSPC;
}

}  // namespace

void create(const Draft& draft, const std::filesystem::path& path, const TrajectoryLayout& layout,
            const TrajectoryHeader& header) {
  const std::vector<Dataset> all = datasets(layout, header.scene.size());
  const Wide bytes = total_bytes(all);
  check_space(path, bytes);
  try {
    try_to_write(draft.descriptor(), static_cast<std::uint64_t>(bytes) + metadata_bytes, metadata_bytes + header.scene.size());
    create_with_hdf5(draft.path(), all, layout, header);
  } catch (const int reason) {
    fail("create trajectory", path, reason);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("cannot create trajectory '{}': {}", path.string(), error.what()));
  }
}

namespace {

Map read_map(const std::filesystem::path& path, hid_t h5, std::uint64_t file_bytes) {
  Map map;
  map.header.program = read_text(h5, "program");
  map.header.build = read_text(h5, "build");
  const std::string warnings = read_text(h5, "warnings");
  for (std::size_t from = 0; from < warnings.size();) {
    const std::size_t to = std::min(warnings.find('\n', from), warnings.size());
    map.header.warnings.push_back(warnings.substr(from, to - from));
    from = to + 1;
  }
  visit_layout(map.layout, [&](const char* name, auto& value) {
    const std::int64_t number = read_number(h5, name);
    const bool order = std::string_view(name).find("order") != std::string_view::npos;
    const std::int64_t largest = order ? 4096 : sizeof value < sizeof number ? 1 << 24 : std::int64_t{1} << 40;
    if (number < 0 || number > largest) throw std::runtime_error(name);
    value = static_cast<std::remove_reference_t<decltype(value)>>(number);
  });
  const Handle scene(H5Dopen2(h5, "scene", H5P_DEFAULT), H5Dclose);
  const Handle scene_type(H5Dget_type(scene), H5Tclose);
  const std::uint64_t scene_bytes = H5Tget_size(scene_type);
  for (const Dataset& d : datasets(map.layout, scene_bytes)) {
    const Handle dataset(H5Dopen2(h5, d.name.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle type(H5Dget_type(dataset), H5Tclose);
    const Handle space(H5Dget_space(dataset), H5Sclose);
    const Handle plan(H5Dget_create_plist(dataset), H5Pclose);
    const auto expected = d.kind == Kind::text ? H5T_STRING : d.kind == Kind::real ? H5T_FLOAT : H5T_INTEGER;
    std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(H5Sget_simple_extent_ndims(space), 0)));
    H5Sget_simple_extent_dims(space, shape.data(), nullptr);
    const Place place{H5Dget_offset(dataset), d.row_bytes(), d.rows()};
    if (H5Pget_layout(plan) != H5D_CONTIGUOUS || H5Tget_class(type) != expected || shape != d.shape ||
        H5Tget_size(type) != (d.kind == Kind::text ? d.text_bytes : 8) || place.offset == HADDR_UNDEF ||
        place.offset > file_bytes || place.row_bytes > largest_row ||
        static_cast<Wide>(place.rows) * place.row_bytes > file_bytes - place.offset)
      throw std::runtime_error(fmt::format("trajectory '{}' is damaged: dataset '{}' is not what its header says",
                                           path.string(), d.name));
    map.datasets.emplace(d.name, place);
  }
  const Place& place = map.at("scene");
  const Descriptor file(path, false);
  map.header.scene.resize(place.row_bytes);
  file.read(place.offset, map.header.scene.data(), place.row_bytes);
  if (map.header.scene == std::string(1, '\0')) map.header.scene.clear();
  if (static_cast<std::int64_t>(scene_checksum(map.header.scene)) != read_number(h5, "scene_checksum"))
    throw std::runtime_error(fmt::format("trajectory '{}' is damaged: its scene does not fit its checksum",
                                         path.string()));
  return map;
}

}  // namespace

Map map(const std::filesystem::path& path) {
  const Descriptor file(path, false);
  struct stat status{};
  if (::stat(path.c_str(), &status) != 0) fail("read trajectory", path, errno);
  if (!S_ISREG(status.st_mode)) throw std::runtime_error(fmt::format("'{}' is not a file", path.string()));
  const auto size = static_cast<std::uint64_t>(status.st_size);
  char start[8] = {};
  if (size >= sizeof start) file.read(0, start, sizeof start);
  if (std::string_view(start, sizeof start) != signature)
    throw std::runtime_error(fmt::format("'{}' is not a trajectory: it is no HDF5 file", path.string()));

  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5Eclear2(H5E_DEFAULT);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, false, true);  // a reader must neither block a writer nor need a writable folder
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
  if (id < 0) {
    const std::string reason = hdf5_reason();
    const bool truncated = reason.find("truncated") != std::string::npos;
    throw std::runtime_error(fmt::format("trajectory '{}' is {}: {}", path.string(),
                                         truncated ? "cut short" : "damaged", reason));
  }
  const Handle h5(id, H5Fclose);
  if (H5Aexists(h5, "content") <= 0 || H5Aexists(h5, "format") <= 0)
    throw std::runtime_error(fmt::format("'{}' is an HDF5 file but not a Tanktread trajectory", path.string()));
  std::int64_t format = 0;
  try {
    format = read_number(h5, "format");
    if (format == trajectory_format) return read_map(path, h5, size);
  } catch (const std::exception& error) {
    if (std::string_view(error.what()).find(path.string()) != std::string_view::npos) throw;
    throw std::runtime_error(fmt::format("trajectory '{}' is damaged: {}", path.string(), hdf5_reason()));
  }
  throw std::runtime_error(fmt::format("trajectory '{}' has format {}; this program reads format {}", path.string(),
                                       format, trajectory_format));
}

Descriptor::Descriptor(const std::filesystem::path& path, bool writable, const std::filesystem::path& name)
    : path_(name), fd_(::open(path.c_str(), (writable ? O_RDWR : O_RDONLY) | O_CLOEXEC)) {
  if (fd_ < 0) fail(writable ? "write trajectory" : "read trajectory", path, errno);
}
Descriptor::Descriptor(Descriptor&& other) noexcept
    : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)) {}
Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(fd_, other.fd_);
  return *this;
}
Descriptor::~Descriptor() { if (fd_ >= 0) ::close(fd_); }

void Descriptor::write(std::uint64_t offset, const void* bytes, std::uint64_t size) const {
  const auto* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t done = ::pwrite(fd_, from, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail("write trajectory", path_, done < 0 ? errno : ENOSPC);
    from += done;
    offset += static_cast<std::uint64_t>(done);
    size -= static_cast<std::uint64_t>(done);
  }
}

void Descriptor::read(std::uint64_t offset, void* bytes, std::uint64_t size) const {
  auto* to = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t done = ::pread(fd_, to, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail("read trajectory", path_, errno);
    if (done == 0) throw std::runtime_error(fmt::format("trajectory '{}' is cut short", path_.string()));
    to += done;
    offset += static_cast<std::uint64_t>(done);
    size -= static_cast<std::uint64_t>(done);
  }
}

void Descriptor::sync(bool data_only) const {
  if ((data_only ? ::fdatasync(fd_) : ::fsync(fd_)) != 0 && errno != EINVAL) fail("write trajectory", path_, errno);
}

std::uint64_t Descriptor::inode() const {
  struct stat status{};
  return ::fstat(fd_, &status) == 0 ? status.st_ino : 0;
}

Lock::Lock(const std::filesystem::path& path) {
  for (;;) {
    fd_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
    if (fd_ < 0) fail("write trajectory", path, errno);
    if (!lock_file(fd_)) {
      ::close(std::exchange(fd_, -1));
      throw std::runtime_error(fmt::format("another process is writing '{}'", path.string()));
    }
    // The holder before us may have put a larger file in its place between our open and our lock.
    struct stat ours{}, named{};
    if (::fstat(fd_, &ours) == 0 && ::stat(path.c_str(), &named) == 0 && ours.st_ino == named.st_ino &&
        ours.st_dev == named.st_dev)
      return;
    ::close(std::exchange(fd_, -1));
  }
}
Lock::Lock(Lock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
Lock& Lock::operator=(Lock&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}
Lock::~Lock() { if (fd_ >= 0) ::close(fd_); }

void require_ours(const std::filesystem::path& path) {
  struct stat status{};
  if (::stat(path.c_str(), &status) != 0) return;
  if (!S_ISREG(status.st_mode))
    throw std::runtime_error(fmt::format("'{}' is not a file; a trajectory cannot take its place", path.string()));
  if (status.st_size == 0) return;
  if (!holds_mark(path))
    throw std::runtime_error(fmt::format("'{}' is not a trajectory of this program and is left as it is; give another name",
                                         path.string()));
}

bool holds_mark(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return false;
  // HDF5 keeps the texts of attributes as they are, at the head of the file: seen also where HDF5 itself finds damage.
  std::string head(metadata_bytes, '\0');
  const ssize_t got = ::pread(file, head.data(), head.size(), 0);
  ::close(file);
  head.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return head.starts_with(signature) && head.find(content_mark) != std::string::npos;
}

Draft draft(const std::filesystem::path& path) {
  try {
    return Draft(path);
  } catch (const std::system_error& error) {
    fail("create trajectory", path, error.code().value());
  }
}

void publish(Draft& draft, const std::filesystem::path& path, bool fresh) {
  try {
    draft.publish(path, fresh);
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::file_exists)
      throw std::runtime_error(fmt::format("another process has made '{}' meanwhile", path.string()));
    fail("write trajectory", path, error.code().value());
  }
}

}  // namespace sim::file
