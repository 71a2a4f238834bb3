// Convergence of a result from a few runs of growing effort: the observed order, the limit, the error of each value.
//
// With a smallness h_k that falls from run to run (a step, a tolerance, exp(-p) of an order p), values
//   v_k = v + C h_k^q
// have differences whose ratio tells q, for any ratios of the h_k:
//   (v_1 - v_2)/(v_2 - v_3) = (h_1^q - h_2^q)/(h_2^q - h_3^q),   v = v_3 - (v_2 - v_3)/((h_2/h_3)^q - 1).
// The last formula is Richardson's; where the h_k fall by one factor, it is Aitken's.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace app {

enum class OrderVerdict {
  converges,   ///< order and limit are known
  settled,     ///< the last differences are within the noise: the limit is the last value
  slow,        ///< the differences fall, but too little to tell the limit
  grows,       ///< the differences do not fall
  alternates,  ///< they change sign; where they fall the limit lies between the last two values
  too_few,     ///< two values
  undefined,   ///< a value is not a number
};
/// "differences do not fall", for tables.
std::string_view text_of(OrderVerdict);

struct Convergence {
  OrderVerdict verdict = OrderVerdict::undefined;
  std::optional<double> order;  ///< q of the last three values
  std::optional<double> limit;  ///< v; the last value where no order tells it
  double uncertainty = 0;       ///< of the limit; without one: the largest of the last differences
  /// Of each value. With a limit the distance from it, else the largest distance from another of the last three.
  std::vector<double> errors;

  /// Without an order an error up to the uncertainty is not known.
  bool known(std::size_t k) const { return order.has_value() || errors[k] > (limit ? uncertainty : 0); }
};

/// smallness: positive, falling. noise: differences up to it mean nothing. expected: the order that theory gives; a
/// higher observed one, often chance, does not make the uncertainty smaller.
Convergence convergence_of(const std::vector<double>& smallness, const std::vector<double>& values, double noise = 0,
                           std::optional<double> expected = {});

/// q from three values; nothing where no positive q fits.
std::optional<double> observed_order(const double (&smallness)[3], const double (&values)[3]);

}  // namespace app
