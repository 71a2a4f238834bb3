// Quantities of trajectories against time.
#pragma once

#include "app/pictures/captions.h"
#include "app/scene/settings.h"
#include "app/tables/quantities.h"

#include "render/figures/figure.h"
#include "sim/trajectory/trajectory.h"

#include <string>
#include <vector>

namespace app {

/// One trajectory as the source of a figure.
struct FigureSource {
  const sim::TrajectoryReader& trajectory;
  const Settings& settings;
  std::string name;                           ///< in the legend when there are several sources; else empty
  std::string file = {};                      ///< of the trajectory, for messages
  std::optional<render::Legend> legend = {};  ///< of the field in its pictures, where several figures share one
};

/// Area radius of the first vesicle in the first state, length.
double length_of(const sim::TrajectoryReader&);

/// What the curves of several trajectories share: a scale that one of them lacks is used for none.
struct SharedScales {
  TimeUnit time;
  bool rate = true, bending = true;
};
SharedScales shared_scales(const std::vector<FigureSource>&);

/// Where quantities of shapes are measured: in the saved states, or in as many between them, interpolated as stills
/// are, as a smooth curve takes.
enum class Instants { saved, dense };

/// Series of one trajectory for each of the quantities, one after the other: one for each vesicle and curve; of the
/// first vesicle and curve only, without names, when `single`. States are measured once for all.
std::vector<render::Series> series_of(const FigureSource&, const SharedScales&, const std::vector<const QuantityRow*>&,
                                      bool single, Instants instants = Instants::saved);

}  // namespace app
