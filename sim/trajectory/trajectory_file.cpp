#include "sim/trajectory/trajectory_file.h"

#include "sim/trajectory/trajectory_datasets.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace sim::file {

namespace {

[[noreturn]] void fail(std::string_view what, const std::filesystem::path& path, int number) {
  throw std::runtime_error(fmt::format("cannot {} '{}': {}", what, path.string(), std::strerror(number)));
}

}  // namespace

Descriptor::Descriptor(const std::filesystem::path& path, bool writable) : path_(path) {
  const char* what = writable ? "write trajectory" : "read trajectory";
  struct stat status {};
  // Before it is opened, and again of what was opened.
  if (::stat(path.c_str(), &status) != 0) fail(what, path, errno);
  if (S_ISREG(status.st_mode)) {
    fd_ = ::open(path.c_str(), (writable ? O_RDWR : O_RDONLY) | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd_ < 0) fail(what, path, errno);
    if (::fstat(fd_, &status) == 0 && S_ISREG(status.st_mode)) return;
    ::close(std::exchange(fd_, -1));
  }
  throw std::runtime_error(fmt::format("'{}' is not a file", path.string()));
}
Descriptor::Descriptor(Descriptor&& other) noexcept
    : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)) {}
Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(fd_, other.fd_);
  return *this;
}
Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

void Descriptor::write(std::uint64_t offset, const void* bytes, std::uint64_t size) const {
  const auto* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t done = ::pwrite(fd_, from, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail("write trajectory", path_, done < 0 ? errno : ENOSPC);
    from += done;
    offset += static_cast<std::uint64_t>(done);
    size -= static_cast<std::uint64_t>(done);
  }
}

void Descriptor::read(std::uint64_t offset, void* bytes, std::uint64_t size) const {
  auto* to = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t done = ::pread(fd_, to, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail("read trajectory", path_, errno);
    if (done == 0) throw std::runtime_error(fmt::format("trajectory '{}' is cut short", path_.string()));
    to += done;
    offset += static_cast<std::uint64_t>(done);
    size -= static_cast<std::uint64_t>(done);
  }
}

void Descriptor::sync(bool data_only) const {
  if ((data_only ? ::fdatasync(fd_) : ::fsync(fd_)) != 0 && errno != EINVAL) fail("write trajectory", path_, errno);
}

std::uint64_t Descriptor::inode() const {
  struct stat status {};
  return ::fstat(fd_, &status) == 0 ? status.st_ino : 0;
}

std::uint64_t Descriptor::size() const {
  struct stat status {};
  if (::fstat(fd_, &status) != 0) fail("read trajectory", path_, errno);
  return static_cast<std::uint64_t>(status.st_size);
}

bool Descriptor::same_file(int descriptor) const {
  struct stat own {
  }, other{};
  return ::fstat(fd_, &own) == 0 && ::fstat(descriptor, &other) == 0 && own.st_dev == other.st_dev &&
         own.st_ino == other.st_ino;
}

Lock::Lock(const std::filesystem::path& path) {
  for (;;) {
    fd_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
    if (fd_ < 0) fail("write trajectory", path, errno);
    if (!lock_file(fd_)) {
      ::close(std::exchange(fd_, -1));
      throw std::runtime_error(fmt::format("another process is writing '{}'", path.string()));
    }
    // The holder before us may have put a larger file in its place between our open and our lock.
    struct stat ours {
    }, named{};
    if (::fstat(fd_, &ours) == 0 && ::stat(path.c_str(), &named) == 0 && ours.st_ino == named.st_ino &&
        ours.st_dev == named.st_dev)
      return;
    ::close(std::exchange(fd_, -1));
  }
}
Lock::Lock(Lock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
Lock& Lock::operator=(Lock&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}
Lock::~Lock() {
  if (fd_ >= 0) ::close(fd_);
}

void require_ours(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return;
  if (!S_ISREG(status.st_mode))
    throw std::runtime_error(fmt::format("'{}' is not a file; a trajectory cannot take its place", path.string()));
  if (status.st_size == 0) return;
  if (!holds_mark(path))
    throw std::runtime_error(
        fmt::format("'{}' is not a trajectory of this program and is left as it is; give another name", path.string()));
}

bool holds_mark(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return false;
  // HDF5 keeps the texts of attributes as they are, at the head of the file: seen also where HDF5 itself finds damage.
  std::string head(metadata_bytes, '\0');
  const ssize_t got = ::pread(file, head.data(), head.size(), 0);
  ::close(file);
  head.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return head.starts_with(signature) && head.find(content) != std::string::npos;
}

Draft draft(const std::filesystem::path& path) {
  try {
    return Draft(path);
  } catch (const std::system_error& error) {
    fail("create trajectory", path, error.code().value());
  }
}

void publish(Draft& draft, const std::filesystem::path& path, bool fresh) {
  try {
    draft.publish(path, fresh);
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::file_exists)
      throw std::runtime_error(fmt::format("another process has made '{}' meanwhile", path.string()));
    fail("write trajectory", path, error.code().value());
  }
}

}  // namespace sim::file
