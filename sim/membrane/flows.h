// Background flows u_inf (1b) and body forces. A flow is a row of a catalogue; a scene may add several, each with a
// time factor. Every row solves the Stokes equations with at most a constant pressure gradient; "streams"
// with a force 8 pi^2 U/l^2 cos cos on the fluid, as a flow along pipes side by side would need walls.
#pragma once

#include "sim/core/catalogue.h"
#include "sim/core/parameters.h"

#include <optional>
#include <span>

namespace sim {

using FlowFunction = Vec3 (*)(const FlowParameters&, const Vec3& position);
const std::vector<CatalogueRow<FlowFunction>>& flow_catalogue();

/// The factor of a flow at time t: 1, cos(2 pi frequency t + phase), or 1 in [from, until) and 0 outside.
double time_factor(const FlowParameters&, double time);

/// Frequency of an oscillating flow of nonzero strength; 0 for others.
double oscillation(const FlowParameters&);
/// Whether it can move anything: its strength is nonzero and it acts at some time before `end`.
bool moves(const FlowParameters&, double end);
/// Rate of a steady simple shear, signed: of one constant flow "shear" that is not zero, alone or beside uniform flows
/// and fluid at rest; none with any other flow.
std::optional<double> steady_shear_rate(std::span<const FlowParameters>);
/// Unit vector across a parallel flow at a place: e_z in shear, away from the axis in Poiseuille flow and in streams
/// (on it, e_z), uniform flows and fluid at rest aside. None without such a flow, beside any other, and where there are
/// both.
std::optional<Vec3> across(std::span<const FlowParameters>, const Vec3& position);
/// The next time after `time` at which a flow is switched on or off; infinite: none.
double next_switch(std::span<const FlowParameters>, double time);
/// The flows that act between two times without a switch between them, each without its switches: at a switching
/// time, a step that ends there still has the old flow, and one that begins there has the new one.
std::vector<FlowParameters> acting_flows(std::span<const FlowParameters>, double from, double to);

/// Sum of all flows at points (count x 3): count x 3.
Matrix background_velocity(std::span<const FlowParameters>, double time, const Matrix& points);

}  // namespace sim
