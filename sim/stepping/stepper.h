// Time stepping: one step of the whole scene, by a scheme of the catalogue (schemes.h), with its checks, the area and
// volume correction, reparametrization and the renewal of upsampling rates.
#pragma once

#include "sim/stepping/start.h"

namespace sim {

/// One step of length dt, within which no flow is switched.
struct Step {
  Dynamics dynamics;
  StepRecord record;
  /// Estimated local error of the position, for each order from 1 as far as the past allows, by size_of(); the largest
  /// of all vesicles.
  std::vector<double> errors;
};
Attempt<Step> take_step(const Model&, const Dynamics&, double dt);

}  // namespace sim
