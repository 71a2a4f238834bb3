#include "sim/trajectory/hdf5_calls.h"
#include "sim/trajectory/trajectory_datasets.h"
#include "sim/trajectory/trajectory_file.h"

#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace sim::file {

namespace {

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

/// The file as HDF5 makes it, with all datasets allocated and nothing in them but the scene.
void create_with_hdf5(const std::filesystem::path& draft, const std::vector<Dataset>& all,
                      const TrajectoryLayout& layout, const TrajectoryHeader& header) {
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
    write_text(h5, "content", std::string(content));
    write_text(h5, "program", header.program);
    write_text(h5, "build", header.build);
    std::string warnings;
    for (const std::string& w : header.warnings) warnings += (warnings.empty() ? "" : "\n") + w;
    write_text(h5, "warnings", warnings);
    visit_layout(layout,
                 [&](const char* name, auto value, std::int64_t, std::int64_t) { write_number(h5, name, value); });
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
                              : d.kind == Kind::real ? H5Tcopy(H5T_IEEE_F64LE)
                                                     : H5Tcopy(H5T_STD_U64LE),
                              H5Tclose);
      const std::vector<hsize_t> shape(d.shape.begin(), d.shape.end());
      const hid_t space = part(shape.empty() ? H5Screate(H5S_SCALAR)
                                             : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
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

/// Makes sure that what HDF5 will write can be written, before there is anything to be undone. Throws
/// std::system_error.
void try_to_write(int file, std::uint64_t file_bytes, std::uint64_t first_bytes) {
  if (::ftruncate(file, static_cast<off_t>(file_bytes)) != 0) throw std::system_error(errno, std::generic_category());
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
    try_to_write(draft.descriptor(), static_cast<std::uint64_t>(bytes) + metadata_bytes,
                 metadata_bytes + header.scene.size());
    create_with_hdf5(draft.path(), all, layout, header);
  } catch (const std::system_error& error) {
    throw std::runtime_error(
        fmt::format("cannot create trajectory '{}': {}", path.string(), std::strerror(error.code().value())));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("cannot create trajectory '{}': {}", path.string(), error.what()));
  }
}

}  // namespace sim::file
