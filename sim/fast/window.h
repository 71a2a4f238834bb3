// The window by which points are spread over a mesh and read from it: a prolate function that covers `width` nodes in
// each direction. In units of the mesh width; value and slope are one polynomial for each of the nodes.
#pragma once

#include "sim/fast/kernel_split.h"

namespace sim {

/// Nodes and weights with which sum w cos(k x) is the transform of an even function.
struct CosineRule {
  std::vector<double> node, weight;
  double operator()(double k) const;
};

class Window {
 public:
  /// The bandwidth with the least aliasing, for a mesh that resolves wave numbers up to `oversampling` times the
  /// split's.
  Window(int width, const KernelSplit&, double oversampling);

  static constexpr int most = 16;  ///< nodes
  int width() const { return width_; }
  /// Values at the nodes, and slopes unless null; z in [0, 1): the first node's distance from the lower end.
  void evaluate(double z, double* values, double* slopes) const;
  double transform(double k) const { return transform_(k); }  ///< Fourier transform at the wave number k

 private:
  int width_, degree_;
  std::vector<double> coefficients_;  ///< [slope][degree][node]
  CosineRule transform_;
};

}  // namespace sim
