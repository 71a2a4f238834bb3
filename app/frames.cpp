#include "frames.h"

#include "captions.h"
#include "fields.h"
#include "interrupt.h"
#include "movie.h"
#include "output.h"
#include "progress.h"
#include "scene_text.h"
#include "version.h"

#include "render/cutaway.h"
#include "render/draw.h"
#include "render/sequence.h"
#include "render/style.h"
#include "sim/diagnostics.h"
#include "sim/flows.h"

#include <fmt/format.h>

#include <stdlib.h>

#include <cmath>
#include <future>
#include <numeric>

namespace app {

namespace fs = std::filesystem;

std::vector<double> frame_times(const sim::TrajectoryReader& trajectory, const render::MovieParameters& movie) {
  std::vector<double> times;
  const std::int64_t states = trajectory.count();
  if (movie.time_per_frame > 0) {
    const double end = trajectory.time(states - 1);
    const auto frames = static_cast<std::int64_t>(std::floor(end / movie.time_per_frame * (1 + 1e-12))) + 1;
    for (std::int64_t f = 0; f < frames; ++f)
      times.push_back(std::min(end, static_cast<double>(f) * movie.time_per_frame));
  } else {
    for (std::int64_t k = 0; k < states; ++k) times.push_back(trajectory.time(k));
  }
  return times;
}

sim::State state_at(const sim::TrajectoryReader& trajectory, double time) {
  std::int64_t low = 0, high = trajectory.count() - 1;
  while (low < high) {  // first state at or after `time`
    const std::int64_t middle = (low + high) / 2;
    if (trajectory.time(middle) < time) low = middle + 1;
    else high = middle;
  }
  sim::State after = trajectory.state(low);
  if (low == 0 || time >= after.time) return after;
  return render::interpolated(trajectory.state(low - 1), after, time);
}

namespace {

/// What all frames of a movie share.
struct Production {
  const Settings& settings;
  render::Framing framing;
  double arrow_speed = 0;
  std::string parameters;
  double area_radius = 1;
  Painting painting;
  std::string hash;  ///< of everything that a frame depends on besides its time
};

render::FlowArrows arrows_of(const Production& p, const render::StateSummary& summary, double time) {
  render::FlowArrows arrows;
  if (!p.settings.view.flow_arrows) return arrows;
  arrows.points = render::arrow_points(p.framing, summary.centroid);
  arrows.velocities = sim::background_velocity(p.settings.scene.flows, time, arrows.points);
  arrows.reference_speed = p.arrow_speed;
  return arrows;
}

Production prepare(const sim::TrajectoryReader& trajectory, const Settings& settings) {
  Production p{settings, {}, 0, {}, 1, {}, {}};
  const std::int64_t states = trajectory.count();
  // A few hundred instants are enough to frame a movie.
  const std::int64_t stride = std::max<std::int64_t>(1, states / 400);
  std::vector<render::StateSummary> summaries;
  std::vector<double> times;
  std::vector<std::int64_t> chosen;
  for (std::int64_t k = 0; k < states; k = k + 1 < states ? std::min(k + stride, states - 1) : states) chosen.push_back(k);
  for (const std::int64_t k : chosen) {
    const sim::State state = trajectory.state(k);
    summaries.push_back(render::summarize(state));
    times.push_back(state.time);
  }
  p.framing = render::frame_trajectory(summaries, settings.view);
  for (std::size_t k = 0; k < summaries.size(); ++k) {
    const render::FlowArrows arrows = arrows_of(p, summaries[k], times[k]);
    if (arrows.velocities.rows() > 0)
      p.arrow_speed = std::max(p.arrow_speed, arrows.velocities.rowwise().norm().maxCoeff());
  }
  sim::Plans plans;
  const sim::VesicleMeasures measures = sim::measure(plans, trajectory.state(0).vesicles.front(), 1, 1);
  p.area_radius = std::sqrt(measures.area / sim::default_area);
  p.painting = plan_painting(trajectory, chosen, settings, p.area_radius);
  p.parameters = parameter_caption(settings.scene, p.area_radius, measures.reduced_volume);
  p.hash = fmt::format("{}-{}-{}", picture_hash(settings), states, version());
  return p;
}

render::Image draw(render::Renderer& renderer, sim::Plans& plans, const Production& p, const sim::State& state,
                   const std::shared_ptr<const render::MeshPlan>& plan) {
  render::Frame frame;
  frame.view = p.settings.view;
  const render::StyleRow& style = render::find_style(frame.view.style);
  for (std::size_t v = 0; v < state.vesicles.size(); ++v) {
    std::optional<sim::Coefficients> field;
    if (p.painting.field) field = painted_field(plans, p.painting, p.settings, state, v);
    frame.bodies.push_back(
        {render::make_mesh(plan, state.vesicles[v], field ? &*field : nullptr), p.painting.bodies[v], {}});
    if (style.cut)
      frame.bodies.back().cut =
          render::make_cut(state.vesicles[v].position, frame.view.cut_normal, frame.view.cut_offset);
  }
  frame.legend = p.painting.legend;
  const render::StateSummary summary = render::summarize(state);
  frame.camera = render::make_camera(p.framing, summary.centroid);
  frame.arrows = arrows_of(p, summary, state.time);
  frame.captions.time = time_caption(p.settings.scene, state.time);
  frame.captions.parameters = p.parameters;
  frame.captions.scale_length = p.area_radius;
  return render::draw_frame(renderer, frame);
}

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

}  // namespace

FrameReport render_frames(const sim::TrajectoryReader& trajectory, const Settings& settings, const fs::path& folder,
                          const Options& options, bool redo_movie) {
  const Production production = prepare(trajectory, settings);
  const std::vector<double> times = frame_times(trajectory, settings.movie);
  const fs::path frames = folder / "frames", movie = folder / "movie.mp4";
  std::error_code error;
  fs::create_directories(frames, error);
  if (error) throw std::runtime_error(fmt::format("cannot make folder '{}': {}", frames.string(), error.message()));

  struct Task {
    std::size_t number;
    fs::path path;
    std::string hash;
    bool current;
  };
  std::vector<Task> tasks;
  FrameReport report;
  for (auto f = static_cast<std::size_t>(options.shard); f < times.size(); f += static_cast<std::size_t>(options.shards)) {
    Task task{f, frames / fmt::format("{:06}.png", f), fmt::format("{}-{:.17g}", production.hash, times[f]), false};
    task.current = options.shader_dir.empty() && is_current(task.path, task.hash);
    report.kept += task.current;
    tasks.push_back(std::move(task));
  }
  const bool all_kept = report.kept == static_cast<std::int64_t>(tasks.size());
  report.movie = all_kept && !redo_movie && fs::exists(movie);
  const bool encode = options.shards == 1 && !report.movie;
  if (all_kept && !encode) return report;

  // Software OpenGL has threads of its own; the pictures do not depend on their number.
  if (options.jobs > 0) setenv("LP_NUM_THREADS", std::to_string(options.jobs).c_str(), 0);
  std::optional<render::Renderer> renderer;
  std::optional<MovieEncoder> encoder;
  if (encode) {
    try {
      encoder.emplace(movie, settings.view.size[0], settings.view.size[1], settings.movie.frame_rate);
    } catch (const FfmpegMissing& missing) {
      report.remark = missing.what();
    }
  }
  const auto to_movie = [&](const auto& action) {
    if (!encoder) return;
    try {
      action();
    } catch (const std::exception& failure) {
      report.remark = failure.what();
      report.movie_failed = true;
      encoder.reset();
    }
  };
  const auto plan = std::make_shared<const render::MeshPlan>();
  sim::Plans plans;
  std::future<void> writing;  // one picture is compressed while the next is drawn
  Progress progress("rendering", options.quiet);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const Task& task = tasks[i];
    if (interrupted()) {
      report.interrupted = true;
      break;
    }
    progress.show(static_cast<double>(i) / static_cast<double>(tasks.size()),
                  fmt::format("frame {} of {}", i + 1, tasks.size()));
    if (task.current) {
      to_movie([&] { encoder->add(render::read_png(task.path).image); });
      continue;
    }
    if (!renderer) renderer.emplace(render::parse_gl_choice(options.gl), options.shader_dir);
    const sim::State state = state_at(trajectory, times[task.number]);
    auto image = std::make_shared<render::Image>(draw(*renderer, plans, production, state, plan));
    to_movie([&] { encoder->add(*image); });
    render::PngText text{{"Title", settings.scene.title},
                         {"Software", "tanktread " + version()},
                         {"tanktread:time", fmt::format("{:.12g}", times[task.number])},
                         {hash_key, task.hash}};
    for (const auto& entry : renderer->metadata()) text.push_back(entry);
    if (writing.valid()) writing.get();
    writing = std::async(std::launch::async, [image, path = task.path, text] { render::write_png(path, *image, text); });
    ++report.drawn;
  }
  if (writing.valid()) writing.get();
  if (report.interrupted) return report;
  if (options.shards == 1) remove_frames(frames, static_cast<std::int64_t>(times.size()));
  to_movie([&] {
    encoder->finish();
    report.movie = true;
  });
  return report;
}

std::vector<render::Image> draw_stills(const sim::TrajectoryReader& trajectory, const Settings& settings,
                                       const std::vector<Still>& stills, const Options& options) {
  Settings plain = settings;
  plain.view.projection = "orthographic";
  plain.view.background = "white";
  plain.view.flow_arrows = plain.view.time_stamp = plain.view.caption = plain.view.scale_bar = false;
  render::Renderer renderer(render::parse_gl_choice(options.gl), options.shader_dir);
  const auto plan = std::make_shared<const render::MeshPlan>();
  sim::Plans plans;
  std::vector<std::int64_t> states(static_cast<std::size_t>(trajectory.count()));
  std::iota(states.begin(), states.end(), 0);
  const double area = sim::measure(plans, trajectory.state(0).vesicles.front(), 1, 1).area;
  const Painting painting = plan_painting(trajectory, states, plain, std::sqrt(area / sim::default_area));
  std::vector<render::Image> images;
  for (const Still& still : stills) {
    const sim::State state = state_at(trajectory, still.time);
    plain.view.size = {still.width, still.height};
    Production p{plain, render::frame_trajectory(std::vector{render::summarize(state)}, plain.view), 0, {}, 1, {}, {}};
    p.painting = painting;
    const glm::dvec3 target(still.target[0], still.target[1], still.target[2]);
    p.framing.depth += glm::length(target - p.framing.target);
    p.framing.follows = false;
    p.framing.target = target;
    p.framing.half_height = still.half_height;
    images.push_back(draw(renderer, plans, p, state, plan));
  }
  return images;
}

}  // namespace app
