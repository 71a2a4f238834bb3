// Placements: rows of a catalogue that make many vesicles from one. The same seed gives the same positions on every
// machine.
#pragma once

#include "sim/core/catalogue.h"
#include "sim/core/parameters.h"

#include <functional>

namespace sim {

/// Called during a search; true ends it.
using StopQuestion = std::function<bool()>;
/// Where copies are placed: in a periodic cell, or in unbounded space.
struct Room {
  std::optional<Vec3> cell;
  StopQuestion stop;
};
using PlacementFunction = std::vector<VesicleParameters> (*)(const PlacementParameters&, const VesicleParameters&,
                                                             const Room&);
const std::vector<CatalogueRow<PlacementFunction>>& placement_catalogue();

/// The scene with each placement expanded into copies of its last vesicle, which they replace. A lattice or box fills
/// the scene's cell, and their copies keep their distance from images, too. Throws
/// std::invalid_argument when they do not fit, and std::system_error (interrupted) when asked to stop.
Scene placed(Scene, const StopQuestion& stop = {});

}  // namespace sim
