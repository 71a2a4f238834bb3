// The files that this program made in a folder, and nothing else: what it may replace and remove there.
//
// They stand in FOLDER/.tanktread.files, a line a file: crc32, bytes, name. A line is added before the file takes its name, so
// that a kill in between leaves no file that nobody knows; a name may therefore stand there more than once, or without a file.
// A file is ours when one of the lines of its name has its very bytes. Whoever changed it since made it his own.
#pragma once

#include "sim/result_file.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace app {

std::uint32_t checksum(std::string_view bytes);

class OwnedFiles {
 public:
  /// Reads the list, and changes nothing. Names are relative to the folder, "frames/000000.png".
  explicit OwnedFiles(std::filesystem::path folder);
  OwnedFiles(OwnedFiles&&) noexcept;
  OwnedFiles& operator=(OwnedFiles&&) = delete;
  ~OwnedFiles();

  const std::filesystem::path& folder() const { return folder_; }
  /// There was no list: a folder of an earlier version, or of somebody else.
  bool unlisted() const { return unlisted_; }

  /// Is there something of this name that is not ours? Links are somebody else's. A name that no line names is ours where the
  /// file itself says so: a picture with a mark in it. `quick` looks at sizes only.
  bool foreign(const std::string& name, bool quick = false) const;
  /// Throws a sentence when one is.
  void require(const std::string& name, bool quick = false) const;
  /// Of a subfolder that we write into: it must be none or a folder, not a link to one.
  void require_folder(const std::string& name) const;
  /// Every file with the name of a frame.
  void require_frames(bool quick) const;

  bool listed(const std::string& name) const { return list_.contains(name); }
  /// Takes a file that is there for ours, though no line names it. The line is written with the next one, or by settle().
  void adopt(const std::string& name);

  /// A new file, complete and on the list, that waits for publish() to get its name. Throws a sentence where something foreign
  /// has it.
  sim::Draft prepare(const std::string& name, std::string_view bytes);
  /// The same of a draft that somebody else has filled.
  void list(const std::string& name, const sim::Draft&);
  void publish(sim::Draft&, const std::string& name);
  void write(const std::string& name, std::string_view bytes);

  /// If it is ours.
  void remove(const std::string& name);
  /// Frames from number `first` on, as far as they are ours.
  void remove_frames(std::int64_t first);

  /// Removes what killed processes left half-written in the folder and its frames.
  void clean() const;
  /// Writes the list anew: what is there, sorted; not while another process is adding to it.
  void settle();

 private:
  struct Mark {
    std::uint32_t checksum = 0;
    std::uint64_t bytes = 0;
    auto operator<=>(const Mark&) const = default;
  };
  using List = std::map<std::string, std::vector<Mark>>;
  static List read(int file);
  /// The list, opened and locked: shared by those who add, who hold it until their file has its name. -1: another has it.
  int open_list(bool exclusive) const;
  void close_list();
  static std::string line_of(const std::string& name, Mark);
  void write_lines(const std::string& lines);
  void add(const std::string& name, Mark);
  bool has_mark(const std::string& name, const std::vector<Mark>&) const;

  std::filesystem::path folder_;
  List list_;
  std::string unwritten_;  ///< lines of what was adopted
  bool unlisted_ = true;
  int adding_ = -1;
};

/// Number of a frame by its name, "000012.png"; -1: the name of something else.
std::int64_t frame_number(const std::filesystem::path&);
std::string frame_name(std::size_t number);  ///< "frames/000012.png"

/// One result with a name of its own, such as a table: `write` puts it there. What is there already must be ours, or else empty
/// or given up by `force`; never a file of `inputs`, by whatever name, nor a trajectory. Links are written through, pipes and
/// devices are written to as they are, "-" is standard output.
class ResultFiles {
 public:
  ResultFiles(const std::vector<std::filesystem::path>& inputs, bool force) : inputs_(inputs), force_(force) {}
  /// The refusal alone, before any work is done.
  void require(const std::filesystem::path&);
  void require_inside(const std::filesystem::path&);
  void write(const std::filesystem::path&, std::string_view bytes);
  sim::FileWriter writer();
  /// Of files in a folder that was given: links in it are refused, since they would lead out of it.
  sim::FileWriter writer_inside();
  /// After the last one.
  void settle();

 private:
  OwnedFiles& owned(const std::filesystem::path& target);

  std::vector<std::filesystem::path> inputs_;
  bool force_;
  std::map<std::filesystem::path, OwnedFiles> folders_;
};

}  // namespace app
