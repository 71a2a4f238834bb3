#include "app/scene/scene_start.h"

#include "sim/trajectory/trajectory.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace app {

namespace {

/// The scene of a trajectory that started in a state of another one.
std::optional<sim::Scene> started_before(const std::filesystem::path& trajectory, const SceneThere& scene_there) {
  if (trajectory.empty() || !sim::holds_trajectory(trajectory)) return std::nullopt;
  try {
    sim::Scene scene = scene_there(sim::TrajectoryReader(trajectory).header().scene, trajectory);
    if (scene.start.from) return scene;
  } catch (const std::runtime_error&) {
    // Whoever continues it says what is wrong with it.
  }
  return std::nullopt;
}

std::string text_of(const sim::Vec3& size) { return fmt::format("[{}, {}, {}]", size[0], size[1], size[2]); }

/// The cell must be that of the source; what it leans by at a time goes on as the strain of the start.
void take_cell(sim::Scene& scene, const sim::Scene& source, double time) {
  const std::string& from = *scene.start.from;
  if (!scene.cell.size && !source.cell.size) {
    if (scene.start.strain) throw WrongKey("start", "strain", "only a periodic [cell] has a strain: leave it out");
    return;
  }
  if (!scene.cell.size)
    throw WrongKey("start", "from",
                   fmt::format("the vesicles of '{}' are in a periodic cell: give the scene its [cell] with size = {}",
                               from, text_of(*source.cell.size)));
  if (!source.cell.size)
    throw WrongKey("cell", "size",
                   fmt::format("the vesicles of '{}' are in unbounded fluid: leave the [cell] out", from));
  constexpr double rounding = 1e-9;
  const sim::Vec3 &here = *scene.cell.size, &there = *source.cell.size;
  if ((here - there).norm() > rounding * there.norm())
    throw WrongKey(
        "cell", "size",
        fmt::format("the vesicles of '{}' are in a cell of size {}, not {}", from, text_of(there), text_of(here)));
  const double strain = (*sim::cell_at(source, time))(0, 2) / there[2];
  if (scene.start.strain && std::abs(*scene.start.strain - strain) > rounding)
    throw WrongKey("start", "strain",
                   fmt::format("the cell of '{}' has the strain {:.10g} at time {:.10g}, not {}", from, strain, time,
                               *scene.start.strain));
  if (!scene.start.strain) scene.start.strain = strain;
}

}  // namespace

std::optional<sim::State> take_start(sim::Scene& scene, bool own_vesicles, const std::filesystem::path& continued,
                                     const SceneThere& scene_there) {
  sim::StartParameters& start = scene.start;
  const std::string from = *start.from;
  std::error_code error;
  const bool there = std::filesystem::is_regular_file(from, error);
  if (const auto before = started_before(continued, scene_there); before && (before->start.from == from || !there)) {
    if (!start.time) start.time = before->start.time;
    if (!start.strain) start.strain = before->start.strain;
    if (!start.checksum) start.checksum = before->start.checksum;
    if (!own_vesicles) scene.vesicles = before->vesicles;
    return std::nullopt;
  }
  if (!there) throw WrongKey("start", "from", fmt::format("there is no file '{}'", from));
  const auto told_by = [&](const char* key, auto&& part) {
    try {
      return part();
    } catch (const WrongKey&) {
      throw;
    } catch (const std::runtime_error& failure) {
      throw WrongKey("start", key, failure.what());
    }
  };
  sim::SavedStart saved = told_by(start.time ? "time" : "from", [&] { return sim::read_start(start); });
  const sim::Scene source =
      told_by("from", [&] { return scene_there(sim::TrajectoryReader(from).header().scene, from); });
  if (source.vesicles.size() != saved.state.vesicles.size())
    throw WrongKey("start", "from",
                   fmt::format("trajectory '{}' is damaged: its scene has {} vesicles, its states have {}", from,
                               source.vesicles.size(), saved.state.vesicles.size()));
  start.time = saved.state.time;
  start.checksum = saved.checksum;
  if (!own_vesicles) scene.vesicles = source.vesicles;
  take_cell(scene, source, saved.state.time);
  return std::move(saved.state);
}

}  // namespace app
