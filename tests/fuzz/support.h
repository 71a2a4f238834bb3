// What the fuzz targets share: the input as a file, and the promise that every refusal is one sentence.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string>

namespace fuzz {

/// A file in memory that has a name of its own: HDF5 opens none by the link in /proc to one without.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* bytes, std::size_t size)
      : path_((std::filesystem::exists("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path()) /
              ("tanktread-fuzz-" + std::to_string(::getpid()))) {
    const int file = ::open(path_.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0600);
    if (file < 0 || ::write(file, bytes, size) != static_cast<ssize_t>(size) || ::close(file) != 0) std::abort();
  }
  MemoryFile(const MemoryFile&) = delete;
  ~MemoryFile() { ::unlink(path_.c_str()); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
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
