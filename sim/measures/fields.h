// Scalar fields on a membrane for pictures: tension, curvatures, force densities, velocities, distance to the
// neighbours. All are functions of one saved state, given as coefficients of a higher degree than the surface, in the
// units of the scene; the caller divides by the scales it needs.
#pragma once

#include "sim/layers/near.h"
#include "sim/layers/plans.h"
#include "sim/surface/geometry.h"

#include "sim/core/catalogue.h"
#include "sim/core/cells.h"
#include "sim/core/parameters.h"

#include <limits>
#include <vector>

namespace sim {

/// Data that the vesicles of one state share when their fields are computed one after the other, and the periodic cell
/// they are in. Built on first use.
class Surroundings {
 public:
  struct Net;
  explicit Surroundings(const CellSides& = {});
  ~Surroundings();
  Surroundings(const Surroundings&) = delete;
  const std::vector<Net>& nets(const State&);
  const CellSides& cell() const { return cell_; }

 private:
  CellSides cell_;
  std::vector<Net> nets_;
};

/// One vesicle at one instant, on the grid on which its fields are sampled.
struct FieldSite {
  const Basis& basis;  ///< the surface's degree on the grid
  const Basis& full;   ///< the grid's own degree
  Geometry geometry;
  const State& state;
  std::size_t vesicle;  ///< within state
  double bending_modulus;
  Surroundings& surroundings;
};

/// The unit by which a field is divided to make it dimensionless.
enum class FieldScale {
  length,            ///< R0
  curvature,         ///< 1/R0
  square_curvature,  ///< 1/R0^2
  tension,           ///< kappa_b/R0^2
  force,             ///< kappa_b/R0^3
  velocity           ///< R0 times the rate of the flow; 1 without a rate
};

/// Value at every grid point.
using FieldFunction = Vector (*)(const FieldSite&);

struct FieldRow {
  std::string_view name, meaning;
  std::string_view symbol;  ///< with _{...} and ^{...} for subscripts and superscripts
  FieldScale scale;
  bool has_sign;          ///< zero is a distinguished value, to be visible in the colours
  bool needs_neighbours;  ///< needs at least two vesicles, or images
  FieldFunction function;
  double automatic_end = std::numeric_limits<double>::infinity();  ///< end of an automatic range, in the unit above
};
const std::vector<FieldRow>& field_catalogue();
/// Throws std::invalid_argument that names the nearest known field.
const FieldRow& find_field(std::string_view name);

/// The field of one vesicle, one column; `surroundings`: of this state. Throws std::invalid_argument when it needs
/// neighbours and there are none, and std::domain_error when the surface is not regular.
Coefficients membrane_field(Plans&, const FieldRow&, const State&, std::size_t vesicle, double bending_modulus,
                            Surroundings& surroundings);
inline Coefficients membrane_field(Plans& plans, const FieldRow& field, const State& state, std::size_t vesicle,
                                   double bending_modulus) {
  Surroundings surroundings;
  return membrane_field(plans, field, state, vesicle, bending_modulus, surroundings);
}

}  // namespace sim
