// Which images of its vesicles a picture of a periodic cell shows.
#pragma once

#include "app/scene/settings.h"

#include "render/scene/frame.h"
#include "sim/core/cells.h"

#include <optional>
#include <vector>

namespace app {

/// The state as a picture of a periodic cell shows it: each vesicle by that image whose centre is in the box about the
/// origin, which moves as the flow does there. Without a cell, the state itself.
sim::State boxed(const sim::Scene&, sim::State);
sim::VesicleState moved(sim::VesicleState, const sim::Vec3& shift);

/// The box at whose faces a picture cuts its vesicles: that of the cell and its copies. None without a cell, and where
/// vesicles are shown whole.
std::optional<render::FaceBox> faces_of(const sim::Scene&, const render::ViewParameters&);

/// The shifts, sums of whole numbers of the sides, that take a vesicle to where it reaches into the shown box; all of
/// them, and only these.
std::vector<sim::Vec3> shifts_into(const Eigen::Matrix3d& sides, const sim::Box& vesicle, const render::FaceBox& shown);

/// What is known of a vesicle.
struct Whereabouts {
  sim::Vec3 middle = sim::Vec3::Zero();
  sim::Box bounds;
};
/// bounds: as of a Sketch.
Whereabouts whereabouts_of(const sim::VesicleState&, const std::array<glm::dvec3, 2>& bounds);

/// How many copies of the cell a picture shows, itself among them; 1 without a cell.
std::size_t cells_shown(const sim::Scene&, const render::ViewParameters&);

/// As render::summarize, but in a cell the middle of the box stands for the centroid of all, which would jump as
/// vesicles leave on one side and come in on the other.
render::StateSummary summary_of(const sim::Scene&, const sim::State& boxed);

/// A vesicle of such a state, moved by this much.
struct Shown {
  std::size_t vesicle;
  sim::Vec3 shift;
};
/// What a picture shows of such a state. With faces all images that reach into their box. Without, all vesicles, and of
/// view.copies those images whose centres are in the box that is larger by so many cells on each side.
std::vector<Shown> shown_of(const sim::Scene&, const render::ViewParameters&, const std::vector<Whereabouts>&,
                            double time);

/// Edges of the box of the cell itself; none without a cell.
std::vector<render::FlowLines::Line> edges_of_cell(const sim::Scene&);

}  // namespace app
