#include "sim/layers/layer_potentials.h"

#include "sim/core/parallel.h"
#include "sim/layers/layer_plan.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <type_traits>

namespace sim {

namespace {

using std::numbers::pi;

}  // namespace

/// Projection of rows on the target harmonics, a block of columns after the other: 12 vectors, 48 or 96 columns. With
/// the memory of a thread.
template <class Vector>
struct LayerPotentials::Plan::Columns {
  const Plan& plan;
  BufferOf<Vector> samples, folded, spectrum, out;

  explicit Columns(const Plan& the_plan)
      : plan(the_plan),
        samples(8 * components),
        folded(std::size_t(8) * plan.target.orbits.size() * components),
        spectrum(std::size_t(2) * plan.target_rows.count * plan.target.half * components),
        out(std::size_t(coefficient_count(plan.p)) * components) {}

  static int blocks(std::ptrdiff_t row_length) {
    return int((row_length / width_of<Vector> + components - 1) / components);
  }

  /// Weighted samples of one orbit of a pair of latitudes; zero where there is none, and beyond the given width.
  [[gnu::always_inline]] void read(int i, int l, const double* columns, std::ptrdiff_t row_length, int width) {
    constexpr int ahead = 2;  // rows lie too far apart for the processor to foresee the next
    const FoldedGrid& target = plan.target;
    const int orbits = int(target.orbits.size()), members = target.mirror(i) == i ? 1 : 2;
    for (int lat = 0; lat < 2; ++lat)
      for (int member = 0; member < 4; ++member) {
        Vector* sample = samples.get() + (lat * 4 + member) * components;
        const int j = target.orbits[l].index[member], latitude = lat == 0 ? i : target.mirror(i);
        const bool present = lat < members && j >= 0;
        const double* row = columns + std::ptrdiff_t(latitude) * target.nlon * row_length;
        if (present && l + ahead < orbits)
          if (const int next = target.orbits[l + ahead].index[member]; next >= 0)
            for (int c = 0; c < width * width_of<Vector>; c += 8) __builtin_prefetch(row + next * row_length + c);
        const double weight = target.weight[latitude] * pi / (plan.q + 1);
        for (int c = 0; c < width && present; ++c) {
          Vector v;
          load(row + j * row_length + c * width_of<Vector>, v);
          sample[c] = weight * v;
        }
        for (int c = present ? width : 0; c < components; ++c) sample[c] = Vector{};
      }
  }

  [[gnu::always_inline]] void write(int first, int width, LayerMatrices& result) const {
    const std::ptrdiff_t length = std::ptrdiff_t(6) * plan.column_stride();
    for (int row = 0; row < coefficient_count(plan.p); ++row)
      for (int c = 0; c < width; ++c) {
        const std::ptrdiff_t column = std::ptrdiff_t(first + c) * width_of<Vector>;
        double* to = column < length ? result.single.values.data() + row * length + column
                                     : result.dual.values.data() + row * length + column - length;
        __builtin_memcpy(to, &out.get()[row * components + c], sizeof(Vector));
      }
  }

  void of_block(int block, const RawVector<double>& rows, std::ptrdiff_t row_length, LayerMatrices& result) {
    const FoldedGrid& target = plan.target;
    const int first = block * components, orbits = int(target.orbits.size());
    const int width = std::min(components, int(row_length / width_of<Vector>) - first);
    const int used = (width + 2) / 3 * 3;  // products take three vectors at once
    for (int i = 0; i < target.half; ++i) {
      run_apart<Vector>([&]() __attribute__((always_inline)) {
        for (int l = 0; l < orbits; ++l) {
          read(i, l, rows.data() + first * width_of<Vector>, row_length, width);
          fold(samples.get(), folded.get() + l * components, std::ptrdiff_t(orbits) * components, used);
        }
      });
      run_apart<Vector>([&]() __attribute__((always_inline)) {
        fourier_analysis(target, plan.target_rows, folded.get(), spectrum.get(), i, used);
      });
    }
    run_apart<Vector>([&]() __attribute__((always_inline)) {
      legendre_analysis(target, plan.target_rows, spectrum.get(), out.get(), used);
      write(first, width, result);
    });
  }
};

LayerMatrices LayerPotentials::Plan::project(const RawVector<double>& rows, bool with_double) const {
  const int nc = coefficient_count(p), stride = column_stride();
  const std::ptrdiff_t row_length = std::ptrdiff_t(with_double ? components : components / 2) * stride;
  LayerMatrices result;
  for (LayerMatrix* m : {&result.single, &result.dual}) {
    if (m == &result.dual && !with_double) continue;
    m->order = p;
    m->stride = stride;
    m->values.resize(std::size_t(nc) * 6 * stride);
  }
  const auto of_width = [&]<class Vector>(std::type_identity<Vector>) {
    parallel_for_with(
        Columns<Vector>::blocks(row_length), [&] { return Columns<Vector>(*this); },
        [&](Columns<Vector>& columns, int block) { columns.of_block(block, rows, row_length, result); });
  };
  if (wide)
    of_width(std::type_identity<WideLane>{});
  else
    of_width(std::type_identity<Lane>{});
  return result;
}

LayerPotentials::LayerPotentials(int order, int source_order, LaneCount width)
    : plan_(std::make_unique<Plan>(order, source_order, width == LaneCount::widest)) {}
LayerPotentials::~LayerPotentials() = default;
LayerPotentials::LayerPotentials(LayerPotentials&&) noexcept = default;
int LayerPotentials::order() const { return plan_->p; }
int LayerPotentials::source_order() const { return plan_->s; }

LayerMatrices LayerPotentials::assemble(const Coefficients& position, bool with_double) const {
  const Plan& plan = *plan_;
  if (position.order > plan.p || position.values.cols() != 3)
    throw std::invalid_argument("LayerPotentials: the position must have 3 fields of at most the plan's degree");
  const Coefficients x = resized(position, plan.p);
  return plan.project(plan.rows_of(x, with_double), with_double);
}

namespace {

/// Sums of one row of the six blocks with three fields.
struct RowSums {
  Lane x{}, y{}, z{};

  void add(const double* block, int stride, Lane fx, Lane fy, Lane fz) {
    const Lane xy = load_lane(block + stride), xz = load_lane(block + 2 * stride), yz = load_lane(block + 4 * stride);
    x += load_lane(block) * fx;
    y += xy * fx;
    z += xz * fx;
    x += xy * fy;
    y += load_lane(block + 3 * stride) * fy;
    z += yz * fy;
    x += xz * fz;
    y += yz * fz;
    z += load_lane(block + 5 * stride) * fz;
  }
  void write(Matrix& out, int row) const {
    const Lane sums = lane_sums(x, y, z, Lane{});
    for (int d = 0; d < 3; ++d) out(row, d) = sums[d];
  }
};

}  // namespace

Coefficients LayerMatrix::apply(const Coefficients& density) const {
  const int nc = coefficient_count(order), given = coefficient_count(std::min(order, density.order));
  Coefficients out{order, Matrix(nc, 3)};
  const Scratch<double, 2048> fields(std::size_t(3) * stride);  // padded with zeros like the blocks
  for (int d = 0; d < 3; ++d) {
    double* to = fields.get() + std::ptrdiff_t(d) * stride;
    std::copy_n(density.values.col(d).data(), given, to);
    std::fill(to + given, to + stride, 0.0);
  }
  const double *fx = fields.get(), *fy = fx + stride, *fz = fy + stride;
  const std::ptrdiff_t length = std::ptrdiff_t(6) * stride;
  const auto two_rows = [&](int pair) {  // at once, whose sums do not wait for each other
    const int row = 2 * pair;
    const double* block = values.data() + row * length;
    RowSums a, b;
    for (int k = 0; k < stride; k += lanes) {
      const Lane x = load_lane(fx + k), y = load_lane(fy + k), z = load_lane(fz + k);
      a.add(block + k, stride, x, y, z);
      b.add(block + length + k, stride, x, y, z);
    }
    a.write(out.values, row);
    b.write(out.values, row + 1);
  };
  shared_for(nc / 2, 9.0 * nc * stride, two_rows);
  if (nc % 2 == 1) {
    RowSums a;
    for (int k = 0; k < stride; k += lanes)
      a.add(values.data() + (nc - 1) * length + k, stride, load_lane(fx + k), load_lane(fy + k), load_lane(fz + k));
    a.write(out.values, nc - 1);
  }
  return out;
}

}  // namespace sim
