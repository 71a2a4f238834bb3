#include "sim/fast/pair_sums.h"

#include "sim/core/lanes.h"
#include "sim/core/parallel.h"

#include <algorithm>

namespace sim {

namespace {

enum class Part { residual, smooth };
constexpr int unrolled = PairLists::multiple;

/// A source as the loops read it: point, force, and for the double layer Q and its trace.
template <bool dual>
constexpr int record_size = dual ? 13 : 6;

template <class Real>
using Polynomials = std::array<std::array<Real, KernelSplit::most_degree + 1>, 4>;

/// Several polynomials at several arguments, interleaved so that no result waits for the last.
template <int degree, int kinds, class Real>
void evaluate(const Polynomials<Real>& p, const LaneOf<Real> (&x)[unrolled], int at, LaneOf<Real> (&value)[kinds][2]) {
  for (int kind = 0; kind < kinds; ++kind)
    for (int s = 0; s < 2; ++s) value[kind][s] = LaneOf<Real>{} + p[std::size_t(kind)][degree];
#pragma GCC unroll 32
  for (int n = degree - 1; n >= 0; --n)
    for (int kind = 0; kind < kinds; ++kind)
      for (int s = 0; s < 2; ++s) value[kind][s] = value[kind][s] * x[at + s] + p[std::size_t(kind)][std::size_t(n)];
}

/// Adds the listed sources at the targets of the lanes.
template <class Real, int degree, bool dual, Part part>
void add_sources(const Polynomials<Real>& polynomials, const Real* records, const std::uint16_t* list, int count,
                 const LaneOf<Real> (&x)[3], LaneOf<Real> (&velocity)[3]) {
  using V = LaneOf<Real>;
  constexpr int kinds = dual ? 4 : 2;
  V v0 = velocity[0], v1 = velocity[1], v2 = velocity[2];
  for (int first = 0; first < count; first += unrolled) {
    const Real* y[unrolled];
    V square[unrolled], tau[unrolled];
    for (int s = 0; s < unrolled; ++s) {
      y[s] = records + std::size_t(list[first + s]) * record_size<dual>;
      const V r0 = x[0] - y[s][0], r1 = x[1] - y[s][1], r2 = x[2] - y[s][2];
      square[s] = r0 * r0 + r1 * r1 + r2 * r2;
      tau[s] = Real(2) * square[s] - Real(1);
    }
    for (int pair = 0; pair < unrolled; pair += 2) {
      V value[kinds][2];
      evaluate<degree, kinds, Real>(polynomials, tau, pair, value);
      for (int k = 0; k < 2; ++k) {
        const Real* z = y[pair + k];
        const V r0 = x[0] - z[0], r1 = x[1] - z[1], r2 = x[2] - z[2];
        const auto inside = square[pair + k] < Real(1);
        const V inverse = Real(1) / lane_sqrt(square[pair + k]), inverse2 = inverse * inverse,
                inverse3 = inverse2 * inverse, none{};
        const auto chosen = [&](const V& whole, const V& smooth) {
          if constexpr (part == Part::smooth)
            return V(inside ? smooth : whole);
          else
            return V(inside ? whole - smooth : none);
        };
        const V even = chosen(inverse, value[0][k]);
        V along = chosen(inverse3, value[1][k]) * (r0 * z[3] + r1 * z[4] + r2 * z[5]);
        if constexpr (dual) {
          const V q0 = r0 * z[6] + r1 * z[7] + r2 * z[8], q1 = r0 * z[7] + r1 * z[9] + r2 * z[10],
                  q2 = r0 * z[8] + r1 * z[10] + r2 * z[11];
          const V cross = chosen(none, value[2][k]);
          along += chosen(inverse3 * inverse2, value[3][k]) * (r0 * q0 + r1 * q1 + r2 * q2) + cross * z[12];
          const V twice = cross + cross;
          v0 += twice * q0;
          v1 += twice * q1;
          v2 += twice * q2;
        }
        v0 += even * z[3] + along * r0;
        v1 += even * z[4] + along * r1;
        v2 += even * z[5] + along * r2;
      }
    }
  }
  velocity[0] = v0;
  velocity[1] = v1;
  velocity[2] = v2;
}

template <class Real>
using PairLoop = void (*)(const Polynomials<Real>&, const Real*, const std::uint16_t*, int, const LaneOf<Real> (&)[3],
                          LaneOf<Real> (&)[3]);

/// The loop for a degree, which is even.
template <class Real, bool dual, Part part, int degree = KernelSplit::least_degree>
PairLoop<Real> loop_of(int wanted) {
  if constexpr (degree < KernelSplit::most_degree) {
    if (wanted > degree) return loop_of<Real, dual, part, degree + 2>(wanted);
  }
  return add_sources<Real, degree, dual, part>;
}

/// All sources of one level of a body, and a point of no strength beyond the cut-off.
template <class Real, bool dual>
std::vector<Real> records_of(const PairLists::Level& level, const FastStrengths& s) {
  std::vector<Real> records;
  if (s.force.cols() == 0) return records;
  records.resize(std::size_t(record_size<dual>) * std::size_t(level.points.cols() + 1));
  Real* out = records.data();
  for (const int k : level.patches.order) {
    const Eigen::Index place = (out - records.data()) / record_size<dual>;
    for (int d = 0; d < 3; ++d) {
      out[d] = static_cast<Real>(level.points(d, place));
      out[3 + d] = static_cast<Real>(s.force(d, k));
    }
    if constexpr (dual) {
      if (s.dual.cols() > 0) {
        for (int c = 0; c < 6; ++c) out[6 + c] = static_cast<Real>(s.dual(c, k));
        out[12] = static_cast<Real>(s.dual(0, k) + s.dual(3, k) + s.dual(5, k));
      }
    }
    out += record_size<dual>;
  }
  constexpr Real far = 1000;
  out[0] = far;
  return records;
}

template <class Real, bool dual>
void add_all(const PairLists& lists, const KernelSplit& split, std::span<const FastStrengths> coarse,
             std::span<const FastStrengths> fine, std::vector<Points>& velocity) {
  Polynomials<Real> polynomials{};
  for (std::size_t kind = 0; kind < 4; ++kind)
    std::copy(split.polynomial(Radial(kind)).begin(), split.polynomial(Radial(kind)).end(), polynomials[kind].begin());
  std::array<std::vector<std::vector<Real>>, 2> records;
  for (auto& level : records) level.resize(lists.bodies.size());
  Eigen::Index most = 0;
  for (const auto& body : lists.bodies) most = std::max(most, body.levels[0].points.cols());
  parallel_for(static_cast<int>(lists.bodies.size()), [&](int j) {
    const auto& levels = lists.bodies[std::size_t(j)].levels;
    records[0][std::size_t(j)] = records_of<Real, dual>(levels[0], coarse[std::size_t(j)]);
    records[1][std::size_t(j)] = records_of<Real, dual>(levels[1], fine[std::size_t(j)]);
  });
  std::vector<std::uint16_t> all(std::size_t(most) + unrolled);
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<std::uint16_t>(k);
  const PairLoop<Real> residual = loop_of<Real, dual, Part::residual>(split.degree()),
                       smooth = loop_of<Real, dual, Part::smooth>(split.degree());
  parallel_for(static_cast<int>(lists.groups.size()), [&](int g) {
    const PairLists::Group& group = lists.groups[std::size_t(g)];
    Points& u = velocity[std::size_t(g)];
    for (const PairLists::Segment& s : group.segments) {
      const std::span<const int> members = group.patches.members(s.patch);
      const PairLists::Body& body = lists.bodies[std::size_t(s.body)];
      const PatchLanes<Real> targets = lanes_of<Real>(group.points, members, body.centre + s.shift);
      LaneOf<Real> v[3] = {};
      residual(polynomials, records[std::size_t(s.level)][std::size_t(s.body)].data(), &group.sources[s.first], s.count,
               targets.x, v);
      for (std::size_t l = 0; l < members.size(); ++l)
        if (s.lanes >> l & 1)
          for (int d = 0; d < 3; ++d) u(d, members[l]) += v[d][l];
    }
    for (const PairLists::Taken& taken : group.taken) {
      const PairLists::Body& body = lists.bodies[std::size_t(taken.body)];
      const std::vector<Real>& from = records[0][std::size_t(taken.body)];
      const auto count = static_cast<int>(body.levels[0].points.cols());
      const int whole = count / unrolled * unrolled;
      // The rest of the points, and then the one of no strength.
      std::uint16_t rest[unrolled];
      for (int k = 0; k < unrolled; ++k) rest[k] = static_cast<std::uint16_t>(std::min(whole + k, count));
      for (std::size_t first = 0; first < taken.targets.size(); first += lane_count<Real>) {
        const std::span<const int> members(taken.targets.begin() + std::ptrdiff_t(first),
                                           std::min<std::size_t>(lane_count<Real>, taken.targets.size() - first));
        const PatchLanes<Real> targets = lanes_of<Real>(group.points, members, body.centre + taken.shift);
        LaneOf<Real> v[3] = {};
        smooth(polynomials, from.data(), all.data(), whole, targets.x, v);
        if (whole < count) smooth(polynomials, from.data(), rest, unrolled, targets.x, v);
        for (std::size_t l = 0; l < members.size(); ++l)
          for (int d = 0; d < 3; ++d) u(d, members[l]) -= v[d][l];
      }
    }
  });
}

}  // namespace

void add_pairs(const PairLists& lists, const KernelSplit& split, bool dual, std::span<const FastStrengths> coarse,
               std::span<const FastStrengths> fine, std::vector<Points>& velocity) {
  if (lists.single_precision)
    (dual ? add_all<float, true> : add_all<float, false>)(lists, split, coarse, fine, velocity);
  else
    (dual ? add_all<double, true> : add_all<double, false>)(lists, split, coarse, fine, velocity);
}

}  // namespace sim
