// The bytes of a trajectory: created and mapped by HDF5, then read and written at fixed offsets without it.
// Internal to the trajectory.
#pragma once

#include "sim/core/result_file.h"
#include "sim/trajectory/trajectory_rows.h"

#include <map>
#include <optional>

namespace sim::file {

/// Position of the rows of one dataset in the file, in bytes.
struct Place {
  std::uint64_t offset = 0, row_bytes = 0, rows = 0;
};

/// Everything that HDF5 knows about a file, read once when it is opened.
struct Map {
  TrajectoryHeader header;
  TrajectoryLayout layout;
  std::map<std::string, Place, std::less<>> datasets;

  const Place& at(std::string_view name) const { return datasets.find(name)->second; }
};

/// Turns a draft into an empty file of that layout: header, all datasets allocated (sparse) and zero. Errors name
/// `path`, the final name.
void create(const Draft&, const std::filesystem::path& path, const TrajectoryLayout&, const TrajectoryHeader&);

/// An open file descriptor whose transfers are complete or throw an exception with a sentence. Only regular files are
/// opened: a named pipe may block its reader forever, and opening a device may have side effects.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path&, bool writable);
  Descriptor(Descriptor&&) noexcept;
  Descriptor& operator=(Descriptor&&) noexcept;
  ~Descriptor();

  void write(std::uint64_t offset, const void* bytes, std::uint64_t size) const;
  void read(std::uint64_t offset, void* bytes, std::uint64_t size) const;
  void sync(bool data_only) const;
  std::uint64_t inode() const;
  std::uint64_t size() const;
  /// Whether this descriptor refers to the same file.
  bool same_file(int descriptor) const;
  const std::filesystem::path& path() const { return path_; }
  void renamed(const std::filesystem::path& path) { path_ = path; }  ///< after the file was renamed

 private:
  std::filesystem::path path_;
  int fd_ = -1;
};

/// Has HDF5 open the file of the descriptor read-only, without locking, checks format, names, types and extents, and
/// closes it again. Empty when another file has taken the name since.
std::optional<Map> map(const Descriptor&);

/// The right to write a trajectory: a lock on the file itself, under whatever name it was opened.
class Lock {
 public:
  /// Throws a sentence when another process holds it.
  explicit Lock(const std::filesystem::path&);
  /// Of a draft that has been published.
  explicit Lock(Draft&& draft) : fd_(draft.release()) {}
  Lock(Lock&&) noexcept;
  Lock& operator=(Lock&&) noexcept;
  ~Lock();

 private:
  int fd_ = -1;
};

/// Checks that a new trajectory may replace what has this name: throws a sentence unless it is empty or a trajectory
/// of this program, damaged or not, and also when it is not a regular file.
void require_ours(const std::filesystem::path&);
bool holds_mark(const std::filesystem::path&);

/// The steps of Draft, with their own error messages.
Draft draft(const std::filesystem::path&);
void publish(Draft&, const std::filesystem::path&, bool fresh);

}  // namespace sim::file
