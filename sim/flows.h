// Background flows u_inf (1b) and body forces. A flow is a row of a catalogue; a scene adds several up, each with a time
// factor. Every row solves the Stokes equations with a constant pressure gradient at most.
#pragma once

#include "catalogue.h"
#include "parameters.h"

#include <span>

namespace sim {

using FlowFunction = Vec3 (*)(const FlowParameters&, const Vec3& position);
const std::vector<CatalogueRow<FlowFunction>>& flow_catalogue();

/// The factor of a flow at time t: 1, cos(2 pi frequency t + phase), or 1 in [from, until) and 0 outside.
double time_factor(const FlowParameters&, double time);

/// Cycles per time of a flow that oscillates and has a strength; 0 of others.
double oscillation(const FlowParameters&);
/// Whether it can move anything: its strength is not zero and it acts at some time before `end`.
bool moves(const FlowParameters&, double end);
/// The next time after `time` at which a flow is switched on or off; infinite: none.
double next_switch(std::span<const FlowParameters>, double time);
/// The flows that act between two times without a switch between them, each without its switches: at the very time of a
/// switch a step that ends there still sees what was, and one that begins there what comes.
std::vector<FlowParameters> acting_flows(std::span<const FlowParameters>, double from, double to);

/// Sum of all flows at points (count x 3): count x 3.
Matrix background_velocity(std::span<const FlowParameters>, double time, const Matrix& points);

}  // namespace sim
