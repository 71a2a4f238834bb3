// Placements: rows of a catalogue that make many vesicles of one. The same seed gives the same places everywhere.
#pragma once

#include "interaction.h"

#include <functional>

namespace sim {

/// Asked while a search goes on; true ends it.
using StopQuestion = std::function<bool()>;
using PlacementFunction = std::vector<VesicleParameters> (*)(const PlacementParameters&, const VesicleParameters&,
                                                             const StopQuestion&);
const std::vector<CatalogueRow<PlacementFunction>>& placement_catalogue();

/// The scene with each placement turned into copies of its last vesicle, which they replace.
/// Throws std::invalid_argument when they do not fit, and std::system_error (interrupted) when told to stop.
Scene placed(Scene, const StopQuestion& stop = {});

}  // namespace sim
