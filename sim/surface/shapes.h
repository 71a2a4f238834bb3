// Initial shapes: rows of a catalogue that turn the parameters of a vesicle into coefficients of its position. In the
// shape's own frame the grid's pole is the local z axis; it is aligned with `axis`, and local y with the y axis made
// orthogonal to it (the z axis where `axis` is parallel to y).
#pragma once

#include "sim/core/catalogue.h"
#include "sim/core/parameters.h"

namespace sim {

/// Position in the local frame, of degree <= order; size as the kind says, before scaling to area or radius.
using ShapeFunction = Coefficients (*)(const VesicleParameters&);
const std::vector<CatalogueRow<ShapeFunction>>& shape_catalogue();

/// Position coefficients of degree `order` (where it is automatic, of the least that keeps the shape): scaled, rotated,
/// and moved to `center`. Throws std::invalid_argument with one sentence when no shape fits the parameters.
Coefficients initial_position(const VesicleParameters&);
/// The dear part of it: scaled, in the local frame, about the origin.
Coefficients upright_shape(const VesicleParameters&);
/// Columns: the axes of the local frame, as the axis of a vesicle turns them.
Eigen::Matrix3d local_frame(const VesicleParameters&);
/// The cheap rest: such a shape along the axis of a vesicle and about its center.
Coefficients laid(const VesicleParameters&, Coefficients upright);

/// Semi-axes (a, b, b) of the spheroid of that reduced volume and of area 4 pi, a along the symmetry axis.
Vec3 spheroid_axes(double reduced_volume, bool prolate);

}  // namespace sim
