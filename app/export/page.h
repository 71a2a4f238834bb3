// `tanktread export --html`: one page that shows a trajectory in WebGL 2 and needs nothing but itself. The membranes
// are evaluated in the page from their spherical harmonics and drawn by the program's own shaders.
#pragma once

#include "app/scene/settings.h"

#include "sim/trajectory/trajectory.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace app {

/// Rounding errors of a page, root mean square over the unit sphere: of positions in area radii, of unit labels, of
/// fields in ranges of the colour bar, of the parameters of tracers.
inline constexpr double page_position_error = 5e-5, page_label_error = 2e-4, page_field_error = 5e-4,
                        page_tracer_error = 2e-4;
/// Longer movies are thinned; the page shows what is between.
inline constexpr std::int64_t most_page_frames = 400;

/// Step in which coefficients of a field of degree p are rounded, so that the field has this error.
double page_quantum(double error, int order);

/// Times of the frames of a page: those of the movie, thinned.
std::vector<double> page_times(const sim::TrajectoryReader&, const render::MovieParameters&);

/// Called with (frames done, total) before each; false stops.
using PageProgress = std::function<bool(std::int64_t, std::int64_t)>;

/// The whole page; empty when it was stopped. Throws std::invalid_argument with one sentence when nothing would be
/// visible.
std::string page_text(const sim::TrajectoryReader&, const Settings&, const std::vector<double>& times,
                      const PageProgress&);

}  // namespace app
