#include "sim/sphere/grid_transform.h"

#include "sim/core/parallel.h"
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

/// One of these calls.
template <class F>
void in_three(int count, int call, F&& f) {
  const int at = 3 * call, rest = count - at;
  if (rest >= 3) return f(std::integral_constant<int, 3>{}, at);
  if (rest == 2) return f(std::integral_constant<int, 2>{}, at);
  f(std::integral_constant<int, 1>{}, at);
}
int threes(int count) { return (count + 2) / 3; }

/// ... 4, 4, ... and the rest.
template <class F>
void in_fours(int count, F&& f) {
  int at = 0;
  for (; at + 4 <= count; at += 4) f(std::integral_constant<int, 4>{}, at);
  in_threes(count - at, [&](auto width, int from) { f(width, at + from); });
}

/// Calls f with widths of 1 to 3 as constants, none of which is 1 unless `count` is.
template <class F>
void in_pairs_or_threes(int count, F&& f) {
  int at = 0;
  for (; count - at > 4 || count - at == 3; at += 3) f(std::integral_constant<int, 3>{}, at);
  for (; count - at >= 2; at += 2) f(std::integral_constant<int, 2>{}, at);
  if (count > at) f(std::integral_constant<int, 1>{}, at);
}

/// ... of 2, and the rest.
template <class F>
void in_twos(int count, F&& f) {
  int at = 0;
  for (; at + 2 <= count; at += 2) f(std::integral_constant<int, 2>{}, at);
  if (count > at) f(std::integral_constant<int, 1>{}, at);
}

Lane reversed(Lane v) { return __builtin_shufflevector(v, v, 3, 2, 1, 0); }

/// Where sums of functions of the latitude go: their sum to a vector, and where that has a mirror the difference to it.
struct Mirrors {
  int vectors, mirrored, first;
  bool odd;  ///< functions that are even in z have odd derivatives

  template <int W>
  void write(Lane* row, const Pack<W>& even, const Pack<W>& uneven) const {
    (even + uneven).store(row + first);
    const Pack<W> mirror = odd ? uneven - even : even - uneven;
    Lane* const last = row + vectors - 1 - first;
    if (first < mirrored) last[0] = reversed(mirror.a);
    if constexpr (W > 1)
      if (first + 1 < mirrored) last[-1] = reversed(mirror.b);
    if constexpr (W > 2)
      if (first + 2 < mirrored) last[-2] = reversed(mirror.c);
  }
};

/// Sums over k of a[r][k] b[k] for R rows of scalars and W vectors, of even and odd k on their own.
template <int R, int W>
void mirrored_rows(const double* a, int depth, const Lane* b, std::ptrdiff_t b_row, Lane* const* out,
                   std::ptrdiff_t out_at, const Mirrors mirrors) {
  Pack<W> even, odd, other_even, other_odd;
  int k = 0;
  for (; k + 2 <= depth; k += 2, b += 2 * b_row) {
    even.add(a[k], b);
    if constexpr (R > 1) other_even.add(a[depth + k], b);
    odd.add(a[k + 1], b + b_row);
    if constexpr (R > 1) other_odd.add(a[depth + k + 1], b + b_row);
  }
  if (k < depth) {
    even.add(a[k], b);
    if constexpr (R > 1) other_even.add(a[depth + k], b);
  }
  mirrors.write(out[0] + out_at, even, odd);
  if constexpr (R > 1) mirrors.write(out[1] + out_at, other_even, other_odd);
}

/// Where the vectors of a group go on the first longitude. `kept`: their lanes, if not all.
template <int W>
struct Columns {
  double* to[W];
  int kept;
  std::ptrdiff_t latitudes;

  template <bool whole>
  void write(std::ptrdiff_t longitude, const Pack<W>& v) const {
    const std::ptrdiff_t at = longitude * latitudes;
    if constexpr (whole) {
      store_lane(to[0] + at, v.a);
      if constexpr (W > 1) store_lane(to[1] + at, v.b);
      if constexpr (W > 2) store_lane(to[2] + at, v.c);
    } else {
      store_some(to[0] + at, v.a, kept);
      if constexpr (W > 1) store_some(to[1] + at, v.b, kept);
      if constexpr (W > 2) store_some(to[2] + at, v.c, kept);
    }
  }
};

/// A Fourier half of a spectrum: its rows of cosines and sines, counted from m = 0.
struct Series {
  const Lane *cosines, *sines;
  std::ptrdiff_t row;
  int degree;
  bool mean;
};

/// Fourier synthesis at all longitudes, orbit by orbit.
template <bool whole, int W>
void write_orbits(const double* table, int p, const Series series, int longitudes, const Columns<W> columns) {
  const std::ptrdiff_t width = 2 * p + 1, half = longitudes / 2;
  for (std::ptrdiff_t l = 0; 4 * l <= longitudes; ++l) {
    const Mirrored<W> f =
        fourier_sums<W>(table + l * width, p, series.degree, series.mean, series.cosines, series.sines, series.row);
    columns.template write<whole>(l, f.member[0]);
    if (l == 0) {
      columns.template write<whole>(half, f.member[2]);
      continue;
    }
    columns.template write<whole>(longitudes - l, f.member[1]);
    if (4 * l == longitudes) return;
    columns.template write<whole>(half - l, f.member[2]);
    columns.template write<whole>(half + l, f.member[3]);
  }
}

/// Sums of samples over the mirrors of every orbit, [cos even, cos odd, sin even, sin odd][orbit][width]: one of the
/// vectors. `kept`: lanes, a constant where it is all.
template <class Kept>
void fold_orbits(const double* from, std::ptrdiff_t latitudes, std::ptrdiff_t longitudes, Kept kept, Lane* sums,
                 std::ptrdiff_t width) {
  const std::ptrdiff_t half = longitudes / 2, kind = (longitudes / 4 + 1) * width;
  const auto member = [=](std::ptrdiff_t j) { return load_some(from + j * latitudes, kept); };
  const auto write = [=](std::ptrdiff_t l, Lane f, Lane g, Lane h, Lane i) {
    const Lane a = f + g, b = h + i, c = f - g, d = h - i;
    Lane* to = sums + l * width;
    to[0] = a + b;
    to[kind] = a - b;
    to[2 * kind] = c - d;
    to[3 * kind] = c + d;
  };
  write(0, member(0), Lane{}, member(half), Lane{});
  std::ptrdiff_t l = 1;
  for (; 4 * l < longitudes; ++l) write(l, member(l), member(longitudes - l), member(half - l), member(half + l));
  if (4 * l == longitudes) write(l, member(l), member(longitudes - l), Lane{}, Lane{});
}

/// R scalar products of vectors of `count` lanes, rows of a following each other: in turn with b and c.
template <int R>
Lane scalar_products(const Lane* a, const Lane* b, const Lane* c, int count) {
  Lane sum[4] = {};
  for (int v = 0; v < count; ++v)
    for (int r = 0; r < R; ++r) sum[r] += a[r * count + v] * (r % 2 == 0 ? b[v] : c[v]);
  return lane_sums(sum[0], sum[1], sum[2], sum[3]);
}

}  // namespace

GridTransform::GridTransform(int order, const GaussLegendre& rule, int longitudes, bool dense)
    : p_(order),
      nlat_(int(rule.theta.size())),
      nlon_(longitudes),
      lanes_((nlat_ + lanes - 1) / lanes),
      mirrored_(nlat_ / (2 * lanes)),
      made_(lanes_ - mirrored_),
      legendre_{LaneBuffer(std::size_t(legendre_count(p_)) * made_),
                LaneBuffer(std::size_t(legendre_count(p_)) * made_),
                LaneBuffer(std::size_t(legendre_count(p_)) * made_)},
      weighted_(std::size_t(legendre_count(p_)) * made_) {
  const LegendreTable table = legendre_table(p_, rule.theta);
  const Matrix* const tables[] = {&table.value, &table.d1, &table.d2};
  for (Eigen::Index k = 0; k < legendre_count(p_); ++k)
    for (int v = 0; v < made_; ++v)
      for (int e = 0; e < lanes; ++e) {
        const int i = first_latitude(v) + e;
        for (int t = 0; t < 3; ++t) legendre_[t].get()[k * made_ + v][e] = i < nlat_ ? (*tables[t])(i, k) : 0;
        const bool own = i < nlat_ && (v + 1 == lanes_ || i < first_latitude(v + 1));
        weighted_.get()[k * made_ + v][e] = own ? table.value(i, k) * rule.weight[i] * (2 * pi / nlon_) : 0;
      }
  if (!dense) return;
  for (int l = 0; l < orbits(); ++l)
    for (int d = 0; d < 3; ++d) append_fourier_row(fourier_[d], p_, l, nlon_, d);
}

Vector GridTransform::latitudes_of(const Lane* row) const {
  Vector values(nlat_);
  for (int v = 0; v < lanes_; ++v)
    for (int e = 0; e < kept(); ++e) values[first_latitude(v) + e] = row[v][e];
  return values;
}

void GridTransform::set_latitudes(const Vector& values, Lane* row) const {
  for (int v = 0; v < lanes_; ++v) row[v] = load_some(values.data() + first_latitude(v), kept());
}

void GridTransform::along_latitudes(const double* coefficients, int degree, int fields, TableRange range,
                                    Lane* spectrum) const {
  const Eigen::Index count = coefficient_count(degree);
  const std::ptrdiff_t row = std::ptrdiff_t(range.count()) * fields * lanes_;
  shared_for(degree + 1, 2.0 * lanes * count * fields * range.count() * made_, [&](int m) {
    const Scratch<double, 1024> gathered(std::size_t(degree + 1) * 2 * fields);
    const Scratch<Lane*, 64> out(std::size_t(2) * fields);
    const int depth = degree - m + 1, rows = (m == 0 ? 1 : 2) * fields;
    for (int r = 0; r < rows; ++r) {
      const int field = r % fields, sign = r < fields ? 1 : -1;
      const double* c = coefficients + field * count;
      for (int n = m; n <= degree; ++n)
        gathered.get()[std::size_t(r) * depth + n - m] = c[coefficient_index(n, sign * m)];
      out.get()[r] = spectrum + (sign > 0 ? m : p_ + m) * row + field * lanes_;
    }
    for (int t = range.first; t < range.last; ++t) {
      const Lane* table = legendre_[t].get() + first_of(m) * made_;
      const std::ptrdiff_t start = std::ptrdiff_t(t - range.first) * fields * lanes_;
      in_pairs_or_threes(made_, [=, this, &gathered, &out](auto width, int vector) {
        const Mirrors mirrors{lanes_, mirrored_, vector, t == 1};
        in_twos(rows, [=, this, &gathered, &out](auto height, int r) {
          mirrored_rows<decltype(height)::value, decltype(width)::value>(
              gathered.get() + r * depth, depth, table + vector, made_, out.get() + r, start, mirrors);
        });
      });
    }
  });
}

void GridTransform::around(const Lane* spectrum, int degree, int fields, TableRange made, const Wanted& wanted) const {
  const std::ptrdiff_t row = std::ptrdiff_t(made.count()) * fields * lanes_;
  const auto vectors = [&](int d) { return wanted.tables[d].count() * fields * lanes_; };
  const int all = vectors(0) + vectors(1) + vectors(2),
            calls = threes(vectors(0)) + threes(vectors(1)) + threes(vectors(2));
  shared_for(calls, double(orbits()) * (2 * degree + 1) * all * lanes, [&](int call) {
    int d = 0;
    for (; call >= threes(vectors(d)); ++d) call -= threes(vectors(d));
    const TableRange range = wanted.tables[d];
    const Lane* first = spectrum + std::ptrdiff_t(range.first - made.first) * fields * lanes_;
    in_three(vectors(d), call, [&](auto group, int at) {
      constexpr int W = decltype(group)::value;
      Columns<W> columns;
      columns.latitudes = nlat_;
      columns.kept = kept();
      for (int w = 0; w < W; ++w) {
        const int column = (at + w) / lanes_, vector = (at + w) % lanes_;
        columns.to[w] = wanted.out[d][range.first + column / fields] + std::ptrdiff_t(column % fields) * nlat_ * nlon_ +
                        first_latitude(vector);
      }
      Series series{first + at, first + at + p_ * row, row, degree, d == 0};
      if (d == 1) std::swap(series.cosines, series.sines);
      if (columns.kept == lanes)
        write_orbits<true, W>(fourier_[d].data(), p_, series, nlon_, columns);
      else
        write_orbits<false, W>(fourier_[d].data(), p_, series, nlon_, columns);
    });
  });
}

void GridTransform::spectrum_of(const double* samples, int fields, Lane* spectrum) const {
  const int vectors = fields * lanes_, width = 2 * p_ + 1;
  const int count = orbits();
  const auto of_group = [&](auto group, int at) {
    constexpr int W = decltype(group)::value;
    const LaneScratch folded(std::size_t(count) * 4 * W);
    Lane* const sums = folded.get();
    const std::ptrdiff_t kind = std::ptrdiff_t(count) * W;
    for (int w = 0; w < W; ++w) {
      const int field = (at + w) / lanes_, vector = (at + w) % lanes_;
      const double* from = samples + std::ptrdiff_t(field) * nlat_ * nlon_ + first_latitude(vector);
      if (kept() == lanes)
        fold_orbits(from, nlat_, nlon_, std::integral_constant<int, lanes>{}, sums + w, W);
      else
        fold_orbits(from, nlat_, nlon_, kept(), sums + w, W);
    }
    for (int part = 0; part < 4; ++part) {
      const int start = part == 0 ? 0 : part == 2 ? 2 : 1;
      const int rows = start > p_ ? 0 : (p_ - start) / 2 + 1, first = start + (part < 2 ? 0 : p_);
      in_fours(rows, [&](auto height, int r0) {
        constexpr int R = decltype(height)::value;
        Pack<W> s, t, u, v;
        const double* table = fourier_[0].data() + first + 2 * r0;
        const Lane* x = sums + part * kind;
        for (int l = 0; l < count; ++l, table += width, x += W) {
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
  };
  shared_for(threes(vectors), double(count) * width * vectors * lanes,
             [&](int call) { in_three(vectors, call, of_group); });
}

void GridTransform::project(const Lane* spectrum, int fields, double* coefficients) const {
  const std::ptrdiff_t row = std::ptrdiff_t(fields) * lanes_, count = coefficient_count(p_);
  shared_for(p_ + 1, 2.0 * lanes * count * fields * made_, [&](int m) {
    const Scratch<Lane, 64> folded(std::size_t(2) * made_);
    Lane *const even = folded.get(), *const odd = even + made_;  // in z
    for (const int sign : {1, -1}) {
      if (m == 0 && sign < 0) continue;
      for (int field = 0; field < fields; ++field) {
        const Lane* in = spectrum + (sign > 0 ? m : p_ + m) * row + field * lanes_;
        for (int v = 0; v < mirrored_; ++v) {
          const Lane mirror = reversed(in[lanes_ - 1 - v]);
          even[v] = in[v] + mirror;
          odd[v] = in[v] - mirror;
        }
        for (int v = mirrored_; v < made_; ++v) even[v] = odd[v] = in[v];
        double* out = coefficients + field * count;
        in_fours(p_ - m + 1, [&](auto height, int n) {
          constexpr int R = decltype(height)::value;
          const Lane sums = scalar_products<R>(weighted_.get() + (first_of(m) + n) * made_, even, odd, made_);
          for (int r = 0; r < R; ++r) out[coefficient_index(m + n + r, sign * m)] = sums[r];
        });
      }
    }
  });
}

}  // namespace sim
