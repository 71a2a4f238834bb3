// Exclusive access to an output folder: one process, or one for each shard of the frames.
#pragma once

#include <filesystem>

namespace app {

/// Locks on files in the folder, which contain the process id. The files are removed with the lock, and so is a
/// folder that was made for them and is otherwise empty; the system releases the locks when the process dies in any
/// way.
class FolderLock {
 public:
  /// Creates the folder if necessary. Throws std::runtime_error when another process holds it: a writer of all frames
  /// (shards 1) excludes every other, a shard those with the same number.
  FolderLock(const std::filesystem::path& folder, int shard = 0, int shards = 1);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();
  void release();

 private:
  struct File {
    std::filesystem::path path;
    int descriptor = -1;
    /// False: another process holds it.
    bool take(bool shared);
    void release();
  };
  static void remove_dead_parts(const std::filesystem::path& folder);

  std::filesystem::path made_;  ///< the folder, if it did not exist
  File whole_, part_;
};

}  // namespace app
