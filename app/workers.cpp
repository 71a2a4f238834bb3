#include "workers.h"

#include "interrupt.h"
#include "progress.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

extern char** environ;

namespace app {

namespace {

std::vector<std::string> words_of(const Options& options, const std::filesystem::path& folder, int shard) {
  std::vector<std::string> words{"tanktread", "render"};
  for (const std::filesystem::path& input : options.inputs) words.push_back(input.string());
  words.insert(words.end(), {"-q", "-o", folder.string(), "--shard", fmt::format("{}/{}", shard, options.jobs), "--gl",
                             options.gl});
  for (const std::string& change : options.set) words.insert(words.end(), {"--set", change});
  if (!options.shader_dir.empty()) words.insert(words.end(), {"--shader-dir", options.shader_dir.string()});
  return words;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> all;
  for (std::string& word : words) all.push_back(word.data());
  all.push_back(nullptr);
  return all;
}

}  // namespace

bool draw_in_processes(const Options& options, const std::filesystem::path& folder) {
  std::vector<std::string> environment;
  for (char** entry = environ; *entry; ++entry)
    if (!std::string_view(*entry).starts_with("LP_NUM_THREADS=")) environment.emplace_back(*entry);
  environment.emplace_back("LP_NUM_THREADS=0");  // each draws in its own thread
  std::vector<char*> variables = pointers(environment);
  std::vector<pid_t> children;
  for (int shard = 0; shard < options.jobs; ++shard) {
    std::vector<std::string> words = words_of(options, folder, shard);
    std::vector<char*> arguments = pointers(words);
    pid_t child = -1;
    if (const int error = posix_spawn(&child, "/proc/self/exe", nullptr, nullptr, arguments.data(), variables.data()))
      throw std::runtime_error(fmt::format("cannot start a process to draw frames: {}", std::strerror(error)));
    children.push_back(child);
  }
  Progress progress("rendering", options.quiet);
  bool failed = false;
  for (std::size_t left = children.size(); left > 0;) {
    for (pid_t& child : children) {
      int status = 0;
      if (child < 0 || waitpid(child, &status, WNOHANG) != child) continue;
      child = -1;
      --left;
      failed = failed || !WIFEXITED(status) || WEXITSTATUS(status) != 0;
    }
    progress.show(1 - static_cast<double>(left) / static_cast<double>(children.size()),
                  fmt::format("{} processes", children.size()));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (interrupted()) return false;
  if (failed) throw std::runtime_error(fmt::format("not all frames could be drawn; those that are complete are kept in '{}'",
                                                   (folder / "frames").string()));
  return true;
}

}  // namespace app
