#include "sim/stepping/start.h"
#include "sim/suspension/interaction.h"
#include "sim/suspension/repulsion.h"
#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;
using test::pi;

namespace {

/// Resultants of force densities.
std::vector<Vec3> resultants(std::span<const Coefficients> x, std::span<const Coefficients> forces) {
  std::vector<Vec3> net;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const Basis basis(x[k].order, 4 * x[k].order);
    net.push_back(basis.synthesize(forces[k]).values.transpose() * geometry(basis, x[k]).dA);
  }
  return net;
}

/// Of exp(-(r - 1) / range) away from the centre of a unit sphere, over another unit sphere with its centre at a
/// distance d: the integral over r from d - 1 to d + 1, with dA = 2 pi r dr / d.
double between_spheres(double d, double range) {
  const auto beyond = [&](double r) {
    return std::exp(-(r - 1) / range) * range * (r * r + d * d - 1 + 2 * r * range + 2 * range * range);
  };
  return pi / (d * d) * (beyond(d - 1) - beyond(d + 1));
}

}  // namespace

TEST_CASE("the repulsion of two spheres has the resultant of its closed form, wherever between grid points they meet") {
  Plans plans;
  for (const double range : {0.01, 0.02, 0.05, 0.1, 0.5})
    for (const Vec3& to : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0.3, -0.5, 0.7), Vec3(0.9, 0.31, 0.13)}) {
      std::vector<Coefficients> x;
      const double d = 2.02;
      for (const double side : {-0.5, 0.5}) {
        VesicleParameters v = test::vesicle("sphere", 1, 8);
        v.center = side * d * to.normalized();
        x.push_back(initial_position(v));
      }
      const auto net = resultants(x, repulsion_forces(plans, x, {3, range}));
      INFO("range " << range << ", towards " << to.transpose());
      const Vec3 expected = 3 * between_spheres(d, range) * to.normalized();
      // 1e-3: what the grid leaves of a peak.
      CHECK((net[1] - expected).norm() < 1e-3 * expected.norm());
      CHECK((net[0] + expected).norm() < 1e-3 * expected.norm());
    }
}

TEST_CASE("the repulsion of ellipsoids tip to tip is that of a grid four times as fine") {
  Plans plans;
  const double range = 0.02;
  for (const double aside : {0.0, 0.07, 0.2}) {
    const Coefficients one = test::ellipsoid({1.5, 0.75, 0.65}, 8);
    Coefficients other = one;
    other.values.row(0) += std::sqrt(4 * pi) * Vec3(3.02, aside, 0.5 * aside).transpose();
    const std::vector<Coefficients> x{one, other};
    const auto force = repulsion_forces(plans, x, {1, range});
    const Basis basis(8, 4 * repulsion_order(8, 1, 1, range));
    const Matrix points = basis.synthesize(one).values;
    Matrix traction = Matrix::Zero(points.rows(), 3);
    for (Eigen::Index k = 0; k < points.rows(); ++k) {
      const Vec3 at = points.row(k).transpose();
      if (at[0] < 0.9) continue;  // there the gap is more than 20 ranges
      const NearestPoint foot = nearest_point(PointSampler(other), at, -Vec3::UnitX());
      traction.row(k) = std::exp(-foot.distance / range) * (at - foot.position).normalized().transpose();
    }
    const Coefficients expected = basis.analyze(traction);
    INFO("aside " << aside);
    // 2e-3: what the coarser grid leaves of the peak.
    CHECK((force[0].values - expected.values).norm() < 2e-3 * expected.values.norm());
  }
}

TEST_CASE("the repulsion of a vesicle's own images is that of two more vesicles in their places") {
  Plans plans;
  VesicleParameters v = test::vesicle("sphere", 1, 8);
  const Coefficients one = initial_position(v);
  Eigen::Matrix3d sides = Eigen::Vector3d(2.05, 6, 6).asDiagonal();
  const auto alone = repulsion_forces(plans, {&one, 1}, {1, 0.05}, sides);
  std::vector<Coefficients> three{one};
  for (const double side : {-1.0, 1.0}) {
    v.center = {2.05 * side, 0, 0};
    three.push_back(initial_position(v));
  }
  const auto beside = repulsion_forces(plans, three, {1, 0.05});
  CHECK(alone[0].values.norm() > 1e-2);
  CHECK((alone[0].values - beside[0].values).norm() < 1e-12);
}

TEST_CASE("no repulsion is made without strength, nor for a vesicle alone, nor between vesicles far apart") {
  Plans plans;
  std::vector<Coefficients> x;
  for (const double side : {-2.0, 2.0}) {
    VesicleParameters v = test::vesicle("sphere", 1, 6);
    v.center = {side, 0, 0};
    x.push_back(initial_position(v));
  }
  CHECK(repulsion_forces(plans, x, {0, 0.05}).empty());
  CHECK(repulsion_forces(plans, {x.data(), 1}, {1, 0.05}).empty());
  CHECK(repulsion_forces(plans, x, {1, 0.05})[0].values.norm() == 0);
}

TEST_CASE("a range of a thousandth of a radius is taken in any unit, and a shorter one is refused with the least") {
  for (const double unit : {1e-6, 1.0, 1e6}) {
    Scene scene = test::shear_scene(test::vesicle("sphere", 1, 4), 0.1, 1);
    scene.vesicles.push_back(scene.vesicles[0]);
    for (VesicleParameters& v : scene.vesicles) v.radius = unit, v.bending_modulus *= unit * unit * unit;
    scene.vesicles[1].center = {0, 0, 3 * unit};
    scene.numerics.repulsion_strength = 1;
    Plans plans;
    scene.numerics.repulsion_range = 0.001 * unit;
    CHECK_NOTHROW(initial_dynamics(make_model(scene, plans)));
    scene.numerics.repulsion_range = 0.0009 * unit;
    CHECK_THROWS_WITH(initial_dynamics(make_model(scene, plans)),
                      Catch::Contains("repulsion_range") && Catch::Contains("at least"));
  }
}

TEST_CASE("magnitudes that leave no digits for the shape are refused by their key") {
  Plans plans;
  const auto refused = [&](const Scene& scene) {
    try {
      initial_dynamics(make_model(scene, plans));
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  Scene usual = test::shear_scene(test::vesicle("prolate", 0.9, 4), 0.1, 1);
  usual.vesicles.push_back(usual.vesicles[0]);
  usual.vesicles[1].center = Vec3(0, 0, 4);
  usual.numerics.repulsion_strength = 1e6;
  usual.buoyancy.gravity = Vec3(0, 0, -1);
  CHECK(refused(usual).empty());
  for (const double large : {1e30, 1e300}) {
    Scene s = usual;
    s.numerics.repulsion_strength = large;
    CHECK_THAT(refused(s), Catch::Contains("numerics.repulsion_strength = 1e+") && Catch::Contains("too large"));
    s = usual;
    s.flows[0].rate = large;
    CHECK_THAT(refused(s), Catch::Contains("the [[flow]] 'shear' is too large"));
    s = usual;
    s.vesicles[0].density_difference = large;
    CHECK_THAT(refused(s), Catch::Contains("vesicle.density_difference = 1e+"));
  }
  usual.vesicles[1].bending_modulus = 1e300;
  CHECK_THAT(refused(usual), Catch::Contains("vesicle.bending_modulus = 1e+") && Catch::Contains("vesicle 1"));
}
