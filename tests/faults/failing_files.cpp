// Counts the changes that the program makes to regular files, and at the one whose number is in TANKTREAD_FAIL_AT does
// what TANKTREAD_FAIL_HOW says: `kill` before it, `torn` (half of a write, then kill), or let it fail `once` for want
// of space. Without a number it writes the count into the file TANKTREAD_FAIL_COUNT at the end.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<long> count{0};

long number_of(const char* name) {
  const char* text = std::getenv(name);
  return text ? std::atol(text) : -1;
}
const long fail_at = number_of("TANKTREAD_FAIL_AT");
const char* const how = std::getenv("TANKTREAD_FAIL_HOW");
const bool watching = std::strcmp(program_invocation_short_name, "tanktread") == 0;

enum class Fate { go_on, fail, tear };

Fate next_fate() {
  if (!watching || ++count != fail_at || !how) return Fate::go_on;
  if (std::strcmp(how, "torn") == 0) return Fate::tear;
  if (std::strcmp(how, "kill") == 0) std::raise(SIGKILL);
  errno = ENOSPC;
  return Fate::fail;
}

template <class F>
F* real(const char* name) {
  return reinterpret_cast<F*>(dlsym(RTLD_NEXT, name));
}

template <class F>
auto changed(F&& call) {
  const Fate fate = next_fate();
  if (fate == Fate::fail) return decltype(call())(-1);
  const auto result = call();
  if (fate == Fate::tear) std::raise(SIGKILL);
  return result;
}

bool regular(int fd) {
  struct stat status {};
  return fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
}

template <class Write>
ssize_t written(int fd, size_t size, Write&& write) {
  if (!regular(fd)) return write(size);
  const Fate fate = next_fate();
  if (fate == Fate::fail) return -1;
  const ssize_t result = write(fate == Fate::tear ? size / 2 : size);
  if (fate == Fate::tear) std::raise(SIGKILL);
  return result;
}

struct AtEnd {
  ~AtEnd() {
    const char* file = std::getenv("TANKTREAD_FAIL_COUNT");
    if (!watching || !file) return;
    const long total = count;
    if (std::FILE* out = std::fopen(file, "w")) {
      std::fprintf(out, "%ld\n", total);
      std::fclose(out);
    }
  }
} at_end;

}  // namespace

extern "C" {

ssize_t write(int fd, const void* bytes, size_t size) {
  return written(fd, size, [&](size_t n) { return real<ssize_t(int, const void*, size_t)>("write")(fd, bytes, n); });
}
ssize_t pwrite(int fd, const void* bytes, size_t size, off_t at) {
  return written(fd, size,
                 [&](size_t n) { return real<ssize_t(int, const void*, size_t, off_t)>("pwrite")(fd, bytes, n, at); });
}
ssize_t pwrite64(int fd, const void* bytes, size_t size, off64_t at) {
  return written(fd, size, [&](size_t n) {
    return real<ssize_t(int, const void*, size_t, off64_t)>("pwrite64")(fd, bytes, n, at);
  });
}
int ftruncate(int fd, off_t size) noexcept {
  return changed([&] { return real<int(int, off_t)>("ftruncate")(fd, size); });
}
int ftruncate64(int fd, off64_t size) noexcept {
  return changed([&] { return real<int(int, off64_t)>("ftruncate64")(fd, size); });
}
int fsync(int fd) {
  return changed([&] { return real<int(int)>("fsync")(fd); });
}
int fdatasync(int fd) {
  return changed([&] { return real<int(int)>("fdatasync")(fd); });
}
int rename(const char* from, const char* to) noexcept {
  return changed([&] { return real<int(const char*, const char*)>("rename")(from, to); });
}
/// Taking away never fails for want of space, but the program may die there.
int unlink(const char* path) noexcept {
  if (how && std::strcmp(how, "once") == 0) return real<int(const char*)>("unlink")(path);
  return changed([&] { return real<int(const char*)>("unlink")(path); });
}

}  // extern "C"
