// Who may write into a folder of results: one process, or one for each shard of the frames.
#pragma once

#include <filesystem>

namespace app {

/// Locks on files in the folder, which hold the number of the process. They go with the lock, and so does a folder that was made for them and holds nothing else;
/// the system gives them back when the process dies, however it dies.
class FolderLock {
 public:
  /// The folder is made when it is not there. Throws std::runtime_error when another process holds it: a writer of the whole
  /// (shards 1) excludes every other, a shard those of the same number.
  FolderLock(const std::filesystem::path& folder, int shard = 0, int shards = 1);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();
  void release();

 private:
  struct File {
    std::filesystem::path path;
    int descriptor = -1;
    /// False: another process has it.
    bool take(bool shared);
    void release();
  };
  static void remove_dead_parts(const std::filesystem::path& folder);

  std::filesystem::path made_;  ///< the folder, if it was not there
  File whole_, part_;
};

}  // namespace app
