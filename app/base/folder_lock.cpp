#include "app/base/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace app {

namespace {

constexpr std::string_view owner = "tanktread ";

/// A lock file says whose it is, as far as a kill let it; anything else with its name is somebody else's.
void sign(int file, const std::filesystem::path& path) {
  char start[owner.size()];
  const ssize_t got = ::pread(file, start, sizeof start, 0);
  if (got > 0 && !owner.starts_with(std::string_view(start, static_cast<std::size_t>(got))))
    throw std::runtime_error(
        fmt::format("'{}' was not made by this program, which needs this name for its lock", path.string()));
  const std::string line = fmt::format("{}{}\n", owner, ::getpid());
  if (::ftruncate(file, 0) == 0 && ::pwrite(file, line.data(), line.size(), 0) < 0)
    return;  // a full disk: locked all the same
}

}  // namespace

bool FolderLock::File::take(bool shared) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  for (;;) {
    descriptor = ::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor < 0)
      throw std::runtime_error(
          fmt::format("cannot write into '{}': {}", path.parent_path().string(), std::strerror(errno)));
    if (::flock(descriptor, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0) {
      const int error = errno;
      if (error != EWOULDBLOCK) return true;  // a file system without locks: nothing can be known there
      ::close(std::exchange(descriptor, -1));
      // A shard that ends has the file to itself for a moment, to see whether it is the last (release()).
      if (!shared || std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      continue;
    }
    // The holder before us may have removed the file between our open and our lock.
    struct stat ours {
    }, named{};
    if (::fstat(descriptor, &ours) == 0 && ::stat(path.c_str(), &named) == 0 && ours.st_ino == named.st_ino) {
      try {
        sign(descriptor, path);
      } catch (...) {
        ::close(std::exchange(descriptor, -1));
        throw;
      }
      return true;
    }
    ::close(std::exchange(descriptor, -1));
  }
}

void FolderLock::File::release() {
  if (descriptor < 0) return;
  // Others that share it still need the file.
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) ::unlink(path.c_str());
  ::close(std::exchange(descriptor, -1));
}

FolderLock::FolderLock(const std::filesystem::path& folder, int shard, int shards)
    : whole_{folder / ".tanktread.lock"}, part_{folder / fmt::format(".tanktread-{}-{}.lock", shard, shards)} {
  std::error_code error;
  if (std::filesystem::create_directories(folder, error)) made_ = folder;
  if (error) throw std::runtime_error(fmt::format("cannot make folder '{}': {}", folder.string(), error.message()));
  if (!whole_.take(shards > 1))
    throw std::runtime_error(fmt::format("another process is writing into '{}'", folder.string()));
  if (shards == 1) {
    remove_dead_parts(folder);
    return;
  }
  if (part_.take(false)) return;
  whole_.release();
  throw std::runtime_error(
      fmt::format("another process is drawing shard {}/{} into '{}'", shard, shards, folder.string()));
}

/// Locks of shards that were killed: nobody draws shards now.
void FolderLock::remove_dead_parts(const std::filesystem::path& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    int shard = 0, shards = 0, length = 0;
    const std::string name = entry.path().filename().string();
    if (std::sscanf(name.c_str(), ".tanktread-%d-%d.lock%n", &shard, &shards, &length) != 2 ||
        length != static_cast<int>(name.size()))
      continue;
    File part{entry.path()};
    try {
      if (part.take(false)) part.release();
    } catch (const std::exception&) {
      // somebody else's file
    }
  }
}

void FolderLock::release() {
  part_.release();
  whole_.release();
  std::error_code ignored;
  if (!made_.empty()) std::filesystem::remove(made_, ignored);  // if it is empty
  made_.clear();
}

FolderLock::~FolderLock() { release(); }

}  // namespace app
