#include "app/pictures/workers.h"

#include "app/base/child.h"
#include "app/base/interrupt.h"
#include "app/base/progress.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

extern char** environ;

namespace app {

namespace {

std::vector<std::string> words_of(const Options& options, const std::filesystem::path& folder, int shard) {
  std::vector<std::string> words{"tanktread", "render"};
  words.insert(words.end(),
               {"-q", "-o", folder.string(), "--shard", fmt::format("{}/{}", shard, options.jobs), "--gl", options.gl});
  for (const std::string& change : options.set) words.insert(words.end(), {"--set", change});
  if (!options.shader_dir.empty()) words.insert(words.end(), {"--shader-dir", options.shader_dir.string()});
  words.emplace_back("--");  // a name may begin with a dash
  for (const std::filesystem::path& input : options.inputs) words.push_back(input.string());
  return words;
}

/// A frame takes its place as a new file, which has another number on the disk than the one it replaces.
using FrameFile = std::pair<std::string, ino_t>;
std::set<FrameFile> frame_files(const std::filesystem::path& frames) {
  std::set<FrameFile> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(frames, error)) {
    struct stat status {};
    const std::string name = entry.path().filename().string();
    if (!name.starts_with('.') && name.ends_with(".png") && ::stat(entry.path().c_str(), &status) == 0)
      files.emplace(name, status.st_ino);
  }
  return files;
}

}  // namespace

std::optional<std::int64_t> draw_in_processes(const Options& options, const std::filesystem::path& folder) {
  const std::set<FrameFile> before = frame_files(folder / "frames");
  std::vector<std::string> environment;
  for (char** entry = environ; *entry; ++entry)
    if (!std::string_view(*entry).starts_with("LP_NUM_THREADS=")) environment.emplace_back(*entry);
  environment.emplace_back("LP_NUM_THREADS=0");  // each draws in its own thread
  Children children;
  for (int shard = 0; shard < options.jobs; ++shard) try {
      children.add(start_child({.file = "/proc/self/exe",
                                .words = words_of(options, folder, shard),
                                .environment = environment,
                                .input = -1,
                                .takes_ctrl_c = true,
                                .last_signal = SIGTERM}));
    } catch (const std::system_error& error) {
      throw std::runtime_error(fmt::format("cannot start a process to draw frames: {}", error.code().message()));
    }
  Progress progress("rendering", options.quiet);
  bool failed = false;
  while (children.running() > 0) {
    if (interrupted()) children.stop();
    failed = !children.collect() || failed;
    progress.show(1 - static_cast<double>(children.running()) / options.jobs,
                  fmt::format("{} processes", options.jobs));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (interrupted()) return {};
  if (failed)
    throw std::runtime_error(fmt::format("not all frames could be drawn; those that are complete are kept in '{}'",
                                         (folder / "frames").string()));
  std::int64_t drawn = 0;
  for (const FrameFile& file : frame_files(folder / "frames")) drawn += !before.contains(file);
  return drawn;
}

}  // namespace app
