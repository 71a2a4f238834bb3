// The places where another method could stand in: near pairs, the far field, the store of plans, the inner product of
// GMRES.
#include "sim/core/attempt.h"
#include "sim/core/cells.h"
#include "sim/layers/far_field.h"
#include "sim/layers/kernels.h"
#include "sim/layers/plans.h"
#include "sim/membrane/gmres.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <thread>

using namespace sim;
using test::pi;

TEST_CASE("cells find the very pairs of near boxes that trying all finds, in the same order") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double spread : {0.5, 3.0, 1e4, 1e20})
    for (const double reach : {0.0, 0.3, 10.0}) {
      std::vector<Box> boxes;
      for (int k = 0; k < 200; ++k) {
        const Vec3 centre = spread * Vec3(uniform(random), uniform(random), uniform(random)) + Vec3(1e5, -3, 0);
        const Vec3 half = 0.5 * Vec3(uniform(random), uniform(random), uniform(random)).cwiseAbs();
        boxes.push_back({centre - half, centre + half});
      }
      std::vector<std::pair<int, int>> all;
      for (int i = 0; i < 200; ++i)
        for (int j = i + 1; j < 200; ++j)
          if (distance(boxes[i], boxes[j]) <= reach) all.emplace_back(i, j);
      INFO(spread << " " << reach);
      CHECK(near_pairs(boxes, reach) == all);
    }
}

TEST_CASE("a pair of boxes is found once, however far from the others it lies") {
  const auto at = [](double x) { return Box{Vec3(x - 1, -1, -1), Vec3(x + 1, 1, 1)}; };
  const std::vector<Box> boxes{at(0), at(1e20), at(1e20), at(3)};
  CHECK(near_pairs(boxes, 2) == std::vector<std::pair<int, int>>{{0, 3}, {1, 2}});
}

TEST_CASE("the kernels are the closed forms, for points, lanes and arrays alike") {
  const Vec3 r(0.3, -1.1, 0.7), n(0.2, 0.5, -0.4), f(1, 2, 3);
  const double d = r.norm();
  const KernelTensor<double> g = stokeslet(1 / d, stokeslet_factor);
  CHECK((g.even * f + g.outer * r.dot(f) * r - (f / d + r * r.dot(f) / std::pow(d, 3)) / (8 * pi)).norm() < 1e-15);
  const double t = stresslet(1 / d, stresslet_factor * r.dot(n));
  CHECK(t * r.dot(f) == Approx(3 / (4 * pi) * r.dot(n) * r.dot(f) / std::pow(d, 5)).epsilon(1e-14));
  double components[6];
  outer_components(t, {r[0], r[1], r[2]}, components);
  const double expected[] = {r[0] * r[0], r[0] * r[1], r[0] * r[2], r[1] * r[1], r[1] * r[2], r[2] * r[2]};
  for (int k = 0; k < 6; ++k) CHECK(components[k] == Approx(t * expected[k]).epsilon(1e-14));
}

TEST_CASE("the far field leaves out a group's own surface and what is excluded, and nothing else") {
  const int order = 6;
  const Basis basis(order, 12);
  std::vector<Sources> sources;
  std::vector<SourceDensities> densities;
  for (unsigned k = 0; k < 3; ++k) {
    Coefficients x = test::potato(order);
    x.values += test::constant_field(order, Vec3(4.0 * k, 1.0 * k, 0)).values;
    sources.push_back(make_sources(basis, x));
    densities.push_back({basis.synthesize(test::smooth_field(order, 3, 3, k)).values,
                         k == 1 ? Matrix() : basis.synthesize(test::smooth_field(order, 3, 3, 9 + k)).values});
  }
  Matrix free(5, 3);
  free << 0, 5, 0, 1, 6, 2, -4, 0, 1, 20, 3, 3, 7, -5, 1;
  FarField far =
      plan_far_field(std::make_shared<const std::vector<Sources>>(sources), {{sources[0].points, 0}, {free, -1}});
  exclude(far, {{1, 2, {1, 3}}, {0, 1, {0}}});
  const std::vector<Matrix> u = far_velocity(far, densities);
  const auto by_one = [&](int surface, const Vec3& at) {
    Matrix v = Matrix::Zero(1, 3);
    add_direct_sum(sources[surface], densities[surface], at.transpose(), v);
    return v;
  };
  for (int k = 0; k < 5; ++k) {
    Matrix expected = by_one(0, free.row(k).transpose()) + by_one(1, free.row(k).transpose());
    if (k != 1 && k != 3) expected += by_one(2, free.row(k).transpose());
    CHECK((u[1].row(k) - expected).norm() < 1e-13);
  }
  for (int k = 0; k < 4; ++k) {
    Matrix expected = by_one(2, sources[0].points.row(k).transpose());
    if (k != 0) expected += by_one(1, sources[0].points.row(k).transpose());
    CHECK((u[0].row(k) - expected).norm() < 1e-13);
  }
}

TEST_CASE("a constant density makes the double layer of a closed surface -1 inside and 0 outside by the smooth rule") {
  const int order = 8;
  const Basis basis(order, 40);
  const Sources s = make_sources(basis, test::potato(order));
  const Vec3 density(1, -2, 0.5);
  const SourceDensities d{Matrix::Zero(basis.points(), 3), density.transpose().replicate(basis.points(), 1)};
  Matrix points(2, 3), u = Matrix::Zero(2, 3);
  points << 0.02, 0.05, -0.03, 0, 0, 5;
  add_direct_sum(s, d, points, u);
  CHECK((u.row(0).transpose() + density).norm() < 1e-6);
  CHECK(u.row(1).norm() < 1e-9);
}

TEST_CASE("a direct sum gives the same bits four targets at once and as many as the processor can") {
  const int order = 4;
  const Basis basis(order, order + 1);
  const Sources s = make_sources(basis, test::potato(order));
  const Matrix force = basis.synthesize(test::smooth_field(order, 3, 3, 1)).values;
  for (const Matrix& dual : {Matrix(), Matrix(basis.synthesize(test::smooth_field(order, 3, 3, 2)).values)})
    for (const int count : {1, 4, 5, 8, 12, 15}) {  // whole and partial vectors of both widths
      const Matrix points = 3 * s.points.topRows(count);
      Matrix four = Matrix::Ones(count, 3), widest = four;
      add_direct_sum(s, {force, dual}, points, four, LaneCount::four);
      add_direct_sum(s, {force, dual}, points, widest);
      CHECK(four == widest);
    }
}

TEST_CASE("a plan is made once, whoever asks at the same time, and forgotten when nobody has asked for long") {
  Plans plans;
  std::vector<const Basis*> seen(8);
  std::vector<std::thread> threads;
  for (const Basis*& basis : seen) threads.emplace_back([&plans, &basis] { basis = &plans.basis(12, 40); });
  for (std::thread& t : threads) t.join();
  for (const Basis* basis : seen) CHECK(basis == seen[0]);
  CHECK(plans.size() == 1);
  for (int round = 0; round < 20; ++round) {
    plans.rotation(4);  // in use
    plans.forget_unused(10);
  }
  CHECK(plans.size() == 1);
  CHECK(&plans.rotation(4) == &plans.rotation(4));
}

TEST_CASE("GMRES solves the same system in whatever inner product it is given") {
  const int n = 30;
  std::srand(5);
  const Matrix a = Matrix::Random(n, n) + 8 * Matrix::Identity(n, n);
  const Vector b = Vector::Random(n), weights = Vector::Random(n).cwiseAbs().array() + 0.5;
  const LinearMap left = [&](const Vector&x) { return Vector(a * x); }, none = [](const Vector&x) { return x; };
  int products = 0;
  const InnerProducts weighted = [&](std::span<const Matrix> vectors, int count, const Vector& with) {
    ++products;
    return plain_products(vectors, count, weights.cwiseProduct(with));
  };
  const GmresResult plain = gmres(left, none, b, Vector::Zero(n), 1e-12, 60);
  const GmresResult other = gmres(left, none, b, Vector::Zero(n), 1e-12, 60, weighted);
  REQUIRE((plain.converged && other.converged));
  CHECK((plain.solution - other.solution).norm() < 1e-10);
  // All products of a new vector at once, and twice; three norms before.
  CHECK(products == 2 * other.iterations + 3);
  const Vector residual = b - a * other.solution;
  CHECK(std::sqrt(residual.cwiseAbs2().dot(weights) / b.cwiseAbs2().dot(weights)) < 2e-12);
}

TEST_CASE("the basis of GMRES is orthogonal to rounding, however ill-conditioned the system is") {
  const int n = 120, most = 60;
  // Eigenvalues from 1 to 1e12: new vectors lie nearly in the space of the earlier ones.
  Vector spectrum(n);
  for (int i = 0; i < n; ++i) spectrum[i] = std::pow(10, 12.0 * i / (n - 1));
  std::srand(9);
  const Matrix q = Eigen::HouseholderQR<Matrix>(Matrix::Random(n, n)).householderQ();
  const Matrix a = q * spectrum.asDiagonal() * q.transpose();
  const Vector b = q * Vector::Ones(n);
  std::vector<Vector> basis;
  const LinearMap left = [&](const Vector& x) { return Vector(a * x); };
  const LinearMap none = [&](const Vector& x) {  // it is asked for every vector of the basis
    basis.push_back(x);
    return x;
  };
  const GmresResult result = gmres(left, none, b, Vector::Zero(n), 1e-14, most);
  REQUIRE(basis.size() == most);
  Matrix v(n, most);
  for (int k = 0; k < most; ++k) v.col(k) = basis[std::size_t(k)];
  // 1e-14 k: rounding of as many products. Once, or modified, Gram-Schmidt leaves 1e-9.
  CHECK((v.transpose() * v - Matrix::Identity(most, most)).norm() < 1e-14 * most);
  // The residual of the recurrence is that of the solution, but for rounding in A x.
  const double norm = spectrum[n - 1], residual = (b - a * result.solution).norm() / b.norm();
  CHECK(std::abs(result.residual - residual) < 1e-15 * norm * result.solution.norm() / b.norm());
}

TEST_CASE("an attempt is a value or the reason why there is none") {
  const Attempt<int> good = 3, bad = Rejection{"too long"};
  CHECK((good && *good == 3));
  CHECK((!bad && bad.rejection().reason == "too long"));
  CHECK_THROWS_WITH(Attempt<int>(bad).value(), "too long");
  const auto refused = within_domain([]() -> Attempt<int> { throw std::domain_error("no surface"); });
  CHECK((!refused && refused.rejection().reason == "no surface"));
}
