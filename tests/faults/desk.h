// A folder with a small scene in it, and the program run there.
#pragma once

#include "tests/support/program.h"

#include <algorithm>
#include <map>
#include <set>

namespace faults {

namespace fs = std::filesystem;
using support::Outcome;

/// `end` / 0.1 steps of a vesicle of order 4: a millisecond or two each.
inline std::string scene(const std::string& end, const std::string& more = {}) {
  return "title = \"small\"\n[flow]\nkind = \"shear\"\n[time]\nend = " + end +
         "\nstep = 0.1\n[[vesicle]]\nshape = \"prolate\"\nreduced_volume = 0.9\norder = 4\n"
         "[view]\nsize = [64, 48]\nsupersampling = 1\n" +
         more;
}

struct Desk : support::TemporaryFolder {
  explicit Desk(const std::string& text = scene("0.5")) { support::write_file(path() / "s.toml", text); }
  std::string file(const std::string& name) const { return (path() / name).string(); }
  Outcome operator()(std::vector<std::string> words) const {
    words.insert(words.begin(), TANKTREAD_PROGRAM);
    return support::run(*this, words);
  }
  /// With variables of the environment.
  Outcome with(std::vector<std::string> variables, std::vector<std::string> words) const {
    variables.insert(variables.begin(), "/usr/bin/env");
    variables.push_back(TANKTREAD_PROGRAM);
    variables.insert(variables.end(), words.begin(), words.end());
    return support::run(*this, variables);
  }
  /// A line for the shell; $T is the program.
  Outcome shell(const std::string& line) const {
    return support::run(*this, {"/bin/bash", "-c", "T=" TANKTREAD_PROGRAM "; cd " + path().string() + "; " + line});
  }
  /// What is in a folder, at any depth.
  std::set<std::string> names(const std::string& folder = ".") const {
    std::set<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(path() / folder))
      if (!entry.is_directory()) all.insert(entry.path().lexically_relative(path() / folder).string());
    for (const char* own : {"s.toml", "out.txt", "err.txt"}) all.erase(own);
    return all;
  }
};

/// A preloaded library of this folder. The address sanitizer, where there is one, would rather come first.
inline std::vector<std::string> preload(const std::string& name) {
  return {"LD_PRELOAD=" TANKTREAD_FAULTS "/" + name + ".so", "ASAN_OPTIONS=verify_asan_link_order=0"};
}

inline bool one_sentence(const std::string& err) {
  return err.starts_with("tanktread: ") && std::count(err.begin(), err.end(), '\n') == 1;
}

}  // namespace faults
