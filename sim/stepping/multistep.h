// Weights of multistep formulas on levels at any distances in time: Lagrange polynomials, and the backward
// differentiation formulas that follow from them.
//
// Levels are given by their times relative to the new one, all negative and the latest first; the new time is 0. With
// d_0 the slope there of the polynomial that is 1 at the new time and 0 at k levels, and d_j those of the levels, BDF
// of order k is
//   u+ = (x+ - h)/c,   c = 1/d_0,   h = -c sum_j d_j x_j.
// Its local error follows from how far x+ lies from the polynomial P through one level more (Milne's device):
//   e_k = dt/(c - t_k) (x+ - P(0)),   the share of the error of x' over dt that order k leaves, for steps of any
//   length.
#pragma once

#include <span>
#include <vector>

namespace sim {

/// Values at a time of the polynomials that are 1 at one node and 0 at the others; and their slopes.
std::vector<double> lagrange(std::span<const double> nodes, double at);
std::vector<double> lagrange_slopes(std::span<const double> nodes, double at);

struct Bdf {
  double c = 0;
  std::vector<double> behind;  ///< h = sum_j behind_j x_j
};
/// Of an order that is at most the number of levels.
Bdf bdf(std::span<const double> times, int order);

/// e_k / (x+ - P(0)); needs order + 1 levels.
double error_share(std::span<const double> times, int order);

}  // namespace sim
