// What a simulation is measured by, for figures against time and phase portraits: a catalogue of quantities, of saved states
// or of steps, each of one or more curves.
#pragma once

#include "render/plot.h"
#include "sim/catalogue.h"
#include "sim/diagnostics.h"
#include "sim/trajectory.h"

namespace app {

/// Scales in which quantities are shown; 0: there is none, and what would be divided by it is shown as it is.
struct QuantityUnits {
  double length = 1;           ///< area radius R0
  double rate = 0;             ///< of the flow, 1/time
  double bending_modulus = 0;  ///< kappa_b
};
enum class Scaling { nothing, rate, bending };  ///< which of them a quantity needs beside the length

/// What is known of a vesicle at a saved state; velocities are relative to its centre.
struct VesicleSample : sim::VesicleMeasures {
  double deformation = 0;  ///< (L - B) / (L + B) of the second moments in the shear plane
};

struct QuantityRow {
  std::string_view name, meaning;
  const char* axis;  ///< label
  render::Scale scale;
  std::vector<const char*> curves;  ///< names in a legend
  /// One value a curve, of a vesicle at a saved state; or
  std::vector<double> (*of_state)(const VesicleSample&, const QuantityUnits&);
  /// ... of a step. The second argument is the vesicle.
  std::vector<double> (*of_step)(const sim::StepRecord&, std::size_t, const QuantityUnits&);
  bool per_vesicle = true;    ///< else one curve for all
  bool differentiate = false; ///< the values are the rates of change of what the function gives, per time / rate
  Scaling scaling = Scaling::nothing;
  const char* bare_axis = nullptr;  ///< label without that scale
};
std::string axis_label(const QuantityRow&, const QuantityUnits&);
const std::vector<QuantityRow>& quantities();
/// Throws std::invalid_argument that names the nearest known quantity.
const QuantityRow& find_quantity(std::string_view name);

}  // namespace app
