// Input files named by the user: only regular files are read. A named pipe may block its reader forever, and a device
// has no end.
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <istream>
#include <string>
#include <string_view>

namespace sim {

/// The open file, or one that is not open; `why` is then "it is not a file" or the system's message.
inline std::ifstream open_input(const std::filesystem::path& path, std::string& why) {
  std::error_code error;
  if (const auto status = std::filesystem::status(path, error); exists(status) && !is_regular_file(status)) {
    why = "it is not a file";
    std::ifstream none;
    none.setstate(std::ios::failbit);
    return none;
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) why = std::strerror(errno);
  return in;
}

/// Some editors start UTF-8 text with a byte order mark, which is not part of the text.
inline void skip_byte_order_mark(std::istream& in) {
  char start[3]{};
  if (in.read(start, 3) && std::string_view(start, 3) == "\xef\xbb\xbf") return;
  in.clear();
  in.seekg(0);
}

}  // namespace sim
