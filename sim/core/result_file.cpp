#include "sim/core/result_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace sim {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view draft_start = ".tanktread-", draft_end = ".tmp";

/// `.tanktread-PID-N.tmp`, nothing else.
bool is_draft_name(std::string_view name) {
  if (!name.starts_with(draft_start) || !name.ends_with(draft_end)) return false;
  const char *at = name.data() + draft_start.size(), *end = name.data() + name.size() - draft_end.size();
  for (const bool last : {false, true}) {
    unsigned long long number = 0;
    const auto [stop, error] = std::from_chars(at, end, number);
    if (error != std::errc() || (last ? stop != end : stop == end || *stop != '-')) return false;
    at = stop + !last;
  }
  return true;
}

[[noreturn]] void fail(int number) { throw std::system_error(number, std::generic_category()); }

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

void write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(file, bytes.data(), bytes.size());
    if (done >= 0)
      bytes.remove_prefix(static_cast<std::size_t>(done));
    else if (errno != EINTR)
      fail(errno);
  }
}

/// The name of a file is on the disk when its folder is. Some file systems cannot say so, and some folders may not be
/// read.
void sync_folder(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  const int reason = ::fsync(file) == 0 || errno == EINVAL || errno == EROFS ? 0 : errno;
  ::close(file);
  if (reason != 0) fail(reason);
}

/// remove_dead_drafts() for the first file that this process writes into a folder.
void clean_once(const fs::path& folder) {
  static std::mutex one_at_a_time;
  static std::set<fs::path> cleaned;
  const std::lock_guard guard(one_at_a_time);
  if (cleaned.insert(folder).second) remove_dead_drafts(folder);
}

bool has_a_name(int file) {
  struct stat status {};
  return ::fstat(file, &status) == 0 && status.st_nlink > 0;
}

}  // namespace

fs::path destination(const fs::path& path) {
  std::error_code none;
  const fs::file_status there = fs::status(path, none);  // a name in /proc/self/fd is a link to no name
  if (fs::exists(there) && !fs::is_regular_file(there) && !fs::is_directory(there)) return path;
  constexpr int most_links = 40;
  fs::path here = path;
  for (int k = 0; k < most_links; ++k) {
    std::error_code error;
    const fs::path next = fs::read_symlink(here, error);
    if (error) return here;  // not a link
    here = next.is_absolute() ? next : folder_of(here) / next;
  }
  throw std::runtime_error(fmt::format("'{}' cannot be written: {}", path.string(), std::strerror(ELOOP)));
}

bool lock_file(int descriptor) {
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  // Of the open file, not of the process; HDF5's own locks, which readers may use, are of another kind.
  return ::fcntl(descriptor, F_OFD_SETLK, &whole) == 0 || (errno != EAGAIN && errno != EACCES);
}

void remove_dead_drafts(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, error)) {
    if (!is_draft_name(entry.path().filename().string())) continue;
    const int file = ::open(entry.path().c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) continue;
    struct flock whole {};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    struct stat status {};
    // Without locks it may be alive, so it stays.
    if (::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && ::fcntl(file, F_OFD_SETLK, &whole) == 0)
      ::unlink(entry.path().c_str());
    ::close(file);
  }
}

Draft::Draft(const fs::path& target) {
  static std::atomic<unsigned> made{0};
  clean_once(target.parent_path());
  for (;;) {
    path_ = target.parent_path() / fmt::format("{}{}-{}{}", draft_start, ::getpid(), made++, draft_end);
    file_ = ::open(path_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
    if (file_ < 0 && errno == EEXIST) continue;  // of a process that had this number
    if (file_ < 0) fail(errno);
    // Somebody who cleans up may have taken it for a dead one between our open and our lock.
    if (lock_file(file_) && has_a_name(file_)) return;
    ::close(std::exchange(file_, -1));
  }
}

Draft::Draft(Draft&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)), published_(other.published_) {}

Draft& Draft::operator=(Draft&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(file_, other.file_);
  std::swap(published_, other.published_);
  return *this;
}

Draft::~Draft() {
  if (file_ < 0) return;
  if (!published_) ::unlink(path_.c_str());
  ::close(file_);
}

void Draft::write(std::string_view bytes) { write_all(file_, bytes); }

void Draft::publish(const fs::path& target, bool fresh) {
  // Renamed before its contents are on the disk, a file could be empty after a power cut.
  if (::fsync(file_) != 0 && errno != EINVAL) fail(errno);
  if (!fresh) {
    if (::rename(path_.c_str(), target.c_str()) != 0) fail(errno);
  } else if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE) != 0) {
    if (errno != EINVAL && errno != ENOSYS) fail(errno);
    // A file system without this call: a second name, then not the first one.
    if (::link(path_.c_str(), target.c_str()) != 0) fail(errno);
    ::unlink(path_.c_str());
  }
  published_ = true;
  sync_folder(folder_of(target));
}

int Draft::release() { return std::exchange(file_, -1); }

void write_file(const fs::path& path, std::string_view bytes) {
  try {
    const fs::path target = destination(path);
    struct stat status {};
    if (::stat(target.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
      const int file = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
      if (file < 0) fail(errno);
      try {
        write_all(file, bytes);
      } catch (...) {
        ::close(file);
        throw;
      }
      if (::close(file) != 0) fail(errno);
      return;
    }
    Draft draft(target);
    draft.write(bytes);
    draft.publish(target);
  } catch (const std::system_error& error) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), error.code().message()));
  }
}

}  // namespace sim
