// Time stepping: one step of the whole scene, by a scheme of the catalogue (schemes.h), with its checks, the area and
// volume correction, reparametrization and the renewal of upsampling rates.
#pragma once

#include "sim/stepping/start.h"

namespace sim {

/// One step of length dt, within which no flow is switched.
struct Step {
  Dynamics dynamics;
  StepRecord record;
};
Attempt<Step> take_step(const Model&, const Dynamics&, double dt);

}  // namespace sim
