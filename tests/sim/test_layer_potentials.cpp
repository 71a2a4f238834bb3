#include "sim/core/parallel.h"
#include "sim/layers/product_matrix.h"
#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;
using test::pi;

namespace {

/// The vector harmonics of the unit sphere: V = grad Y - (n+1) Y e_r, W = grad Y + n Y e_r, X = e_r x grad Y.
struct VectorHarmonics {
  Coefficients v, w, x;
};

VectorHarmonics vector_harmonics(int p, int n, int m) {
  const Basis basis(p, p);
  Coefficients y{p, Matrix::Zero(coefficient_count(p), 1)};
  y.values(coefficient_index(n, m), 0) = 1;
  const Geometry g = geometry(basis, test::surface("sphere", 1, p));
  const FirstDerivatives d = basis.first(y);
  const Matrix gradient = surface_gradient(g, d);
  const Matrix radial = (g.n.array().colwise() * d.value.col(0).array()).matrix();
  Matrix turned(gradient.rows(), 3);
  for (Eigen::Index k = 0; k < gradient.rows(); ++k)
    turned.row(k) = Vec3(g.n.row(k).transpose()).cross(Vec3(gradient.row(k).transpose())).transpose();
  return {basis.analyze(Matrix(gradient - (n + 1) * radial)), basis.analyze(Matrix(gradient + n * radial)),
          basis.analyze(turned)};
}

double eigenvalue_error(const LayerMatrix& m, const Coefficients& f, double eigenvalue) {
  return (m.apply(f).values - eigenvalue * f.values).norm() / f.values.norm();
}

}  // namespace

TEST_CASE("S and D of the unit sphere have the exact spectra on the three families of vector harmonics") {
  for (const int p : {8, 10}) {  // even and odd numbers of latitudes come with the source orders
    for (const int source : {0, 2 * p, 2 * p + 1}) {
      const LayerMatrices m = LayerPotentials(p, source).assemble(test::surface("sphere", 1, p), true);
      for (int n = 1; n <= p - 1; ++n)  // V and W of degree n hold components of degree n + 1
        for (const int order : {0, 1, n, -1, -n}) {
          const VectorHarmonics h = vector_harmonics(p, n, order);
          const double a = n;
          CHECK(eigenvalue_error(m.single, h.v, a / ((2 * a + 1) * (2 * a + 3))) < 1e-12);
          CHECK(eigenvalue_error(m.single, h.w, (a + 1) / ((2 * a + 1) * (2 * a - 1))) < 1e-12);
          CHECK(eigenvalue_error(m.single, h.x, 1 / (2 * a + 1)) < 1e-12);
          CHECK(eigenvalue_error(m.dual, h.v, 3 / (2 * (2 * a + 1) * (2 * a + 3))) < 1e-12);
          CHECK(eigenvalue_error(m.dual, h.w, -3 / (2 * (2 * a + 1) * (2 * a - 1))) < 1e-12);
          CHECK(eigenvalue_error(m.dual, h.x, -3 / (2 * (2 * a + 1))) < 1e-12);
        }
    }
  }
}

TEST_CASE("D of a rigid motion is minus one half of it, within 2e-6 at source order p + 1 and 1e-11 at 2p") {
  const int p = 16;
  const Coefficients x = test::surface("prolate", 0.85, p), translation = test::constant_field(p, {1, 0.5, -0.3});
  const auto error = [&](int source, const Coefficients& f) {
    const LayerMatrices m = LayerPotentials(p, source).assemble(x, true);
    return (m.dual.apply(f).values + 0.5 * f.values).cwiseAbs().maxCoeff() / std::sqrt(4 * pi);
  };
  CHECK(error(0, translation) < 2e-6);
  CHECK(error(2 * p, translation) < 1e-11);
  const Basis basis(p, p);
  const Coefficients rotation = basis.analyze(test::cross_rows({0.2, -1, 0.4}, basis.synthesize(x).values));
  CHECK(error(2 * p, rotation) < 1e-11);
}

TEST_CASE("S and D of the position converge spectrally to the reference norms on the ellipsoid (1, 0.8, 0.6)") {
  constexpr double dual = 1.335754224622, single = 0.150573650159;
  // Measured errors of an independent implementation: 8.1e-6, 3.7e-8, 1.6e-10 at p = 8, 12, 16.
  const std::pair<int, double> allowed[] = {{8, 2e-5}, {12, 1e-7}, {16, 5e-10}};
  for (const auto& [p, tolerance] : allowed) {
    const Coefficients x = test::ellipsoid({1, 0.8, 0.6}, p);
    const LayerMatrices m = LayerPotentials(p).assemble(x, true);
    CHECK(m.dual.apply(x).values.norm() == Approx(dual).epsilon(tolerance));
    CHECK(m.single.apply(x).values.norm() == Approx(single).epsilon(tolerance));
  }
}

TEST_CASE("S and D of the position on the biconcave disc are within twice the reference errors") {
  constexpr double dual = 1.236249878;
  const std::pair<int, double> allowed[] = {{8, 2e-2}, {12, 4e-3}, {16, 1.1e-3}};
  for (const auto& [p, tolerance] : allowed) {
    const Coefficients x = test::surface("biconcave", 0.65, p);
    const LayerMatrices m = LayerPotentials(p).assemble(x, true);
    CHECK(m.dual.apply(x).values.norm() == Approx(dual).epsilon(tolerance));
  }
}

TEST_CASE("turning the surface and the density turns S and D of it") {
  const int p = 10;
  const Coefficients x = test::potato(p), f = test::smooth_field(p, 4, 3, 9);
  const LayerPotentials layers(p, 3 * p);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
  const auto turned = [&](const Coefficients& c) { return Coefficients{p, c.values * turn.transpose()}; };
  const LayerMatrices before = layers.assemble(x, true), after = layers.assemble(turned(x), true);
  CHECK((after.single.apply(turned(f)).values - turned(before.single.apply(f)).values).norm() < 1e-13);
  CHECK((after.dual.apply(turned(f)).values - turned(before.dual.apply(f)).values).norm() < 1e-13);
}

TEST_CASE("turning the parametrisation does not change S and D as functions of space, up to quadrature error") {
  const int p = 12;
  const Coefficients x = test::ellipsoid({1, 0.9, 0.8}, p), f = test::smooth_field(p, 2, 3, 10);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.8, Vec3(0.3, 1, 0.2).normalized()).toRotationMatrix();
  const Basis basis(p, p);
  Matrix direction(basis.points(), 3);
  for (int j = 0; j < basis.longitudes(); ++j)
    for (int i = 0; i < basis.latitudes(); ++i) {
      const double t = basis.theta()[i], a = basis.phi()[j];
      direction.row(i + basis.latitudes() * j) << std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t);
    }
  const auto reparametrised = [&](const Coefficients& c) {
    return basis.analyze(sample_points(c, direction * turn.transpose()));
  };
  const LayerPotentials layers(p, 2 * p);
  const LayerMatrices a = layers.assemble(x, true), b = layers.assemble(reparametrised(x), true);
  CHECK((b.single.apply(reparametrised(f)).values - reparametrised(a.single.apply(f)).values).norm() < 1e-7);
  CHECK((b.dual.apply(reparametrised(f)).values - reparametrised(a.dual.apply(f)).values).norm() < 1e-7);
}

TEST_CASE("assembly gives the same bits four targets at once and as many as the processor can") {
  for (const int p : {2, 7, 8, 9, 12}) {  // rows of targets that are no multiples of eight, odd and even latitudes
    const Coefficients x = test::potato(p);
    for (const bool with_double : {false, true}) {
      const LayerMatrices four = LayerPotentials(p, 0, LaneCount::four).assemble(x, with_double);
      const LayerMatrices widest = LayerPotentials(p).assemble(x, with_double);
      CHECK(four.single.values == widest.single.values);
      CHECK(four.dual.values == widest.dual.values);
    }
  }
}

TEST_CASE("assembly gives the same bits with one and with two threads, and S does not depend on asking for D") {
  const Coefficients x = test::potato(9);
  const LayerPotentials layers(9);
  LayerMatrices one, two, alone;
  with_threads(1, [&] { one = layers.assemble(x, true); });
  with_threads(2, [&] { two = layers.assemble(x, true), alone = layers.assemble(x, false); });
  CHECK(one.single.values == two.single.values);
  CHECK(one.dual.values == two.dual.values);
  const Coefficients f = test::smooth_field(9, 9, 3, 1);
  CHECK(one.single.apply(f).values == alone.single.apply(f).values);
}

TEST_CASE("the matrix of a product with a tensor field does what synthesis, product and analysis do") {
  for (const int p : {1, 4, 7})
    for (const int q : {p, p + 1, 2 * p}) {
      const Basis basis(p, q);
      Matrix tensor(basis.points(), 6), w = test::smooth_field(p, p, 3, 1).values;
      for (int d = 0; d < 6; ++d)  // of any degree: whatever a grid makes of it, both make
        for (int k = 0; k < basis.points(); ++k) tensor(k, d) = std::sin(1.0 + d + k * (3.0 + d));
      const Matrix on_grid = basis.synthesize({p, w}).values;
      Matrix image(basis.points(), 3);
      for (int d = 0; d < 3; ++d) {
        const int column[3] = {d == 0 ? 0 : d, d == 0 ? 1 : d + 2, d == 0 ? 2 : d + 3};
        image.col(d) = tensor.col(column[0]).cwiseProduct(on_grid.col(0)) +
                       tensor.col(column[1]).cwiseProduct(on_grid.col(1)) +
                       tensor.col(column[2]).cwiseProduct(on_grid.col(2));
      }
      const Matrix expected = basis.analyze(image).values;
      INFO("p = " << p << ", q = " << q);
      CHECK((product_matrix(basis, tensor).apply({p, w}).values - expected).norm() < 1e-13 * expected.norm());
    }
}
