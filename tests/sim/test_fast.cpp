// Fast sums: kernels split into a smooth part, summed by Fourier transforms, and a rest within a cut-off.
#include "sim/core/parallel.h"
#include "sim/fast/fast_sum.h"
#include "sim/suspension/interaction.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <cmath>
#include <complex>
#include <random>

using namespace sim;

namespace {

/// Bodies of random points that overlap, each a group of targets, and one group that belongs to none.
struct Cloud {
  std::vector<FastBody> bodies;
  std::vector<FastGroup> groups;
  std::vector<FastStrengths> strengths;
  std::vector<Exclusion> exclusions{{0, 1, {0, 3, 7}}, {2, 4, {1}}, {12, 0, {2, 5}}};
};

Cloud cloud(bool dual, double unit = 1, const Vec3& place = Vec3::Zero()) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  Cloud c;
  constexpr int bodies = 12, points = 30;
  for (int i = 0; i < bodies; ++i) {
    const Vec3 centre = 2 * vector();
    FastBody body{Points(3, points), {}, 0};
    FastStrengths strengths{Points(3, points), Tensors(6, dual ? points : 0)};
    for (int k = 0; k < points; ++k) {
      body.coarse.col(k) = unit * (place + centre + 0.5 * vector());
      strengths.force.col(k) = unit * vector();
      for (int row = 0; dual && row < 6; ++row) strengths.dual(row, k) = unit * unit * uniform(random);
    }
    c.groups.push_back({body.coarse, i});
    c.bodies.push_back(body);
    c.strengths.push_back(strengths);
  }
  FastGroup free{Points(3, 7), -1};
  for (int k = 0; k < 7; ++k) free.points.col(k) = unit * (place + 3 * vector());
  c.groups.push_back(free);
  return c;
}

std::vector<Points> fast(const Cloud& c, double tolerance, bool dual, double cutoff) {
  FastSetting setting = fast_setting(tolerance, dual);
  setting.cutoff = cutoff;
  FastParts parts;
  const FastSum sum = plan_fast_sum(setting, c.bodies, c.groups, c.exclusions, dual, parts);
  return fast_velocity(sum, c.strengths, std::vector<FastStrengths>(c.bodies.size()));
}

std::vector<Points> direct(const Cloud& c) {
  std::vector<Points> all;
  for (std::size_t g = 0; g < c.groups.size(); ++g) {
    const FastGroup& group = c.groups[g];
    Points& u = all.emplace_back(Points::Zero(3, group.points.cols()));
    for (int k = 0; k < group.points.cols(); ++k)
      for (int j = 0; j < std::ssize(c.bodies); ++j) {
        bool seen = j != group.body;
        for (const Exclusion& e : c.exclusions)
          if (e.group == int(g) && e.surface == j && std::count(e.targets.begin(), e.targets.end(), k) > 0)
            seen = false;
        const FastStrengths& s = c.strengths[std::size_t(j)];
        for (Eigen::Index l = 0; seen && l < s.force.cols(); ++l) {
          const Vec3 r = group.points.col(k) - c.bodies[std::size_t(j)].coarse.col(l), f = s.force.col(l);
          const double d = r.norm();
          u.col(k) += f / d + r * r.dot(f) / std::pow(d, 3);
          if (s.dual.cols() == 0) continue;
          const auto q = s.dual.col(l);
          Eigen::Matrix3d Q;
          Q << q[0], q[1], q[2], q[1], q[3], q[4], q[2], q[4], q[5];
          u.col(k) += r * r.dot(Q * r) / std::pow(d, 5);
        }
      }
  }
  return all;
}

double difference(const std::vector<Points>& a, const std::vector<Points>& b) {
  double square = 0, norm = 0;
  for (std::size_t g = 0; g < a.size(); ++g) {
    square += (a[g] - b[g]).squaredNorm();
    norm += b[g].squaredNorm();
  }
  return std::sqrt(square / norm);
}

}  // namespace

TEST_CASE("the prolate function is its own Fourier transform on the interval, up to a factor") {
  const double c = 9;
  const Prolate psi(c);
  const GaussRule rule = gauss_rule(60);
  const auto transform = [&](double x) {
    double sum = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i)
      sum += double(rule.weight[i]) * psi(double(rule.node[i])).value * std::cos(c * x * double(rule.node[i]));
    return sum;
  };
  CHECK(psi(0).value == Approx(1).epsilon(1e-14));
  for (const double x : {0.2, 0.55, 0.9, 1.0}) CHECK(std::abs(transform(x) / transform(0) - psi(x).value) < 1e-12);
  const double h = 1e-5;
  CHECK(psi(0.4).slope == Approx((psi(0.4 + h).value - psi(0.4 - h).value) / (2 * h)).epsilon(1e-8));
}

TEST_CASE("the smooth part of the kernels is the whole kernels at the cut-off, to the error of the split") {
  for (const double c : {12.0, 18.0, 24.0}) {
    const KernelSplit split(c, 1e-12);
    const auto at_cutoff = [&](Radial part) {
      double sum = 0;
      for (const double term : split.polynomial(part)) sum += term;  // 2 r^2 - 1 = 1
      return sum;
    };
    const double error = 500 * std::exp(-0.95 * c);
    CHECK(std::abs(at_cutoff(Radial::even) - 1) < error);
    CHECK(std::abs(at_cutoff(Radial::outer) - 1) < error);
    CHECK(std::abs(at_cutoff(Radial::cross)) < error);
    CHECK(std::abs(at_cutoff(Radial::dual) - 1) < error);
    CHECK(split.multiplier(0) == Approx(1).epsilon(1e-14));
    CHECK(std::abs(split.multiplier(0.01 * c) - 1) < 1e-8 * std::pow(c, 4));  // 1 + O(k^4)
    CHECK(split.multiplier(1.0001 * c) == 0);
  }
}

TEST_CASE("the fast sum of random points is the direct one to the tolerance, whatever the cut-off") {
  for (const bool dual : {false, true}) {
    const Cloud c = cloud(dual);
    const std::vector<Points> exact = direct(c);
    for (const auto& [tolerance, cutoff] : {std::pair(1e-4, 1.0), {1e-4, 2.0}, {1e-6, 1.5}, {1e-8, 1.5}}) {
      INFO(dual << " " << tolerance << " " << cutoff);
      CHECK(difference(fast(c, tolerance, dual, cutoff), exact) < 1.5 * tolerance);
    }
  }
}

TEST_CASE("a fast sum knows no unit of length and no origin") {
  const bool dual = true;
  const std::vector<Points> here = fast(cloud(dual), 1e-6, dual, 1.2);
  // In units of a power of two nothing is rounded in another way.
  const double unit = std::ldexp(1, 20);
  const std::vector<Points> scaled = fast(cloud(dual, unit), 1e-6, dual, 1.2 * unit);
  for (std::size_t g = 0; g < here.size(); ++g) CHECK((scaled[g] - here[g]).norm() == 0);
  CHECK(difference(fast(cloud(dual, 1e-6), 1e-6, dual, 1.2e-6), here) < 1e-12);
  // A point so far out has lost ten bits.
  CHECK(difference(fast(cloud(dual, 1, {1000, -300, 700}), 1e-6, dual, 1.2), here) < 1e-10);
}

TEST_CASE("fine points stand for the coarse ones where a patch of targets is near them, and nowhere else") {
  Cloud c = cloud(true);
  const double tolerance = 1e-6;
  std::vector<FastStrengths> fine;
  for (std::size_t j = 0; j < c.bodies.size(); ++j) {  // each point twice, with half the strength
    FastBody& body = c.bodies[j];
    body.fine.resize(3, 2 * body.coarse.cols());
    body.fine << body.coarse, body.coarse;
    body.fine_within = 0.4;
    FastStrengths s{Points(3, body.fine.cols()), Tensors(6, body.fine.cols())};
    s.force << 0.5 * c.strengths[j].force, 0.5 * c.strengths[j].force;
    s.dual << 0.5 * c.strengths[j].dual, 0.5 * c.strengths[j].dual;
    fine.push_back(s);
  }
  FastSetting setting = fast_setting(tolerance, true);
  setting.cutoff = 1.2;
  FastParts parts;
  const FastSum sum = plan_fast_sum(setting, c.bodies, c.groups, c.exclusions, true, parts);
  CHECK(difference(fast_velocity(sum, c.strengths, fine), direct(c)) < tolerance);
  for (FastStrengths& s : fine) s.force *= 2;
  CHECK(difference(fast_velocity(sum, c.strengths, fine), direct(c)) > 0.01);
}

TEST_CASE("the bits of a fast sum do not depend on the number of threads, nor on the sums before it") {
  const Cloud c = cloud(true);
  std::vector<Points> one, many;
  with_threads(1, [&] { one = fast(c, 1e-4, true, 1.0); });
  for (const int threads : {2, 3}) {
    with_threads(threads, [&] { many = fast(c, 1e-4, true, 1.0); });
    for (std::size_t g = 0; g < one.size(); ++g) CHECK(many[g] == one[g]);
  }
  FastParts parts;
  FastSetting setting = fast_setting(1e-6, true);
  plan_fast_sum(setting, c.bodies, c.groups, c.exclusions, true, parts);
  setting = fast_setting(1e-4, true);
  const FastSum again = plan_fast_sum(setting, c.bodies, c.groups, c.exclusions, true, parts);
  const std::vector<Points> later = fast_velocity(again, c.strengths, std::vector<FastStrengths>(c.bodies.size()));
  for (std::size_t g = 0; g < one.size(); ++g) CHECK(later[g] == one[g]);
}

TEST_CASE("patches hold every point once, as many as asked for, and lie within their radii") {
  const Cloud c = cloud(false);
  const Points& points = c.bodies[3].coarse;
  const Patches p = divide(points, 8);
  std::vector<int> seen(std::size_t(points.cols()), 0);
  for (int b = 0; b < p.count(); ++b) {
    const int size = p.first[std::size_t(b) + 1] - p.first[std::size_t(b)];
    CHECK(size == (b + 1 < p.count() ? 8 : points.cols() % 8));
    for (int k = p.first[std::size_t(b)]; k < p.first[std::size_t(b) + 1]; ++k) {
      const int point = p.order[std::size_t(k)];
      ++seen[std::size_t(point)];
      CHECK((points.col(point) - p.centres.col(b)).norm() <= p.radii[std::size_t(b)] * (1 + 1e-12));
    }
  }
  CHECK(seen == std::vector<int>(seen.size(), 1));
}

namespace {

/// Vesicles of two orders, sizes and contrasts, some close to each other.
struct Crowd {
  std::vector<Coefficients> positions;
  std::vector<Densities> densities;
  std::vector<Material> materials;
};

Crowd crowd(int side, double distance) {
  Crowd c;
  for (int k = 0; k < side * side * side; ++k) {
    const int order = k % 3 == 0 ? 6 : 8;
    VesicleParameters v = test::vesicle("prolate", 0.9, order);
    v.axis = Vec3(1, 0.3 * (k % 5), -0.2 * (k % 7));
    v.center = distance * Vec3(k % side, k / side % side, k / (side * side)) + 0.05 * Vec3(k % 3, k % 4, k % 5);
    Coefficients x = initial_position(v);
    if (k % 4 == 1) {
      const Vec3 centre = x.values.row(0).transpose();
      x.values *= 0.7;
      x.values.row(0) = centre.transpose();
    }
    c.positions.push_back(x);
    c.materials.push_back({k % 2 == 0 ? 5.0 : 1.0, 0.01, 0});
    c.densities.push_back(
        {test::smooth_field(order, 4, 3, unsigned(k)), test::smooth_field(order, 4, 3, unsigned(100 + k))});
    if (k % 2 == 1) c.densities.back().dual.values.setZero();
  }
  return c;
}

Interaction interaction_by(Plans& plans, const Crowd& c, const std::string& method, double tolerance) {
  InteractionOptions options;
  options.far = {method, tolerance};
  return plan_interaction(plans, c.positions, c.materials, options);
}

}  // namespace

TEST_CASE("vesicles of several orders and sizes move one another by the fast sum as by the direct one, near and far") {
  Plans plans;
  const Crowd c = crowd(2, 2.6);
  const Interaction direct = interaction_by(plans, c, "direct", 1e-6);
  CHECK(std::any_of(direct.pairs.begin(), direct.pairs.end(), [](const PairPlan& p) { return !p.near.empty(); }));
  const std::vector<Coefficients> expected = induced_velocity(direct, c.densities);
  // The direct sum itself, with its coarse grids of order p + 1, errs by 1e-6.
  for (const double tolerance : {1e-4, 3e-6}) {
    const Interaction fast = interaction_by(plans, c, "fast", tolerance);
    REQUIRE(fast.fast);
    const std::vector<Coefficients> u = induced_velocity(fast, c.densities);
    double square = 0, norm = 0;
    for (std::size_t k = 0; k < u.size(); ++k) {
      square += (u[k].values - expected[k].values).squaredNorm();
      norm += expected[k].values.squaredNorm();
    }
    INFO(tolerance);
    CHECK(std::sqrt(square / norm) < tolerance);
  }
}

TEST_CASE("two vesicles, and a cloud that is mostly empty, are summed directly; a crowd is not") {
  Plans plans;
  CHECK(interaction_by(plans, crowd(4, 2.8), "auto", 1e-4).fast);
  CHECK(!interaction_by(plans, crowd(4, 200), "auto", 1e-4).fast);
  Crowd pair = crowd(2, 2.8);
  pair.positions.resize(2);
  pair.materials.resize(2);
  CHECK(!interaction_by(plans, pair, "auto", 1e-4).fast);
}
