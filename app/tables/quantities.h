// Quantities for time series and phase portraits: a catalogue of measures of saved states or of steps, each with one
// or more curves.
#pragma once

#include "render/figures/plot.h"
#include "sim/core/catalogue.h"
#include "sim/measures/diagnostics.h"
#include "sim/trajectory/trajectory.h"

namespace app {

/// Scales of quantities; 0: undefined, and quantities are shown without dividing by it.
struct QuantityUnits {
  double length = 1;           ///< area radius R0
  double rate = 0;             ///< of the flow, 1/time
  double bending_modulus = 0;  ///< kappa_b
};
enum class Scaling { nothing, rate, bending };  ///< which of them a quantity needs besides the length

/// Measures of a vesicle at a saved state; velocities are relative to its centre.
struct VesicleSample : sim::VesicleMeasures {
  double deformation = 0;  ///< (L - B) / (L + B) of the second moments in the shear plane
};

struct QuantityRow {
  std::string_view name, meaning;
  const char* axis;  ///< label
  render::Scale scale;
  std::vector<const char*> curves;  ///< names in a legend
  /// One value per curve, of a vesicle at a saved state; or
  std::vector<double> (*of_state)(const VesicleSample&, const QuantityUnits&);
  /// ... of a step. The second argument is the vesicle.
  std::vector<double> (*of_step)(const sim::StepRecord&, std::size_t, const QuantityUnits&);
  bool per_vesicle = true;    ///< else one curve for all
  bool differentiate = false; ///< the values are the rates of change of the function, per time / rate
  Scaling scaling = Scaling::nothing;
  const char* bare_axis = nullptr;  ///< label without that scale
};
std::string axis_label(const QuantityRow&, const QuantityUnits&);
const std::vector<QuantityRow>& quantities();
/// Throws std::invalid_argument that names the nearest known quantity.
const QuantityRow& find_quantity(std::string_view name);

}  // namespace app
