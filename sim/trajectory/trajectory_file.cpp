#include "sim/trajectory/trajectory_file.h"

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
constexpr std::uint64_t largest_text = 16 << 20, largest_scene = 256 << 20, largest_row = std::uint64_t{4} << 30;

constexpr std::string_view signature = "\211HDF\r\n\032\n";

__extension__ using Wide = unsigned __int128;  // products of sizes cannot overflow

/// What HDF5 refused, or a part of a file that is not what it must be; the sentence is made where the path is known.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

hid_t checked(hid_t id, const char* what) {
  if (id < 0) throw Refused(what);
  return id;
}

/// An HDF5 identifier that is read from; closing it can lose nothing.
class Handle {
 public:
  Handle(hid_t id, herr_t (*closer)(hid_t), const char* what) : id_(checked(id, what)), close_(closer) {}
  Handle(const Handle&) = delete;
  ~Handle() { close_(id_); }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Identifiers of a file that is being made. Every call is checked, the closing ones too. Where one failed, nothing more is
/// asked of HDF5 about that file, not even to close it: libhdf5 crashes over what a failed write has left half done.
class Making {
 public:
  hid_t operator()(hid_t id, herr_t (*closer)(hid_t)) {
    open_.emplace_back(checked(id, "HDF5 refused a call"), closer);
    return id;
  }
  void close() {
    for (; !open_.empty(); open_.pop_back()) check(open_.back().second(open_.back().first));
  }
  static void check(herr_t status) { checked(status, "HDF5 could not write"); }

 private:
  std::vector<std::pair<hid_t, herr_t (*)(hid_t)>> open_;
};

/// Before each use of HDF5. It says nothing by itself, loads no plugin that a file asks for, and leaves what is open alone
/// when the program ends.
void start_hdf5() {
  [[maybe_unused]] static const herr_t first = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5Eclear2(H5E_DEFAULT);
  H5PLset_loading_state(0);
}

const std::string content = "tanktread trajectory";  // what the file says that it is

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

void write_attribute(hid_t object, const char* name, hid_t type, const void* value) {
  Making made;
  const hid_t attribute = made(H5Acreate2(object, name, type, made(H5Screate(H5S_SCALAR), H5Sclose), H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose);
  Making::check(H5Awrite(attribute, type, value));
  made.close();
}

void write_text(hid_t object, const char* name, const std::string& text) {
  Making made;
  write_attribute(object, name, made(text_type(std::max<std::size_t>(text.size(), 1)), H5Tclose), text.c_str());
  made.close();
}

void write_number(hid_t object, const char* name, std::int64_t value) {
  write_attribute(object, name, H5T_STD_I64LE, &value);
}

bool is_text(hid_t type) { return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0; }

/// The one way in which HDF5 copies anything out of a file: an attribute of one value. Type, extent and size are what the
/// caller expects before a byte is copied. A type below 0 stands for a text of a fixed length.
std::string read_attribute(hid_t object, const char* name, hid_t expected, std::uint64_t largest) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, name);
  const Handle space(H5Aget_space(attribute), H5Sclose, name);
  const std::uint64_t size = H5Tget_size(type);
  if (H5Sget_simple_extent_type(space) != H5S_SCALAR || !(expected < 0 ? is_text(type) : H5Tequal(type, expected) > 0) ||
      size == 0 || size > largest || H5Aget_storage_size(attribute) != size)
    throw Refused(name);
  std::string bytes(size, '\0');
  if (H5Aread(attribute, type, bytes.data()) < 0) throw Refused(name);
  return bytes;
}

std::string read_text(hid_t object, const char* name, std::uint64_t file_bytes) {
  std::string text = read_attribute(object, name, H5I_INVALID_HID, std::min(largest_text, file_bytes));
  text.resize(std::strlen(text.c_str()));
  return text;
}

std::int64_t read_number(hid_t object, const char* name) {
  std::int64_t value = 0;
  const std::string bytes = read_attribute(object, name, H5T_STD_I64LE, sizeof value);
  std::memcpy(&value, bytes.data(), sizeof value);
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

/// What the system said to HDF5 when it failed, "No space left on device"; empty: nothing.
std::string system_reason() {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
    constexpr std::string_view before = "error message = '";
    const std::string_view words(error->desc ? error->desc : "");
    if (const std::size_t at = words.find(before); at != std::string_view::npos) {
      const std::string_view rest = words.substr(at + before.size());
      *static_cast<std::string*>(text) = rest.substr(0, rest.find('\''));
    }
    return 0;
  }, &reason);
  H5Eclear2(H5E_DEFAULT);
  return reason;
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
  start_hdf5();
  try {
    Making made;
    const hid_t creation = made(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    Making::check(H5Pset_obj_track_times(creation, false));  // or the root group carries the time of day
    const hid_t access = made(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    Making::check(H5Pset_file_locking(access, false, true));  // the draft is locked already
    Making::check(H5Pset_fapl_sec2(access));
    // Checksummed metadata, no consistency flags; all of it at the head of the file.
    Making::check(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18));
    Making::check(H5Pset_meta_block_size(access, metadata_bytes));
    const hid_t h5 = made(H5Fcreate(draft.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose);

    write_number(h5, "format", trajectory_format);
    write_text(h5, "content", content);
    write_text(h5, "program", header.program);
    write_text(h5, "build", header.build);
    std::string warnings;
    for (const std::string& w : header.warnings) warnings += (warnings.empty() ? "" : "\n") + w;
    write_text(h5, "warnings", warnings);
    visit_layout(layout, [&](const char* name, auto value) { write_number(h5, name, value); });
    write_number(h5, "scene_checksum", static_cast<std::int64_t>(scene_checksum(header.scene)));

    Making group;
    const hid_t group_creation = group(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    Making::check(H5Pset_obj_track_times(group_creation, false));
    group(H5Gcreate2(h5, "steps", H5P_DEFAULT, group_creation, H5P_DEFAULT), H5Gclose);
    for (const Dataset& d : all) {
      Making part;
      const hid_t plan = part(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      Making::check(H5Pset_layout(plan, H5D_CONTIGUOUS));
      Making::check(H5Pset_alloc_time(plan, H5D_ALLOC_TIME_EARLY));
      Making::check(H5Pset_fill_time(plan, H5D_FILL_TIME_NEVER));
      Making::check(H5Pset_obj_track_times(plan, false));
      const hid_t type = part(d.kind == Kind::text   ? text_type(d.text_bytes)
                              : d.kind == Kind::real ? H5Tcopy(H5T_IEEE_F64LE) : H5Tcopy(H5T_STD_U64LE), H5Tclose);
      const hid_t space = part(d.shape.empty() ? H5Screate(H5S_SCALAR)
                                               : H5Screate_simple(static_cast<int>(d.shape.size()), d.shape.data(), nullptr),
                               H5Sclose);
      const hid_t dataset = part(H5Dcreate2(h5, d.name.c_str(), type, space, H5P_DEFAULT, plan, H5P_DEFAULT), H5Dclose);
      write_text(dataset, "meaning", d.meaning);
      if (d.name == "scene" && !header.scene.empty())
        Making::check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, header.scene.data()));
      part.close();
    }
    group.close();
    Making::check(H5Fflush(h5, H5F_SCOPE_GLOBAL));
    made.close();
  } catch (const Refused& refused) {
    const std::string reason = system_reason();
    throw std::runtime_error(reason.empty() ? refused.what() : reason);
  }
}

/// Makes sure that what HDF5 will write can be written, before there is anything to be undone. Throws std::system_error.
void try_to_write(int file, std::uint64_t file_bytes, std::uint64_t first_bytes) {
  if (::ftruncate(file, static_cast<off_t>(file_bytes)) != 0)
    throw std::system_error(errno, std::generic_category());
  const std::vector<char> zeros(65536);
  for (std::uint64_t at = 0; at < first_bytes; at += zeros.size())
    if (const ssize_t done = ::pwrite(file, zeros.data(), zeros.size(), static_cast<off_t>(at));
        done != static_cast<ssize_t>(zeros.size()))
      throw std::system_error(done < 0 ? errno : ENOSPC, std::generic_category());
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
  } catch (const std::system_error& error) {
    fail("create trajectory", path, error.code().value());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("cannot create trajectory '{}': {}", path.string(), error.what()));
  }
}

namespace {

/// Only links to an object of this very file are followed: others lead to other files, to pipes, or round in circles.
void require_own_object(hid_t group, const char* name) {
  H5L_info_t link{};
  if (H5Lget_info(group, name, &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD) throw Refused(name);
}

Handle open_dataset(hid_t h5, const std::string& name) {
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos) {
    require_own_object(h5, name.c_str());
    return {H5Dopen2(h5, name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str()};
  }
  const std::string folder = name.substr(0, slash);
  require_own_object(h5, folder.c_str());
  const Handle group(H5Gopen2(h5, folder.c_str(), H5P_DEFAULT), H5Gclose, folder.c_str());
  return open_dataset(group, name.substr(slash + 1));
}

/// Where a dataset lies, when its type, extent and size are the expected ones and it lies within the file. A text of 0
/// bytes stands for one of any length. The layout comes first: asked for the extent of a virtual dataset, HDF5 opens others.
Place place_of(hid_t h5, const Dataset& expected, std::uint64_t file_bytes) {
  const char* name = expected.name.c_str();
  const Handle dataset = open_dataset(h5, expected.name);
  const Handle plan(H5Dget_create_plist(dataset), H5Pclose, name);
  if (H5Pget_layout(plan) != H5D_CONTIGUOUS || H5Pget_external_count(plan) != 0) throw Refused(name);
  const Handle type(H5Dget_type(dataset), H5Tclose, name);
  const bool text = expected.kind == Kind::text;
  if (!(text ? is_text(type) : H5Tequal(type, expected.kind == Kind::real ? H5T_IEEE_F64LE : H5T_STD_U64LE) > 0))
    throw Refused(name);
  const Handle space(H5Dget_space(dataset), H5Sclose, name);
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::clamp(H5Sget_simple_extent_ndims(space), 0, H5S_MAX_RANK)));
  if (H5Sget_simple_extent_type(space) != (expected.shape.empty() ? H5S_SCALAR : H5S_SIMPLE) ||
      H5Sget_simple_extent_dims(space, shape.data(), nullptr) < 0 || shape != expected.shape)
    throw Refused(name);
  Dataset there = expected;
  if (text) {
    there.text_bytes = H5Tget_size(type);
    if (there.text_bytes == 0 || there.text_bytes > largest_scene ||
        (expected.text_bytes != 0 && there.text_bytes != expected.text_bytes))
      throw Refused(name);
  }
  const Place place{H5Dget_offset(dataset), there.row_bytes(), there.rows()};
  if (place.offset == HADDR_UNDEF || place.offset > file_bytes || place.row_bytes > largest_row ||
      static_cast<Wide>(place.rows) * place.row_bytes > file_bytes - place.offset)
    throw Refused(name);
  return place;
}

/// No two datasets share a byte, or writing one would change another.
void require_separate(const std::map<std::string, Place, std::less<>>& datasets) {
  std::map<std::uint64_t, std::pair<std::uint64_t, const std::string*>> by_offset;  // end and name
  for (const auto& [name, place] : datasets)
    if (place.rows * place.row_bytes > 0 &&
        !by_offset.emplace(place.offset, std::pair(place.offset + place.rows * place.row_bytes, &name)).second)
      throw Refused(name.c_str());
  std::uint64_t end = 0;
  for (const auto& [offset, part] : by_offset) {
    if (offset < end) throw Refused(part.second->c_str());
    end = part.first;
  }
}

Map read_map(const Descriptor& file, hid_t h5, std::uint64_t file_bytes) {
  Map map;
  map.header.program = read_text(h5, "program", file_bytes);
  map.header.build = read_text(h5, "build", file_bytes);
  const std::string warnings = read_text(h5, "warnings", file_bytes);
  for (std::size_t from = 0; from < warnings.size();) {
    const std::size_t to = std::min(warnings.find('\n', from), warnings.size());
    map.header.warnings.push_back(warnings.substr(from, to - from));
    from = to + 1;
  }
  visit_layout(map.layout, [&](const char* name, auto& value) {
    const std::int64_t number = read_number(h5, name);
    const bool order = std::string_view(name).find("order") != std::string_view::npos;
    const std::int64_t largest = order ? largest_order : sizeof value < sizeof number ? 1 << 24 : std::int64_t{1} << 40;
    if (number < (std::string_view(name) == "vesicles") || number > largest) throw Refused(name);
    value = static_cast<std::remove_reference_t<decltype(value)>>(number);
  });
  const std::uint64_t scene_bytes = place_of(h5, {"scene", "", Kind::text, {}, 0}, file_bytes).row_bytes;
  for (const Dataset& d : datasets(map.layout, scene_bytes)) map.datasets.emplace(d.name, place_of(h5, d, file_bytes));
  require_separate(map.datasets);
  const Place& place = map.at("scene");
  map.header.scene.resize(place.row_bytes);
  file.read(place.offset, map.header.scene.data(), place.row_bytes);
  if (map.header.scene == std::string(1, '\0')) map.header.scene.clear();
  if (static_cast<std::int64_t>(scene_checksum(map.header.scene)) != read_number(h5, "scene_checksum"))
    throw std::runtime_error(fmt::format("trajectory '{}' is damaged: its scene does not fit its checksum",
                                         file.path().string()));
  return map;
}

/// The length that the head of an HDF5 file gives to it; 0: it gives none.
std::uint64_t promised_bytes(const Descriptor& file, std::uint64_t size) {
  std::uint8_t head[48] = {};
  if (size < sizeof head) return sizeof head;
  file.read(0, head, sizeof head);
  // Superblock 0, or 2 or 3, with addresses of 8 bytes.
  const std::uint8_t version = head[8];
  const std::size_t at = version == 0 ? 40 : 28, address_bytes = version == 0 ? 13 : 9;
  if (version == 1 || version > 3 || head[address_bytes] != sizeof(std::uint64_t)) return 0;
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, head + at, sizeof bytes);
  return bytes;
}

}  // namespace

std::optional<Map> map(const Descriptor& file) {
  const std::string path = file.path().string();
  const std::uint64_t size = file.size();
  std::string start(std::min<std::uint64_t>(size, signature.size()), '\0');
  file.read(0, start.data(), start.size());
  if (size == 0) throw std::runtime_error(fmt::format("'{}' is not a trajectory: it is empty, no HDF5 file", path));
  if (!signature.starts_with(start))
    throw std::runtime_error(fmt::format("'{}' is not a trajectory: it is no HDF5 file", path));
  if (const std::uint64_t promised = promised_bytes(file, size); promised > size)
    throw std::runtime_error(fmt::format("trajectory '{}' is cut short: only {} bytes of it are there", path, size));

  start_hdf5();
  try {
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "the file");
    H5Pset_fapl_sec2(access);                  // plain files, whatever the environment asks of HDF5
    H5Pset_file_locking(access, false, true);  // a reader must neither block a writer nor need a writable folder
    const Handle h5(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose, "the index of the file");
    void* descriptor = nullptr;
    if (H5Fget_vfd_handle(h5, H5P_DEFAULT, &descriptor) < 0 || !descriptor) throw Refused("the file");
    if (!file.same_file(*static_cast<int*>(descriptor))) return std::nullopt;
    if (H5Aexists(h5, "content") <= 0 || H5Aexists(h5, "format") <= 0 || read_text(h5, "content", size) != content)
      throw std::runtime_error(fmt::format("'{}' is an HDF5 file but not a Tanktread trajectory", path));
    if (const std::int64_t format = read_number(h5, "format"); format != trajectory_format)
      throw std::runtime_error(fmt::format("trajectory '{}' has format {}; this program reads format {}", path, format,
                                           trajectory_format));
    return read_map(file, h5, size);
  } catch (const Refused& refused) {
    throw std::runtime_error(fmt::format("trajectory '{}' is damaged: {} is not what it must be", path, refused.what()));
  }
}

Descriptor::Descriptor(const std::filesystem::path& path, bool writable) : path_(path) {
  const char* what = writable ? "write trajectory" : "read trajectory";
  struct stat status{};
  // Before it is opened, and again of what was opened.
  if (::stat(path.c_str(), &status) != 0) fail(what, path, errno);
  if (S_ISREG(status.st_mode)) {
    fd_ = ::open(path.c_str(), (writable ? O_RDWR : O_RDONLY) | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd_ < 0) fail(what, path, errno);
    if (::fstat(fd_, &status) == 0 && S_ISREG(status.st_mode)) return;
    ::close(std::exchange(fd_, -1));
  }
  throw std::runtime_error(fmt::format("'{}' is not a file", path.string()));
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

std::uint64_t Descriptor::size() const {
  struct stat status{};
  if (::fstat(fd_, &status) != 0) fail("read trajectory", path_, errno);
  return static_cast<std::uint64_t>(status.st_size);
}

bool Descriptor::same_file(int descriptor) const {
  struct stat own{}, other{};
  return ::fstat(fd_, &own) == 0 && ::fstat(descriptor, &other) == 0 && own.st_dev == other.st_dev &&
         own.st_ino == other.st_ino;
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
  return head.starts_with(signature) && head.find(content) != std::string::npos;
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
