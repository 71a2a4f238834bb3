// Result files: complete or absent, whatever happens while they are written, and never in place of a user's file.
//
// Each is written as a draft, `.tanktread-PID-N.tmp`, in its final folder, and renamed when it is complete and on the
// disk. A draft is locked while its process lives: one without a lock was left by a killed process, and the next
// writer into the folder removes it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace sim {

/// Target of a name with every link followed, including the last, whether or not it exists. A pipe or a device keeps
/// its name.
std::filesystem::path destination(const std::filesystem::path&);

/// Exclusive write lock on an open file, held until this process closes the file or ends in any way. It belongs to
/// the file, not to one of its names, and does not affect readers. False: another process holds it. Granted where the
/// file system has no locks.
bool lock_file(int descriptor);

/// Removes the drafts that killed processes left in a folder.
void remove_dead_drafts(const std::filesystem::path& folder);

/// A new file being written, locked; removed with the object unless it was published.
class Draft {
 public:
  /// In the folder of `target`, whose links must have been resolved. Throws std::system_error.
  explicit Draft(const std::filesystem::path& target);
  Draft(Draft&&) noexcept;
  Draft& operator=(Draft&&) noexcept;
  ~Draft();

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return file_; }

  void write(std::string_view bytes);  ///< appended; throws std::system_error
  /// Renames the draft durably to `target`, replacing an existing file or link; throws std::system_error. With
  /// `fresh` an existing target is an error, std::errc::file_exists.
  void publish(const std::filesystem::path& target, bool fresh = false);
  /// After publish(): the descriptor with its lock, which the caller closes.
  int release();

 private:
  std::filesystem::path path_;
  int file_ = -1;
  bool published_ = false;
};

/// Writes a whole file. Where `path` is a link, its target is replaced; a pipe or a device is written to directly.
/// Throws std::runtime_error with path and reason, and then leaves nothing behind.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// write_file(), or another function that writes a whole file.
using FileWriter = std::function<void(const std::filesystem::path&, std::string_view)>;

}  // namespace sim
