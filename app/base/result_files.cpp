#include "app/base/result_files.h"

#include "sim/trajectory/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <system_error>

namespace app {

namespace fs = std::filesystem;

OwnedFiles& ResultFiles::owned(const fs::path& target) {
  const fs::path folder = target.parent_path();
  return folders_.try_emplace(folder, folder).first->second;
}

void ResultFiles::require(const fs::path& path) {
  if (path == "-") return;
  const fs::path target = sim::destination(path);
  std::error_code error;
  if (!fs::exists(target, error)) return;
  for (const fs::path& input : inputs_)
    if (fs::equivalent(input, target, error))
      throw std::runtime_error(
          fmt::format("'{}' is read by this command, which cannot replace it; give another name", path.string()));
  if (fs::is_directory(target))
    throw std::runtime_error(fmt::format("'{}' is a folder; give the name of a file", path.string()));
  if (!fs::is_regular_file(target)) return;  // a pipe, a device: nothing is replaced
  if (sim::holds_trajectory(target))
    throw std::runtime_error(
        fmt::format("'{}' is a trajectory, which nothing else replaces; give another name", path.string()));
  if (!force_ && owned(target).foreign(target.filename().string()))
    throw std::runtime_error(
        fmt::format("'{}' exists and was not made by this program, or was changed since; give another name, "
                    "or --force to replace it",
                    path.string()));
}

void ResultFiles::require_inside(const fs::path& path) {
  if (fs::is_symlink(path))
    throw std::runtime_error(
        fmt::format("'{}' is a link, and links are not followed out of a folder of results", path.string()));
  require(path);
}

void ResultFiles::write(const fs::path& path, std::string_view bytes) {
  require(path);
  const fs::path target = path == "-" ? path : sim::destination(path);
  std::error_code error;
  if (path == "-") {
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
      throw std::system_error(errno, std::generic_category(), "cannot write to standard output");
  } else if (fs::exists(target, error) && !fs::is_regular_file(target, error)) {
    sim::write_file(target, bytes);
  } else {
    OwnedFiles& files = owned(target);
    const std::string name = target.filename().string();
    if (force_) files.adopt(name);
    files.write(name, bytes);
  }
}

sim::FileWriter ResultFiles::writer() {
  return [this](const fs::path& path, std::string_view bytes) { write(path, bytes); };
}

sim::FileWriter ResultFiles::writer_inside() {
  return [this](const fs::path& path, std::string_view bytes) {
    require_inside(path);
    write(path, bytes);
  };
}

void ResultFiles::settle() {
  for (auto& [folder, files] : folders_) files.settle();
}

}  // namespace app
