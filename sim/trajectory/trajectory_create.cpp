#include "sim/trajectory/hdf5_calls.h"
#include "sim/trajectory/trajectory_datasets.h"
#include "sim/trajectory/trajectory_file.h"

#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

namespace sim::file {

namespace {

constexpr std::size_t length_at = 28;  // where a superblock of version 2 has the length of the file

__extension__ using Wide = unsigned __int128;  // products of sizes cannot overflow

Wide total_bytes(const std::vector<Dataset>& all) {
  Wide bytes = 0;
  for (const Dataset& d : all) bytes += static_cast<Wide>(d.rows()) * d.row_bytes();
  return bytes;
}

void check_space(const std::filesystem::path& path, Wide bytes) {
  if (bytes >> 62)
    throw std::runtime_error(fmt::format("trajectory '{}' would be too large for any disk", path.string()));
  struct statvfs disk {};
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (statvfs(folder.c_str(), &disk) != 0) return;
  const double needed = static_cast<double>(bytes);
  const double available = static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
  if (needed > available)
    throw std::runtime_error(fmt::format("trajectory '{}' will take {:.3g} GB and only {:.3g} GB are free in '{}'",
                                         path.string(), needed * 1e-9, available * 1e-9, folder.string()));
}

/// One a line. A compact attribute has less than 64 KiB; of a thousand vesicles, what the first ones say will do.
std::string lines(const std::vector<std::string>& all) {
  std::string text;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (text.size() + all[k].size() > most_warning_bytes)
      return text + fmt::format("{}and {} more", k > 0 ? "\n" : "", all.size() - k);
    text += (k > 0 ? "\n" : "") + all[k];
  }
  return text;
}

/// Memory that HDF5 takes for a file. Kept where HDF5 failed: it may still know it.
class Image {
 public:
  /// Asks HDF5 to write into this memory instead of a file.
  void offer(hid_t access) {
    H5FD_file_image_callbacks_t calls{};
    calls.image_realloc = [](void*, size_t size, H5FD_file_image_op_t, void* bytes) { return grown(bytes, size); };
    calls.image_free = [](void*, H5FD_file_image_op_t, void*) -> herr_t { return 0; };
    calls.udata_copy = [](void* bytes) { return bytes; };
    calls.udata_free = [](void*) -> herr_t { return 0; };
    calls.udata = bytes_;
    Making::check(H5Pset_fapl_core(access, metadata_bytes, false));
    Making::check(H5Pset_file_image_callbacks(access, &calls));
  }
  /// After HDF5 has closed the file.
  std::string take() {
    std::string taken = std::move(*bytes_);
    delete std::exchange(bytes_, nullptr);
    return taken;
  }

 private:
  std::string* bytes_ = new std::string;

  static void* grown(void* bytes, size_t size) {
    try {
      auto& text = *static_cast<std::string*>(bytes);
      text.resize(size);
      return text.data();
    } catch (const std::exception&) {
      return nullptr;
    }
  }
};

/// What HDF5 has to say about a new file, with room for all datasets but nothing in them.
struct Start {
  std::string bytes;  ///< with which the file begins
  std::uint64_t file_bytes = 0, scene_offset = 0;
};

/// Made in memory: HDF5 2 ends the process, and 1.10 crashes, when a write into a file fails at the wrong moment. HDF5
/// writes nothing but metadata, and is never told to flush, for which it would take memory for the whole file.
Start start_of_file(const std::vector<Dataset>& all, const TrajectoryLayout& layout, const TrajectoryHeader& header) {
  start_hdf5();
  Making made;
  const hid_t creation = made(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  Making::check(H5Pset_obj_track_times(creation, false));  // or the root group carries the time of day
  // All attributes in the header of the root, which is guarded by a checksum, none in an index of their own.
  Making::check(H5Pset_attr_phase_change(creation, 65535, 65535));
  const hid_t access = made(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  Image image;
  image.offer(access);
  // Checksummed metadata, no consistency flags; all of it at the head of the file.
  Making::check(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18));
  Making::check(H5Pset_meta_block_size(access, metadata_bytes));
  // No file can have this name, or HDF5 would read it.
  const hid_t h5 = made(H5Fcreate("/dev/null/memory", H5F_ACC_TRUNC, creation, access), H5Fclose);

  write_number(h5, "format", trajectory_format);
  write_text(h5, "content", std::string(content));
  write_text(h5, "program", header.program);
  write_text(h5, "build", header.build);
  write_text(h5, "warnings", lines(header.warnings));
  visit_layout(layout,
               [&](const char* name, auto value, std::int64_t, std::int64_t) { write_number(h5, name, value); });
  write_number(h5, "scene_checksum", static_cast<std::int64_t>(scene_checksum(header.scene)));

  Start start;
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
                            : d.kind == Kind::real ? H5Tcopy(H5T_IEEE_F64LE)
                                                   : H5Tcopy(H5T_STD_U64LE),
                            H5Tclose);
    const std::vector<hsize_t> shape(d.shape.begin(), d.shape.end());
    const hid_t space = part(
        shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
        H5Sclose);
    const hid_t dataset = part(H5Dcreate2(h5, d.name.c_str(), type, space, H5P_DEFAULT, plan, H5P_DEFAULT), H5Dclose);
    write_text(dataset, "meaning", d.meaning);
    if (d.name == "scene") start.scene_offset = H5Dget_offset(dataset);
    part.close();
  }
  group.close();
  made.close();
  start.bytes = image.take();
  std::memcpy(&start.file_bytes, start.bytes.data() + length_at, sizeof start.file_bytes);
  start.bytes.resize(std::min<std::uint64_t>(start.bytes.size(), start.file_bytes));
  return start;
}

/// Throws std::system_error.
void write_at(int file, std::uint64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) throw std::system_error(done < 0 ? errno : ENOSPC, std::generic_category());
    bytes.remove_prefix(static_cast<std::size_t>(done));
    offset += static_cast<std::uint64_t>(done);
  }
}

}  // namespace

void create(const Draft& draft, const std::filesystem::path& path, const TrajectoryLayout& layout,
            const TrajectoryHeader& header) {
  const std::vector<Dataset> all = datasets(layout, header.scene.size());
  const Wide bytes = total_bytes(all);
  check_space(path, bytes);
  try {
    const Start start = start_of_file(all, layout, header);
    if (::ftruncate(draft.descriptor(), static_cast<off_t>(start.file_bytes)) != 0)
      throw std::system_error(errno, std::generic_category());
    write_at(draft.descriptor(), 0, start.bytes);
    write_at(draft.descriptor(), start.scene_offset, header.scene);
  } catch (const std::system_error& error) {
    throw std::runtime_error(
        fmt::format("cannot create trajectory '{}': {}", path.string(), std::strerror(error.code().value())));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("cannot create trajectory '{}': {}", path.string(), error.what()));
  }
}

}  // namespace sim::file
