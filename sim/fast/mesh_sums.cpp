#include "sim/core/lanes.h"
#include "sim/core/parallel.h"
#include "sim/fast/mesh_plan.h"

#include <algorithm>
#include <cstring>

namespace sim {

namespace {

fftw_complex* complex_of(double* data) { return reinterpret_cast<fftw_complex*>(data); }

/// The force and divergence of one point, as three numbers a channel: factors of values, slopes in y and z, and in x.
struct PointStrength {
  double force[3], gradient[3][3], trace;
};

PointStrength strength_of(const Points& force, const Tensors& dual, Eigen::Index k, const Eigen::Matrix3d& per_node) {
  PointStrength s{{force(0, k), force(1, k), force(2, k)}, {}, 0};
  if (dual.cols() == 0) return s;
  constexpr int component[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  // The force less a third of the divergence of Q: slopes are those in the place of the node.
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int c = 0; c < 3; ++c) s.gradient[a][b] -= dual(component[a][c], k) * per_node(b, c) / 3;
  s.trace = dual(0, k) + dual(3, k) + dual(5, k);
  return s;
}

/// Adds a row of a window, in whole vectors.
template <int vectors>
void add_row(double* to, double value, const Lane* window) {
  for (int v = 0; v < vectors; ++v) store_lane(to + lanes * v, load_lane(to + lanes * v) + value * window[v]);
}
template <int vectors>
void add_row(double* to, double value, const Lane* window, double slope, const Lane* slopes) {
  for (int v = 0; v < vectors; ++v)
    store_lane(to + lanes * v, load_lane(to + lanes * v) + value * window[v] + slope * slopes[v]);
}

/// Calls body(number of vectors that hold a padded window), known to the compiler.
template <class Body>
void with_vectors(int padded_width, Body&& body) {
  switch (padded_width / lanes) {
    case 1:
      return body(std::integral_constant<int, 1>());
    case 2:
      return body(std::integral_constant<int, 2>());
    case 3:
      return body(std::integral_constant<int, 3>());
    default:
      return body(std::integral_constant<int, 4>());
  }
}

template <int vectors>
void load_window(const double* from, Lane* window) {
  for (int v = 0; v < vectors; ++v) window[v] = load_lane(from + lanes * v);
}

}  // namespace

void Mesh::Plan::spread(const MeshPoints& points, const Points& force, const Tensors& dual, const MeshSlab& slab,
                        std::span<Field> fields) const {
  const int width = window.width();
  with_vectors(padded_width, [&](auto count) {
    constexpr int vectors = count.value, padded = vectors * lanes;
    parallel_for(blocks, [&](int b) {
      const int z0 = std::max(b * block, slab.first_plane),
                z1 = std::min({nodes[2], (b + 1) * block, slab.first_plane + slab.planes});
      if (z0 >= z1) return;
      for (Field& field : fields)
        std::memset(&field[at(z0 - slab.first_plane, 0, 0)], 0, std::size_t(z1 - z0) * plane * sizeof(double));
      for (int i = points.first[std::size_t(b)]; i < points.first[std::size_t(b) + 1]; ++i) {
        const std::size_t k = std::size_t(points.touching[std::size_t(i)]);
        const int* start = &points.start[3 * k];
        const double *wx = &points.windows[3 * padded * k], *wy = wx + padded, *wz = wy + padded;
        const PointStrength s = strength_of(force, dual, points.point[k], per_node);
        Lane values[vectors], slopes[vectors] = {};
        load_window<vectors>(wx, values);
        const double *dx = nullptr, *dy = nullptr, *dz = nullptr;
        if (fields.size() == 4) {
          dx = &points.slopes[3 * padded * k];
          dy = dx + padded;
          dz = dy + padded;
          load_window<vectors>(dx, slopes);
        }
        for (int z = 0; z < width; ++z) {
          const int in_z = wrapped(start[2] + z, 2);
          if (in_z < z0 || in_z >= z1) continue;
          for (int y = 0; y < width; ++y) {
            const std::size_t to = at(in_z - slab.first_plane, wrapped(start[1] + y, 1), start[0]);
            const double w = wy[y] * wz[z];
            if (fields.size() == 3) {
              for (std::size_t c = 0; c < 3; ++c) add_row<vectors>(&fields[c][to], s.force[c] * w, values);
              continue;
            }
            const double along_y = dy[y] * wz[z], along_z = wy[y] * dz[z];
            for (std::size_t c = 0; c < 3; ++c)
              add_row<vectors>(&fields[c][to], s.force[c] * w + s.gradient[c][1] * along_y + s.gradient[c][2] * along_z,
                               values, s.gradient[c][0] * w, slopes);
            add_row<vectors>(&fields[3][to], s.trace * w, values);
          }
        }
      }
    });
  });
}

void Mesh::Plan::forward_planes(const MeshSlab& slab, std::span<Field> fields) const {
  parallel_for(int(fields.size()) * slab.planes, [&](int task) {
    double* g = &fields[std::size_t(task / slab.planes)][at(task % slab.planes, 0, 0)];
    for (int y = 0; periodic && y < nodes[1]; ++y) {  // windows reached beyond the end of the rows
      double* begin = g + std::size_t(y) * row;
      for (int x = 0; x < padded_width; ++x) begin[x] += begin[nodes[0] + x];
    }
    fftw_execute_dft_r2c(fftw[to_x], g, complex_of(g));
    fftw_execute_dft(fftw[to_y], complex_of(g), complex_of(g));
  });
}

void Mesh::Plan::backward_planes(const MeshSlab& slab, std::span<Field> fields) const {
  parallel_for(3 * slab.planes, [&](int task) {
    double* g = &fields[std::size_t(task / slab.planes)][at(task % slab.planes, 0, 0)];
    fftw_execute_dft(fftw[from_y], complex_of(g), complex_of(g));
    fftw_execute_dft_c2r(fftw[from_x], complex_of(g), g);
    for (int y = 0; periodic && y < nodes[1]; ++y) {
      double* begin = g + std::size_t(y) * row;
      std::copy_n(begin, padded_width, begin + nodes[0]);
    }
  });
}

namespace {

/// u = b [k^2 g - k (k.g + (i/6) k^2 t)] for `width` columns in x of one y and z, with wave vectors start + i step;
/// numbers are pairs of doubles.
void apply_kernel(const double* b, const Eigen::Vector3d& start, const Eigen::Vector3d& step, int width,
                  double* const* channels, std::size_t offset, bool dual) {
  double *u = channels[0] + offset, *v = channels[1] + offset, *w = channels[2] + offset;
  const double* t = channels[3] + offset;
  for (int i = 0; i < width; ++i) {
    const double kx = start[0] + i * step[0], ky = start[1] + i * step[1], kz = start[2] + i * step[2];
    const double square = b[i] * (kx * kx + ky * ky + kz * kz), sixth = square / 6;
    for (int n = 2 * i; n < 2 * i + 2; ++n) {
      double along = b[i] * (kx * u[n] + ky * v[n] + kz * w[n]);
      // The real part of i t is less the imaginary one of t.
      if (dual) along += n == 2 * i ? -sixth * t[n + 1] : sixth * t[n - 1];
      u[n] = square * u[n] - along * kx;
      v[n] = square * v[n] - along * ky;
      w[n] = square * w[n] - along * kz;
    }
  }
}

}  // namespace

template <class Row>
void Mesh::Plan::multiply_row_columns(int y, std::size_t count, const Row& row_at) const {
  const int half = full[0] / 2 + 1, pieces = (half + batch - 1) / batch;
  const std::array<std::size_t, 3> size = multiplier_size();
  const std::size_t length = std::size_t(2 * batch) * std::size_t(full[2]);
  RawVector<double> buffer(4 * length);
  double* channels[4];
  for (std::size_t c = 0; c < 4; ++c) channels[c] = &buffer[c * length];
  for (int piece = 0; piece < pieces; ++piece) {
    const int x0 = piece * batch, width = std::min(batch, half - x0);
    const std::size_t bytes = std::size_t(2 * width) * sizeof(double);
    for (std::size_t c = 0; c < count; ++c) {
      if (width < batch)
        std::memset(channels[c], 0, length * sizeof(double));
      else if (!periodic)
        std::memset(channels[c] + length / 2, 0, length / 2 * sizeof(double));
      for (int z = 0; z < nodes[2]; ++z)
        std::memcpy(channels[c] + std::size_t(2 * batch) * std::size_t(z), row_at(c, z, y) + 2 * x0, bytes);
      fftw_execute_dft(fftw[to_z], complex_of(channels[c]), complex_of(channels[c]));
    }
    for (int z = 0; z < full[2]; ++z) {
      double b[batch];
      for (int i = 0; i < width; ++i)
        b[i] = multiplier[(wave_place(y, 1) * size[0] + std::size_t(x0 + i)) * size[2] + wave_place(z, 2)];
      apply_kernel(b, waves * Eigen::Vector3d(x0, signed_wave(y, 1), signed_wave(z, 2)), waves.col(0), width, channels,
                   std::size_t(2 * batch) * std::size_t(z), count == 4);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      fftw_execute_dft(fftw[from_z], complex_of(channels[c]), complex_of(channels[c]));
      for (int z = 0; z < nodes[2]; ++z)
        std::memcpy(row_at(c, z, y) + 2 * x0, channels[c] + std::size_t(2 * batch) * std::size_t(z), bytes);
    }
  }
}

void Mesh::Plan::multiply_columns(std::span<Field> fields) const {
  const auto row_at = [&](std::size_t c, int z, int y) { return &fields[c][at(z, y, 0)]; };
  parallel_for(full[1], [&](int y) { multiply_row_columns(y, fields.size(), row_at); });
}

void Mesh::Plan::multiply_columns(const MeshSlab& mine, const Ranks& ranks, std::span<Field> fields) const {
  // Rows of a message: by channel, plane of the slab, row of the spectrum; as they come, they serve as the array of
  // columns: that of plane z lies in the message of its rank.
  const std::size_t length = static_cast<std::size_t>(full[0] / 2 + 1) * 2;
  const auto slot = [&](std::size_t c, int plane_number, int row_number, int planes, int rows) {
    return ((c * std::size_t(planes) + std::size_t(plane_number)) * std::size_t(rows) + std::size_t(row_number)) *
           length;
  };
  const auto between = [&](std::size_t channels, std::vector<std::vector<double>>& messages, bool out) {
    for (int r = 0; r < ranks.count; ++r) {
      const MeshSlab other = slab(r, ranks.count);
      std::vector<double>& message = messages[std::size_t(r)];
      if (out) message.resize(slot(channels, 0, 0, mine.planes, other.rows));
      for (std::size_t c = 0; c < channels; ++c)
        for (int z = 0; z < mine.planes; ++z)
          for (int y = 0; y < other.rows; ++y) {
            double *there = &message[slot(c, z, y, mine.planes, other.rows)],
                   *here = &fields[c][at(z, other.first_row + y, 0)];
            std::memcpy(out ? there : here, out ? here : there, length * sizeof(double));
          }
    }
  };
  std::vector<std::vector<double>> messages(static_cast<std::size_t>(ranks.count));
  between(fields.size(), messages, true);
  messages = ranks.exchanged(messages);
  std::vector<int> rank_of;  // by plane
  for (int r = 0; r < ranks.count; ++r) rank_of.resize(rank_of.size() + std::size_t(slab(r, ranks.count).planes), r);
  const auto row_at = [&](std::size_t c, int z, int y) {
    const int r = rank_of[std::size_t(z)];
    const MeshSlab other = slab(r, ranks.count);
    return &messages[std::size_t(r)][slot(c, z - other.first_plane, y - mine.first_row, other.planes, mine.rows)];
  };
  parallel_for(mine.rows, [&](int y) { multiply_row_columns(mine.first_row + y, fields.size(), row_at); });
  for (int r = 0; r < ranks.count; ++r)  // three channels go back, which stand first
    messages[std::size_t(r)].resize(slot(3, 0, 0, slab(r, ranks.count).planes, mine.rows));
  messages = ranks.exchanged(messages);
  between(3, messages, false);
}

void Mesh::Plan::fill_halo(const MeshSlab& mine, const Ranks& ranks, std::span<Field> fields) const {
  // Rank r wants the planes behind its own, around the end; in free space there are none beyond it, nor windows.
  const auto wanted = [&](const MeshSlab& slab_of_rank, auto&& take) {
    if (slab_of_rank.planes == 0) return;
    for (int h = 0; h < halo(ranks.count); ++h) {
      const int beyond = slab_of_rank.first_plane + slab_of_rank.planes + h;
      if (!periodic && beyond >= nodes[2]) return;
      take(slab_of_rank.planes + h, beyond % nodes[2]);
    }
  };
  const std::size_t size = static_cast<std::size_t>(nodes[1]) * row;
  std::vector<std::vector<double>> messages(static_cast<std::size_t>(ranks.count));
  for (int r = 0; r < ranks.count; ++r)
    wanted(slab(r, ranks.count), [&](int, int z) {
      const int here = z - mine.first_plane;
      if (here < 0 || here >= mine.planes) return;
      for (std::size_t c = 0; c < 3; ++c) {
        const double* from = &fields[c][at(here, 0, 0)];
        messages[std::size_t(r)].insert(messages[std::size_t(r)].end(), from, from + size);
      }
    });
  messages = ranks.exchanged(messages);
  std::vector<std::size_t> read(static_cast<std::size_t>(ranks.count));
  wanted(mine, [&](int to, int z) {
    const auto r = static_cast<std::size_t>(home(z, ranks.count));
    for (std::size_t c = 0; c < 3; ++c, read[r] += size)
      std::memcpy(&fields[c][at(to, 0, 0)], &messages[r][read[r]], size * sizeof(double));
  });
}

void Mesh::Plan::read(std::span<const Field> fields, const MeshPoints& points, const MeshSlab& slab, bool divided,
                      Points& velocity) const {
  const int width = window.width();
  constexpr int piece = 256;
  const auto total = points.order.size();
  with_vectors(padded_width, [&](auto count) {
    constexpr int vectors = count.value, padded = vectors * lanes;
    parallel_for(int((total + piece - 1) / piece), [&](int part) {
      const std::size_t end = std::min(total, std::size_t(part + 1) * piece);
      for (std::size_t i = std::size_t(part) * piece; i < end; ++i) {
        const std::size_t k = std::size_t(points.order[i]);
        const int* start = &points.start[3 * k];
        const double *wx = &points.windows[3 * padded * k], *wy = wx + padded, *wz = wy + padded;
        Lane sums[3][vectors] = {};
        for (int z = 0; z < width; ++z)
          for (int y = 0; y < width; ++y) {
            const int in_z = divided ? start[2] + z - slab.first_plane : wrapped(start[2] + z, 2);
            const std::size_t from = at(in_z, wrapped(start[1] + y, 1), start[0]);
            const double w = wy[y] * wz[z];
            for (std::size_t c = 0; c < 3; ++c)
              for (int v = 0; v < vectors; ++v) sums[c][v] += w * load_lane(&fields[c][from + std::size_t(lanes * v)]);
          }
        for (int c = 0; c < 3; ++c) {
          Lane sum{};
          for (int v = 0; v < vectors; ++v) sum += load_lane(wx + lanes * v) * sums[c][v];
          velocity(c, points.point[k]) += (sum[0] + sum[1]) + (sum[2] + sum[3]);
        }
      }
    });
  });
}

}  // namespace sim
