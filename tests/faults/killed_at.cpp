// Preloaded: kills the program at its n-th operation that changes a file, before it, in the middle of it, or after it.
// KILL_AT=n, KILL_HOW=before|torn|after; COUNT_TO=FILE: writes there how many operations a whole run has.
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <atomic>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

std::atomic<long> operations{0};
long wanted = -1;
enum class How { before, torn, after } how = How::before;
bool watching = false;
const char* count_file = nullptr;

[[noreturn]] void die() {
  ::kill(::getpid(), SIGKILL);
  for (;;) ::pause();
}

/// Is this the operation at which to die? Before it, it does not return.
bool last_one() {
  if (!watching) return false;
  const bool here = ++operations == wanted;
  if (here && how == How::before) die();
  return here;
}

template <class F>
F real(const char* name) {
  return reinterpret_cast<F>(::dlsym(RTLD_NEXT, name));
}

/// Streams and pipes are no results.
bool is_file(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

/// A write of which half may come to the disk.
template <class Write>
ssize_t cut_short(int descriptor, size_t size, Write&& write) {
  if (!watching || !is_file(descriptor)) return write(size);
  const bool last = last_one();
  if (last && how == How::torn) {
    if (size > 1) write(size / 2);
    die();
  }
  const ssize_t done = write(size);
  if (last) die();
  return done;
}

template <class Call>
int whole(Call&& call) {
  const bool last = last_one();
  const int result = call();
  if (last) die();
  return result;
}

}  // namespace

extern "C" {

__attribute__((constructor)) void killed_at_begin() {
  if (std::strcmp(program_invocation_short_name, "tanktread") != 0 &&
      std::strcmp(program_invocation_short_name, "exe") != 0)
    return;
  watching = true;
  if (const char* text = std::getenv("KILL_AT")) wanted = std::atol(text);
  if (const char* text = std::getenv("KILL_HOW"))
    how = !std::strcmp(text, "torn") ? How::torn : !std::strcmp(text, "after") ? How::after : How::before;
  count_file = std::getenv("COUNT_TO");
}

__attribute__((destructor)) void killed_at_end() {
  if (!watching || !count_file) return;
  // Past the functions below.
  const int file = static_cast<int>(::syscall(SYS_openat, AT_FDCWD, count_file, O_WRONLY | O_CREAT | O_APPEND, 0666));
  char line[32];
  const int length = std::snprintf(line, sizeof line, "%ld\n", operations.load());
  ::syscall(SYS_write, file, line, length);
  ::syscall(SYS_close, file);
}

ssize_t write(int f, const void* bytes, size_t size) {
  static const auto call = real<ssize_t (*)(int, const void*, size_t)>("write");
  return cut_short(f, size, [&](size_t part) { return call(f, bytes, part); });
}
ssize_t pwrite(int f, const void* bytes, size_t size, off_t at) {
  static const auto call = real<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
  return cut_short(f, size, [&](size_t part) { return call(f, bytes, part, at); });
}
ssize_t pwrite64(int f, const void* bytes, size_t size, off_t at) {
  static const auto call = real<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite64");
  return cut_short(f, size, [&](size_t part) { return call(f, bytes, part, at); });
}
int rename(const char* from, const char* to) noexcept {
  static const auto call = real<int (*)(const char*, const char*)>("rename");
  return whole([&] { return call(from, to); });
}
int renameat2(int a, const char* from, int b, const char* to, unsigned flags) noexcept {
  static const auto call = real<int (*)(int, const char*, int, const char*, unsigned)>("renameat2");
  return whole([&] { return call(a, from, b, to, flags); });
}
int unlink(const char* name) noexcept {
  static const auto call = real<int (*)(const char*)>("unlink");
  return whole([&] { return call(name); });
}
int remove(const char* name) noexcept {
  static const auto call = real<int (*)(const char*)>("remove");
  return whole([&] { return call(name); });
}
int mkdir(const char* name, mode_t mode) noexcept {
  static const auto call = real<int (*)(const char*, mode_t)>("mkdir");
  return whole([&] { return call(name, mode); });
}
int ftruncate(int f, off_t size) noexcept {
  static const auto call = real<int (*)(int, off_t)>("ftruncate");
  return whole([&] { return call(f, size); });
}
int ftruncate64(int f, off_t size) noexcept {
  static const auto call = real<int (*)(int, off_t)>("ftruncate64");
  return whole([&] { return call(f, size); });
}
int fsync(int f) {
  static const auto call = real<int (*)(int)>("fsync");
  return whole([&] { return call(f); });
}
int fdatasync(int f) {
  static const auto call = real<int (*)(int)>("fdatasync");
  return whole([&] { return call(f); });
}
int open(const char* name, int flags, ...) {
  static const auto call = real<int (*)(const char*, int, mode_t)>("open");
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return flags & O_CREAT ? whole([&] { return call(name, flags, mode); }) : call(name, flags, mode);
}
int open64(const char* name, int flags, ...) {
  static const auto call = real<int (*)(const char*, int, mode_t)>("open64");
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return flags & O_CREAT ? whole([&] { return call(name, flags, mode); }) : call(name, flags, mode);
}

}  // extern "C"
