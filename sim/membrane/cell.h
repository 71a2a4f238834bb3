// The periodic cell of a scene. Its sides are the columns of a lattice; copies of all that is in it stand at every sum
// of whole numbers of sides. The background flow must take a lattice to a lattice, which uniform flows and a shear
// along x do: with the strain gamma(t), the integral of the shear rate and the strain of the start,
//   a_1 = (L_x, 0, 0),   a_2 = (0, L_y, 0),   a_3 = (gamma L_z, 0, L_z)
// (Lees and Edwards). a_3 may be changed by whole numbers of a_1, so that it leans by no more than half of L_x. The
// velocity less the background flow is the same in all copies.
//
// Vesicles are wherever they have drifted to, in any cell: positions are never wrapped.
#pragma once

#include "sim/core/cells.h"
#include "sim/membrane/flows.h"

#include <string>

namespace sim {

/// Integral of the shear rate of all flows from 0 to t.
double shear_strain(std::span<const FlowParameters>, double time);

/// The lattice of a scene at a time; none without a cell.
CellSides cell_at(const Scene&, double time);
double cell_volume(const Scene&);  ///< infinite without a cell

/// By how much a place is moved into the upright box about the origin, which fills space with its copies as the leaning
/// cell does: the sum of lattice vectors that leads there.
Vec3 into_box(const Scene&, double time, const Vec3& place);

/// Why a scene cannot have its flows or its cell: the offending table and key, and a sentence; nothing where it can.
struct SceneObjection {
  std::string_view table, key;
  std::string reason;
};
std::optional<SceneObjection> scene_objection(const Scene&);

}  // namespace sim
