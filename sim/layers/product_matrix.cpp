#include "sim/layers/product_matrix.h"

#include "sim/core/packs.h"
#include "sim/sphere/legendre.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

using std::numbers::pi;

constexpr int blocks = 6;

/// Sums over the longitudes of each latitude with cos k phi and sin k phi, k = 0..2p.
struct LongitudeSums {
  std::array<Matrix, blocks> cosine, sine;  ///< latitudes x (2p + 1)

  LongitudeSums(const Basis& basis, const Matrix& tensor) {
    const int count = 2 * basis.order() + 1, nlat = basis.latitudes(), nlon = basis.longitudes();
    Vector turn_cosine(nlon), turn_sine(nlon);
    for (int j = 0; j < nlon; ++j) {
      turn_cosine[j] = std::cos(2 * pi * j / nlon);
      turn_sine[j] = std::sin(2 * pi * j / nlon);
    }
    Matrix waves(nlon, 2 * count);
    for (int k = 0; k < count; ++k)
      for (int j = 0; j < nlon; ++j) {
        waves(j, k) = turn_cosine[k * j % nlon];
        waves(j, count + k) = turn_sine[k * j % nlon];
      }
    for (int d = 0; d < blocks; ++d) {
      const Matrix sums = Eigen::Map<const Matrix>(tensor.col(d).data(), nlat, nlon) * waves;
      cosine[d] = sums.leftCols(count);
      sine[d] = sums.rightCols(count);
    }
  }
};

}  // namespace

LayerMatrix product_matrix(const Basis& basis, const Matrix& tensor) {
  const int p = basis.order(), nlat = basis.latitudes(), nc = coefficient_count(p);
  const LongitudeSums sums(basis, tensor);
  const Matrix functions = legendre_table(p, basis.theta(), 0).value;
  LayerMatrix matrix;
  matrix.order = p;
  matrix.stride = (nc + lanes - 1) / lanes * lanes;
  const std::ptrdiff_t row = std::ptrdiff_t(blocks) * matrix.stride;
  matrix.values.resize(std::size_t(nc) * row);
  for (int r = 0; r < nc * blocks; ++r)
    std::fill_n(matrix.values.begin() + std::ptrdiff_t(r) * matrix.stride + nc, matrix.stride - nc, 0.0);
  // What (cos, cos), (sin, sin), (sin, cos) and (cos, sin) of m and m' make of the components, latitude by latitude of
  // the northern half: the sum with that of the mirrored latitude, and the difference. Y_a Y_b is even or odd in z.
  constexpr int kinds = 4, numbers = kinds * blocks;
  static_assert(numbers == 6 * lanes);
  constexpr int sign[kinds] = {1, -1, -1, 1}, other_sign[kinds] = {1, -1, 1, -1};
  const int half = (nlat + 1) / 2;
  const LaneBuffer longitude[2] = {LaneBuffer(std::size_t(half) * numbers / lanes),
                                   LaneBuffer(std::size_t(half) * numbers / lanes)};
  const Vector& weights = basis.weights();
  for (int m = 0; m <= p; ++m)
    for (int o = 0; o <= m; ++o) {
      const double norm = (m == 0 ? 1 : std::numbers::sqrt2) * (o == 0 ? 1 : std::numbers::sqrt2) / (4 * pi);
      for (int i = 0; i < half; ++i) {
        const int mirror = nlat - 1 - i;
        double* const even = reinterpret_cast<double*>(longitude[0].get()) + std::ptrdiff_t(i) * numbers;
        double* const odd = reinterpret_cast<double*>(longitude[1].get()) + std::ptrdiff_t(i) * numbers;
        for (int d = 0; d < blocks; ++d) {
          const auto products = [&](int latitude) {
            const double c = sums.cosine[d](latitude, m - o), c_sum = sums.cosine[d](latitude, m + o);
            const double s = sums.sine[d](latitude, m - o), s_sum = sums.sine[d](latitude, m + o);
            return Eigen::Vector4d(c + c_sum, c - c_sum, s_sum + s, s_sum - s);
          };
          const Eigen::Vector4d here = norm * weights[i] * products(i);
          const Eigen::Vector4d there =
              mirror == i ? Eigen::Vector4d::Zero() : Eigen::Vector4d(norm * weights[mirror] * products(mirror));
          for (int kind = 0; kind < kinds; ++kind) {
            even[kind * blocks + d] = here[kind] + there[kind];
            odd[kind * blocks + d] = here[kind] - there[kind];
          }
        }
      }
      const int used = o > 0 ? kinds : m > 0 ? 3 : 1;  // no sine has m = 0
      for (int l = m; l <= p; ++l)
        for (int n = o; n <= p; ++n) {
          const double* f = functions.col(legendre_index(p, l, m)).data();
          const double* g = functions.col(legendre_index(p, n, o)).data();
          Pack<3> first, second;
          const Lane* here = longitude[(l + m + n + o) % 2].get();
          for (int i = 0; i < half; ++i, here += numbers / lanes) {
            const double both = f[i] * g[i];
            first.add(both, here);
            second.add(both, here + 3);
          }
          Lane entry[numbers / lanes];
          first.store(entry);
          second.store(entry + 3);
          const double* from = reinterpret_cast<const double*>(entry);
          for (int kind = 0; kind < used; ++kind, from += blocks) {
            if (o == 0 && kind == 1) continue;
            const int a = coefficient_index(l, sign[kind] * m), b = coefficient_index(n, other_sign[kind] * o);
            double *one = matrix.values.data() + a * row + b, *other = matrix.values.data() + b * row + a;
            for (int d = 0; d < blocks; ++d, one += matrix.stride, other += matrix.stride) *one = *other = from[d];
          }
        }
    }
  return matrix;
}

}  // namespace sim
