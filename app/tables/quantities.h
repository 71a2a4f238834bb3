// Quantities for time series and phase portraits: a catalogue of measures of saved states or of steps, each with one
// or more curves.
#pragma once

#include "render/figures/plot.h"
#include "sim/core/catalogue.h"
#include "sim/measures/diagnostics.h"
#include "sim/measures/rheology.h"
#include "sim/measures/stresslet.h"
#include "sim/trajectory/trajectory.h"

#include <variant>
#include <vector>

namespace app {

/// Scales of quantities; 0: undefined, and quantities are shown without dividing by it.
struct QuantityUnits {
  double length = 1;           ///< area radius R0
  double rate = 0;             ///< of the flow, 1/time
  double bending_modulus = 0;  ///< kappa_b
};
enum class Scaling { nothing, rate, bending };  ///< which of them a quantity needs besides the length

/// What of a state a quantity is made of: the forces take a solve.
enum class Needs { shape, velocity, forces };

/// Measures of a vesicle at a saved state; velocities are relative to its centre.
struct VesicleSample : sim::VesicleMeasures {
  double deformation = 0;       ///< (L - B) / (L + B) of the second moments in the shear plane
  sim::FlowMeasures flow = {};  ///< where a quantity needs it
  double frequency = 0;         ///< of the membrane round the section with the shear plane, likewise
};

/// A curve and its value: of a vesicle at a saved state, of a vesicle in a step, or of all vesicles at a saved state.
struct StateCurve {
  const char* name;  ///< in a legend
  double (*value)(const VesicleSample&, const QuantityUnits&);
};
struct StepCurve {
  const char* name;  ///< in a legend
  double (*value)(const sim::StepRecord&, std::size_t vesicle, const QuantityUnits&);
};
/// Of all vesicles at a saved state.
struct SuspensionCurve {
  const char* name;
  double (*value)(const sim::SuspensionMeasures&, const QuantityUnits&);
};
using SuspensionCurves = std::vector<SuspensionCurve>;
using StateCurves = std::vector<StateCurve>;
using StepCurves = std::vector<StepCurve>;

struct QuantityRow {
  std::string_view name, meaning;
  const char* axis;  ///< label
  render::Scale scale;
  std::variant<StateCurves, StepCurves, SuspensionCurves> curves;  ///< at least one
  bool per_vesicle = true;                                         ///< else one curve for all
  bool differentiate = false;  ///< the values are the rates of change of the function, per time / rate
  Scaling scaling = Scaling::nothing;
  const char* bare_axis = nullptr;  ///< label without that scale
  Needs needs = Needs::shape;
};
/// The names of its curves.
std::vector<const char*> curve_names(const QuantityRow&);
std::string axis_label(const QuantityRow&, const QuantityUnits&);
const std::vector<QuantityRow>& quantities();
/// Throws std::invalid_argument that names the nearest known quantity.
const QuantityRow& find_quantity(std::string_view name);

}  // namespace app
