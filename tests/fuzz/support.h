// What the fuzz targets share: the input as a file, and the promise that every refusal is one sentence.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string>

namespace fuzz {

/// A file in memory that has a path.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* bytes, std::size_t size) : fd_(memfd_create("input", MFD_CLOEXEC)) {
    if (fd_ < 0 || ::write(fd_, bytes, size) != static_cast<ssize_t>(size)) std::abort();
  }
  MemoryFile(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(fd_); }
  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

[[noreturn]] inline void broken(const char* promise) {
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

/// Runs f; bad input may end in an exception with one sentence, and in nothing else. True when there was none.
template <class F>
bool accepted(F&& f) {
  try {
    f();
    return true;
  } catch (const std::bad_alloc&) {
    broken("no size in a file is believed before it is checked");
  } catch (const std::exception& error) {
    if (*error.what() == '\0') broken("a refusal says why");
  }
  return false;
}

}  // namespace fuzz
