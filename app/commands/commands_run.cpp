// Commands that simulate: run, simulate.
#include "app/base/folder_lock.h"
#include "app/base/interrupt.h"
#include "app/base/message.h"
#include "app/base/printable.h"
#include "app/commands/commands.h"
#include "app/export/simulation.h"
#include "app/export/summary.h"
#include "app/figures/figures.h"
#include "app/figures/movie_plots.h"
#include "app/pictures/frames.h"
#include "app/scene/output.h"
#include "app/scene/scene_file.h"
#include "app/scene/scene_text.h"
#include "app/tables/movie_formats.h"

#include "render/gl/context.h"

#include "sim/core/started_ranks.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <new>
#include <thread>

namespace app {

namespace fs = std::filesystem;

namespace {

/// The scene as the command line changes it. The number of threads is none of its: results do not depend on it.
Settings requested_scene(const Options& options, const fs::path& continued) {
  return read_scene(options.inputs.front(), options.set, continued);
}

void say(const Options& options, const std::string& line) {
  if (!options.quiet) fmt::print("{}\n", printable(line));
}

/// Tells how a simulation ended; the exit status.
int report_end(const SimulationReport& report, const fs::path& trajectory, const Options& options) {
  const std::string there =
      fmt::format("{}: {} states, to time {:.6g}", trajectory.string(), report.states, report.time);
  if (report.interrupted) {
    tell(fmt::format("interrupted; {}; the same command {}continues", there,
                     options.command == "simulate" ? "with --resume " : ""));
    return interrupted_status;
  }
  if (!report.stopped.empty()) {
    tell(fmt::format("the simulation stopped: {}; {}", report.stopped, there));
    return 1;
  }
  say(options, there + (report.already_finished ? ", finished before" : ""));
  if (options.quiet) return 0;
  if (const std::string errors = error_summary(trajectory); !errors.empty()) say(options, errors);
  return 0;
}

/// The resolved scene.toml must not take the place of a scene that somebody wrote.
void protect_scene(const fs::path& scene, const OwnedFiles& files, const Settings& settings) {
  std::error_code error;
  const fs::path resolved = files.folder() / "scene.toml";
  if (!fs::equivalent(scene, resolved, error)) return;
  const std::string text = read_whole_file(scene);
  const bool changes = text != write_scene(settings);
  if (changes && (text != write_scene(read_scene(scene)) || files.foreign("scene.toml")))
    throw std::runtime_error(
        fmt::format("the resolved scene would overwrite '{}' itself; give another -o", scene.string()));
}

/// The plan and the resolved scene: valid as a scene file itself.
int print_plan(const Settings& settings) {
  fmt::print("{}\n{}", scene_summary(settings), write_scene(settings));
  return 0;
}

}  // namespace

int run(const Options& options) {
  if (sim::announced_ranks() > 1)
    throw std::runtime_error("'run' is for one process; under mpirun, 'simulate', then 'render --shard auto'");
  const fs::path folder = options.output.empty() ? fs::path("out") / options.inputs.front().stem() : options.output;
  const fs::path trajectory = folder / "trajectory.h5";
  const Settings settings = requested_scene(options, options.force ? fs::path() : trajectory);
  {
    OwnedFiles there(folder);
    protect_scene(options.inputs.front(), there, settings);
    if (inspect_folder(there, settings, options.force) != FolderState::fresh && fs::exists(trajectory))
      check_further(settings, trajectory);
  }
  if (options.dry_run) return print_plan(settings);
  // Before hours of simulation: can there be pictures at all?
  static_cast<void>(render::GlContext(render::parse_gl_choice(options.gl)));
  check_movie(find_movie_format(settings.movie.format), settings.view.size[0], settings.view.size[1]);
  const FolderLock lock(folder);
  OwnedFiles files(folder);
  const FolderState state = inspect_folder(files, settings, options.force);
  bool claimed = false;
  const auto claim = [&] {  // once it is known that the scene can be simulated
    if (!claimed) claim_folder(files, settings, state);
    claimed = true;
  };
  const SimulationReport report = state != FolderState::fresh && fs::exists(trajectory)
                                      ? simulate_further(settings, trajectory, options, claim)
                                      : simulate_new(settings, trajectory, options, claim);
  claim();
  const int status = report_end(report, trajectory, options);
  if (report.interrupted) return status;

  // A simulation that stopped early is drawn as far as it went: that is where one looks for the reason.
  const sim::TrajectoryReader reader(trajectory);
  limit_drawing_threads(options.jobs);
  const FrameReport frames = render_frames({{reader, settings}}, files, options, movie_plots({{reader, settings, {}}}));
  if (frames.interrupted) {
    tell(fmt::format("interrupted; {} frames are in '{}'; the same command continues", frames.drawn + frames.kept,
                     (folder / "frames").string()));
    return interrupted_status;
  }
  say(options, fmt::format("{}: {} frames drawn, {} kept", (folder / "frames").string(), frames.drawn, frames.kept));
  if (!frames.movie.empty()) say(options, frames.movie.string());
  if (!frames.poster.empty()) say(options, frames.poster.string());
  if (!frames.poster_remark.empty()) tell(frames.poster_remark);
  if (!frames.remark.empty())
    tell(fmt::format("{}; the frames are in '{}'", frames.remark, (folder / "frames").string()));
  const sim::FileWriter write = [&](const fs::path& path, std::string_view bytes) {
    files.write(path.filename().string(), bytes);
  };
  for (const render::FigureParameters& figure : settings.figures) {
    const fs::path stem = folder / (figure.out.empty() ? figure.kind : figure.out);
    for (const fs::path& file :
         draw_figure({{reader, settings, {}, trajectory.string()}}, figure, stem, write, options))
      say(options, file.string());
  }
  files.settle();
  return frames.movie_failed ? 1 : status;
}

namespace {

/// By the first rank, or the only one.
int simulate_first(const Options& options, const sim::Ranks& ranks) {
  const fs::path file =
      options.output.empty() ? fs::path(options.inputs.front().stem().string() + ".h5") : options.output;
  const bool exists = fs::exists(file);
  const Settings settings = requested_scene(options, exists && options.resume ? file : fs::path());
  if (exists && !options.resume && !options.force)
    throw std::runtime_error(fmt::format("'{}' exists; --resume continues it, --force replaces it", file.string()));
  if (options.dry_run) return print_plan(settings);
  const SimulationReport report = exists && options.resume ? simulate_further(settings, file, options, {}, {}, ranks)
                                                           : simulate_new(settings, file, options, {}, {}, ranks);
  return report_end(report, file, options);
}

/// Ends all ranks after a sentence of this one. What all find, the first says: the others give it the time to.
[[noreturn]] void end_all(const sim::Ranks& ranks, int status, std::string_view sentence) {
  constexpr std::chrono::seconds head_start(3);
  if (!ranks.first()) std::this_thread::sleep_for(head_start);
  tell(ranks.first() ? std::string(sentence) : fmt::format("process {}: {}", ranks.rank, sentence));
  ranks.end_all(status);
  std::abort();
}

}  // namespace

int simulate(const Options& options) {
  if (options.dry_run) return simulate_first(options, sim::alone);
  const sim::Ranks ranks = sim::started_ranks();
  if (ranks.count == 1) return simulate_first(options, ranks);
  try {
    if (ranks.first()) return simulate_first(options, ranks);
    simulate_along(options, ranks);
    return 0;
  } catch (const Interrupted&) {
    end_all(ranks, interrupted_status, "interrupted");
  } catch (const std::bad_alloc&) {
    end_all(ranks, 1, "there is not enough memory");
  } catch (const std::exception& error) {
    end_all(ranks, 1, error.what());
  }
}

}  // namespace app
