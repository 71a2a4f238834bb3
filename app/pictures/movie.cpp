#include "app/pictures/movie.h"

#include "app/base/child.h"
#include "app/base/printable.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

namespace app {

namespace {

/// One thread and no dates: the same frames give the same file.
std::vector<std::string> arguments(const MovieFormat& format, const std::filesystem::path& draft, int width, int height,
                                   double frame_rate, bool transparent) {
  std::vector<std::string> words{"ffmpeg",     "-hide_banner",
                                 "-loglevel",  "error",
                                 "-nostdin",   "-y",
                                 "-f",         "rawvideo",
                                 "-pix_fmt",   transparent ? "rgba" : "rgb24",
                                 "-s",         fmt::format("{}x{}", width, height),
                                 "-framerate", fmt::format("{}", frame_rate),
                                 "-i",         "pipe:0",
                                 "-an"};
  const std::vector<std::string>& encoder = transparent ? format.transparent_encoder : format.encoder;
  words.insert(words.end(), encoder.begin(), encoder.end());
  if (frame_rate > format.fastest) words.insert(words.end(), {"-r", fmt::format("{}", format.fastest)});
  words.insert(words.end(), {"-threads", "1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1",
                             "-f", std::string(format.muxer), draft.string()});
  return words;
}

sim::Draft draft_in(const std::filesystem::path& folder) {
  try {
    return sim::Draft(folder / "movie");
  } catch (const std::system_error& error) {
    throw std::runtime_error(fmt::format("no movie can be made in '{}': {}", folder.string(), error.code().message()));
  }
}

}  // namespace

MovieEncoder::MovieEncoder(const MovieFormat& format, OwnedFiles& folder, int width, int height, double frame_rate,
                           bool transparent)
    : folder_(folder),
      name_(movie_name(format)),
      draft_(draft_in(folder.folder())),
      width_(width),
      height_(height),
      channels_(transparent ? 4 : 3) {
  int frames[2];  // its input
  if (pipe2(frames, O_CLOEXEC) != 0)
    throw std::runtime_error(fmt::format("no pipe to ffmpeg: {}", std::strerror(errno)));
  said_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);  // -1: it speaks for itself
  int reason = 0;
  try {
    // An ffmpeg without its parent would go on with a movie that nobody waits for. Ctrl-C is for us: we end the movie
    // in order.
    child_ = start_child(
        {.file = "ffmpeg",
         .words = arguments(format, std::filesystem::absolute(draft_.path()), width, height, frame_rate, transparent),
         .environment = {},
         .input = frames[0],
         .errors = said_,
         .takes_ctrl_c = false,
         .last_signal = SIGKILL});
  } catch (const std::system_error& error) {
    reason = error.code().value();
  }
  ::close(frames[0]);
  pipe_ = frames[1];
  if (reason == 0) return;
  ::close(std::exchange(pipe_, -1));
  if (reason == ENOENT)
    throw FfmpegMissing("ffmpeg is not installed, so there is no movie (Debian: apt-get install ffmpeg)");
  throw std::runtime_error(fmt::format("ffmpeg cannot be started: {}", std::strerror(reason)));
}

MovieEncoder::~MovieEncoder() {
  // At the end of its input it would try to finish the movie, and complain where the disk is full.
  if (child_ >= 0) ::kill(child_, SIGKILL);
  if (pipe_ >= 0) ::close(pipe_);
  if (child_ >= 0) wait_for_child(child_);
  if (said_ >= 0) ::close(said_);
}

std::string MovieEncoder::complaint() const {
  std::array<char, 1000> text{};
  const ssize_t size = said_ < 0 ? 0 : ::pread(said_, text.data(), text.size(), 0);
  const std::string_view all(text.data(), size < 0 ? 0 : static_cast<std::size_t>(size));
  const std::string_view line = all.substr(0, all.find('\n'));
  return line.empty() ? std::string() : fmt::format(" ({})", printable(line));
}

void MovieEncoder::add(const render::Image& image) {
  if (image.width != width_ || image.height != height_ || image.channels != channels_)
    throw std::runtime_error(
        fmt::format("a frame of the movie is {} x {}, not {} x {}", image.width, image.height, width_, height_));
  const std::uint8_t* from = image.pixels.data();
  for (std::size_t left = image.pixels.size(); left > 0;) {
    const ssize_t done = ::write(pipe_, from, left);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) throw std::runtime_error(fmt::format("ffmpeg stopped before the movie was complete{}", complaint()));
    from += done;
    left -= static_cast<std::size_t>(done);
  }
}

void MovieEncoder::finish() {
  ::close(std::exchange(pipe_, -1));
  const int status = wait_for_child(std::exchange(child_, -1));
  const bool good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (good && std::filesystem::file_size(draft_.path()) == 0)
    throw std::runtime_error(fmt::format("ffmpeg left no movie '{}'", (folder_.folder() / name_).string()));
  if (!good)
    throw std::runtime_error(fmt::format(
        "ffmpeg failed with {} {}{}; '{}' was not written", WIFEXITED(status) ? "exit status" : "signal",
        WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status), complaint(), (folder_.folder() / name_).string()));
  folder_.list(name_, draft_);
  folder_.publish(draft_, name_);
}

}  // namespace app
