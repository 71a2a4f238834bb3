// Files of results: whole or absent, whatever happens while they are written, and nobody else's file in their place.
//
// Each is written under the name of a draft, `.tanktread-PID-N.tmp`, in the folder where it will stand, and takes its own name
// when it is complete and on the disk. A draft is locked while its process lives: one without a lock was left by a process that
// was killed, and the next writer into the folder removes it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace sim {

/// Where a name leads when every link is followed, the last one included, whether or not anything is there. A pipe or a device
/// keeps its name.
std::filesystem::path destination(const std::filesystem::path&);

/// The right to write an open file, held by this process until it closes the file or dies, however it dies. It belongs to the
/// file, not to one of its names. Readers are not disturbed. False: another process holds it. Where the file system has no
/// locks nothing can be known, and it is granted.
bool lock_file(int descriptor);

/// Removes what processes that were killed left half-written in a folder.
void remove_dead_drafts(const std::filesystem::path& folder);

/// A new file in the making, locked; removed with the object unless it was published.
class Draft {
 public:
  /// Beside `target`, whose links must have been followed. Throws std::system_error.
  explicit Draft(const std::filesystem::path& target);
  Draft(Draft&&) noexcept;
  Draft& operator=(Draft&&) noexcept;
  ~Draft();

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return file_; }

  void write(std::string_view bytes);  ///< appended; throws std::system_error
  /// The draft takes the name, durably, in place of a file or link that may be there; throws std::system_error. With
  /// `fresh` anything that is there already is an error, std::errc::file_exists.
  void publish(const std::filesystem::path& target, bool fresh = false);
  /// After publish(): the descriptor with its lock, which the caller closes.
  int release();

 private:
  std::filesystem::path path_;
  int file_ = -1;
  bool published_ = false;
};

/// Writes a whole file. Where `path` is a link, what it points to is replaced; a pipe or a device is written to as it is.
/// Throws std::runtime_error with path and reason; nothing is left then.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// write_file(), or what else puts a whole file in its place.
using FileWriter = std::function<void(const std::filesystem::path&, std::string_view)>;

}  // namespace sim
