// Single results with a name given by the user, such as a table. They belong to the list of their folder like all
// others (owned_files.h).
#pragma once

#include "app/base/owned_files.h"

#include <map>

namespace app {

/// An existing file must be ours, empty, or released
/// by `force`; never one of `inputs` under any name, nor a trajectory. Links are followed, pipes and devices are
/// written to directly, "-" is standard output.
class ResultFiles {
 public:
  ResultFiles(const std::vector<std::filesystem::path>& inputs, bool force) : inputs_(inputs), force_(force) {}
  /// Only the check, before any work is done.
  void require(const std::filesystem::path&);
  void require_inside(const std::filesystem::path&);
  void write(const std::filesystem::path&, std::string_view bytes);
  sim::FileWriter writer();
  /// For files in a given folder: links in it are refused, since they would lead out of it.
  sim::FileWriter writer_inside();
  /// Call it after the last one.
  void settle();

 private:
  OwnedFiles& owned(const std::filesystem::path& target);

  std::vector<std::filesystem::path> inputs_;
  bool force_;
  std::map<std::filesystem::path, OwnedFiles> folders_;
};

}  // namespace app
