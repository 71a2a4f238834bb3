#include "sim/trajectory/attributes.h"
#include "sim/trajectory/file_blocks.h"
#include "sim/trajectory/hdf5_calls.h"
#include "sim/trajectory/trajectory_datasets.h"
#include "sim/trajectory/trajectory_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace sim::file {

namespace {

// More than any simulation has: a file that says otherwise is damaged, and takes no memory.
constexpr std::uint64_t largest_scene = 256 << 20, largest_row = std::uint64_t{4} << 30;

__extension__ using Wide = unsigned __int128;  // products of sizes cannot overflow

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
/// bytes stands for one of any length. The layout comes first: asked for the extent of a virtual dataset, HDF5 opens
/// others.
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
      H5Sget_simple_extent_dims(space, shape.data(), nullptr) < 0 ||
      !std::equal(shape.begin(), shape.end(), expected.shape.begin(), expected.shape.end()))
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

Map read_map(const Descriptor& file, hid_t h5, const Attributes& attributes, std::uint64_t file_bytes, int format) {
  Map map;
  map.layout.format = format;
  map.header.program = attributes.text("program");
  map.header.build = attributes.text("build");
  const std::string warnings = attributes.text("warnings");
  for (std::size_t from = 0; from < warnings.size();) {
    const std::size_t to = std::min(warnings.find('\n', from), warnings.size());
    map.header.warnings.push_back(warnings.substr(from, to - from));
    from = to + 1;
  }
  visit_layout(map.layout, [&](const char* name, auto& value, std::int64_t least, std::int64_t largest) {
    const std::int64_t number = attributes.number(name);
    if (number < least || number > largest) throw Refused(name);
    value = static_cast<std::remove_reference_t<decltype(value)>>(number);
  });
  const std::uint64_t scene_bytes = place_of(h5, {"scene", "", Kind::text, {}, 0}, file_bytes).row_bytes;
  for (const Dataset& d : datasets(map.layout, scene_bytes)) map.datasets.emplace(d.name, place_of(h5, d, file_bytes));
  require_separate(map.datasets);
  const Place& place = map.at("scene");
  map.header.scene.resize(place.row_bytes);
  file.read(place.offset, map.header.scene.data(), place.row_bytes);
  if (map.header.scene == std::string(1, '\0')) map.header.scene.clear();
  if (static_cast<std::int64_t>(scene_checksum(map.header.scene)) != attributes.number("scene_checksum"))
    throw std::runtime_error(
        fmt::format("trajectory '{}' is damaged: its scene does not fit its checksum", file.path().string()));
  return map;
}

std::string foreign(const std::string& path) {
  return fmt::format("'{}' is an HDF5 file but not a Tanktread trajectory", path);
}

/// What cannot be read is damage only in a trajectory.
Attributes attributes_of(const Descriptor& file) {
  try {
    return Attributes(file);
  } catch (const Unread&) {
    throw;
  } catch (const Refused&) {
    if (holds_mark(file.path())) throw;
    throw std::runtime_error(foreign(file.path().string()));
  }
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
    const Attributes attributes = attributes_of(file);
    if (!attributes.has("content") || !attributes.has("format") || attributes.text("content") != content)
      throw std::runtime_error(foreign(path));
    const std::int64_t format = attributes.number("format");
    if (format < 1 || format > trajectory_format)
      throw std::runtime_error(fmt::format("trajectory '{}' has format {}; this program reads formats 1 to {}", path,
                                           format, trajectory_format));
    return read_map(file, h5, attributes, size, static_cast<int>(format));
  } catch (const Unread& unread) {
    throw std::runtime_error(fmt::format(
        "HDF5 file '{}' is stored in a way that this program does not read: {}; 'h5repack' can make a plain copy", path,
        unread.what()));
  } catch (const Refused& refused) {
    throw std::runtime_error(
        fmt::format("trajectory '{}' is damaged: {} is not what it must be", path, refused.what()));
  }
}

}  // namespace sim::file
