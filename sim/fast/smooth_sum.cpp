#include "sim/fast/smooth_sum.h"

#include "sim/core/lanes.h"

#include <algorithm>

namespace sim {

namespace {

/// 0 where there is no double layer.
template <bool dual>
void subtract(const KernelSplit& split, const Points& y, const FastStrengths& s, const Points& targets,
              Points& velocity) {
  constexpr std::size_t kinds = dual ? 4 : 2;
  const double* p[4];
  for (std::size_t kind = 0; kind < 4; ++kind) p[kind] = split.polynomial(Radial(kind)).data();
  const int degree = split.degree();
  for (Eigen::Index first = 0; first < targets.cols(); first += lanes) {
    Lane x[3], v[3] = {};
    for (int d = 0; d < 3; ++d) {
      double place[lanes];
      for (int lane = 0; lane < lanes; ++lane) place[lane] = targets(d, std::min(first + lane, targets.cols() - 1));
      x[d] = load_lane(place);
    }
    for (Eigen::Index k = 0; k < y.cols(); ++k) {
      const Lane r0 = x[0] - y(0, k), r1 = x[1] - y(1, k), r2 = x[2] - y(2, k);
      const Lane square = r0 * r0 + r1 * r1 + r2 * r2, tau = 2.0 * square - 1.0;
      const auto inside = square < 1.0;
      const Lane inverse = 1.0 / lane_sqrt(square), inverse2 = inverse * inverse, inverse3 = inverse2 * inverse, none{};
      const Lane whole[4] = {inverse, inverse3, none, inverse3 * inverse2};
      Lane value[kinds];
      for (std::size_t kind = 0; kind < kinds; ++kind) {
        Lane sum = none + p[kind][degree];
        for (int n = degree - 1; n >= 0; --n) sum = sum * tau + p[kind][n];
        value[kind] = inside ? sum : whole[kind];
      }
      Lane along = value[1] * (r0 * s.force(0, k) + r1 * s.force(1, k) + r2 * s.force(2, k));
      if constexpr (dual) {
        const auto q = s.dual.col(k);
        const Lane q0 = r0 * q[0] + r1 * q[1] + r2 * q[2], q1 = r0 * q[1] + r1 * q[3] + r2 * q[4],
                   q2 = r0 * q[2] + r1 * q[4] + r2 * q[5];
        along += value[3] * (r0 * q0 + r1 * q1 + r2 * q2) + value[2] * (q[0] + q[3] + q[5]);
        const Lane twice = 2.0 * value[2];
        v[0] += twice * q0;
        v[1] += twice * q1;
        v[2] += twice * q2;
      }
      v[0] += value[0] * s.force(0, k) + along * r0;
      v[1] += value[0] * s.force(1, k) + along * r1;
      v[2] += value[0] * s.force(2, k) + along * r2;
    }
    for (int lane = 0; lane < lanes && first + lane < targets.cols(); ++lane)
      for (int d = 0; d < 3; ++d) velocity(d, first + lane) -= v[d][lane];
  }
}

}  // namespace

void subtract_smooth(const KernelSplit& split, const Points& sources, const FastStrengths& s, const Points& targets,
                     Points& velocity) {
  (s.dual.cols() > 0 ? subtract<true> : subtract<false>)(split, sources, s, targets, velocity);
}

}  // namespace sim
