// The colours of a movie: range of its field over the whole trajectory, labels in dimensionless units, and colours of
// whole vesicles.
#pragma once

#include "app/scene/settings.h"

#include "render/scene/frame.h"
#include "sim/measures/fields.h"
#include "sim/trajectory/trajectory.h"

namespace app {

/// The same for all frames of a movie.
struct Painting {
  std::vector<render::Colour> bodies;    ///< one a vesicle
  std::optional<render::Legend> legend;  ///< of the field, or of the quantity that colours whole vesicles
  const sim::FieldRow* field = nullptr;  ///< set when the style shows a field
  double length = 1;                     ///< R0
  double rate = 0;                       ///< of the flow at the size of a vesicle; 0: none
};

/// Passes over `states` of the trajectory when the style shows a field, or takes the `still` when only that is drawn.
/// An automatic range covers all of it but the lowest and the highest 0.5 % of the membranes' area, and of a movie not
/// what happens in its first tenth alone, widened to round numbers; a field that has a sign has zero in the middle,
/// whatever its values. The colour bar shows whether values lie outside the range. Throws std::invalid_argument for a
/// field that this scene does not have.
Painting plan_painting(const sim::TrajectoryReader&, const std::vector<std::int64_t>& states, const Settings&,
                       double area_radius, const sim::State* still = nullptr);

/// One range for all movies that are drawn side by side, so that equal colours mean equal values; about zero if that of
/// one is, unless it was given. Unless all show the same field nothing happens; throws std::invalid_argument where the
/// range is to be shared.
void share_legend(const std::vector<Painting*>&, const render::FieldRange&);

/// The field of one vesicle in the units of the legend, for make_mesh(); the surroundings are those of the state.
sim::Coefficients painted_field(sim::Plans&, const Painting&, const Settings&, const sim::State&, std::size_t vesicle,
                                sim::Surroundings&);

}  // namespace app
