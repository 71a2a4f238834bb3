#include "sim/core/parallel.h"
#include "sim/layers/source_tiles.h"
#include "sim/suspension/gap.h"
#include "sim/suspension/placements.h"
#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;
using test::pi;

namespace {

/// A target at `gap` outside (or inside, negative) the surface point of a parameter, with its nearest point.
struct Target {
  Vec3 x;
  NearestPoint nearest;
};

std::vector<Target> targets(const Coefficients& x, double gap) {
  const Basis basis(x.order, x.order + 3);
  const Geometry g = geometry(basis, x);
  std::vector<Target> all;
  for (int k = 3; k < basis.points(); k += 23) {
    const double t = basis.theta()[k % basis.latitudes()], f = basis.phi()[k / basis.latitudes()];
    const Vec3 at = g.x.value.row(k).transpose() + gap * g.n.row(k).transpose();
    all.push_back({at, nearest_point(PointSampler(x), at,
                                     Vec3(std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t)))});
  }
  return all;
}

/// Largest relative errors of S and D of the position against a much finer rule.
std::pair<double, double> near_errors(const Coefficients& x, double gap, NearOrder order) {
  const RotationPlan plan(x.order);
  double single = 0, dual = 0;
  for (const Target& t : targets(x, gap)) {
    const PointRow row = near_row(near_rule(plan.order(), order), plan, x, t.x, t.nearest, true),
                   exact = near_row(near_rule(plan.order(), {220, 300}), plan, x, t.x, t.nearest, true);
    const Vec3 s = apply_row(exact.single, x.values);
    single = std::max(single, (apply_row(row.single, x.values) - s).norm() / s.norm());
    dual = std::max(dual, (apply_row(row.dual, x.values) - apply_row(exact.dual, x.values)).norm() / 0.5);
  }
  return {single, dual};
}

Scene pair_scene(const Vec3& centre, double step, double lambda = 10, std::string scheme = "bdf2", int order = 6) {
  VesicleParameters v = test::vesicle("prolate", 0.9, order, lambda);
  v.center = -centre;
  Scene scene = test::shear_scene(v, step, 1, std::move(scheme));
  v.center = centre;
  scene.vesicles.push_back(v);
  return scene;
}

}  // namespace

TEST_CASE("turning a field to the pole and back leaves it, and its value at the pole is that at the point") {
  const RotationPlan plan(9);
  const Coefficients c = test::smooth_field(9, 9, 2, 3);
  const double theta = 0.8, phi = 2.3;
  const Matrix turned = plan.to_pole(c.values, theta, phi);
  CHECK((plan.from_pole(turned, theta, phi) - c.values).norm() < 1e-13);  // orthogonal: the transpose is the inverse
  const Vec3 s(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  CHECK((sample_points({9, turned}, Vec3::UnitZ().transpose()) - sample_points(c, s.transpose())).norm() < 1e-13);
}

TEST_CASE("the nearest source is found in tiles as among all points, and none beyond a limit") {
  const Coefficients x = test::potato(8);
  const Basis basis(8, 23);
  const Sources sources = make_sources(basis, x);
  const SourceTiles tiles = make_tiles(basis, sources);
  std::srand(3);
  for (int k = 0; k < 500; ++k) {
    const Vec3 at = (k % 2 ? 0.9 : 3.0) * Vec3::Random();
    Eigen::Index source = 0;
    const double distance = (sources.points.rowwise() - at.transpose()).rowwise().norm().minCoeff(&source);
    const auto [found, near] = nearest_source(tiles, at);
    CHECK(found == source);
    CHECK(near == Approx(distance).epsilon(1e-14));
    CHECK(nearest_source(tiles, at, 0.999 * distance).first == -1);
    CHECK(nearest_source(tiles, at, 1.001 * distance).first == source);
  }
}

TEST_CASE("the nearest point of an ellipsoid is found from outside and from inside") {
  const Coefficients x = test::ellipsoid({1.5, 1, 0.7}, 4);
  for (const double gap : {0.3, 0.01, -0.01})
    for (const Target& t : targets(x, gap)) {
      CHECK(t.nearest.distance == Approx(std::abs(gap)).epsilon(1e-9));
      CHECK(t.nearest.inside == (gap < 0));
    }
}

TEST_CASE(
    "the side of a membrane is known over its poles, where the coordinates end, from starts there and beside them") {
  const Coefficients x = test::ellipsoid({1.5, 1, 0.7}, 4);
  for (const Vec3& pole : {Vec3(0, 0, 1), Vec3(0, 0, -1)})
    for (const Vec3& start : {pole, Vec3(pole + Vec3(0.07, -0.03, 0))})
      for (const double gap : {0.3, 0.01, 1e-5, -1e-5, -0.01}) {
        const Vec3 foot = sample_points(x, pole.transpose()).row(0).transpose();
        const NearestPoint nearest = nearest_point(PointSampler(x), foot + gap * foot.normalized(), start);
        INFO("gap " << gap << ", start " << start.transpose());
        CHECK(nearest.distance == Approx(std::abs(gap)).epsilon(1e-6));  // 1e-6 beside the pole
        CHECK(nearest.inside == (gap < 0));
      }
}

TEST_CASE(
    "the nearest point of a disc is the foot of the normal to rounding, from a start of a grid point's distance") {
  const Coefficients x = test::surface("biconcave", 0.65, 8);
  const Basis basis(8, 11);
  const Geometry g = geometry(basis, x);
  const Matrix s = grid_directions(basis);
  for (const double gap : {-0.01, 1e-3, 0.3})
    for (int k = 3; k < basis.points(); k += 7) {
      const Vec3 foot = g.x.value.row(k).transpose(), start = s.row(k).transpose() + 0.07 * Vec3(0.6, -0.5, 0.6);
      const NearestPoint nearest = nearest_point(PointSampler(x), foot + gap * g.n.row(k).transpose(), start);
      CHECK(nearest.distance == Approx(std::abs(gap)).epsilon(1e-12));
      CHECK((nearest.position - foot).norm() <
            1e-9);  // a root of rounding errors where the distance is flat: 1e-8 of 1e-16
      CHECK(nearest.inside == (gap < 0));
    }
}

TEST_CASE("the near rule meets 1e-5 at a gap of 0.01 and 1e-4 at 0.001, on the prolate at 48 x 64") {
  const Coefficients x = test::surface("prolate", 0.85, 8);
  for (const auto& [gap, bound] : {std::pair{1e-1, 1e-8}, {1e-2, 1e-5}, {1e-3, 1e-4}}) {
    const auto [single, dual] = near_errors(x, gap, {48, 64});
    CHECK(single < bound);
    CHECK(dual < bound);
  }
}

TEST_CASE("the near rule meets the same bounds on the biconcave disc at 96 x 160") {
  const Coefficients x = test::surface("biconcave", 0.65, 8);
  for (const auto& [gap, bound] : {std::pair{1e-2, 1e-5}, {1e-3, 1e-4}}) {
    const auto [single, dual] = near_errors(x, gap, {96, 160});
    CHECK(single < bound);
    CHECK(dual < bound);
  }
}

TEST_CASE("the near rule gives at once what its rows give") {
  const Coefficients x = test::surface("biconcave", 0.65, 7), force = test::smooth_field(7, 7, 3, 2),
                     dual = test::smooth_field(7, 7, 3, 4);
  const RotationPlan plan(7);
  for (const Target& t : targets(x, 0.02)) {
    const PointRow row = near_row(near_rule(plan.order(), {20, 24}), plan, x, t.x, t.nearest, true);
    const Vec3 single = apply_row(row.single, force.values), both = single + apply_row(row.dual, dual.values);
    CHECK((near_velocity(near_rule(plan.order(), {20, 24}), plan, x, t.x, t.nearest, force, nullptr) - single).norm() <
          1e-13);
    CHECK((near_velocity(near_rule(plan.order(), {20, 24}), plan, x, t.x, t.nearest, force, &dual) - both).norm() <
          1e-12);
  }
}

TEST_CASE("the block scheme of a close pair differs from the coupled one by the order of the step") {
  const auto position = [](const char* scheme, double dt) {
    Plans plans;
    Scene scene = pair_scene({0, 0, 0.8}, dt, 4, scheme);
    scene.numerics.correction = false;
    scene.numerics.reparametrization = "off";
    const Model s = make_model(scene, plans);
    return Matrix(test::advanced(s, initial_dynamics(s), dt, int(std::lround(0.2 / dt))).vesicles[0].position.values);
  };
  const Matrix exact = position("bdf2", 0.025);
  const double coarse = (position("block-implicit", 0.1) - exact).norm(),
               fine = (position("block-implicit", 0.05) - exact).norm();
  CHECK(coarse / fine == Approx(2).margin(0.5));
}

TEST_CASE("the double layer of a constant is 0 just outside and -1 just inside") {
  const Coefficients x = test::surface("prolate", 0.85, 8), one = test::constant_field(8, {1, -2, 0.5});
  const RotationPlan plan(8);
  for (const double gap : {1e-1, 1e-3, -1e-1, -1e-3})
    for (const Target& t : targets(x, gap)) {
      const Vec3 u =
          apply_row(near_row(near_rule(plan.order(), {48, 64}), plan, x, t.x, t.nearest, true).dual, one.values);
      const Vec3 expected = gap > 0 ? Vec3(Vec3::Zero()) : Vec3(-1, 2, -0.5);
      CHECK((u - expected).norm() < 1e-5);
    }
}

TEST_CASE(
    "Green's identity: a Stokes flow from within gives S[traction] - D[u] of its own values outside, near and far") {
  // With f = traction of the exterior flow on the surface, exterior u = -S[f] + D[u] in the signs of conventions.md;
  // for a translating sphere f = -3/(2a) U is constant and D[U] vanishes outside: u = (3/2) S[U].
  const Coefficients x = test::surface("sphere", 1, 8), f = test::constant_field(8, {1.5, 0, 0});
  const RotationPlan plan(8);
  for (const double gap : {0.5, 0.05, 1e-3})
    for (const Target& t : targets(x, gap)) {
      const double r = t.x.norm();
      const Vec3 e = t.x / r, U(1, 0, 0);
      const Vec3 stokes = 0.75 / r * (U + e * e.dot(U)) + 0.25 / (r * r * r) * (U - 3 * e * e.dot(U));
      CHECK((apply_row(near_row(near_rule(plan.order(), {48, 64}), plan, x, t.x, t.nearest, false).single, f.values) -
             stokes)
                .norm() < 1e-5);
    }
}

TEST_CASE("the smooth rule and the near rule agree where both are accurate") {
  Plans plans;
  std::vector<Coefficients> x;
  for (const double side : {-1.0, 1.0}) {
    VesicleParameters v = test::vesicle("prolate", 0.85, 8);
    v.center = {0, 0, side * 1.1};
    x.push_back(initial_position(v));
  }
  const std::vector<Material> materials(2, {5, 0.01, 0});
  const std::vector<Densities> densities{{test::smooth_field(8, 5, 3, 1), test::smooth_field(8, 5, 3, 2)},
                                         {test::smooth_field(8, 5, 3, 3), test::smooth_field(8, 5, 3, 4)}};
  const auto velocity = [&](double spacings, int order) {
    return induced_velocity(plan_interaction(plans, x, materials, {order, true, {48, 64}, spacings, 0}), densities);
  };
  const auto near = velocity(100, 0), smooth = velocity(0, 60);
  for (int k = 0; k < 2; ++k) CHECK((near[k].values - smooth[k].values).norm() < 1e-7 * near[k].values.norm());
}

TEST_CASE("two close vesicles move as the near rule for an error says, to that error, and no finer than need be") {
  const auto velocity = [](int order, double gap, NearOrder nodes) {
    const double half = spheroid_axes(0.85, true).y() + gap / 2;
    Scene scene = pair_scene({0, 0, half}, 0.1, 10, "bdf2", order);
    for (VesicleParameters& v : scene.vesicles) v.reduced_volume = 0.85;
    scene.vesicles[0].axis = {1, 0, 0};
    scene.vesicles[1].axis = {0.6, 0.8, 0};
    scene.numerics.far_field = "direct";
    scene.numerics.near_latitudes = nodes.latitudes;
    scene.numerics.near_longitudes = nodes.longitudes;
    Plans plans;
    const Model s = make_model(scene, plans);
    return evaluate(s, initial_dynamics(s)).value().vesicles[0].velocity.values;
  };
  for (const auto& [order, gap, allowed] : {std::tuple{8, 0.1, 1e-4}, {8, 0.02, 1e-5}, {12, 0.02, 1e-6}}) {
    const Matrix exact = velocity(order, gap, {72, 96});
    const double error = (velocity(order, gap, near_order_for(order, allowed)) - exact).cwiseAbs().maxCoeff();
    CHECK(error < allowed);
    CHECK(error > 0.01 * allowed);
  }
}

TEST_CASE("two sinking spheres far apart follow the method of reflections with an error of fourth order") {
  // Side by side 1 + (3/4) a/r + (1/2)(a/r)^3; in line 1 + (3/2) a/r - (a/r)^3; what is left out begins at (a/r)^4.
  const auto excess = [](double r, const Vec3& along) {
    Plans plans;
    Scene scene;
    scene.time.step = 0.1;
    scene.buoyancy.gravity = {0, 0, -1};
    for (const double side : {-0.5, 0.5}) {
      VesicleParameters v = test::vesicle("sphere", 1, 6, 2);
      v.density_difference = 4.5;  // U0 = 1
      v.center = side * r * along;
      scene.vesicles.push_back(v);
    }
    const Model s = make_model(scene, plans);
    const State state = evaluate(s, initial_dynamics(s)).value();
    const double u = -state.vesicles[0].velocity.values(0, 2) / std::sqrt(4 * pi);  // mean over the sphere
    const double a = 1 / r;
    const double theory = along[2] == 0 ? 1 + 0.75 * a + 0.5 * a * a * a : 1 + 1.5 * a - a * a * a;
    return std::abs(u - theory);
  };
  for (const Vec3& along : {Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
    CHECK(excess(16, along) < 10 * std::pow(1.0 / 16, 4));
    CHECK(excess(16, along) < excess(8, along) / 8);  // at least third order in 1/r; fourth in theory
  }
}

TEST_CASE("identical vesicles at x and -x stay point-symmetric") {
  Plans plans;
  const Scene scene = pair_scene({1.3, 0, -0.6}, 0.1);
  const Model s = make_model(scene, plans);
  const Dynamics d = test::advanced(s, initial_dynamics(s), 0.1, 5);
  const Matrix dots = tracer_directions();
  const Matrix a = sample_points(d.vesicles[0].position, dots), b = sample_points(d.vesicles[1].position, -dots);
  CHECK((a + b).norm() < 1e-8);  // GMRES at 1e-10, five steps
}

TEST_CASE("all schemes agree to first order in the step on one vesicle") {
  const double lambda = GENERATE(1.0, 4.0);
  const auto position = [lambda](const char* scheme, double dt) {
    Plans plans;
    Scene scene = test::shear_scene(test::vesicle("prolate", 0.9, 6, lambda), dt, 1, scheme);
    scene.numerics.correction = false;
    scene.numerics.reparametrization = "off";
    const Model s = make_model(scene, plans);
    return Matrix(test::advanced(s, initial_dynamics(s), dt, int(std::lround(0.2 / dt))).vesicles[0].position.values);
  };
  const Matrix exact = position("bdf2", 0.01);
  INFO("viscosity contrast " << lambda);
  for (const char* scheme : {"explicit", "block-jacobi", "block-implicit", "globally-implicit"}) {
    const double coarse = (position(scheme, 0.05) - exact).norm(), fine = (position(scheme, 0.025) - exact).norm();
    INFO(scheme);
    CHECK(coarse < 0.05);
    CHECK(coarse / fine == Approx(2).margin(0.5));
  }
}

TEST_CASE("block and global solves agree when vesicles are far apart, and differ more as the gap closes") {
  const auto difference = [](double distance) {
    Plans plans;
    std::vector<Matrix> x;
    for (const char* scheme : {"block-implicit", "globally-implicit"}) {
      const Scene scene = pair_scene({0, 0, distance / 2}, 0.1, 10, scheme);
      const Model s = make_model(scene, plans);
      x.push_back(test::advanced(s, initial_dynamics(s), 0.1, 1).vesicles[0].position.values);
    }
    return (x[0] - x[1]).norm() / x[1].norm();
  };
  const double far = difference(20), middle = difference(3), close = difference(1.8);
  CHECK(far < 1e-4);
  CHECK(middle > 3 * far);
  CHECK(close > 2 * middle);
}

TEST_CASE("with the block preconditioner the coupled solve takes single digits on vesicles far apart") {
  Plans plans;
  Scene scene = pair_scene({0, 0, 5}, 0.1, 10, "globally-implicit");
  scene.numerics.preconditioner = "block";
  scene.numerics.gmres_tolerance = 1e-8;
  const Model s = make_model(scene, plans);
  CHECK(take_step(s, initial_dynamics(s), 0.1).value().record.iterations < 10);
}

TEST_CASE("gaps are measured between the surfaces, not between grid points") {
  Plans plans;
  for (const double gap : {0.5, 0.01, 1e-3}) {
    VesicleParameters v = test::vesicle("sphere", 1, 6);
    const Coefficients a = initial_position(v);
    v.center = (2 + gap) * Vec3(0.3, -0.5, 0.8).normalized();
    const Coefficients b = initial_position(v);
    const Gap g = smallest_gap(plans, std::vector{a, b});
    CHECK(g.distance == Approx(gap).epsilon(gap < 0.1 ? 1e-5 : 0.05));  // exact only near contact, where it matters
    CHECK_FALSE(g.crossing);
  }
}

TEST_CASE("the gap from each vesicle to its neighbours is that to the nearest") {
  Plans plans;
  std::vector<Coefficients> row;
  for (const double at : {0.0, 2.1, 4.15, 9.0}) {  // spheres of radius 1
    VesicleParameters v = test::vesicle("sphere", 1, 6);
    v.center = {at, 0, 0};
    row.push_back(initial_position(v));
  }
  const std::vector<double> gaps = gaps_to_neighbours(plans, row, 0.5);
  CHECK(gaps[0] == Approx(0.1).epsilon(1e-5));
  CHECK(gaps[1] == Approx(0.05).epsilon(1e-5));
  CHECK(gaps[2] == Approx(0.05).epsilon(1e-5));
  CHECK(gaps[3] > 0.5);
  CHECK(smallest_gap(plans, row).distance == Approx(0.05).epsilon(1e-5));
}

TEST_CASE("surfaces that touch or cross slightly are said to cross") {
  Plans plans;
  for (const double overlap : {1e-12, 1e-3, 0.02, 0.2}) {
    VesicleParameters v = test::vesicle("prolate", 0.85, 8);
    const Coefficients a = initial_position(v);
    const Geometry g = geometry(plans.basis(8, 12), a);
    v.center = {0, 0, 2 * g.x.value.col(2).maxCoeff() - overlap};
    CHECK(smallest_gap(plans, std::vector{a, initial_position(v)}).crossing);
  }
}

TEST_CASE("overlapping and nested vesicles are refused with their numbers") {
  Plans plans;
  for (const double distance : {0.0, 0.4, 1.9}) {
    Scene scene = test::shear_scene(test::vesicle("sphere", 1, 6), 0.1, 1);
    VesicleParameters other = test::vesicle("sphere", 1, 6);
    other.radius = distance == 0 ? 0.4 : 1;
    other.center = {distance, 0, 0};
    scene.vesicles.push_back(other);
    const Model s = make_model(scene, plans);
    CHECK_THROWS_WITH(initial_dynamics(s), Catch::Contains("vesicles 0 and 1 overlap"));
  }
}

TEST_CASE("a pair gives the same bits with one and with two threads") {
  const Scene scene = pair_scene({1.3, 0, -0.6}, 0.1);
  const auto run = [&](int threads) {
    Plans plans;
    const Model s = make_model(scene, plans);
    std::vector<double> numbers;
    with_threads(threads, [&] { numbers = serialised(test::advanced(s, initial_dynamics(s), 0.1, 2)); });
    return numbers;
  };
  const bool same = run(1) == run(2);
  CHECK(same);
}

TEST_CASE(
    "placements put as many vesicles as asked at the volume fraction asked, without overlap, and alike each time") {
  for (const auto& row : placement_catalogue()) {
    if (row.name == "file") continue;
    Scene scene = test::shear_scene(test::vesicle("prolate", 0.9, 4), 0.1, 1);
    PlacementParameters p;
    p.kind = row.name;
    p.count = 8;
    p.volume_fraction = 0.08;
    p.jitter = 0.05;
    p.orientation = "random";
    scene.placements = {p};
    const Scene full = placed(scene), again = placed(scene);
    INFO(row.name);
    REQUIRE(full.vesicles.size() == 8);
    CHECK(full.placements.empty());
    for (std::size_t k = 0; k < 8; ++k) CHECK(full.vesicles[k].center == again.vesicles[k].center);
    const double gap = test::starting_gap(full);
    CHECK(gap > 0);
    if (row.name != "lattice") CHECK(gap >= default_placement_gap * (1 - 1e-6));
  }
}

TEST_CASE(
    "a volume fraction that cannot be placed is refused, at once where it is hopeless, else with how many could") {
  Scene scene = test::shear_scene(test::vesicle("sphere", 1, 4), 0.1, 1);
  PlacementParameters p;
  p.kind = "tube";
  p.count = 60;
  p.volume_fraction = 0.45;
  scene.placements = {p};
  CHECK_THROWS_WITH(placed(scene), Catch::Contains("of 60 vesicles of radius 1 could be placed"));
  scene.placements[0].kind = "box";
  scene.placements[0].volume_fraction = 0.74;
  scene.placements[0].gap = 0.2;
  scene.placements[0].count = 5000;
  int asked = 0;
  CHECK_THROWS_WITH(placed(scene, [&] { return ++asked > 0; }), Catch::Contains("cannot be placed at random"));
  CHECK(asked == 0);
}

TEST_CASE("a search for places ends when it is told to stop") {
  Scene scene = test::shear_scene(test::vesicle("sphere", 1, 4), 0.1, 1);
  PlacementParameters p;
  p.kind = "box";
  p.count = 60;
  p.volume_fraction = 0.3;
  scene.placements = {p};
  int asked = 0;
  CHECK_THROWS_AS(placed(scene, [&] { return ++asked == 5; }), std::system_error);
  CHECK(asked == 5);
}

TEST_CASE("gaps of placements are in radii unless they are given") {
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.9, 4), 0.1, 1);
  PlacementParameters p;
  p.kind = "box";
  p.count = 6;
  scene.placements = {p};
  const Scene large = placed(scene);
  scene.vesicles[0].radius = 1e-6;
  const Scene small = placed(scene);
  for (std::size_t k = 0; k < 6; ++k) CHECK((small.vesicles[k].center * 1e6 - large.vesicles[k].center).norm() < 1e-9);
}

TEST_CASE("a volume of many vesicles gives the same velocities by the coarse and the fine source grid") {
  Plans plans;
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.9, 6, 5), 0.1, 1);
  PlacementParameters p;
  p.count = 8;
  p.volume_fraction = 0.01;  // far apart: all pairs take the coarse grid
  scene.placements = {p};
  scene = placed(scene);
  std::vector<Coefficients> x;
  std::vector<Densities> densities;
  for (unsigned k = 0; k < 8; ++k) {
    x.push_back(initial_position(scene.vesicles[k]));
    densities.push_back({test::smooth_field(6, 6, 3, k), test::smooth_field(6, 6, 3, 50 + k)});
  }
  const std::vector<Material> materials(8, {5, 0.01, 0});
  const auto coarse = induced_velocity(plan_interaction(plans, x, materials, {}), densities);
  const auto fine = induced_velocity(plan_interaction(plans, x, materials, {40, true, {48, 64}, 4, 0}), densities);
  // The densities reach the highest degree; what the coarse grid aliases of them decays like (size/distance)^p.
  for (int k = 0; k < 8; ++k) CHECK((coarse[k].values - fine[k].values).norm() < 2e-5 * fine[k].values.norm());
}
