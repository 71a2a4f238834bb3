// The files that this program made in a folder: the only ones it may replace or remove there.
//
// They are listed in FOLDER/.tanktread.files, one line per file: crc32, bytes, name. A line is added before the file
// takes its name, so that a kill in between leaves no unlisted file; a name may therefore be listed more than once,
// or without a file. A file is ours when its bytes match one of the lines with its name; a file edited since belongs
// to the user.
#pragma once

#include "sim/core/result_file.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace app {

class OwnedFiles {
 public:
  /// Reads the list, and changes nothing. Names are relative to the folder, "frames/000000.png".
  explicit OwnedFiles(std::filesystem::path folder);
  OwnedFiles(OwnedFiles&&) noexcept;
  OwnedFiles& operator=(OwnedFiles&&) = delete;
  ~OwnedFiles();

  const std::filesystem::path& folder() const { return folder_; }
  /// There was no list: a folder of an earlier version, or not made by this program.
  bool unlisted() const { return unlisted_; }

  /// Whether something of this name exists that is not ours. Links never are. An unlisted file is ours if it says so
  /// itself: a picture with our mark. `quick` compares only sizes.
  bool foreign(const std::string& name, bool quick = false) const;
  /// Throws a sentence if foreign().
  void require(const std::string& name, bool quick = false) const;
  /// For a subfolder to write into: it must not exist or be a folder, not a link to one.
  void require_folder(const std::string& name) const;
  /// require() for every file with the name of a frame.
  void require_frames(bool quick) const;

  bool listed(const std::string& name) const { return list_.contains(name); }
  /// Declares an existing unlisted file to be ours. Its line is written with the next one, or by settle().
  void adopt(const std::string& name);

  /// A new file, complete and listed, to be renamed by publish(). Throws a sentence when the name is taken by a
  /// foreign file.
  sim::Draft prepare(const std::string& name, std::string_view bytes);
  /// The same for a draft written by the caller.
  void list(const std::string& name, const sim::Draft&);
  void publish(sim::Draft&, const std::string& name);
  void write(const std::string& name, std::string_view bytes);

  /// Removes a file if it is ours.
  void remove(const std::string& name);
  /// Removes frames from number `first` on, if they are ours.
  void remove_frames(std::int64_t first);

  /// Removes drafts left by killed processes in the folder and its frames.
  void clean() const;
  /// Rewrites the list: existing files, sorted; not while another process is adding to it.
  void settle();

 private:
  struct Mark {
    std::uint32_t checksum = 0;
    std::uint64_t bytes = 0;
    auto operator<=>(const Mark&) const = default;
  };
  using List = std::map<std::string, std::vector<Mark>>;
  static List read(int file);
  /// The list, opened and locked: shared between processes that add, each until its file has its name. -1: another
  /// process holds it.
  int open_list(bool exclusive) const;
  void close_list();
  static std::string line_of(const std::string& name, Mark);
  void write_lines(const std::string& lines);
  void add(const std::string& name, Mark);
  bool has_mark(const std::string& name, const std::vector<Mark>&) const;

  std::filesystem::path folder_;
  List list_;
  std::string unwritten_;  ///< lines of adopted files
  bool unlisted_ = true;
  int adding_ = -1;
};

/// Number of a frame by its name, "000012.png"; -1: not the name of a frame.
std::int64_t frame_number(const std::filesystem::path&);
std::string frame_name(std::size_t number);  ///< "frames/000012.png"

}  // namespace app
