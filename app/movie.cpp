#include "movie.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>
#include <vector>

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

/// Of runs that were killed.
void remove_drafts(const std::filesystem::path& path) {
  const std::string start = path.filename().string() + ".";
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(path.has_parent_path() ? path.parent_path() : ".", error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(start) && name.ends_with(".tmp")) std::filesystem::remove(entry.path(), error);
  }
}

/// In the child, between fork and exec: nothing but system calls. An ffmpeg without its parent would go on with a movie that
/// nobody waits for, so it dies with it.
[[noreturn]] void become_ffmpeg(char* const* argv, int input, int trouble, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  ::setpgid(0, 0);  // Ctrl-C is for us: we end the movie in order
  for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ}) std::signal(number, SIG_DFL);
  ::dup2(input, STDIN_FILENO);
  ::execvp(argv[0], argv);
  const int reason = errno;
  [[maybe_unused]] const ssize_t told = ::write(trouble, &reason, sizeof reason);
  ::_exit(127);
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  return status;
}

}  // namespace

MovieEncoder::MovieEncoder(const MovieFormat& format, const std::filesystem::path& path, int width, int height,
                           double frame_rate)
    : path_(path), draft_(fmt::format("{}.{}.tmp", path.string(), ::getpid())), width_(width), height_(height) {
  remove_drafts(path);
  int frames[2], trouble[2];  // its input, and a line that closes when ffmpeg has been started
  if (pipe2(frames, O_CLOEXEC) != 0) throw std::runtime_error(fmt::format("no pipe to ffmpeg: {}", std::strerror(errno)));
  if (pipe2(trouble, O_CLOEXEC) != 0) {
    const int reason = errno;
    for (const int end : frames) ::close(end);
    throw std::runtime_error(fmt::format("no pipe to ffmpeg: {}", std::strerror(reason)));
  }
  std::vector<std::string> words = arguments(format, std::filesystem::absolute(draft_), width, height, frame_rate);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t parent = ::getpid();
  child_ = ::fork();
  if (child_ == 0) become_ffmpeg(argv.data(), frames[0], trouble[1], parent);
  const int reason = errno;
  ::close(frames[0]);
  ::close(trouble[1]);
  pipe_ = frames[1];
  int error = child_ < 0 ? reason : 0;
  if (child_ > 0 && ::read(trouble[0], &error, sizeof error) > 0) wait_for(std::exchange(child_, -1));
  ::close(trouble[0]);
  if (error == 0) return;
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
    throw std::runtime_error(fmt::format("ffmpeg left no movie '{}': {}", path_.string(), error.message()));
  }
  std::filesystem::remove(draft_, error);
  throw std::runtime_error(fmt::format("ffmpeg failed with {} {}; '{}' was not written",
                                       WIFEXITED(status) ? "exit status" : "signal",
                                       WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status), path_.string()));
}

}  // namespace app
