#include "sim/stepping/multistep.h"

namespace sim {

std::vector<double> lagrange(std::span<const double> nodes, double at) {
  std::vector<double> values(nodes.size(), 1.0);
  for (std::size_t j = 0; j < nodes.size(); ++j)
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (i != j) values[j] *= (at - nodes[i]) / (nodes[j] - nodes[i]);
  return values;
}

std::vector<double> lagrange_slopes(std::span<const double> nodes, double at) {
  std::vector<double> slopes(nodes.size(), 0.0);
  for (std::size_t j = 0; j < nodes.size(); ++j)
    for (std::size_t left_out = 0; left_out < nodes.size(); ++left_out) {
      if (left_out == j) continue;
      double product = 1 / (nodes[j] - nodes[left_out]);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        if (i != j && i != left_out) product *= (at - nodes[i]) / (nodes[j] - nodes[i]);
      slopes[j] += product;
    }
  return slopes;
}

Bdf bdf(std::span<const double> times, int order) {
  std::vector<double> nodes{0};
  nodes.insert(nodes.end(), times.begin(), times.begin() + order);
  const std::vector<double> slopes = lagrange_slopes(nodes, 0);
  Bdf formula{1 / slopes[0], {}};
  for (int j = 1; j <= order; ++j) formula.behind.push_back(-formula.c * slopes[j]);
  return formula;
}

double error_share(std::span<const double> times, int order) {
  return -times[0] / (bdf(times, order).c - times[order]);
}

}  // namespace sim
