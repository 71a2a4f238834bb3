#include "app/pictures/frames.h"

#include "app/base/interrupt.h"
#include "app/base/printable.h"
#include "app/base/progress.h"
#include "app/base/version.h"
#include "app/pictures/movie.h"
#include "app/scene/output.h"

#include "render/core/ground.h"
#include "sim/core/digits.h"

#include <fmt/format.h>

#include <stdlib.h>

#include <cmath>
#include <future>

namespace app {

namespace fs = std::filesystem;

namespace {

constexpr const char* hash_key = "tanktread:hash";

/// Is this file a whole picture of the same frame?
bool is_current(const fs::path& path, const std::string& hash) {
  if (!fs::exists(path)) return false;
  try {
    for (const auto& [key, text] : render::read_png_text(path))
      if (key == hash_key) return text == hash;
  } catch (const std::exception&) {
    // damaged: draw it again
  }
  return false;
}

double end_of(const PictureSource& source) { return source.trajectory.time(source.trajectory.count() - 1); }

const PictureSource& longest(const std::vector<PictureSource>& sources) {
  return *std::max_element(sources.begin(), sources.end(),
                           [](const PictureSource& a, const PictureSource& b) { return end_of(a) < end_of(b); });
}

render::PngText picture_text(const PictureSource& source, const Studio& studio, double time, const std::string& hash) {
  render::PngText text{{"Title", printable(source.settings.scene.title)},
                       {"Software", "tanktread " + version()},
                       {"tanktread:time", fmt::format("{:.12g}", time)},
                       {hash_key, hash}};
  for (const auto& entry : studio.renderer.metadata()) text.push_back(entry);
  return text;
}

std::string hash_of(const Production& production, double time) {
  return fmt::format("{}-{:.17g}", production.hash, time);
}

/// The numbers of the frames that this process draws, and what becomes of them.
struct Task {
  std::size_t number;
  bool current;
};

std::vector<Task> tasks_of(const Production& production, const std::vector<double>& times, OwnedFiles& files,
                           const Options& options) {
  std::vector<Task> tasks;
  for (auto f = static_cast<std::size_t>(options.shard); f < times.size();
       f += static_cast<std::size_t>(options.shards)) {
    files.require(frame_name(f));
    const bool current =
        options.shader_dir.empty() && is_current(files.folder() / frame_name(f), hash_of(production, times[f]));
    if (current && !files.listed(frame_name(f))) files.adopt(frame_name(f));
    tasks.push_back({f, current});
  }
  return tasks;
}

std::string movie_record(const Production& production, std::size_t frames, const render::MovieParameters& settings,
                         const fs::path& movie) {
  return fmt::format("{} frames at {:.17g} a second, {} bytes, {}\n", frames, settings.frame_rate, fs::file_size(movie),
                     production.hash);
}

bool is_current_movie(const OwnedFiles& files, const std::string& movie, const Production& production,
                      std::size_t frames, const render::MovieParameters& settings) {
  const fs::path path = files.folder() / movie, record = files.folder() / record_of_movie(movie);
  return fs::exists(path) && fs::exists(record) &&
         read_whole_file(record) == movie_record(production, frames, settings, path);
}

void remove_movie(OwnedFiles& files, const std::string& movie) {
  files.remove(record_of_movie(movie));
  files.remove(movie);
}

/// A copy of the frame nearest to `wanted`.
fs::path write_poster(OwnedFiles& files, const std::vector<double>& times, double wanted) {
  const auto nearest = std::min_element(
      times.begin(), times.end(), [&](double a, double b) { return std::abs(a - wanted) < std::abs(b - wanted); });
  const std::string frame =
      read_whole_file(files.folder() / frame_name(static_cast<std::size_t>(nearest - times.begin())));
  fs::path poster = files.folder() / poster_name;
  if (!fs::exists(poster) || read_whole_file(poster) != frame)
    files.write(poster_name, frame);
  else if (!files.listed(poster_name))
    files.adopt(poster_name);
  return poster;
}

/// The movie under way; a failure of ffmpeg ends it, not the frames.
struct Film {
  std::optional<MovieEncoder> encoder;
  FrameReport& report;

  template <class Action>
  void attempt(const Action& action) {
    if (!encoder) return;
    try {
      action();
    } catch (const std::exception& failure) {
      report.remark = failure.what();
      report.movie_failed = true;
      encoder.reset();
    }
  }
};

/// What one call of render_frames works on.
struct Job {
  const std::vector<PictureSource>& sources;
  OwnedFiles& files;
  const Options& options;
  const Settings& settings;  ///< of the first source
  const MovieFormat& format;
  std::string movie;  ///< name of its file
  Production production = {};
  std::vector<double> times = {};  ///< of the frames of all shards
  std::vector<Task> tasks = {};    ///< of this shard

  bool whole() const { return options.shards == 1; }
  fs::path frames() const { return files.folder() / "frames"; }
};

/// Throws before anything is changed when a file of the user is in the way.
Job prepare(const std::vector<PictureSource>& sources, OwnedFiles& files, const Options& options,
            const std::optional<PlotStrip>& plots) {
  const Settings& settings = sources.front().settings;
  const MovieFormat& format = find_movie_format(settings.movie.format);
  Job job{.sources = sources,
          .files = files,
          .options = options,
          .settings = settings,
          .format = format,
          .movie = movie_name(format)};
  if (job.whole())
    check_movie(format, settings.view.size[0], settings.view.size[1],
                render::ground_of(settings.view.background).transparent);
  job.production = prepare_pictures(sources, {}, plots);
  job.times = frame_times(longest(sources).trajectory, settings.movie);
  adopt_movie(files, job.movie);
  if (job.whole())
    require_pictures(files, settings);
  else
    files.require_frames(true);
  std::error_code error;
  fs::create_directories(job.frames(), error);
  if (error)
    throw std::runtime_error(fmt::format("cannot make folder '{}': {}", job.frames().string(), error.message()));
  files.clean();
  job.tasks = tasks_of(job.production, job.times, files, options);
  return job;
}

void finish_poster(const Job& job, FrameReport& report) {
  const std::optional<double>& wanted = job.settings.movie.poster;
  if (!job.whole() || !wanted) return;
  if (const double end = end_of(longest(job.sources)); *wanted <= end * (1 + 1e-9)) {
    report.poster = write_poster(job.files, job.times, *wanted);
  } else {  // the simulation ended before it
    job.files.remove(poster_name);
    const auto [time, last] = sim::told_apart(*wanted, end);
    report.poster_remark =
        fmt::format("there is no poster: it is to show t = {}, and the trajectory ends at t = {}", time, last);
  }
}

void remove_other_frames(const Job& job) {
  if (job.whole()) job.files.remove_frames(static_cast<std::int64_t>(job.times.size()));
}

void start(Film& film, const Job& job) {
  try {
    film.encoder.emplace(job.format, job.files, job.production.width, job.production.height,
                         job.settings.movie.frame_rate, render::ground_of(job.settings.view.background).transparent);
    remove_movie(job.files, job.movie);
  } catch (const FfmpegMissing& missing) {
    film.report.remark = missing.what();
  }
}

void finish(Film& film, const Job& job) {
  film.attempt([&] {
    const fs::path path = job.files.folder() / job.movie;
    film.encoder->finish();
    job.files.write(record_of_movie(job.movie),
                    movie_record(job.production, job.times.size(), job.settings.movie, path));
    film.report.movie = path;
  });
}

/// Waits for the frame that is being written, the last of those drawn.
void await(std::future<void>& writing, const Job& job, const FrameReport& report) {
  if (!writing.valid()) return;
  try {
    writing.get();
  } catch (const std::exception& failure) {
    throw std::runtime_error(fmt::format("{}; {} frames are complete in '{}', and the same command continues",
                                         failure.what(), report.kept + report.drawn - 1, job.frames().string()));
  }
}

/// Draws the missing frames of this shard; the film gets all of them in order. Ends early at a signal.
void draw(const Job& job, Film& film, Progress& progress, FrameReport& report) {
  std::optional<Studio> studio;
  std::future<void> writing;  // one picture is compressed while the next is drawn
  for (std::size_t i = 0; i < job.tasks.size(); ++i) {
    const Task& task = job.tasks[i];
    const std::string path = frame_name(task.number);
    if (interrupted()) {
      report.interrupted = true;
      break;
    }
    progress.show(static_cast<double>(i) / static_cast<double>(job.tasks.size()),
                  fmt::format("frame {} of {}", i + 1, job.tasks.size()));
    if (task.current) {
      if (film.encoder) film.attempt([&] { film.encoder->add(render::read_png(job.files.folder() / path).image); });
      continue;
    }
    if (!studio) studio.emplace(render::parse_gl_choice(job.options.gl), job.options.shader_dir, job.production.height);
    const double time = job.times[task.number];
    auto image = std::make_shared<render::Image>(draw_picture(*studio, job.production, time));
    film.attempt([&] { film.encoder->add(*image); });
    await(writing, job, report);
    // A picture by shaders under work is never taken for a finished one.
    const std::string hash = job.options.shader_dir.empty() ? hash_of(job.production, time) : "";
    const render::PngText text = picture_text(job.sources.front(), *studio, time, hash);
    writing = std::async(std::launch::async, [&files = job.files, image, path, text] {
      files.write(path, render::png_bytes(*image, text));
    });
    ++report.drawn;
  }
  await(writing, job, report);
}

}  // namespace

void limit_drawing_threads(int threads) {
  if (threads > 0) setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 0);
}

FrameReport render_frames(const std::vector<PictureSource>& sources, OwnedFiles& files, const Options& options,
                          const std::optional<PlotStrip>& plots) {
  const Job job = prepare(sources, files, options, plots);
  FrameReport report;
  for (const Task& task : job.tasks) report.kept += task.current;
  const bool all_kept = report.kept == static_cast<std::int64_t>(job.tasks.size());
  // A movie that is there is one of all these frames: it goes before the first of them does.
  if (!all_kept) remove_movie(files, job.movie);
  if (all_kept && is_current_movie(files, job.movie, job.production, job.times.size(), job.settings.movie))
    report.movie = files.folder() / job.movie;
  const bool encode = job.whole() && report.movie.empty();
  if (all_kept && !encode) {
    remove_other_frames(job);
    finish_poster(job, report);
    files.settle();
    return report;
  }

  Film film{{}, report};
  if (encode) start(film, job);
  Progress progress("rendering", options.quiet);
  draw(job, film, progress, report);
  if (report.interrupted) return report;
  remove_other_frames(job);
  finish(film, job);
  finish_poster(job, report);
  files.settle();
  return report;
}

void render_still(const std::vector<PictureSource>& sources, double time, const fs::path& path, ResultFiles& files,
                  const Options& options, const std::optional<PlotStrip>& plots) {
  const double end = end_of(longest(sources));
  require_time(time, end);
  const Production production = prepare_pictures(sources, time, plots);
  Studio studio(render::parse_gl_choice(options.gl), options.shader_dir, production.height);
  const render::Image image = draw_picture(studio, production, time);
  files.write(path, render::png_bytes(image, picture_text(sources.front(), studio, time, hash_of(production, time))));
}

}  // namespace app
