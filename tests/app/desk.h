// A folder with a small scene in it, and the program as a user meets it there.
#pragma once

#include "tests/support/program.h"

#include <set>

namespace commands {

inline const std::string scene = R"(title = "small"
[flow]
kind = "shear"
[time]
end = 0.5
step = 0.1
[[vesicle]]
shape = "prolate"
reduced_volume = 0.9
order = 6
[view]
size = [64, 48]
supersampling = 1
)";

/// A folder with s.toml in it.
struct Desk : support::TemporaryFolder {
  explicit Desk(const std::string& text = scene) { support::write_file(file("s.toml"), text); }
  std::string file(const std::string& name) const { return (path() / name).string(); }
  support::Outcome operator()(const std::vector<std::string>& words) const {
    std::vector<std::string> all{TANKTREAD_PROGRAM};
    all.insert(all.end(), words.begin(), words.end());
    return support::run(*this, all);
  }
  /// Names in the folder, but for those of the test itself.
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(path())) all.insert(entry.path().filename().string());
    for (const char* own : {"s.toml", "out.txt", "err.txt"}) all.erase(own);
    return all;
  }
};

}  // namespace commands
