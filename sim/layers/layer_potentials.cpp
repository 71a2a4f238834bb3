#include "sim/layers/layer_potentials.h"

#include "sim/layers/folded_analysis.h"
#include "sim/layers/kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sim {

namespace {

constexpr double pi = std::numbers::pi;

int round_up(int n, int step) { return (n + step - 1) / step * step; }

}  // namespace

struct LayerPotentials::Plan {
  int p, q, s;
  FoldedGrid target, source;
  SpectrumRows target_rows, source_rows;
  std::vector<double> singular_weight;  ///< of each source latitude, for the integrand kernel * |x_t x x_f|
  struct Rotation {                     ///< the two mirror classes of one degree n, row-major, forward and transposed
    std::vector<double> cosine, sine, cosine_t, sine_t;
  };
  std::vector<std::vector<Rotation>> rotations;  ///< [target latitude][n]
  std::vector<int> identity3, identity12;        ///< 0, 3, 6, ... and 0, 12, 24, ...

  Plan(int order, int source_order);
  void rows_of_tile(int latitude, int tile, const Coefficients& x, bool with_double, double* rows) const;
  LayerMatrices project(const RawVector<double>& rows, bool with_double) const;
  int column_stride() const { return round_up(coefficient_count(p), lanes); }
};

LayerPotentials::Plan::Plan(int order, int source_order)
    : p(order), q(order + 1), s(source_order > 0 ? source_order : order + 1), target(order, order + 1),
      source(order, source_order > 0 ? source_order : order + 1), target_rows(target), source_rows(source) {
  if (s < p) throw std::invalid_argument("LayerPotentials: the source order must be at least p");
  for (int k = 0; k <= s; ++k) {
    const double t = source.theta[k], z = std::cos(t);
    double p0 = 1, p1 = z, sum = 1 + z;
    for (int n = 2; n <= s; ++n) {
      const double p2 = ((2 * n - 1) * z * p1 - (n - 1) * p0) / n;
      sum += p2;
      p0 = p1;
      p1 = p2;
    }
    singular_weight.push_back(source.weight[k] * pi / (s + 1) * sum * 2 * std::sin(t / 2) / std::sin(t));
  }
  for (int i = 0; i < std::max(4 * coefficient_count(p), 8 * (s + 2)); ++i) {
    identity3.push_back(3 * i);
    identity12.push_back(components * i);
  }
  // W_i: the basis at points turned by Ry(theta_i), projected on a p-grid, where the product is integrated exactly.
  const Basis basis(p, p);
  const Matrix direction = grid_directions(basis);
  Matrix turned(basis.points(), 3);
  const Matrix projection = basis_functions(p, direction).transpose() * basis.weights().asDiagonal();
  for (int i = 0; i <= q; ++i) {
    const double c = std::cos(target.theta[i]), sn = std::sin(target.theta[i]);
    turned << c * direction.col(0) + sn * direction.col(2), direction.col(1), c * direction.col(2) - sn * direction.col(0);
    const Matrix values = basis_functions(p, turned);
    std::vector<Rotation> all;
    for (int n = 0; n <= p; ++n) {
      const Matrix w = projection.middleRows(n * n, 2 * n + 1) * values.middleCols(n * n, 2 * n + 1);
      Rotation r{std::vector<double>((n + 1) * (n + 1)), std::vector<double>(n * n), {}, {}};
      r.cosine_t = r.cosine;
      r.sine_t = r.sine;
      for (int a = 0; a <= n; ++a)
        for (int b = 0; b <= n; ++b) {
          r.cosine[a * (n + 1) + b] = r.cosine_t[b * (n + 1) + a] = w(n + a, n + b);
          if (a > 0 && b > 0)
            r.sine[(a - 1) * n + b - 1] = r.sine_t[(b - 1) * n + a - 1] =
                w(n - a, n - b);
        }
      all.push_back(std::move(r));
    }
    rotations.push_back(std::move(all));
  }
}

namespace {

struct SourcePoint {
  Lane x[3], n[3], area;  ///< position, area-weighted normal x_t x x_f, its length
};

/// Stokes kernels at the four targets of a tile, with the weight and |n| or n of the source, n = x_t x x_f.
void kernels(const Lane* target, const SourcePoint& y, double weight, bool with_double, Lane* out) {
  const Lane r0 = target[0] - y.x[0], r1 = target[1] - y.x[1], r2 = target[2] - y.x[2];
  const Lane r[3] = {r0, r1, r2}, inverse = 1.0 / lane_sqrt(r0 * r0 + r1 * r1 + r2 * r2);
  const KernelTensor<Lane> single = stokeslet(inverse, y.area * (weight * stokeslet_factor));
  outer_components(single.outer, r, out);
  for (const int diagonal : {0, 3, 5}) out[diagonal] += single.even;
  if (!with_double) return;
  const Lane rn = r0 * y.n[0] + r1 * y.n[1] + r2 * y.n[2];
  outer_components(stresslet(inverse, Lane(rn * (weight * stresslet_factor))), r, out + 6);
}

void transpose(Lane* block) {
  const Lane a = __builtin_shufflevector(block[0], block[1], 0, 4, 2, 6);
  const Lane b = __builtin_shufflevector(block[0], block[1], 1, 5, 3, 7);
  const Lane c = __builtin_shufflevector(block[2], block[3], 0, 4, 2, 6);
  const Lane d = __builtin_shufflevector(block[2], block[3], 1, 5, 3, 7);
  block[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  block[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  block[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  block[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

}  // namespace

/// Rows of the collocation operator for the four targets (theta_latitude, phi of `tile`), in the original frame:
/// rows[target longitude][component][nm], strides column_stride() and 12 or (S alone) 6 column_stride().
void LayerPotentials::Plan::rows_of_tile(int latitude, int tile, const Coefficients& x, bool with_double,
                                         double* rows) const {
  const int nc = coefficient_count(p), half = source.half, used = with_double ? components : components / 2, orbits = int(source.orbits.size());
  const int longitudes = target.nlon, spectra = source_rows.count;
  LaneBuffer turned(3 * nc), pole(3 * nc), x_lat(std::size_t(2) * spectra * 2 * half * 3);

  // z-rotation by phi_j, one target a lane.
  std::vector<Lane> cosine(p + 1), sine(p + 1);
  for (int m = 0; m <= p; ++m)
    for (int lane = 0; lane < lanes; ++lane) {
      const double angle = 2 * pi * ((std::int64_t(m) * (tile * lanes + lane)) % longitudes) / longitudes;
      cosine[m][lane] = std::cos(angle);
      sine[m][lane] = std::sin(angle);
    }
  for (int n = 0; n <= p; ++n)
    for (int m = 0; m <= n; ++m)
      for (int d = 0; d < 3; ++d) {
        const double c = x.values(coefficient_index(n, m), d), sn = x.values(coefficient_index(n, -m), d);
        if (m == 0) {
          turned.get()[3 * coefficient_index(n, 0) + d] = c + 0 * cosine[0];
        } else {
          turned.get()[3 * coefficient_index(n, m) + d] = c * cosine[m] + sn * sine[m];
          turned.get()[3 * coefficient_index(n, -m) + d] = sn * cosine[m] - c * sine[m];
        }
      }
  // y-rotation: the target becomes the pole. Sines stand in reverse order of m, hence the row lists.
  std::array<int, 130> down{};
  for (int m = 0; m < 130; ++m) down[m] = -3 * m;
  const auto& w = rotations[latitude];
  for (int n = 0; n <= p; ++n) {
    const int centre = 3 * coefficient_index(n, 0);
    multiply({n + 1, n + 1, w[n].cosine.data(), n + 1, identity3.data(), identity3.data()}, 3, turned.get() + centre,
             pole.get() + centre);
    if (n > 0)
      multiply({n, n, w[n].sine.data(), n, down.data(), down.data()}, 3, turned.get() + centre - 3,
               pole.get() + centre - 3);
  }
  Lane target_x[3] = {};
  for (int n = 0; n <= p; ++n)
    for (int d = 0; d < 3; ++d)
      target_x[d] += std::sqrt((2 * n + 1) / (4 * pi)) * pole.get()[3 * coefficient_index(n, 0) + d];

  // Legendre synthesis of x and x_theta: [parity][block, m][value or slope, half][3].
  {
    std::array<int, 130> in{};
    for (int b = 0; b < 4; ++b)
      for (std::size_t k = 0; k < source.blocks[b].m.size(); ++k)
        for (int parity = 0; parity < 2; ++parity) {
          const int m = source.blocks[b].m[k], sign = b < 2 ? 1 : -1, count = (p - m - parity + 2) / 2;
          Lane* out = x_lat.get() + std::ptrdiff_t(parity * spectra + source_rows.first[b] + int(k)) * 2 * half * 3;
          if (count <= 0) {
            std::fill(out, out + 2 * half * 3, Lane{});
            continue;
          }
          for (int c = 0; c < count; ++c) in[c] = 3 * coefficient_index(m + parity + 2 * c, sign * m);
          multiply({2 * half, count, source.synthesis[parity][m].data(), count, in.data(), identity3.data()}, 3,
                   pole.get(), out);
        }
  }

  // Latitude pair by latitude pair: Fourier synthesis, kernels, folding, Fourier analysis.
  LaneBuffer spectrum(std::size_t(2) * spectra * half * components);
  LaneBuffer folded(std::size_t(8) * orbits * components);
  const int widest = p / 2 + 1;
  LaneBuffer modes(std::size_t(widest) * 9), quarter(std::size_t(4) * orbits * 9);
  std::vector<SourcePoint> points(std::size_t(2) * orbits * 4);
  std::array<int, 130> nine{};
  for (int k = 0; k < 130; ++k) nine[k] = 9 * k;
  std::vector<Lane> samples(8 * components);
  for (int i = 0; i < half; ++i) {
    const int members = source.mirror(i) == i ? 1 : 2;
    for (int lat = 0; lat < members; ++lat) {
      for (int b = 0; b < 4; ++b) {
        const int count = int(source.blocks[b].m.size()), partner = b < 2 ? b + 2 : b - 2;
        const double lat_sign = lat == 0 ? 1 : -1;
        // Value and slope of (block, m) at this latitude from the two parities of n - m: P is even for parity 0, P' odd.
        const auto at = [&](int block, int k, int slope, int d) {
          const Lane* even = x_lat.get() + std::ptrdiff_t(source_rows.first[block] + k) * 2 * half * 3;
          const Lane* odd = x_lat.get() + std::ptrdiff_t(spectra + source_rows.first[block] + k) * 2 * half * 3;
          const int at_row = (slope * half + i) * 3 + d;
          return slope == 0 ? even[at_row] + lat_sign * odd[at_row] : lat_sign * even[at_row] + odd[at_row];
        };
        // d/dphi turns sin(m phi) coefficients s into cosines m s, and cosines c into sines -m c; m keeps its parity.
        for (int k = 0; k < count; ++k) {
          const int m = source.blocks[b].m[k];
          // Among the even m the cosines start at 0, the sines at 2.
          const int k_partner = m == 0 ? -1 : b == 0 ? k - 1 : b == 2 ? k + 1 : k;
          for (int d = 0; d < 3; ++d) {
            modes.get()[9 * k + d] = at(b, k, 0, d);
            modes.get()[9 * k + 3 + d] = at(b, k, 1, d);
            modes.get()[9 * k + 6 + d] =
                m == 0 ? Lane{} : (b < 2 ? double(m) : -double(m)) * at(partner, k_partner, 0, d);
          }
        }
        Lane* out = quarter.get() + std::ptrdiff_t(b) * orbits * 9;
        if (count == 0) {
          std::fill(out, out + orbits * 9, Lane{});
          continue;
        }
        multiply({orbits, count, source.blocks[b].transposed.data(), count, nine.data(), nine.data()}, 9, modes.get(), out);
      }
      for (int l = 0; l < orbits; ++l)
        for (int member = 0; member < 4; ++member) {
          if (source.orbits[l].index[member] < 0) continue;
          Lane v[9];
          for (int c = 0; c < 9; ++c) {
            v[c] = Lane{};
            for (int b = 0; b < 4; ++b) v[c] += fold_sign[b][member] * quarter.get()[(b * orbits + l) * 9 + c];
          }
          SourcePoint& y = points[(std::size_t(lat) * orbits + l) * 4 + member];
          for (int d = 0; d < 3; ++d) {
            y.x[d] = v[d];
            const int e = (d + 1) % 3, f = (d + 2) % 3;
            y.n[d] = v[3 + e] * v[6 + f] - v[3 + f] * v[6 + e];
          }
          y.area = lane_sqrt(y.n[0] * y.n[0] + y.n[1] * y.n[1] + y.n[2] * y.n[2]);
        }
    }
    for (int l = 0; l < orbits; ++l) {
      for (int lat = 0; lat < 2; ++lat)
        for (int member = 0; member < 4; ++member) {
          Lane* out = samples.data() + (lat * 4 + member) * components;
          if (lat >= members || source.orbits[l].index[member] < 0)
            std::fill(out, out + components, Lane{});
          else
            kernels(target_x, points[(std::size_t(lat) * orbits + l) * 4 + member],
                    singular_weight[lat == 0 ? i : source.mirror(i)], with_double, out);
        }
      fold(samples.data(), folded.get() + l * components, std::ptrdiff_t(orbits) * components, used);
    }
    fourier_analysis(source, source_rows, folded.get(), spectrum.get(), i, used);
  }
  LaneBuffer in_pole_frame(std::size_t(components) * nc), back(std::size_t(components) * nc);
  legendre_analysis(source, source_rows, spectrum.get(), in_pole_frame.get(), used);

  // Back to the original frame: W^T, then the z-rotation.
  for (int m = 0; m < 130; ++m) down[m] = -components * m;
  for (int n = 0; n <= p; ++n) {
    const int centre = components * coefficient_index(n, 0);
    multiply({n + 1, n + 1, w[n].cosine_t.data(), n + 1, identity12.data(), identity12.data()}, used,
             in_pole_frame.get() + centre, back.get() + centre);
    if (n > 0)
      multiply({n, n, w[n].sine_t.data(), n, down.data(), down.data()}, used,
               in_pole_frame.get() + centre - components, back.get() + centre - components);
  }
  for (int n = 0; n <= p; ++n)
    for (int m = 1; m <= n; ++m) {
      Lane* c = back.get() + components * coefficient_index(n, m);
      Lane* sn = back.get() + components * coefficient_index(n, -m);
      for (int k = 0; k < used; ++k) {
        const Lane turned_c = c[k] * cosine[m] - sn[k] * sine[m];
        sn[k] = sn[k] * cosine[m] + c[k] * sine[m];
        c[k] = turned_c;
      }
    }
  // From a target a lane to a coefficient a lane, so that rows are written along their length.
  const int stride = column_stride(), targets = std::min(lanes, longitudes - tile * lanes);
  for (int nm = 0; nm < stride; nm += lanes)
    for (int k = 0; k < used; ++k) {
      Lane block[lanes];
      for (int e = 0; e < lanes; ++e) block[e] = nm + e < nc ? back.get()[components * (nm + e) + k] : Lane{};
      transpose(block);
      for (int lane = 0; lane < targets; ++lane)
        __builtin_memcpy(rows + (std::ptrdiff_t(lane) * used + k) * stride + nm, &block[lane], sizeof(Lane));
    }
}

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
          double* to = m.values.data() + std::ptrdiff_t(row) * 6 * stride + column - (&m == &result.dual ? 6 * stride : 0);
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
