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
  const int longitudes = plan.target.nlon, tiles = (longitudes + lanes - 1) / lanes, tasks = plan.target.nlat * tiles;
  const std::ptrdiff_t row_length = std::ptrdiff_t(with_double ? components : components / 2) * plan.column_stride();
  RawVector<double> rows(std::size_t(plan.target.nlat) * longitudes * row_length);
#pragma omp parallel for schedule(static)
  for (int task = 0; task < tasks; ++task) {
    const int latitude = task / tiles, tile = task % tiles;
    plan.rows_of_tile(latitude, tile, x, with_double,
                      rows.data() + (std::ptrdiff_t(latitude) * longitudes + tile * lanes) * row_length);
  }
  return plan.project(rows, with_double);
}

Coefficients LayerMatrix::apply(const Coefficients& density) const {
  const int nc = coefficient_count(order);
  Coefficients in = density.order == order ? density : resized(density, order), out{order, Matrix(nc, 3)};
  const Vector fx = in.values.col(0), fy = in.values.col(1), fz = in.values.col(2);
  using Row = Eigen::Map<const Eigen::RowVectorXd>;
  for (int row = 0; row < nc; ++row) {
    const double* block = values.data() + std::ptrdiff_t(row) * 6 * stride;
    const Row xx(block, nc), xy(block + stride, nc), xz(block + 2 * stride, nc), yy(block + 3 * stride, nc),
        yz(block + 4 * stride, nc), zz(block + 5 * stride, nc);
    out.values(row, 0) = xx.dot(fx) + xy.dot(fy) + xz.dot(fz);
    out.values(row, 1) = xy.dot(fx) + yy.dot(fy) + yz.dot(fz);
    out.values(row, 2) = xz.dot(fx) + yz.dot(fy) + zz.dot(fz);
  }
  return out;
}

}  // namespace sim
