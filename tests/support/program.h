// Runs the program as a user would and tells what it said.
#pragma once

#include "temporary_folder.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <vector>

extern char** environ;

namespace support {

struct Outcome {
  int status = -1;  ///< exit status, or -signal
  std::string out, err;
};

/// Starts a program with its output in folder/out.txt and folder/err.txt.
inline pid_t start(const TemporaryFolder& folder, std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string out = (folder / "out.txt").string(), err = (folder / "err.txt").string();
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = -1;
  const int error = posix_spawnp(&child, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::runtime_error("cannot start " + words[0]);
  return child;
}

inline Outcome finish(const TemporaryFolder& folder, pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read_file(folder / "out.txt"),
          read_file(folder / "err.txt")};
}

/// Until the file is there, at most 10 s: a program that died makes none.
inline bool wait_for(const std::filesystem::path& file) {
  for (int k = 0; k < 1000 && !std::filesystem::exists(file); ++k) usleep(10000);
  return std::filesystem::exists(file);
}

inline Outcome run(const TemporaryFolder& folder, std::vector<std::string> words) {
  return finish(folder, start(folder, std::move(words)));
}

}  // namespace support
