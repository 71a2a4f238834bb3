#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;
using test::pi;

TEST_CASE("the Gauss-Legendre rule integrates polynomials of degree 2n-1 exactly") {
  for (const int n : {2, 5, 9, 34}) {
    const GaussLegendre rule = gauss_legendre(n);
    for (int degree = 0; degree < 2 * n; ++degree) {
      double sum = 0;
      for (int i = 0; i < n; ++i) sum += rule.weight[i] * std::pow(std::cos(rule.theta[i]), degree);
      CHECK(sum == Approx(degree % 2 ? 0 : 2.0 / (degree + 1)).margin(1e-14));
    }
  }
}

TEST_CASE("the real spherical harmonics are orthonormal on the grid") {
  for (const int p : {4, 9, 16}) {
    const Basis basis(p, p);
    const Coefficients unit{p, Matrix::Identity(coefficient_count(p), coefficient_count(p))};
    const Matrix y = basis.synthesize(unit).values;
    const Matrix gram = y.transpose() * basis.weights().asDiagonal() * y;
    CHECK((gram - Matrix::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff() < 1e-13);
  }
}

TEST_CASE("analysis inverts synthesis, with dense Fourier products and with FFTW") {
  for (const int p : {8, 16, 48}) {  // FFTW above degree 40
    const Basis basis(p, p + 3);
    const Coefficients c = test::smooth_field(p, p, 3, 7);
    CHECK((basis.analyze(basis.synthesize(c)).values - c.values).cwiseAbs().maxCoeff() < 1e-13);
  }
}

TEST_CASE("both Fourier paths give the same values and derivatives") {
  const Coefficients c = test::smooth_field(12, 12, 2, 3);
  const Basis dense(12, 50), fast(48, 50);
  const SecondDerivatives a = dense.second(c), b = fast.second(resized(c, 48));
  for (const auto member : {&SecondDerivatives::value, &SecondDerivatives::t, &SecondDerivatives::f,
                            &SecondDerivatives::tt, &SecondDerivatives::tf, &SecondDerivatives::ff})
    CHECK((a.*member - b.*member).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("derivatives of x y z on the sphere are the exact ones") {
  const Basis basis(5, 9);
  Matrix samples(basis.points(), 1);
  const auto each = [&](auto&& f) {
    for (int j = 0; j < basis.longitudes(); ++j)
      for (int i = 0; i < basis.latitudes(); ++i) f(i + basis.latitudes() * j, basis.theta()[i], basis.phi()[j]);
  };
  // x y z = sin^2 t cos t sin 2f / 2
  each(
      [&](int k, double t, double f) { samples(k, 0) = std::pow(std::sin(t), 2) * std::cos(t) * std::sin(2 * f) / 2; });
  const SecondDerivatives d = basis.second(basis.analyze(samples));
  double worst = 0;
  each([&](int k, double t, double f) {
    const double s = std::sin(t), c = std::cos(t);
    const double g = s * s * c / 2, g1 = s * c * c - s * s * s / 2, g2 = c * c * c - 7 * s * s * c / 2;
    for (const double error : {d.value(k, 0) - g * std::sin(2 * f), d.t(k, 0) - g1 * std::sin(2 * f),
                               d.f(k, 0) - 2 * g * std::cos(2 * f), d.tt(k, 0) - g2 * std::sin(2 * f),
                               d.tf(k, 0) - 2 * g1 * std::cos(2 * f), d.ff(k, 0) + 4 * g * std::sin(2 * f)})
      worst = std::max(worst, std::abs(error));
  });
  CHECK(worst < 1e-13);
}

TEST_CASE("values at scattered points and on any lattice agree with the grid, poles included") {
  const int p = 11;
  const Basis basis(p, p);
  const Coefficients c = test::smooth_field(p, p, 2, 5);
  Vector theta(basis.latitudes() + 2);
  theta << 0, basis.theta(), pi;
  const FirstDerivatives lattice = sample_grid(c, theta, basis.phi()), grid = basis.first(c);
  Matrix direction(basis.points(), 3);
  double worst = 0;
  for (int j = 0; j < basis.longitudes(); ++j)
    for (int i = 0; i < basis.latitudes(); ++i) {
      const int k = i + basis.latitudes() * j;
      const Eigen::Index l = i + 1 + theta.size() * j;
      const double t = basis.theta()[i], f = basis.phi()[j];
      direction.row(k) << std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t);
      worst = std::max({worst, (lattice.value.row(l) - grid.value.row(k)).norm(),
                        (lattice.t.row(l) - grid.t.row(k)).norm(), (lattice.f.row(l) - grid.f.row(k)).norm()});
    }
  CHECK(worst < 1e-13);
  const FirstDerivatives points = sample_points_first(c, direction);
  CHECK((points.value - grid.value).cwiseAbs().maxCoeff() < 1e-13);
  CHECK((points.t - grid.t).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((points.f - grid.f).cwiseAbs().maxCoeff() < 1e-12);
  for (int j = 1; j < basis.longitudes(); ++j)  // one value at each pole, whatever phi
    CHECK((lattice.value.row(theta.size() * j) - lattice.value.row(0)).norm() < 1e-14);
}

TEST_CASE("derivatives of a point taken alone are covariant ones of those on the grid") {
  const int p = 9;
  const Basis basis(p, p);
  const Coefficients x = test::smooth_field(p, p, 3, 3);
  const SecondDerivatives d = basis.second(x);
  const PointSampler sampler(x);
  const auto row = [](const Matrix& m, Eigen::Index k) { return Vec3(m.row(k).transpose()); };
  for (Eigen::Index k = 0; k < basis.points(); ++k) {
    const PointTangents at = sampler.tangents(grid_direction(basis, k));
    const double t = basis.theta()[k % basis.latitudes()], sine = std::sin(t), cot = std::cos(t) / sine;
    const double error = (at.x - row(d.value, k)).norm() + (at.a - row(d.t, k)).norm() +
                         (at.b - row(d.f, k) / sine).norm() + (at.aa - row(d.tt, k)).norm() +
                         (at.ab - (row(d.tf, k) - cot * row(d.f, k)) / sine).norm() +
                         (at.bb - (row(d.ff, k) / (sine * sine) + cot * row(d.t, k))).norm();
    CHECK(error < 1e-11);  // rounding, of second derivatives divided by the square of the sine
  }
}

TEST_CASE("resampling to a higher order and back changes nothing") {
  const Coefficients c = test::smooth_field(6, 6, 1, 1);
  CHECK((resized(resized(c, 13), 6).values - c.values).norm() == 0);
  CHECK((Basis(13, 13).synthesize(resized(c, 13)).values - Basis(6, 13).synthesize(c).values).norm() < 1e-13);
}

TEST_CASE(
    "a point of a surface taken alone lies on it, and its second derivatives add up to the Laplacian, at poles too") {
  const auto p = GENERATE(0, 1, 7, 30);
  std::srand(5);
  Coefficients x{p, Matrix::Random(coefficient_count(p), 3)};
  for (int n = 0; n <= p; ++n) x.values.middleRows(n * n, 2 * n + 1) *= std::pow(0.7, n);
  Coefficients laplacian = x;
  for (int n = 0; n <= p; ++n) laplacian.values.middleRows(n * n, 2 * n + 1) *= -n * (n + 1);
  const PointSampler sampler(x);
  for (const Vec3& given : {Vec3(0.3, -0.5, 0.9), Vec3(-0.2, 0, -0.1), Vec3(1, 0, 0), Vec3(1e-3, 1e-3, 1),
                            Vec3(0, 0, 1), Vec3(1e-12, 0, -1)}) {
    const Vec3 s = beside_the_pole(given.normalized());
    INFO("p = " << p << ", s = " << s.transpose());
    const PointTangents at = sampler.tangents(given);
    const double size = x.values.norm() * (p + 1) * (p + 1);  // bound of all sums, and so of their rounding
    CHECK((sampler.position(3 * given) - sample_points(x, given.normalized().transpose()).row(0).transpose()).norm() <
          1e-14 * size);
    CHECK((at.x - sampler.position(s)).norm() < 1e-14 * size);
    // Circles of latitude of radius rho amplify rounding by its inverse square.
    const double rounding = 1e-14 * (p + 1) * (p + 1) * size / std::min(1.0, at.pole * at.pole);
    CHECK((at.aa + at.bb - sample_points(laplacian, s.transpose()).row(0).transpose()).norm() <
          std::max(rounding, 1e-13));
    // Central differences along great circles, which are exact to h^4 of the fifth derivative.
    constexpr double h = 1e-3;
    const auto along = [&](double u, double v) { return sampler.position(s + u * at.e1 + v * at.e2); };
    const auto slope = [&](auto f) { return Vec3((8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h)); };
    const double truncation = std::pow(h * (p + 1), 4) * size + 1e-12 * size;
    CHECK((at.a - slope([&](double u) { return along(std::tan(u), 0); })).norm() < truncation);
    CHECK((at.b - slope([&](double v) { return along(0, std::tan(v)); })).norm() < truncation + 1e-16 * size / at.pole);
    CHECK(at.e1.cross(at.e2).dot(s) == Approx(1).epsilon(1e-14));
    if (at.pole > 0.1) {  // mixed: the slope along e2, moved in parallel along e1
      const Vec3 mixed = slope([&](double u) {
        const PointTangents there = sampler.tangents(s + std::tan(u) * at.e1);
        return there.b;  // meridians are great circles, so e2 is parallel along them
      });
      CHECK((at.ab - mixed).norm() < (p + 1) * (truncation + 1e-12 * size));
    }
  }
}
