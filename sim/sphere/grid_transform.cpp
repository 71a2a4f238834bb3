#include "sim/sphere/grid_transform.h"

#include "sim/sphere/fourier_sums.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

namespace sim {

namespace {

using std::numbers::pi;

/// The first `count` lanes, the others 0.
Lane load_some(const double* from, int count) {
  Lane v{};
  switch (count) {
    case 1:
      __builtin_memcpy(&v, from, sizeof(double));
      return v;
    case 2:
      __builtin_memcpy(&v, from, 2 * sizeof(double));
      return v;
    case 3:
      __builtin_memcpy(&v, from, 3 * sizeof(double));
      return v;
    default:
      return load_lane(from);
  }
}

void store_some(double* to, Lane v, int count) {
  switch (count) {
    case 1:
      __builtin_memcpy(to, &v, sizeof(double));
      return;
    case 2:
      __builtin_memcpy(to, &v, 2 * sizeof(double));
      return;
    case 3:
      __builtin_memcpy(to, &v, 3 * sizeof(double));
      return;
    default:
      store_lane(to, v);
  }
}

/// Calls f with the widths 3, 3, ... and the rest of 1 or 2 as constants, and where each starts.
template <class F>
void in_threes(int count, F&& f) {
  int at = 0;
  for (; at + 3 <= count; at += 3) f(std::integral_constant<int, 3>{}, at);
  if (count - at == 2) f(std::integral_constant<int, 2>{}, at);
  if (count - at == 1) f(std::integral_constant<int, 1>{}, at);
}

/// ... 4, 4, ... and the rest.
template <class F>
void in_fours(int count, F&& f) {
  int at = 0;
  for (; at + 4 <= count; at += 4) f(std::integral_constant<int, 4>{}, at);
  in_threes(count - at, [&](auto width, int from) { f(width, at + from); });
}

/// out[r] = sum_k a[r][k] b[k] for R rows of scalars and W vectors.
template <int R, int W>
void scalar_rows(const double* a, int depth, const Lane* b, std::ptrdiff_t b_row, Lane* out, std::ptrdiff_t out_row) {
  Pack<W> x, y, z;
  for (int k = 0; k < depth; ++k, b += b_row) {
    x.add(a[k], b);
    if constexpr (R > 1) y.add(a[depth + k], b);
    if constexpr (R > 2) z.add(a[2 * depth + k], b);
  }
  x.store(out);
  if constexpr (R > 1) y.store(out + out_row);
  if constexpr (R > 2) z.store(out + 2 * out_row);
}

/// Where the vectors of a group go on the first longitude; only some lanes of the last of a column are kept.
template <int W>
struct Columns {
  double* to[W];
  int kept[W];
  bool whole = true;

  void write(std::ptrdiff_t at, const Pack<W>& v) const {
    if (whole) {
      store_lane(to[0] + at, v.a);
      if constexpr (W > 1) store_lane(to[1] + at, v.b);
      if constexpr (W > 2) store_lane(to[2] + at, v.c);
    } else {
      store_some(to[0] + at, v.a, kept[0]);
      if constexpr (W > 1) store_some(to[1] + at, v.b, kept[1]);
      if constexpr (W > 2) store_some(to[2] + at, v.c, kept[2]);
    }
  }
};

/// R scalar products of vectors of `count` lanes, rows of a following each other.
template <int R>
Lane scalar_products(const Lane* a, const Lane* b, int count) {
  Lane sum[4] = {};
  for (int v = 0; v < count; ++v)
    for (int r = 0; r < R; ++r) sum[r] += a[r * count + v] * b[v];
  return lane_sums(sum[0], sum[1], sum[2], sum[3]);
}

}  // namespace

GridTransform::GridTransform(int order, const GaussLegendre& rule, int longitudes, bool dense)
    : p_(order),
      nlat_(int(rule.theta.size())),
      nlon_(longitudes),
      lanes_((nlat_ + lanes - 1) / lanes),
      legendre_{LaneBuffer(std::size_t(legendre_count(p_)) * lanes_),
                LaneBuffer(std::size_t(legendre_count(p_)) * lanes_),
                LaneBuffer(std::size_t(legendre_count(p_)) * lanes_)},
      weighted_(std::size_t(legendre_count(p_)) * lanes_) {
  const LegendreTable table = legendre_table(p_, rule.theta);
  const Matrix* const tables[] = {&table.value, &table.d1, &table.d2};
  for (Eigen::Index k = 0; k < legendre_count(p_); ++k)
    for (int v = 0; v < lanes_; ++v)
      for (int e = 0; e < lanes; ++e) {
        const int i = v * lanes + e;
        for (int t = 0; t < 3; ++t) legendre_[t].get()[k * lanes_ + v][e] = i < nlat_ ? (*tables[t])(i, k) : 0;
        weighted_.get()[k * lanes_ + v][e] = i < nlat_ ? table.value(i, k) * rule.weight[i] * (2 * pi / nlon_) : 0;
      }
  if (!dense) return;
  for (int l = 0; 4 * l <= nlon_; ++l) {
    Orbit orbit{{l, (nlon_ - l) % nlon_, nlon_ / 2 - l, nlon_ / 2 + l}};
    if (l == 0) orbit.index[1] = orbit.index[3] = -1;
    if (4 * l == nlon_) orbit.index[2] = orbit.index[3] = -1;
    orbits_.push_back(orbit);
    for (int d = 0; d < 3; ++d) append_fourier_row(fourier_[d], p_, l, nlon_, d);
  }
}

void GridTransform::along_latitudes(const double* coefficients, int degree, int fields, TableRange range,
                                    Lane* spectrum) const {
  const Eigen::Index count = coefficient_count(degree);
  const std::ptrdiff_t row = std::ptrdiff_t(range.count()) * fields * lanes_;
  std::vector<double> gathered(std::size_t(degree + 1) * 3);
  for (int m = 0; m <= degree; ++m) {
    const int depth = degree - m + 1;
    for (const int sign : {1, -1}) {
      if (m == 0 && sign < 0) continue;
      Lane* out = spectrum + (sign > 0 ? m : p_ + m) * row;
      in_threes(fields, [&](auto height, int field) {
        constexpr int R = decltype(height)::value;
        for (int r = 0; r < R; ++r)
          for (int n = m; n <= degree; ++n)
            gathered[std::size_t(r) * depth + n - m] =
                coefficients[(field + r) * count + coefficient_index(n, sign * m)];
        for (int t = range.first; t < range.last; ++t)
          in_fours(lanes_, [&](auto width, int lane) {
            scalar_rows<R, decltype(width)::value>(
                gathered.data(), depth, legendre_[t].get() + first_of(m) * lanes_ + lane, lanes_,
                out + (std::ptrdiff_t(t - range.first) * fields + field) * lanes_ + lane, lanes_);
          });
      });
    }
  }
}

void GridTransform::around(const Lane* spectrum, int degree, int fields, TableRange made, const Wanted& wanted) const {
  const std::ptrdiff_t row = std::ptrdiff_t(made.count()) * fields * lanes_;
  const int width = 2 * p_ + 1, last = nlat_ - (lanes_ - 1) * lanes;
  for (int d = 0; d < 3; ++d) {
    const TableRange range = wanted.tables[d];
    const int vectors = range.count() * fields * lanes_;
    const Lane* first = spectrum + std::ptrdiff_t(range.first - made.first) * fields * lanes_;
    in_threes(vectors, [&](auto group, int at) {
      constexpr int W = decltype(group)::value;
      Columns<W> columns;
      for (int w = 0; w < W; ++w) {
        const int column = (at + w) / lanes_, lane = (at + w) % lanes_;
        columns.to[w] = wanted.out[d][range.first + column / fields] + std::ptrdiff_t(column % fields) * nlat_ * nlon_ +
                        lane * lanes;
        columns.kept[w] = lane == lanes_ - 1 ? last : lanes;
        columns.whole = columns.whole && columns.kept[w] == lanes;
      }
      const Lane* cosines = first + at;
      const Lane* sines = cosines + p_ * row;
      if (d == 1) std::swap(cosines, sines);
      const double* table = fourier_[d].data();
      const std::ptrdiff_t half = nlon_ / 2;
      for (std::size_t l = 0; l < orbits_.size(); ++l, table += width) {
        const Mirrored<W> f = fourier_sums<W>(table, p_, degree, d == 0, cosines, sines, row);
        const int* index = orbits_[l].index;
        columns.write(std::ptrdiff_t(l) * nlat_, f.member[0]);
        if (index[1] >= 0) columns.write((nlon_ - std::ptrdiff_t(l)) * nlat_, f.member[1]);
        if (index[2] >= 0) columns.write((half - std::ptrdiff_t(l)) * nlat_, f.member[2]);
        if (index[3] >= 0) columns.write((half + std::ptrdiff_t(l)) * nlat_, f.member[3]);
      }
    });
  }
}

void GridTransform::spectrum_of(const double* samples, int fields, Lane* spectrum) const {
  const int vectors = fields * lanes_, width = 2 * p_ + 1, last = nlat_ - (lanes_ - 1) * lanes;
  const int orbits = int(orbits_.size());
  LaneBuffer folded(std::size_t(orbits) * 4 * 3);
  in_threes(vectors, [&](auto group, int at) {
    constexpr int W = decltype(group)::value;
    Lane* const sums = folded.get();  // [cos even, cos odd, sin even, sin odd][orbit][W]
    const std::ptrdiff_t kind = std::ptrdiff_t(orbits) * W;
    for (int w = 0; w < W; ++w) {
      const int field = (at + w) / lanes_, lane = (at + w) % lanes_;
      const double* from = samples + std::ptrdiff_t(field) * nlat_ * nlon_ + lane * lanes;
      const auto fold = [&](auto kept) {
        const auto member = [&](std::ptrdiff_t j) { return load_some(from + j * nlat_, kept); };
        for (int l = 0; l < orbits; ++l) {
          const bool on_axis = l == 0, across = 4 * l == nlon_;
          const Lane f = member(l), g = on_axis ? Lane{} : member(nlon_ - l),
                     h = across ? Lane{} : member(nlon_ / 2 - l),
                     i = on_axis || across ? Lane{} : member(nlon_ / 2 + l);
          const Lane a = f + g, b = h + i, c = f - g, d = h - i;
          Lane* to = sums + l * W + w;
          to[0] = a + b;
          to[kind] = a - b;
          to[2 * kind] = c - d;
          to[3 * kind] = c + d;
        }
      };
      if (lane < lanes_ - 1 || last == lanes)
        fold(std::integral_constant<int, lanes>{});
      else
        fold(last);
    }
    for (int part = 0; part < 4; ++part) {
      const int start = part == 0 ? 0 : part == 2 ? 2 : 1;
      const int rows = start > p_ ? 0 : (p_ - start) / 2 + 1, first = start + (part < 2 ? 0 : p_);
      in_fours(rows, [&](auto height, int r0) {
        constexpr int R = decltype(height)::value;
        Pack<W> s, t, u, v;
        const double* table = fourier_[0].data() + first + 2 * r0;
        const Lane* x = sums + part * kind;
        for (int l = 0; l < orbits; ++l, table += width, x += W) {
          s.add(table[0], x);
          if constexpr (R > 1) t.add(table[2], x);
          if constexpr (R > 2) u.add(table[4], x);
          if constexpr (R > 3) v.add(table[6], x);
        }
        Lane* out = spectrum + std::ptrdiff_t(first + 2 * r0) * vectors + at;
        s.store(out);
        if constexpr (R > 1) t.store(out + 2 * vectors);
        if constexpr (R > 2) u.store(out + 4 * vectors);
        if constexpr (R > 3) v.store(out + 6 * vectors);
      });
    }
  });
}

void GridTransform::project(const Lane* spectrum, int fields, double* coefficients) const {
  const std::ptrdiff_t row = std::ptrdiff_t(fields) * lanes_, count = coefficient_count(p_);
  for (int m = 0; m <= p_; ++m)
    for (const int sign : {1, -1}) {
      if (m == 0 && sign < 0) continue;
      for (int field = 0; field < fields; ++field) {
        const Lane* in = spectrum + (sign > 0 ? m : p_ + m) * row + field * lanes_;
        double* out = coefficients + field * count;
        in_fours(p_ - m + 1, [&](auto height, int n) {
          constexpr int R = decltype(height)::value;
          const Lane sums = scalar_products<R>(weighted_.get() + (first_of(m) + n) * lanes_, in, lanes_);
          for (int r = 0; r < R; ++r) out[coefficient_index(m + n + r, sign * m)] = sums[r];
        });
      }
    }
}

}  // namespace sim
