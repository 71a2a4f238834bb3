#include "app/export/summary.h"

#include "app/base/printable.h"
#include "app/figures/motions.h"
#include "app/pictures/frames.h"
#include "app/scene/scene_text.h"
#include "app/scene/trajectory_scene.h"

#include "render/image/image.h"
#include "sim/core/derived.h"
#include "sim/measures/statement.h"
#include "sim/trajectory/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {

namespace {

/// Intervals of length `part` that fill `whole`, a last shorter one included.
std::int64_t intervals(double whole, double part) {
  return static_cast<std::int64_t>(std::ceil(whole / part * (1 - 1e-12)));
}

std::string counted(std::int64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// Columns of the step records whose largest magnitude is worth a line.
struct Extreme {
  std::string name;
  double value = 0;
};

std::vector<Extreme> extremes(const std::vector<sim::StepRecord>& steps) {
  std::vector<Extreme> all;
  double gap = std::numeric_limits<double>::infinity();
  const auto note = [&all](const char* name, double value) {
    auto entry = std::find_if(all.begin(), all.end(), [&](const Extreme& e) { return e.name == name; });
    if (entry == all.end()) entry = all.insert(all.end(), {name, 0});
    if (std::abs(value) > std::abs(entry->value)) entry->value = value;
  };
  for (const sim::StepRecord& step : steps) {
    visit(step, [&](const char* name, const char*, double value) {
      const std::string_view word(name);
      if (word == "gap")
        gap = std::min(gap, value);
      else if (word != "step" && word != "time" && std::isfinite(value))
        note(name, value);
    });
    for (const sim::VesicleStep& vesicle : step.vesicles)
      visit(vesicle, [&](const char* name, const char*, double value) { note(name, value); });
  }
  if (std::isfinite(gap)) all.push_back({"gap (smallest)", gap});
  return all;
}

/// Line by line.
std::string printable_lines(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    result += printable(line) + "\n";
  }
  return result;
}

}  // namespace

std::string scene_summary(const Settings& settings) {
  const sim::Scene& scene = settings.scene;
  std::string flows;
  for (const sim::FlowParameters& flow : scene.flows) flows += (flows.empty() ? "" : " + ") + flow.kind;
  const bool adapts = sim::steps_adapt(scene.time);
  const double step = scene.time.step.value_or(scene.time.end), every = sim::save_interval(scene.time).value_or(step);
  const std::int64_t states = intervals(scene.time.end, every) + 1;
  const std::int64_t frames =
      settings.movie.time_per_frame > 0 ? frame_count(scene.time.end, settings.movie.time_per_frame) : states;
  std::string text = fmt::format("# {}\n", scene.title.empty() ? "(no title)" : printable(scene.title));
  text += fmt::format("# flow {}; time 0 to {}, {}{}, {}\n", flows, scene.time.end, adapts ? "" : "about ",
                      adapts ? fmt::format("steps of tolerance {}", sim::tolerance_of(scene.time))
                             : counted(intervals(scene.time.end, std::min(every, step)), "step"),
                      counted(states, "saved state"));
  if (scene.start.from)
    text += fmt::format("# starts in the state of '{}' at time {}\n", printable(*scene.start.from),
                        scene.start.time.value_or(0));
  for (const sim::VesicleParameters& v : scene.vesicles)
    text += fmt::format("# vesicle: {}, order {}, viscosity contrast {}, bending modulus {}\n", v.shape,
                        v.order > 0 ? fmt::to_string(v.order) : std::string("auto"), v.viscosity_contrast,
                        v.bending_modulus);
  text += fmt::format("# {} of {} x {}, {} per second\n", counted(frames, "frame"), settings.view.size[0],
                      settings.view.size[1], settings.movie.frame_rate);
  for (const auto& figure : settings.figures) text += fmt::format("# figure {}\n", figure.kind);
  return text;
}

namespace {

/// Of the last state's vesicle that is resolved worst; assembling all of hundreds would take seconds. Nothing where
/// that state is damaged or has no surface.
std::string quadrature_text(const sim::TrajectoryReader& trajectory, const sim::StepRecord& last) try {
  const auto worst = std::max_element(last.vesicles.begin(), last.vesicles.end(),
                                      [](const auto& a, const auto& b) { return a.tail < b.tail; });
  const sim::State state = trajectory.state(trajectory.count() - 1);
  const auto vesicle = static_cast<std::size_t>(worst - last.vesicles.begin());
  sim::Plans plans;
  return fmt::format("double layer of rigid motions {:.1e}; ",
                     sim::quadrature_error(plans, state.vesicles.at(vesicle).position));
} catch (const std::exception&) {
  return {};
}

std::string error_line(const sim::TrajectoryReader& trajectory, const std::vector<sim::StepRecord>& steps) {
  const sim::ErrorStatement e = sim::stated_errors(steps);
  return fmt::format(
      "position {:.1e} R0 by the steps{}; {}linear solves {:.1e}; area {:.1e}, volume {:.1e}; {:.2g} % of "
      "the curvature's spectrum in its tail",
      e.time, e.degrees > 0 ? fmt::format(", {:.1e} by the degrees", e.degrees) : std::string(),
      quadrature_text(trajectory, steps.back()), e.solve, e.area, e.volume, 100 * e.space);
}

}  // namespace

std::string error_summary(const std::filesystem::path& path) {
  const sim::TrajectoryReader trajectory(path);
  const std::vector<sim::StepRecord> steps = trajectory.steps();
  return steps.empty() ? std::string() : "estimated errors: " + error_line(trajectory, steps);
}

namespace {

/// Nothing where the scene cannot be read; the lines above and below say so.
std::string motion_summary(const sim::TrajectoryReader& trajectory, const std::filesystem::path& path) try {
  std::string text;
  for (const std::string& line : motion_lines(trajectory, scene_in(trajectory, path).scene))
    text += fmt::format("motion     {}\n", line);
  return text;
} catch (const std::exception&) {
  return {};
}

}  // namespace

std::string trajectory_summary(const std::filesystem::path& path) {
  const sim::TrajectoryReader trajectory(path);
  const sim::TrajectoryHeader& header = trajectory.header();
  const sim::TrajectoryLayout& layout = trajectory.layout();
  const std::int64_t states = trajectory.count();
  std::string text =
      fmt::format("file       {}, a trajectory, format {}\n", printable(path.string()), sim::trajectory_format);
  text += fmt::format("program    tanktread {}, {}\n", printable(header.program), printable(header.build));
  text += fmt::format("vesicles   {}, order at most {}, labels at most {}\n", layout.vesicles, layout.order,
                      layout.label_order);
  text += fmt::format("states     {}, time {} to {}\n", states, states > 0 ? trajectory.time(0) : 0,
                      states > 0 ? trajectory.time(states - 1) : 0);
  text += motion_summary(trajectory, path);
  const std::vector<sim::StepRecord> steps = trajectory.steps();
  text += fmt::format("steps      {}\n", steps.size());
  if (!steps.empty()) {
    text += fmt::format("errors     {}\n", error_line(trajectory, steps));
    text += "largest over all steps and vesicles:\n";
    for (const Extreme& e : extremes(steps)) text += fmt::format("  {:<14} {:.6g}\n", e.name, e.value);
  }
  for (const std::string& warning : header.warnings) text += fmt::format("warning    {}\n", printable(warning));
  for (const std::string& note : trajectory.notes()) text += fmt::format("note       {}\n", printable(note));
  for (const std::int64_t k : trajectory.damaged()) text += fmt::format("damaged    state {}\n", k);
  return text + "\n" + printable_lines(header.scene);
}

std::string picture_summary(const std::filesystem::path& path) {
  const render::PngFile file = render::read_png(path);
  std::string text =
      fmt::format("file       {}, a picture, {} x {}\n", printable(path.string()), file.image.width, file.image.height);
  for (const auto& [key, value] : file.text) text += fmt::format("{:<10} {}\n", printable(key), printable(value));
  return text;
}

}  // namespace app
