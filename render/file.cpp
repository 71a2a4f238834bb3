#include "file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace render {

namespace fs = std::filesystem;

namespace {

/// Beside the file: a name that nobody lists, and that no other process takes.
fs::path draft_of(const fs::path& target) {
  return target.parent_path() / fmt::format(".{}.{}.tmp", target.filename().string(), ::getpid());
}

/// 0, or the reason why not all could be written.
int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(file, bytes.data(), bytes.size());
    if (done >= 0) bytes.remove_prefix(static_cast<std::size_t>(done));
    else if (errno != EINTR) return errno;
  }
  return 0;
}

}  // namespace

void write_file(const fs::path& path, std::string_view bytes) {
  std::error_code error;
  const fs::path target = fs::is_symlink(path, error) ? fs::canonical(path, error) : path;
  // Only a file can be replaced by a complete one.
  const bool replaces = error || !fs::exists(target, error) || fs::is_regular_file(target, error);
  const fs::path draft = replaces ? draft_of(target) : target;
  if (replaces) ::unlink(draft.c_str());
  const int file = ::open(draft.c_str(), replaces ? O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC : O_WRONLY | O_CLOEXEC, 0666);
  int reason = file < 0 ? errno : write_all(file, bytes);
  // Renamed before its contents are on the disk, a file could be empty after a power cut.
  if (replaces && reason == 0 && ::fsync(file) != 0) reason = errno;
  if (file >= 0 && ::close(file) != 0 && reason == 0) reason = errno;
  if (replaces && reason == 0 && ::rename(draft.c_str(), target.c_str()) != 0) reason = errno;
  if (reason == 0) return;
  if (replaces && file >= 0) ::unlink(draft.c_str());
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(reason)));
}

}  // namespace render
