// The part of a vesicle removed by the style "cutaway", and the rim that remains.
#pragma once

#include "render/scene/frame.h"
#include "render/scene/section.h"

namespace render {

/// Of the rims: their corners stay below a tenth of a pixel.
inline constexpr int rim_latitudes = 80;

/// The plane has the given normal, of any length but 0, and goes through the point. plan: of rim_latitudes; rotation:
/// of the surface's degree.
Cut make_cut(const SectionPlan& plan, const sim::RotationPlan& rotation, const sim::Coefficients& position,
             const sim::Vec3& normal, const sim::Vec3& point);

/// Of one vesicle, `offset` from its centre of mass along the normal.
Cut make_cut(const sim::Coefficients& position, const sim::Vec3& normal, double offset);

}  // namespace render
