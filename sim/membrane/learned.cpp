#include "sim/membrane/learned.h"

#include <algorithm>
#include <cmath>

namespace sim {

Vector precondition(const Learned* known, const LinearMap& inverse, const Vector& v) {
  if (!known || known->images.rows() != v.size()) return inverse(v);
  const Eigen::VectorXf share = known->images.transpose() * v.cast<float>(), part = known->images * share,
                        answer = known->directions * share;
  Vector z = inverse(v - part.cast<double>());
  z += answer.cast<double>();
  return z;
}

namespace {

/// What becomes of a coefficient when an axis of the parameters is reflected, x, y or z.
bool odd_under(int axis, int n, int m) {
  const bool sine = m < 0, odd_order = m % 2 != 0;
  if (axis == 2) return (n + m) % 2 != 0;
  return axis == 1 ? sine : sine != odd_order;
}

/// Column by column the unknowns, or rows, of a vesicle that are odd under a symmetry which a shape may have by itself,
/// as ones: reflections of an axis in space together with one of the parameters, and the inversion of all of them.
Eigen::MatrixXf odd_parts(Eigen::Index size) {
  const int p = int(std::lround(std::sqrt(double(size) / 4))) - 1, nc = coefficient_count(p);
  Eigen::MatrixXf odd = Eigen::MatrixXf::Zero(size, 10);
  for (int column = 0; column < 10; ++column) {
    const bool inversion = column == 9;
    for (int n = 0; n <= p; ++n)
      for (int m = -n; m <= n; ++m) {
        const bool of_parameters = inversion ? n % 2 != 0 : odd_under(column % 3, n, m);
        float* const at = odd.col(column).data() + coefficient_index(n, m);
        for (int d = 0; d < 3; ++d) at[d * nc] = of_parameters != (inversion || d == column / 3) ? 1 : 0;
        at[3 * nc] = of_parameters ? 1 : 0;
      }
  }
  return odd;
}

/// A direction and its image that are all but even, or odd, under a symmetry become so.
void make_symmetric(const Eigen::MatrixXf& odd, Eigen::VectorXf& direction, Eigen::VectorXf& image) {
  constexpr float least = 0.03F * 0.03F;
  const Eigen::VectorXf a = odd.transpose() * direction.cwiseAbs2() / direction.squaredNorm(),
                        b = odd.transpose() * image.cwiseAbs2() / image.squaredNorm();
  for (Eigen::Index k = 0; k < odd.cols(); ++k) {
    if (std::max(a[k], b[k]) < least) {
      direction.array() *= 1 - odd.col(k).array();
      image.array() *= 1 - odd.col(k).array();
    } else if (std::min(a[k], b[k]) > 1 - least) {
      direction.array() *= odd.col(k).array();
      image.array() *= odd.col(k).array();
    }
  }
}

}  // namespace

std::size_t telling(std::span<const double> residuals) {
  constexpr double least = 1e-5;
  return std::size_t(std::count_if(residuals.begin(), residuals.end(), [](double r) { return r > least; }));
}

std::shared_ptr<const Learned> learned(const Learned* before, const Searched& searched, std::size_t use, int most) {
  if (use == 0 || searched.images.empty()) return before ? std::make_shared<const Learned>(*before) : nullptr;
  const Eigen::Index size = searched.images[0].size();
  Eigen::MatrixXf directions(size, most), images(size, most);
  const Eigen::MatrixXf odd = odd_parts(size);
  int count = 0;
  const auto add = [&](Eigen::VectorXf direction, Eigen::VectorXf image) {
    for (int twice = 0; twice < 2; ++twice) {
      const Eigen::VectorXf h = images.leftCols(count).transpose() * image;
      image.noalias() -= images.leftCols(count) * h;
      direction.noalias() -= directions.leftCols(count) * h;
    }
    constexpr float new_share = 0.03F;  // what is scaled up from less brings its rounding along
    const float length = image.norm();
    if (!(length > new_share) || !direction.allFinite()) return;
    make_symmetric(odd, direction, image);
    directions.col(count) = direction / length;
    images.col(count++) = image / length;
  };
  for (std::size_t k = 0; k < std::min(use, searched.images.size()) && count < most; ++k) {
    const double length = searched.images[k].norm();
    if (length > 0 && std::isfinite(length))
      add((searched.directions[k] / length).cast<float>(), (searched.images[k] / length).cast<float>());
  }
  if (before && before->images.rows() == size)
    for (Eigen::Index k = 0; k < before->images.cols() && count < most; ++k)
      add(before->directions.col(k), before->images.col(k));
  return std::make_shared<const Learned>(Learned{directions.leftCols(count), images.leftCols(count)});
}

}  // namespace sim
