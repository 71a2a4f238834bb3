// Single numbers that a run ends in, for studies of convergence: a catalogue of what is made from the history of a
// quantity, of its reductions to a number, and of distances between the final membranes of two runs.
#pragma once

#include "sim/core/catalogue.h"
#include "sim/core/types.h"

#include <string>
#include <variant>
#include <vector>

namespace app {

/// One value against time. Angles are continued, so that one that turns goes on beyond 180 degrees.
struct History {
  std::vector<double> times, values;
};

/// A history made a number; NaN where the run has no such number.
struct ReductionRow {
  std::string_view name;  ///< as in "energy:largest"
  std::string_view meaning;
  double (*reduce)(const History&);
};
/// The first is what a quantity without reduction means: its final value.
const std::vector<ReductionRow>& reductions();

/// Made from the history of a quantity of `quantities()`.
struct OfQuantity {
  std::string_view quantity;
  double (*reduce)(const History&);
  bool is_time = false;  ///< in the unit of the history's times, else in that of the quantity
};
/// Of a membrane and that of the most accurate run, both final, in area radii `length`.
struct OfMembranes {
  const char* subject;  ///< what has the error that the distance tells
  double (*distance)(const sim::VesicleState&, const sim::VesicleState& reference, double length);
};
struct ResultRow {
  std::string_view name, meaning;
  std::variant<OfQuantity, OfMembranes> source;
};
const std::vector<ResultRow>& results();

}  // namespace app
