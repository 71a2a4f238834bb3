#include "app/base/owned_files.h"

#include "render/image/image.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace app {

namespace fs = std::filesystem;

namespace {

constexpr const char list_name[] = ".tanktread.files";
constexpr std::string_view heading = "# What tanktread made in this folder, and may replace: crc32, bytes, name.\n";

[[noreturn]] void fail(const fs::path& path, int number) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(number)));
}

/// Checksum and length of a whole file, a piece at a time; false: it cannot be read.
bool measure(int file, std::uint32_t& checksum, std::uint64_t& bytes) {
  std::vector<unsigned char> piece(std::size_t{1} << 18);
  uLong sum = ::crc32(0, nullptr, 0);
  bytes = 0;
  for (;;) {
    const ssize_t got = ::pread(file, piece.data(), piece.size(), static_cast<off_t>(bytes));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got == 0) break;
    sum = ::crc32(sum, piece.data(), static_cast<uInt>(got));
    bytes += static_cast<std::uint64_t>(got);
  }
  checksum = static_cast<std::uint32_t>(sum);
  return true;
}

/// A name on one line.
std::string written(std::string_view name) {
  std::string text;
  for (const char c : name)
    if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7f || c == '%')
      text += fmt::format("%{:02x}", byte);
    else
      text += c;
  return text;
}

std::string read_name(std::string_view text) {
  std::string name;
  for (std::size_t at = 0; at < text.size(); ++at) {
    unsigned byte = 0;
    if (text[at] == '%' && at + 2 < text.size() &&
        std::from_chars(text.data() + at + 1, text.data() + at + 3, byte, 16).ptr == text.data() + at + 3) {
      name += static_cast<char>(byte);
      at += 2;
    } else {
      name += text[at];
    }
  }
  return name;
}

std::string read_all(int file) {
  std::string text;
  char piece[65536];
  for (;;) {
    const ssize_t got = ::pread(file, piece, sizeof piece, static_cast<off_t>(text.size()));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(piece, static_cast<std::size_t>(got));
  }
}

/// The list is empty or begins as ours do, as far as a kill let it; anything else of its name is somebody else's.
void require_list(int file, const fs::path& path) {
  struct stat status {};
  char start[heading.size()];
  const ssize_t got =
      ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) ? ::pread(file, start, sizeof start, 0) : -1;
  const std::string_view text(start, got > 0 ? static_cast<std::size_t>(got) : 0);
  const std::string_view line = text.substr(0, text.find('\n'));
  if (got == 0 || (!line.empty() && heading.starts_with(line))) return;
  throw std::runtime_error(
      fmt::format("'{}' was not made by this program, which needs this name for its list", path.string()));
}

/// A picture that says it is ours. `damaged`: and cannot be read.
bool is_marked_picture(const fs::path& path, bool damaged) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return false;
  char head[4096];  // texts stand before the pixels
  const ssize_t got = ::pread(file, head, sizeof head, 0);
  ::close(file);
  const std::string_view start(head, got > 0 ? static_cast<std::size_t>(got) : 0);
  if (!start.starts_with("\211PNG\r\n\032\n") || start.find("tanktread:hash") == std::string_view::npos) return false;
  if (!damaged) return true;
  try {
    render::read_png(path);
    return false;
  } catch (const std::exception&) {
    return true;
  }
}

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      ::crc32_z(::crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

OwnedFiles::OwnedFiles(fs::path folder) : folder_(std::move(folder)) {
  if (folder_.empty()) folder_ = ".";
  const fs::path path = folder_ / list_name;
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return;
  try {
    require_list(file, path);
  } catch (...) {
    ::close(file);
    throw;
  }
  list_ = read(file);
  unlisted_ = false;
  ::close(file);
}

OwnedFiles::OwnedFiles(OwnedFiles&& other) noexcept
    : folder_(std::move(other.folder_)),
      list_(std::move(other.list_)),
      unwritten_(std::move(other.unwritten_)),
      unlisted_(other.unlisted_),
      adding_(std::exchange(other.adding_, -1)) {}

OwnedFiles::~OwnedFiles() { close_list(); }

OwnedFiles::List OwnedFiles::read(int file) {
  List list;
  struct stat status {};
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return list;
  const std::string text = read_all(file);
  for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const char *first = text.data() + at, *last = text.data() + end;
    Mark mark;
    const auto sum = std::from_chars(first, last, mark.checksum, 16);
    if (sum.ec != std::errc() || sum.ptr == last || *sum.ptr != ' ')
      continue;  // the heading, or a line that a kill cut short
    const auto size = std::from_chars(sum.ptr + 1, last, mark.bytes);
    if (size.ec != std::errc() || size.ptr == last || *size.ptr != ' ') continue;
    std::vector<Mark>& marks = list[read_name({size.ptr + 1, last})];
    if (std::find(marks.begin(), marks.end(), mark) == marks.end()) marks.push_back(mark);
  }
  return list;
}

bool OwnedFiles::has_mark(const std::string& name, const std::vector<Mark>& marks) const {
  const int file = ::open((folder_ / name).c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return false;
  Mark there;
  const bool read = measure(file, there.checksum, there.bytes);
  ::close(file);
  return read && std::find(marks.begin(), marks.end(), there) != marks.end();
}

bool OwnedFiles::foreign(const std::string& name, bool quick) const {
  const fs::path path = folder_ / name;
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return false;  // nothing is there
  if (!S_ISREG(status.st_mode)) return true;
  if (status.st_size == 0) return false;  // nothing is in it
  const auto line = list_.find(name);
  if (line == list_.end()) return !is_marked_picture(path, false);
  const auto same_size = [&](const Mark& mark) { return mark.bytes == static_cast<std::uint64_t>(status.st_size); };
  const bool may_be = std::any_of(line->second.begin(), line->second.end(), same_size);
  if (may_be && (quick || has_mark(name, line->second))) return false;
  return !is_marked_picture(path, true);  // a frame of ours that the disk has damaged
}

void OwnedFiles::require(const std::string& name, bool quick) const {
  if (!foreign(name, quick)) return;
  const bool link = fs::is_symlink(folder_ / name);
  throw std::runtime_error(fmt::format("'{}' {}; it is left as it is: move it away, or give another -o",
                                       (folder_ / name).string(),
                                       link ? "is a link, and links are not followed out of a folder of results"
                                       : list_.contains(name) ? "has been changed since this program wrote it"
                                                              : "was not made by this program"));
}

void OwnedFiles::require_folder(const std::string& name) const {
  const fs::file_status status = fs::symlink_status(folder_ / name);
  if (!fs::exists(status) || fs::is_directory(status)) return;
  throw std::runtime_error(fmt::format(
      "'{}' is {}; give another -o", (folder_ / name).string(),
      fs::is_symlink(status) ? "a link, and links are not followed out of a folder of results" : "not a folder"));
}

void OwnedFiles::require_frames(bool quick) const {
  require_folder("frames");
  std::error_code error;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / "frames", error))
    if (frame_number(entry.path()) >= 0) names.push_back("frames/" + entry.path().filename().string());
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) require(name, quick);
}

void OwnedFiles::adopt(const std::string& name) {
  const int file = ::open((folder_ / name).c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return;
  struct stat status {};
  Mark mark;
  const bool read = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && measure(file, mark.checksum, mark.bytes);
  ::close(file);
  std::vector<Mark>& marks = list_[name];
  if (!read || std::find(marks.begin(), marks.end(), mark) != marks.end()) return;
  unwritten_ += line_of(name, mark);
  marks.push_back(mark);
}

int OwnedFiles::open_list(bool exclusive) const {
  const fs::path path = folder_ / list_name;
  for (;;) {
    const int file = ::open(path.c_str(), O_CREAT | O_RDWR | O_APPEND | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0) fail(path, errno);
    struct flock whole {};
    whole.l_type = exclusive ? F_WRLCK : F_RDLCK;
    whole.l_whence = SEEK_SET;
    int error = 0;
    do error = ::fcntl(file, exclusive ? F_OFD_SETLK : F_OFD_SETLKW, &whole) == 0 ? 0 : errno;
    while (error == EINTR);
    if (exclusive && error != 0) {
      ::close(file);
      return -1;
    }
    // It may have been written anew between our open and our lock.
    struct stat ours {
    }, named{};
    if (::fstat(file, &ours) == 0 && ::stat(path.c_str(), &named) == 0 && ours.st_ino == named.st_ino) {
      try {
        require_list(file, path);
      } catch (...) {
        ::close(file);
        throw;
      }
      return file;
    }
    ::close(file);
  }
}

void OwnedFiles::close_list() {
  if (adding_ >= 0) ::close(std::exchange(adding_, -1));
}

std::string OwnedFiles::line_of(const std::string& name, Mark mark) {
  return fmt::format("{:08x} {} {}\n", mark.checksum, mark.bytes, written(name));
}

void OwnedFiles::write_lines(const std::string& lines) {
  if (adding_ < 0) adding_ = open_list(false);
  const std::string text = std::exchange(unwritten_, {}) + lines;
  if (text.empty()) return;
  struct stat status {};
  char last = '\n';  // of a line that a kill cut short, something else
  if (::fstat(adding_, &status) == 0 && status.st_size > 0 && ::pread(adding_, &last, 1, status.st_size - 1) != 1)
    last = '\n';
  const std::string all = fmt::format("{}{}{}", status.st_size == 0 ? heading : "", last == '\n' ? "" : "\n", text);
  // In one piece, so that those of several processes do not mix.
  if (const ssize_t done = ::write(adding_, all.data(), all.size()); done != static_cast<ssize_t>(all.size())) {
    const int reason = done < 0 ? errno : ENOSPC;
    close_list();
    fail(folder_ / list_name, reason);
  }
  ::fdatasync(adding_);
}

void OwnedFiles::add(const std::string& name, Mark mark) {
  std::vector<Mark>& marks = list_[name];
  const bool known = std::find(marks.begin(), marks.end(), mark) != marks.end();
  write_lines(known ? "" : line_of(name, mark));
  if (!known) marks.push_back(mark);
}

sim::Draft OwnedFiles::prepare(const std::string& name, std::string_view bytes) {
  require(name);
  if (!list_.contains(name))
    adopt(name);  // what says that it is ours without a line would be a stranger beside the new one
  try {
    sim::Draft draft(folder_ / name);
    draft.write(bytes);
    add(name, {crc_of(bytes), bytes.size()});
    return draft;
  } catch (const std::system_error& error) {
    fail(folder_ / name, error.code().value());
  }
}

void OwnedFiles::list(const std::string& name, const sim::Draft& draft) {
  require(name);
  Mark mark;
  if (!measure(draft.descriptor(), mark.checksum, mark.bytes)) fail(folder_ / name, errno);
  add(name, mark);
}

void OwnedFiles::publish(sim::Draft& draft, const std::string& name) {
  try {
    draft.publish(folder_ / name);
  } catch (const std::system_error& error) {
    fail(folder_ / name, error.code().value());
  }
  close_list();
}

void OwnedFiles::write(const std::string& name, std::string_view bytes) {
  sim::Draft draft = prepare(name, bytes);
  publish(draft, name);
}

void OwnedFiles::remove(const std::string& name) {
  if (foreign(name)) return;
  if (::unlink((folder_ / name).c_str()) != 0 && errno != ENOENT)
    throw std::runtime_error(fmt::format("cannot replace '{}': {}", (folder_ / name).string(), std::strerror(errno)));
}

void OwnedFiles::remove_frames(std::int64_t first) {
  std::error_code error;
  if (fs::is_symlink(folder_ / "frames")) return;
  for (const auto& entry : fs::directory_iterator(folder_ / "frames", error))
    if (frame_number(entry.path()) >= first) remove("frames/" + entry.path().filename().string());
}

void OwnedFiles::clean() const {
  sim::remove_dead_drafts(folder_);
  if (!fs::is_symlink(folder_ / "frames")) sim::remove_dead_drafts(folder_ / "frames");
}

void OwnedFiles::settle() {
  if (!unwritten_.empty()) write_lines("");
  close_list();
  struct stat status {};
  if (::lstat((folder_ / list_name).c_str(), &status) != 0) return;
  const int file = open_list(true);
  if (file < 0) return;  // the other one will
  try {
    const List before = read(file);
    std::string text(heading);
    list_.clear();
    for (const auto& entry : before) {
      const std::string& name = entry.first;
      const std::vector<Mark>& marks = entry.second;
      if (::lstat((folder_ / name).c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
      std::vector<Mark> fitting;
      for (const Mark& mark : marks)
        if (mark.bytes == static_cast<std::uint64_t>(status.st_size)) fitting.push_back(mark);
      if (fitting.size() > 1) std::erase_if(fitting, [&](const Mark& mark) { return !has_mark(name, {mark}); });
      // One that was changed keeps its line, so that it is known as changed.
      if (fitting.empty()) fitting = {marks.back()};
      list_[name] = fitting;
      for (const Mark& mark : fitting) text += line_of(name, mark);
    }
    if (text != read_all(file)) {
      sim::Draft draft(folder_ / list_name);
      draft.write(text);
      draft.publish(folder_ / list_name);
    }
  } catch (const std::system_error& error) {
    ::close(file);
    fail(folder_ / list_name, error.code().value());
  }
  ::close(file);
}

std::int64_t frame_number(const fs::path& path) {
  const std::string stem = path.stem().string();
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  const bool whole = error == std::errc() && end == stem.data() + stem.size() && stem.size() >= 6 && stem.size() < 12;
  return whole && path.extension() == ".png" && number >= 0 ? number : -1;
}

std::string frame_name(std::size_t number) { return fmt::format("frames/{:06}.png", number); }

}  // namespace app
