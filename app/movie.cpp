#include "movie.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>
#include <vector>

extern char** environ;

namespace app {

namespace {

/// One thread and no dates: the same frames give the same file.
std::vector<std::string> arguments(const MovieFormat& format, const std::filesystem::path& draft, int width, int height,
                                   double frame_rate) {
  std::vector<std::string> words{"ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y",
                                 "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", fmt::format("{}x{}", width, height),
                                 "-framerate", fmt::format("{}", frame_rate), "-i", "pipe:0", "-an"};
  words.insert(words.end(), format.encoder.begin(), format.encoder.end());
  if (frame_rate > format.fastest) words.insert(words.end(), {"-r", fmt::format("{}", format.fastest)});
  words.insert(words.end(), {"-threads", "1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1", "-f",
                             std::string(format.muxer), draft.string()});
  return words;
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  return status;
}

}  // namespace

MovieEncoder::MovieEncoder(const MovieFormat& format, const std::filesystem::path& path, int width, int height,
                           double frame_rate)
    : path_(path), draft_(path.string() + ".tmp"), width_(width), height_(height) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error(fmt::format("no pipe to ffmpeg: {}", std::strerror(errno)));
  std::vector<std::string> words = arguments(format, std::filesystem::absolute(draft_), width, height, frame_rate);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);  // Ctrl-C is for us: we end the movie in order
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  const int error = posix_spawnp(&child_, "ffmpeg", &files, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  ::close(ends[0]);
  pipe_ = ends[1];
  if (error == 0) return;
  child_ = -1;
  ::close(std::exchange(pipe_, -1));
  if (error == ENOENT)
    throw FfmpegMissing("ffmpeg is not installed, so there is no movie (Debian: apt-get install ffmpeg)");
  throw std::runtime_error(fmt::format("ffmpeg cannot be started: {}", std::strerror(error)));
}

MovieEncoder::~MovieEncoder() {
  if (pipe_ >= 0) ::close(pipe_);
  if (child_ < 0) return;
  ::kill(child_, SIGKILL);
  wait_for(child_);
  std::error_code ignored;
  std::filesystem::remove(draft_, ignored);
}

void MovieEncoder::add(const render::Image& image) {
  if (image.width != width_ || image.height != height_ || image.channels != 3)
    throw std::runtime_error(fmt::format("a frame of the movie is {} x {}, not {} x {}", image.width, image.height, width_,
                                         height_));
  const std::uint8_t* from = image.pixels.data();
  for (std::size_t left = image.pixels.size(); left > 0;) {
    const ssize_t done = ::write(pipe_, from, left);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) throw std::runtime_error("ffmpeg stopped before the movie was complete");
    from += done;
    left -= static_cast<std::size_t>(done);
  }
}

void MovieEncoder::finish() {
  ::close(std::exchange(pipe_, -1));
  const int status = wait_for(std::exchange(child_, -1));
  std::error_code error;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    std::filesystem::rename(draft_, path_, error);
    if (!error) return;
    throw std::runtime_error(fmt::format("cannot write '{}': {}", path_.string(), error.message()));
  }
  std::filesystem::remove(draft_, error);
  throw std::runtime_error(fmt::format("ffmpeg failed with {} {}; '{}' was not written",
                                       WIFEXITED(status) ? "exit status" : "signal",
                                       WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status), path_.string()));
}

}  // namespace app
