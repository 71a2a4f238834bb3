#include "sim/core/fftw_planner.h"
#include "sim/core/lanes.h"
#include "sim/core/parallel.h"
#include "sim/fast/mesh_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <tuple>

namespace sim {

namespace {

using std::numbers::pi;

/// The least product of 2, 3, 5 and 7 that is no less.
int good_size(double least) {
  for (int n = std::max(1, static_cast<int>(std::ceil(least - 1e-9)));; ++n) {
    int rest = n;
    for (const int factor : {2, 3, 5, 7})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return n;
  }
}

fftw_complex* as_complex(double* data) { return reinterpret_cast<fftw_complex*>(data); }

/// Fourier transform of -(R - r)^2/(2R), r < R, over R^4; t = k R.
double truncated_kernel(double t) {
  return -4 * pi * (t == 0 ? 1.0 / 60 : (2 + std::cos(t) - 3 * std::sin(t) / t) / (t * t * t * t));
}

/// Cosine transform in three dimensions, in place; x runs fastest.
void cosine_transform(RawVector<double>& values, const std::array<int, 3>& count) {
  fftw_plan plan = nullptr;
  {
    const std::lock_guard lock(planner_mutex());
    plan = fftw_plan_r2r_3d(count[2], count[1], count[0], values.data(), values.data(), FFTW_REDFT00, FFTW_REDFT00,
                            FFTW_REDFT00, FFTW_ESTIMATE);
  }
  fftw_execute(plan);
  const std::lock_guard lock(planner_mutex());
  fftw_destroy_plan(plan);
}

}  // namespace

double Mesh::spacing(double wave_number, double oversampling) { return pi / (oversampling * wave_number); }

std::array<int, 3> Mesh::nodes_for(const Eigen::Vector3d& sides, double spacing, int width) {
  std::array<int, 3> nodes{};
  constexpr double most = 1e6;  // nobody has memory for so many
  // A window reaches half its width beyond a point on both sides; another node takes up rounding.
  for (int d = 0; d < 3; ++d) nodes[d] = good_size(std::fmin(most, std::fmax(0, sides[d] / spacing)) + width + 1);
  return nodes;
}

double Mesh::padded_nodes(const std::array<int, 3>& nodes) { return 8.0 * nodes[0] * nodes[1] * nodes[2]; }

Mesh::Mesh(const KernelSplit& split, const Window& window, double oversampling, const std::array<int, 3>& nodes)
    : plan_(std::make_unique<const Plan>(split, window, oversampling, nodes)) {}
Mesh::Mesh(const KernelSplit& split, const Window& window, double oversampling, const Eigen::Matrix3d& cell)
    : plan_(std::make_unique<const Plan>(split, window, oversampling, cell)) {}
Mesh::~Mesh() = default;

Mesh::Plan::Plan(const KernelSplit& split, const Window& w, double oversampling, const std::array<int, 3>& node_counts)
    : window(w), periodic(false), step(spacing(split.wave_number(), oversampling)), nodes(node_counts) {
  cut = step * std::hypot(nodes[0], nodes[1], nodes[2]);
  per_node = Eigen::Matrix3d::Identity() / step;
  waves.setZero();
  for (int d = 0; d < 3; ++d) {
    full[d] = 2 * nodes[d];
    waves(d, d) = pi / (step * nodes[d]);
  }
  make_layout();
  make_transforms();
  make_free_multiplier(split);
}

Mesh::Plan::Plan(const KernelSplit& split, const Window& w, double oversampling, const Eigen::Matrix3d& cell)
    : window(w), periodic(true) {
  // All wave vectors within K: n_d is no larger than K |a_d| / 2 pi.
  const double per_length = 1 / spacing(split.wave_number(), oversampling);
  for (int d = 0; d < 3; ++d) nodes[d] = good_size(std::max(cell.col(d).norm() * per_length, w.width() + 1.0));
  if (nodes[0] % 2 == 1) nodes[0] = 2 * good_size(nodes[0] / 2.0);
  full = nodes;
  const Eigen::Matrix3d inverse = cell.inverse();
  per_node = Eigen::Vector3d(nodes[0], nodes[1], nodes[2]).asDiagonal() * inverse;
  waves = 2 * pi * inverse.transpose();
  make_layout();
  make_transforms();
  make_periodic_multiplier(split, std::abs(cell.determinant()));
}

void Mesh::Plan::make_layout() {
  padded_width = (window.width() + lanes - 1) / lanes * lanes;
  row = (std::size_t(std::max(full[0] + 2, nodes[0] + padded_width)) + lanes - 1) / lanes * lanes;
  if (row % 128 == 0) row += lanes;  // rows a multiple of 1024 bytes apart share lines of the cache
  plane = std::size_t(full[1]) * row;
  block = std::clamp(nodes[2] / 8, 2, window.width());
  blocks = (nodes[2] + block - 1) / block;
}

Mesh::Plan::~Plan() {
  const std::lock_guard lock(planner_mutex());
  for (fftw_plan plan : fftw) fftw_destroy_plan(plan);
}

void Mesh::Plan::make_transforms() {
  RawVector<double> whole(plane), columns(static_cast<std::size_t>(2 * full[2]) * batch);
  const int half = full[0] / 2 + 1, reals = static_cast<int>(row), spectra = static_cast<int>(row / 2);
  const unsigned flags = FFTW_ESTIMATE;  // the same plan in every run
  fftw_complex *in_plane = as_complex(whole.data()), *in_batch = as_complex(columns.data());
  const std::lock_guard lock(planner_mutex());
  fftw[to_x] = fftw_plan_many_dft_r2c(1, &full[0], nodes[1], whole.data(), nullptr, 1, reals, in_plane, nullptr, 1,
                                      spectra, flags);
  fftw[from_x] = fftw_plan_many_dft_c2r(1, &full[0], nodes[1], in_plane, nullptr, 1, spectra, whole.data(), nullptr, 1,
                                        reals, flags);
  for (const auto& [kind, sign] : {std::pair(to_y, FFTW_FORWARD), std::pair(from_y, FFTW_BACKWARD)})
    fftw[kind] = fftw_plan_many_dft(1, &full[1], half, in_plane, nullptr, spectra, 1, in_plane, nullptr, spectra, 1,
                                    sign, flags);
  for (const auto& [kind, sign] : {std::pair(to_z, FFTW_FORWARD), std::pair(from_z, FFTW_BACKWARD)})
    fftw[kind] =
        fftw_plan_many_dft(1, &full[2], batch, in_batch, nullptr, batch, 1, in_batch, nullptr, batch, 1, sign, flags);
}

/// The smooth kernel, windows divided out, on a mesh large enough for it, cut to the doubled mesh in space.
void Mesh::Plan::make_free_multiplier(const KernelSplit& split) {
  std::array<int, 3> large{}, count{};
  std::array<std::vector<double>, 3> deconvolved;
  for (int d = 0; d < 3; ++d) {
    large[d] = good_size(((cut + 1) / step + nodes[d]) / 2 + 1);  // a period of R, the side and the smoothing
    count[d] = large[d] + 1;
    for (int n = 0; n < count[d]; ++n) deconvolved[d].push_back(std::pow(window.transform(pi * n / large[d]), -2));
  }
  const std::size_t nx = std::size_t(count[0]), ny = std::size_t(count[1]);
  RawVector<double> kernel(nx * ny * std::size_t(count[2]));
  const double volume = 8.0 * large[0] * large[1] * large[2] * std::pow(step, 3);
  parallel_for(count[2], [&](int z) {
    for (int y = 0; y < count[1]; ++y)
      for (int x = 0; x < count[0]; ++x) {
        const double k = pi / step * std::hypot(double(x) / large[0], double(y) / large[1], double(z) / large[2]);
        kernel[(std::size_t(z) * ny + std::size_t(y)) * nx + std::size_t(x)] =
            k > split.wave_number()
                ? 0
                : -std::pow(cut, 4) * truncated_kernel(k * cut) * split.multiplier(k) / volume *
                      deconvolved[0][std::size_t(x)] * deconvolved[1][std::size_t(y)] * deconvolved[2][std::size_t(z)];
      }
  });
  cosine_transform(kernel, count);
  const std::array<int, 3> octant{nodes[0] + 1, nodes[1] + 1, nodes[2] + 1};
  const std::size_t mx = std::size_t(octant[0]), my = std::size_t(octant[1]), mz = std::size_t(octant[2]);
  RawVector<double> near(mx * my * mz);
  for (std::size_t z = 0; z < mz; ++z)
    for (std::size_t y = 0; y < my; ++y)
      std::copy_n(kernel.begin() + std::ptrdiff_t((z * ny + y) * nx), mx,
                  near.begin() + std::ptrdiff_t((z * my + y) * mx));
  cosine_transform(near, octant);
  multiplier.resize(near.size());
  const double share = 1 / (8.0 * nodes[0] * nodes[1] * nodes[2]);
  parallel_for(octant[1], [&](int y) {
    for (std::size_t x = 0; x < mx; ++x)
      for (std::size_t z = 0; z < mz; ++z)
        multiplier[(std::size_t(y) * mx + x) * mz + z] = near[(z * my + std::size_t(y)) * mx + x] * share;
  });
}

void Mesh::Plan::make_periodic_multiplier(const KernelSplit& split, double volume) {
  const std::array<std::size_t, 3> size = multiplier_size();
  multiplier.resize(size[0] * size[1] * size[2]);
  std::array<std::vector<double>, 3> deconvolved;
  for (int d = 0; d < 3; ++d)
    for (int n = 0; n < full[d]; ++n)
      deconvolved[d].push_back(std::pow(window.transform(2 * pi * signed_wave(n, d) / full[d]), -2));
  parallel_for(full[1], [&](int y) {
    for (std::size_t x = 0; x < size[0]; ++x)
      for (int z = 0; z < full[2]; ++z) {
        const double square = (waves * Eigen::Vector3d(double(x), signed_wave(y, 1), signed_wave(z, 2))).squaredNorm();
        multiplier[(std::size_t(y) * size[0] + x) * size[2] + std::size_t(z)] =
            square == 0 ? 0
                        : 8 * pi * split.multiplier(std::sqrt(square)) / (square * square * volume) *
                              deconvolved[0][x] * deconvolved[1][std::size_t(y)] * deconvolved[2][std::size_t(z)];
      }
  });
}

std::vector<int> Mesh::Plan::starts(const Points& points, const Eigen::Vector3d& middle) const {
  const int width = window.width();
  std::vector<int> all(static_cast<std::size_t>(3 * points.cols()));
  constexpr int piece = 512;
  const auto total = static_cast<int>(points.cols());
  parallel_for((total + piece - 1) / piece, [&](int part) {
    for (int k = part * piece; k < std::min(total, (part + 1) * piece); ++k) {
      const Eigen::Vector3d x = per_node * (points.col(k) - middle);
      for (int d = 0; d < 3; ++d) {
        const double first = std::ceil(x[d] + (nodes[d] - 1) / 2.0 - width / 2.0);
        const double start = periodic ? first - nodes[d] * std::floor(first / nodes[d]) : first;
        if (!(start >= 0 && start + (periodic ? 1 : width) <= nodes[d]))
          throw std::domain_error("a point lies outside the mesh");
        all[3 * std::size_t(k) + std::size_t(d)] = static_cast<int>(start);
      }
    }
  });
  return all;
}

MeshPoints Mesh::Plan::placed(const Points& points, const Eigen::Vector3d& middle, const std::vector<int>& starts,
                              std::vector<int> wanted, bool slopes) const {
  const int width = window.width();
  const auto padded = static_cast<std::size_t>(padded_width);
  const std::size_t count = wanted.size();
  MeshPoints result;
  result.point = std::move(wanted);
  result.start.resize(3 * count);
  result.windows.resize(3 * padded * count);
  if (slopes) result.slopes.resize(3 * padded * count);
  constexpr int piece = 512;
  parallel_for(static_cast<int>((count + piece - 1) / piece), [&](int part) {
    const std::size_t end = std::min(count, std::size_t(part + 1) * piece);
    for (std::size_t k = std::size_t(part) * piece; k < end; ++k) {
      const int point = result.point[k];
      const Eigen::Vector3d x = per_node * (points.col(point) - middle);
      for (int d = 0; d < 3; ++d) {
        const std::size_t slot = 3 * k + std::size_t(d);
        const double low = x[d] + (nodes[d] - 1) / 2.0 - width / 2.0;
        result.start[slot] = starts[3 * std::size_t(point) + std::size_t(d)];
        double* w = &result.windows[slot * padded];
        double* s = slopes ? &result.slopes[slot * padded] : nullptr;
        window.evaluate(std::ceil(low) - low, w, s);
        for (std::size_t j = std::size_t(width); j < padded; ++j) w[j] = 0;
        for (std::size_t j = std::size_t(width); s && j < padded; ++j) s[j] = 0;
      }
    }
  });
  // By blocks of planes, then by columns of 8 x 8 nodes.
  std::vector<std::tuple<int, int, int, int>> keys;
  for (std::size_t k = 0; k < count; ++k) {
    const int* at = &result.start[3 * k];
    keys.emplace_back(at[2] / block, at[1] / 8, at[0] / 8, static_cast<int>(k));
  }
  std::sort(keys.begin(), keys.end());
  for (const auto& key : keys) result.order.push_back(std::get<3>(key));
  return result;
}

MeshPoints Mesh::place_sources(const Points& points, const Eigen::Vector3d& middle, bool slopes,
                               const Ranks& ranks) const {
  const Plan& m = *plan_;
  const int width = m.window.width();
  const auto reaches = [&](int start, int z0, int z1) {
    return (start < z1 && start + width > z0) || start + width - m.nodes[2] > z0;
  };
  const std::vector<int> starts = m.starts(points, middle);
  const MeshSlab slab = m.slab(ranks.rank, ranks.count);
  std::vector<int> wanted;
  for (int k = 0; k < static_cast<int>(points.cols()); ++k)
    if (ranks.count == 1 ||
        (slab.planes > 0 && reaches(starts[3 * std::size_t(k) + 2], slab.first_plane, slab.first_plane + slab.planes)))
      wanted.push_back(k);
  MeshPoints placed = m.placed(points, middle, starts, std::move(wanted), slopes);
  placed.first.push_back(0);
  for (int b = 0; b < m.blocks; ++b) {
    const int z0 = b * m.block, z1 = std::min(m.nodes[2], z0 + m.block);
    for (const int k : placed.order)
      if (reaches(placed.start[3 * std::size_t(k) + 2], z0, z1)) placed.touching.push_back(k);
    placed.first.push_back(static_cast<int>(placed.touching.size()));
  }
  return placed;
}

MeshPoints Mesh::place_targets(const Points& points, const Eigen::Vector3d& middle) const {
  std::vector<int> all(static_cast<std::size_t>(points.cols()));
  std::iota(all.begin(), all.end(), 0);
  return plan_->placed(points, middle, plan_->starts(points, middle), std::move(all), false);
}

std::vector<int> Mesh::homes(const Points& points, const Eigen::Vector3d& middle, const Ranks& ranks) const {
  const std::vector<int> starts = plan_->starts(points, middle);
  std::vector<int> home;
  for (std::size_t k = 2; k < starts.size(); k += 3) home.push_back(plan_->home(starts[k], ranks.count));
  return home;
}

bool Mesh::reaches_slab(const Box& box, const Eigen::Vector3d& middle, const Ranks& ranks) const {
  const Plan& m = *plan_;
  if (ranks.count == 1) return true;
  const MeshSlab slab = m.slab(ranks.rank, ranks.count);
  if (slab.planes == 0) return false;
  const int width = m.window.width(), nodes = m.nodes[2];
  const Eigen::RowVector3d along = m.per_node.row(2);
  const double at = along.dot(0.5 * (box.low + box.high) - middle) + (nodes - 1) / 2.0 - width / 2.0,
               half = along.cwiseAbs().dot(0.5 * (box.high - box.low));
  // Windows begin between these planes; one more takes up rounding.
  const double low = std::floor(at - half), high = std::ceil(at + half) + 1, reach = high - low + width;
  if (!m.periodic) return low < slab.first_plane + slab.planes && high + width > slab.first_plane;
  double from = slab.first_plane - low;  // to the slab, around the end
  from -= nodes * std::floor(from / nodes);
  return from < reach || from + slab.planes > nodes;
}

MeshVelocity Mesh::velocity_of(const MeshPoints& sources, const MeshStrengths& strengths, const Ranks& ranks) const {
  const Plan& m = *plan_;
  const MeshSlab slab = m.slab(ranks.rank, ranks.count);
  const bool divided = ranks.count > 1;
  std::vector<Plan::Field> fields(strengths.double_layers ? 4 : 3);
  for (Plan::Field& field : fields) field.resize(m.plane * std::size_t(slab.planes + m.halo(ranks.count)));
  m.spread(sources, strengths.force, strengths.dual, slab, fields);
  m.forward_planes(slab, fields);
  if (divided)
    m.multiply_columns(slab, ranks, fields);
  else
    m.multiply_columns(fields);
  m.backward_planes(slab, fields);
  if (divided) m.fill_halo(slab, ranks, fields);
  MeshVelocity velocity;
  for (std::size_t c = 0; c < 3; ++c) velocity.nodes[c] = std::move(fields[c]);
  if (!m.periodic) velocity.everywhere = 2 / m.cut * strengths.net_force;
  return velocity;
}

void Mesh::add_velocity(const MeshVelocity& v, const MeshPoints& targets, Points& velocity, const Ranks& ranks) const {
  plan_->read(v.nodes, targets, plan_->slab(ranks.rank, ranks.count), ranks.count > 1, velocity);
  if (v.everywhere.isZero(0)) return;
  for (const int k : targets.point) velocity.col(k) += v.everywhere;
}

void Mesh::add_velocity(const MeshPoints& sources, const MeshStrengths& strengths, const MeshPoints& targets,
                        Points& velocity, const Ranks& ranks) const {
  add_velocity(velocity_of(sources, strengths, ranks), targets, velocity, ranks);
}

}  // namespace sim
