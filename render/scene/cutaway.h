// The part of a vesicle removed by the style "cutaway", and the rim that remains.
#pragma once

#include "render/scene/frame.h"

namespace render {

/// The plane has the given normal, of any length but 0, and lies `offset` from the vesicle's centre of mass along it.
Cut make_cut(const sim::Coefficients& position, const sim::Vec3& normal, double offset);

/// The plane has the given normal and goes through the point.
Cut make_cut_at(const sim::Coefficients& position, const sim::Vec3& normal, const sim::Vec3& point);

}  // namespace render
