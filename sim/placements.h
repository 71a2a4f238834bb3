// Placements: rows of a catalogue that make many vesicles of one. The same seed gives the same places everywhere.
#pragma once

#include "interaction.h"

namespace sim {

using PlacementFunction = std::vector<VesicleParameters> (*)(const PlacementParameters&, const VesicleParameters&);
const std::vector<CatalogueRow<PlacementFunction>>& placement_catalogue();

/// The scene with each placement turned into copies of its last vesicle, which they replace.
/// Throws std::invalid_argument when they do not fit.
Scene placed(Scene);

}  // namespace sim
