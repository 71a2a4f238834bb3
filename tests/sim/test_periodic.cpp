// Fast sums in periodic cells, sheared or not.
#include "sim/fast/fast_sum.h"
#include "sim/layers/far_field.h"
#include "sim/layers/kernels.h"
#include "sim/layers/layer_potentials.h"
#include "sim/membrane/gmres.h"
#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;

namespace {

/// Random points in bodies that overlap one another and their images.
struct Lattice {
  Eigen::Matrix3d cell;
  std::vector<FastBody> bodies;
  std::vector<FastGroup> groups;
  std::vector<FastStrengths> strengths;
  std::vector<Exclusion> exclusions;
};

Lattice lattice() {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  Lattice l;
  l.cell << 2.5, 0.1, 1.1, 0, 2.7, 0, 0, 0, 3;
  constexpr int points = 20;
  for (int i = 0; i < 4; ++i) {
    const Vec3 centre = 4 * vector();  // in other cells, too
    FastBody body{Points(3, points), {}, 0};
    FastStrengths s{Points(3, points), Tensors(6, points)};
    for (int k = 0; k < points; ++k) {
      body.coarse.col(k) = centre + 0.5 * vector();
      s.force.col(k) = vector();
      for (int row = 0; row < 6; ++row) s.dual(row, k) = uniform(random);
    }
    l.groups.push_back({body.coarse, i});
    l.bodies.push_back(body);
    l.strengths.push_back(s);
  }
  return l;
}

std::vector<Points> velocities(const Lattice& l, double cutoff, double wave_number = 0) {
  FastSetting setting = fast_setting(1e-10, true);
  setting.cutoff = cutoff;
  setting.cell = l.cell;
  if (wave_number > 0) {
    setting.wave_number = wave_number;
    setting.accuracy = 1e-14;
    setting.window = Window::most;
    setting.oversampling = 1.4;
  }
  FastParts parts;
  return fast_velocity(plan_fast_sum(setting, l.bodies, l.groups, l.exclusions, true, parts), l.strengths,
                       std::vector<FastStrengths>(l.bodies.size()));
}

double difference(std::span<const Points> a, std::span<const Points> b) {
  double square = 0, norm = 0;
  for (std::size_t g = 0; g < b.size(); ++g) {
    square += (a[g] - b[g]).squaredNorm();
    norm += b[g].squaredNorm();
  }
  return std::sqrt(square / norm);
}

}  // namespace

TEST_CASE("a periodic sum does not depend on where it is split, nor on how its lattice is written") {
  Lattice l = lattice();
  l.exclusions = {{0, 1, {0, 3, 7}}, {2, 2, {1, 4}, Eigen::Vector3i(1, 0, 0)}};
  const std::vector<Points> u = velocities(l, 0.8, 31);
  CHECK(difference(velocities(l, 1.1, 31), u) < 1e-10);
  CHECK(difference(velocities(l, 1.1), u) < 1e-8);
  // A strain of 1/2 is one of -1/2.
  l.exclusions.clear();
  l.cell.col(2) = Vec3(1.25, 0, 3);
  const std::vector<Points> half = velocities(l, 1);
  l.cell.col(2) = Vec3(-1.25, 0, 3);
  CHECK(difference(velocities(l, 1), half) < 1e-8);
}

TEST_CASE("a periodic cell that is doubled in any direction, with all that is in it, has the same velocities") {
  Lattice l = lattice();
  const std::vector<Points> u = velocities(l, 1);
  const std::size_t n = u.size();
  for (int d = 0; d < 3; ++d) {
    Lattice twice = l;
    for (std::size_t i = 0; i < n; ++i) {
      FastBody body = l.bodies[i];
      body.coarse.colwise() += Vec3(l.cell.col(d));
      twice.groups.push_back({body.coarse, int(n + i)});
      twice.bodies.push_back(body);
      twice.strengths.push_back(l.strengths[i]);
    }
    twice.cell.col(d) *= 2;
    const std::vector<Points> both = velocities(twice, 1);
    INFO(d);
    // Bodies do not see themselves, but now their images.
    CHECK(difference(std::span(both).first(n), u) < 1e-8);
    CHECK(difference(std::span(both).last(n), u) < 1e-8);
  }
}

TEST_CASE("in a sheared periodic cell the double layer of a body that moves as a whole is 0 outside and -1 inside") {
  const int order = 8;
  const Basis basis(order, 40);
  const Sources s = make_sources(basis, test::potato(order));
  const Vec3 density(1, -2, 0.5);
  FastStrengths strengths{Points::Zero(3, basis.points()), Tensors(6, basis.points())};
  for (int k = 0; k < basis.points(); ++k) {
    const Vec3 n = stresslet_factor * s.normals.row(k).transpose();
    const Eigen::Matrix3d q = 0.5 * (n * density.transpose() + density * n.transpose());
    strengths.dual.col(k) << q(0, 0), q(0, 1), q(0, 2), q(1, 1), q(1, 2), q(2, 2);
  }
  Points x(3, 3);
  x << 0.02, 0, 1.9, 0.05, 0, 0.2, -0.03, 2.2, -1.8;
  FastSetting setting = fast_setting(1e-7, true);
  setting.cutoff = 1.5;
  Eigen::Matrix3d cell;
  cell << 4, 0, 1.2, 0, 4.2, 0, 0, 0, 4.4;
  setting.cell = cell;
  FastParts parts;
  const std::vector<FastGroup> groups{{x, -1}};
  const std::vector<FastBody> bodies{{s.points.transpose(), {}, 0}};
  const Points u = fast_velocity(plan_fast_sum(setting, bodies, groups, {}, true, parts), std::vector{strengths},
                                 std::vector<FastStrengths>(1))[0];
  CHECK((u.col(0) + density).norm() < 1e-5);
  CHECK(u.col(1).norm() < 1e-5);
  CHECK(u.col(2).norm() < 1e-5);
}

TEST_CASE("spheres in a simple cubic array have the drag of Zick and Homsy") {
  const int p = 8;
  const Coefficients x = test::surface("sphere", 1, p);
  const Basis target(p, p + 1), spread(p, 2 * p), fine(p, 4 * p);
  const Sources on_spread = make_sources(spread, x), on_fine = make_sources(fine, x);
  const LayerMatrix own = LayerPotentials(p).assemble(x, false).single;
  const auto strengths = [](const Basis& basis, const Sources& s, const Coefficients& f) {
    return FastStrengths{
        stokeslet_factor * (basis.synthesize(f).values.array().colwise() * s.area.array()).matrix().transpose(), {}};
  };
  for (const auto& [fraction, drag, digits] :
       {std::tuple(0.027, 2.008, 5e-4), {0.125, 4.292, 5e-4}, {0.343, 15.4, 0.05}}) {
    FastSetting setting = fast_setting(1e-7, false);
    setting.cutoff = 1.2;
    setting.cell = Eigen::Matrix3d(std::cbrt(4 * test::pi / 3 / fraction) * Eigen::Matrix3d::Identity());
    FastParts parts;
    const std::vector<FastBody> bodies{
        {on_spread.points.transpose(), on_fine.points.transpose(), 4 * on_spread.spacing.maxCoeff()}};
    const std::vector<FastGroup> groups{{make_sources(target, x).points.transpose(), 0}};
    const FastSum sum = plan_fast_sum(setting, bodies, groups, {}, false, parts);
    const auto velocity = [&](const Vector& y) {
      const Coefficients f{p, y.reshaped(coefficient_count(p), 3)};
      const Points images =
          fast_velocity(sum, std::vector{strengths(spread, on_spread, f)}, std::vector{strengths(fine, on_fine, f)})[0];
      return Vector((own.apply(f).values + target.analyze(Matrix(images.transpose())).values).reshaped());
    };
    const Vector wanted = test::constant_field(p, {1, 0, 0}).values.reshaped();
    const GmresResult result = gmres(
        velocity, [](const Vector& y) { return y; }, wanted, Vector::Zero(wanted.size()), 1e-6, 60);
    REQUIRE(result.converged);
    const Coefficients f{p, result.solution.reshaped(coefficient_count(p), 3)};
    const Sources on_target = make_sources(target, x);
    const double force = target.synthesize(f).values.col(0).dot(on_target.area);
    INFO(fraction);
    CHECK(std::abs(force / (6 * test::pi) - drag) < digits);
  }
}
