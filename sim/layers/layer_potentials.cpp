#include "sim/layers/layer_potentials.h"

#include "sim/layers/layer_plan.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace sim {

namespace {

using std::numbers::pi;

}  // namespace

/// Projection of all rows on the target harmonics, column block by column block: 48 columns are 12 vectors.
LayerMatrices LayerPotentials::Plan::project(const RawVector<double>& rows, bool with_double) const {
  const int nc = coefficient_count(p), stride = column_stride(), half = target.half, orbits = int(target.orbits.size());
  const int used = with_double ? components : components / 2, vectors = used * stride / lanes;
  const int blocks = (vectors + components - 1) / components;
  const std::ptrdiff_t row_length = std::ptrdiff_t(used) * stride;
  LayerMatrices result;
  for (LayerMatrix* m : {&result.single, &result.dual}) {
    if (m == &result.dual && !with_double) continue;
    m->order = p;
    m->stride = stride;
    m->values.resize(std::size_t(nc) * 6 * stride);
  }
#pragma omp parallel
  {
    LaneBuffer spectrum(std::size_t(2) * target_rows.count * half * components);
    LaneBuffer folded(std::size_t(8) * orbits * components), out(std::size_t(nc) * components);
    std::vector<Lane> samples(8 * components);
#pragma omp for schedule(static)
    for (int block = 0; block < blocks; ++block) {
      const int first = block * components, width = std::min(components, vectors - first);
      const auto row_at = [&](int latitude, int longitude) {
        return rows.data() + (std::ptrdiff_t(latitude) * target.nlon + longitude) * row_length + first * lanes;
      };
      constexpr int ahead = 2;  // rows lie too far apart for the processor to foresee the next
      for (int i = 0; i < half; ++i) {
        const int members = target.mirror(i) == i ? 1 : 2;
        for (int l = 0; l < orbits; ++l) {
          for (int lat = 0; lat < 2; ++lat)
            for (int member = 0; member < 4; ++member) {
              Lane* sample = samples.data() + (lat * 4 + member) * components;
              const int j = target.orbits[l].index[member];
              if (lat >= members || j < 0) {
                std::fill(sample, sample + components, Lane{});
                continue;
              }
              const int lat_index = lat == 0 ? i : target.mirror(i);
              const double weight = target.weight[lat_index] * pi / (q + 1);
              const double* in = row_at(lat_index, j);
              if (l + ahead < orbits)
                if (const int next = target.orbits[l + ahead].index[member]; next >= 0)
                  for (int c = 0; c < width; c += 2) __builtin_prefetch(row_at(lat_index, next) + c * lanes);
              for (int c = 0; c < width; ++c) {
                Lane v;
                __builtin_memcpy(&v, in + c * lanes, sizeof v);
                sample[c] = weight * v;
              }
              std::fill(sample + width, sample + components, Lane{});
            }
          fold(samples.data(), folded.get() + l * components, std::ptrdiff_t(orbits) * components, components);
        }
        fourier_analysis(target, target_rows, folded.get(), spectrum.get(), i, components);
      }
      legendre_analysis(target, target_rows, spectrum.get(), out.get(), components);
      for (int row = 0; row < nc; ++row)
        for (int c = 0; c < width; ++c) {
          const int column = (first + c) * lanes;
          LayerMatrix& m = column < 6 * stride ? result.single : result.dual;
          double* to =
              m.values.data() + std::ptrdiff_t(row) * 6 * stride + column - (&m == &result.dual ? 6 * stride : 0);
          __builtin_memcpy(to, &out.get()[row * components + c], sizeof(Lane));
        }
    }
  }
  return result;
}

LayerPotentials::LayerPotentials(int order, int source_order) : plan_(std::make_unique<Plan>(order, source_order)) {}
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
  RawVector<double> fields(std::size_t(3) * stride);  // padded with zeros like the blocks
  for (int d = 0; d < 3; ++d) {
    double* to = fields.data() + std::ptrdiff_t(d) * stride;
    std::copy_n(density.values.col(d).data(), given, to);
    std::fill(to + given, to + stride, 0.0);
  }
  const double *fx = fields.data(), *fy = fx + stride, *fz = fy + stride;
  const std::ptrdiff_t length = std::ptrdiff_t(6) * stride;
  int row = 0;
  for (; row + 2 <= nc; row += 2) {  // two at once, whose sums do not wait for each other
    const double* block = values.data() + row * length;
    RowSums a, b;
    for (int k = 0; k < stride; k += lanes) {
      const Lane x = load_lane(fx + k), y = load_lane(fy + k), z = load_lane(fz + k);
      a.add(block + k, stride, x, y, z);
      b.add(block + length + k, stride, x, y, z);
    }
    a.write(out.values, row);
    b.write(out.values, row + 1);
  }
  if (row < nc) {
    RowSums a;
    for (int k = 0; k < stride; k += lanes)
      a.add(values.data() + row * length + k, stride, load_lane(fx + k), load_lane(fy + k), load_lane(fz + k));
    a.write(out.values, row);
  }
  return out;
}

}  // namespace sim
