// Scenes in periodic cells: the lattice under a shear, images among near pairs and gaps, and runs.
#include "sim/measures/rheology.h"
#include "sim/membrane/cell.h"
#include "sim/suspension/gap.h"
#include "sim/suspension/placements.h"
#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;

namespace {

FlowParameters shear(double rate) {
  FlowParameters f;
  f.kind = "shear";
  f.rate = rate;
  return f;
}

/// Two vesicles that reach out of the cell, near images of each other and of themselves; one is more viscous.
struct Pair {
  std::vector<Coefficients> positions;
  std::vector<Material> materials;
  std::vector<Densities> densities;
  Eigen::Matrix3d cell;
};

Pair pair() {
  Pair p;
  for (int k = 0; k < 2; ++k) {
    VesicleParameters v = test::vesicle("prolate", 0.9, 6);
    v.axis = k == 0 ? Vec3(1, 0.2, 0.3) : Vec3(0.3, 1, -0.2);
    v.center = k == 0 ? Vec3(0.4, 0.1, 1.5) : Vec3(-0.3, 8.2, -0.6);
    p.positions.push_back(initial_position(v));
    p.materials.push_back({k == 0 ? 1.0 : 4.0, 0.1, 0});
    p.densities.push_back({test::smooth_field(6, 4, 3, unsigned(k)), test::smooth_field(6, 4, 3, unsigned(10 + k))});
  }
  p.densities[0].dual.values.setZero();
  p.cell << 3.6, 0, 0.9, 0, 3.7, 0, 0, 0, 4.4;
  return p;
}

std::vector<Coefficients> velocities(Plans& plans, const Pair& p, double tolerance) {
  InteractionOptions options;
  options.far = {"auto", tolerance, p.cell};
  return induced_velocity(plan_interaction(plans, p.positions, p.materials, options), p.densities);
}

double difference(std::span<const Coefficients> a, std::span<const Coefficients> b) {
  double square = 0, norm = 0;
  for (std::size_t k = 0; k < b.size(); ++k) {
    square += (a[k].values - b[k].values).squaredNorm();
    norm += b[k].values.squaredNorm();
  }
  return std::sqrt(square / norm);
}

void move(Coefficients& x, const Vec3& by) { x.values.row(0) += std::sqrt(4 * test::pi) * by.transpose(); }

Scene scene_of(std::vector<VesicleParameters> vesicles, const Vec3& size, std::vector<FlowParameters> flows) {
  Scene s;
  s.flows = std::move(flows);
  s.vesicles = std::move(vesicles);
  s.cell.size = size;
  s.time.end = 1;
  s.numerics.gmres_tolerance = 1e-7;
  return s;
}

Vec3 mean_velocity(const VesicleState& v) { return v.velocity.values.row(0).transpose() / std::sqrt(4 * test::pi); }

}  // namespace

TEST_CASE("a cell leans by the integral of the shear rate, no more than half of its length") {
  Scene s = scene_of({}, {4, 5, 2}, {shear(0.7)});
  const auto lean = [&](double t) { return (*cell_at(s, t))(0, 2); };
  CHECK(lean(0) == 0);
  CHECK(lean(1) == Approx(1.4));
  CHECK(lean(2) == Approx(2.8 - 4));
  CHECK(lean(200) == Approx(280 - 70 * 4).margin(1e-12));
  CHECK((*cell_at(s, 2)).col(1) == Vec3(0, 5, 0));
  FlowParameters pulse = shear(3);
  pulse.time_factor = "step";
  pulse.from = 1;
  pulse.until = 2.5;
  FlowParameters wave = shear(2);
  wave.time_factor = "oscillating";
  wave.frequency = 0.25;
  wave.phase = 0.4;
  const std::vector<FlowParameters> flows{pulse, wave, shear(0.1)};
  for (const double t : {0.5, 1.7, 4.0}) {
    double sum = 0;  // midpoints; the pulse begins and ends on a multiple of the step
    constexpr int steps = 4000;
    for (int k = 0; k < steps; ++k)
      for (const FlowParameters& f : flows) sum += f.rate * time_factor(f, (k + 0.5) * t / steps) * t / steps;
    CHECK(shear_strain(flows, t) == Approx(sum).epsilon(1e-3));
  }
}

TEST_CASE("every place is moved into the box by lattice vectors, and stays there") {
  const Scene s = scene_of({}, {4, 5, 2}, {shear(0.7)});
  for (const double t : {0.0, 1.0, 3.3})
    for (const Vec3& x : {Vec3(0.1, 0.2, 0.3), Vec3(17, -23, 4.9), Vec3(-2, 2.5, -1), Vec3(1e3, 0, -77)}) {
      const Vec3 shift = into_box(s, t, x), home = x + shift;
      for (int d = 0; d < 3; ++d) CHECK(std::abs(home[d]) <= (*s.cell.size)[d] / 2 * (1 + 1e-9));
      const Vec3 sides = cell_at(s, t)->inverse() * shift;
      CHECK((sides - sides.array().round().matrix()).norm() < 1e-9);
      CHECK(into_box(s, t, home).norm() < 1e-9);
    }
}

TEST_CASE("near images are those that trying all finds, each once, wherever the boxes lie") {
  Eigen::Matrix3d cell;
  cell << 3, 0, 1.2, 0, 4, 0, 0, 0, 2.5;
  std::vector<Box> boxes;
  for (int k = 0; k < 4; ++k) {
    const Vec3 low(1.3 * k - 9, 7 - 3.1 * k, 0.7 * k * k);
    boxes.push_back({low, low + Vec3(0.9, 1.1, 0.8)});
  }
  const double reach = 1.1;
  std::vector<std::tuple<int, int, int, int, int>> expected, found;
  constexpr int far = 9;
  for (int i = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j)
      for (int x = -far; x <= far; ++x)
        for (int y = -far; y <= far; ++y)
          for (int z = -far; z <= far; ++z) {
            if (i == j && std::tuple(x, y, z) <= std::tuple(0, 0, 0)) continue;
            const Vec3 shift = cell * Vec3(x, y, z);
            if (distance(boxes[i], Box{boxes[j].low + shift, boxes[j].high + shift}) <= reach)
              expected.emplace_back(i, j, x, y, z);
          }
  for (const ImagePair& p : near_images(boxes, reach, cell))
    found.emplace_back(p.first, p.second, p.image[0], p.image[1], p.image[2]);
  CHECK(expected.size() > 10);
  CHECK(found == expected);
}

TEST_CASE(
    "vesicles in a cell move one another by a sum that does not depend on its split, nor on the cell they are in") {
  Plans plans;
  Pair p = pair();
  const std::vector<Coefficients> u = velocities(plans, p, 1e-7);
  CHECK(difference(velocities(plans, p, 1e-4), u) < 1e-4);
  CHECK(difference(velocities(plans, p, 1e-5), u) < 1e-5);
  Pair elsewhere = p;
  move(elsewhere.positions[0], p.cell * Vec3(3, -1, 2));
  CHECK(difference(velocities(plans, elsewhere, 1e-7), u) < 1e-6);
}

TEST_CASE("a cell that leans by half of its length is one that leans the other way") {
  Plans plans;
  Pair p = pair();
  p.cell(0, 2) = 1.8;
  const std::vector<Coefficients> u = velocities(plans, p, 1e-6);
  p.cell(0, 2) = -1.8;
  CHECK(difference(velocities(plans, p, 1e-6), u) < 1e-6);
}

TEST_CASE("a cell that is doubled along any side, with what is in it, has the same velocities") {
  Plans plans;
  const Pair p = pair();
  const double tolerance = 1e-5;
  const std::vector<Coefficients> u = velocities(plans, p, tolerance);
  for (int d = 0; d < 3; ++d) {
    Pair twice = p;
    for (int k = 0; k < 2; ++k) {
      twice.positions.push_back(p.positions[k]);
      move(twice.positions.back(), p.cell.col(d));
      twice.materials.push_back(p.materials[k]);
      twice.densities.push_back(p.densities[k]);
    }
    twice.cell.col(d) *= 2;
    const std::vector<Coefficients> both = velocities(plans, twice, tolerance);
    INFO(d);
    CHECK(difference(std::span(both).first(2), u) < 2 * tolerance);
    CHECK(difference(std::span(both).last(2), u) < 2 * tolerance);
  }
}

TEST_CASE("the gap in a cell is that to the nearest image, its own included, and overlaps with images are found") {
  Plans plans;
  Eigen::Matrix3d cell = Vec3(5, 2.3, 6).asDiagonal();
  const std::vector<Coefficients> one{test::surface("sphere", 1, 6)};
  Gap gap = smallest_gap(plans, one, cell);
  CHECK(gap.distance == Approx(0.3).epsilon(1e-6));
  CHECK((gap.first == 0 && gap.second == 0 && !gap.crossing));
  CHECK(pair_name(gap) == "vesicle 0 and its own image");
  cell.col(2) = Vec3(2.5, 0, 2);  // the image above is half a side away
  CHECK(smallest_gap(plans, one, cell).distance == Approx(std::min(0.3, std::hypot(2.5, 2) - 2)).epsilon(1e-6));
  cell.col(1) = Vec3(0, 1.9, 0);
  CHECK(smallest_gap(plans, one, cell).crossing);
  std::vector<Coefficients> two{one[0], one[0]};
  move(two[1], {40 + 2.5, 0, 12 + 0.2});
  const Eigen::Matrix3d wide = Vec3(5, 4, 6).asDiagonal();
  gap = smallest_gap(plans, two, wide);
  CHECK(gap.distance == Approx(std::hypot(2.5, 0.2) - 2).epsilon(1e-6));
  CHECK((gap.first == 0 && gap.second == 1));
  const std::vector<double> gaps = gaps_to_neighbours(plans, two, 1, wide);
  CHECK(gaps[0] == Approx(gap.distance));
  CHECK(gaps[1] == Approx(gap.distance));
  CHECK(!std::isfinite(smallest_gap(plans, one).distance));
}

// Zick and Homsy 1982: a rigid sphere sinks at 2/9 of its weight over the drag coefficient of the array, relative to a
// mean velocity of zero. A vesicle that is a sphere does, too, where its membrane has no reason to flow: far from its
// images, or very viscous inside, which tests the constant of the double layer.
TEST_CASE("spherical vesicles that sink in a cubic array have the drag of Zick and Homsy's rigid spheres") {
  Plans plans;
  for (const auto& [fraction, drag, contrast] :
       {std::tuple(0.027, 2.008, 1.0), {0.125, 4.292, 1.0}, {0.125, 4.292, 1e4}, {0.343, 15.40, 1e4}}) {
    VesicleParameters v = test::vesicle("sphere", 1, 6, contrast);
    v.density_difference = 1;
    FlowParameters none;
    Scene s = scene_of({v}, Vec3::Constant(std::cbrt(4 * test::pi / 3 / fraction)), {none});
    s.buoyancy.gravity = Vec3(0, 0, -1);
    const Model model = make_model(s, plans);
    const Vec3 u = mean_velocity(evaluate(model, initial_dynamics(model)).value().vesicles[0]);
    INFO(fraction << " " << contrast);
    CHECK(2.0 / 9 / -u[2] == Approx(drag).epsilon(1e-3));
    CHECK(std::abs(u[0]) < 1e-6);
  }
}

TEST_CASE("a uniform flow carries a sheared cell along and changes nothing else") {
  Plans plans;
  VesicleParameters a = test::vesicle("prolate", 0.9, 4), b = test::vesicle("prolate", 0.9, 4, 3);
  b.center = Vec3(0.4, 0.3, 2.3);
  FlowParameters wind;
  wind.kind = "uniform";
  wind.velocity = Vec3(0.3, -0.2, 0);  // along z, the shear would carry it on
  Scene still = scene_of({a, b}, {4.2, 3, 4.6}, {shear(1)}), moving = scene_of({a, b}, {4.2, 3, 4.6}, {shear(1), wind});
  for (Scene* s : {&still, &moving}) {
    s->time.step = 0.05;
    s->time.scheme = "bdf2";
  }
  const Model first = make_model(still, plans), second = make_model(moving, plans);
  Dynamics x = initial_dynamics(first), y = initial_dynamics(second);
  for (int k = 0; k < 2; ++k) {
    x = take_step(first, x, 0.05).value().dynamics;
    y = take_step(second, y, 0.05).value().dynamics;
  }
  for (int k = 0; k < 2; ++k) {
    Coefficients carried = x.vesicles[k].position;
    move(carried, x.time * wind.velocity);
    CHECK((y.vesicles[k].position.values - carried.values).norm() < 1e-5);
  }
  CHECK(y.control.gap == Approx(x.control.gap).epsilon(1e-4));
}

TEST_CASE(
    "a dilute cell is more viscous by the intrinsic viscosity of a single vesicle, the more exactly the larger the "
    "cell") {
  Plans plans;
  VesicleParameters v = test::vesicle("prolate", 0.9, 6, 2);
  v.axis = Vec3(1, 0, 0.6);
  v.bending_modulus = 0.2;
  const auto intrinsic = [&](const std::optional<Vec3>& size) {
    Scene s = scene_of({v}, Vec3::Ones(), {shear(1)});
    s.cell.size = size;
    const Model model = make_model(s, plans);
    return flow_measures(plans, s, evaluate(model, initial_dynamics(model)).value())[0].intrinsic_viscosity;
  };
  const double alone = intrinsic(std::nullopt);
  const double volume = 0.9 * 4 * test::pi / 3;
  double last = 0;
  for (const double side : {10.0, 20.0}) {
    const double excess = intrinsic(Vec3::Constant(side)) / alone - 1, fraction = volume / std::pow(side, 3);
    // Images strain the vesicle by the share of their stresslets in the volume.
    CHECK(std::abs(excess) < 6 * fraction);
    if (last != 0) CHECK(excess / last == Approx(1.0 / 8).epsilon(0.15));  // the next terms: the fifth power
    last = excess;
  }
}

TEST_CASE("the stress of a suspension is the sum of stresslets over the cell, its angles have no sign") {
  Scene s = scene_of({}, {4, 5, 2}, {shear(-2)});
  std::vector<VesicleMeasures> vesicles(2);
  vesicles[0].inclination_deg = 80;
  vesicles[1].inclination_deg = -80;
  vesicles[0].volume = 3;
  vesicles[1].volume = 1;
  vesicles[0].center = Vec3(1, 2, 3);
  vesicles[1].center = Vec3(0, 4, -1);
  std::vector<FlowMeasures> flow(2);
  flow[0].stresslet << 6, 0, -3, 0, -2, 0, -3, 0, -4;
  flow[1].stresslet = flow[0].stresslet / 3;
  const std::vector<Vec3> first{Vec3(1, 1, 1), Vec3(0, 1, 1)};
  SuspensionMeasures m = suspension_measures(s, vesicles, flow, first);
  CHECK(m.volume_fraction == Approx(0.1));
  CHECK(m.relative_viscosity == Approx(1 + 4 / (2.0 * 40)));
  CHECK(m.normal_stress_1 == Approx(4.0 / 3 * 10 / (2 * 40)));
  CHECK(m.normal_stress_2 == Approx(-4.0 / 3 * 2 / (2 * 40)));
  CHECK(std::abs(m.inclination_mean) == Approx(90));
  CHECK(m.inclination_spread == Approx(std::sqrt(-2 * std::log(std::cos(test::pi / 9))) * 90 / test::pi));
  CHECK(m.displacement[1] == Approx(1));  // 1 and 3: 2 less and more than the mean by 1
  CHECK(m.displacement[2] == Approx(4));
  s.cell.size.reset();
  m = suspension_measures(s, vesicles, flow, first);
  CHECK(std::isnan(m.relative_viscosity));
  CHECK(std::isnan(m.volume_fraction));
}

TEST_CASE("pairs of points at random have a distribution of 1, those of a lattice its distances, in any cells") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-8, 8);
  Eigen::Matrix3d cell = Vec3(4, 5, 6).asDiagonal();
  cell(0, 2) = 1.9;
  PairDistribution pairs(Vec3(4, 5, 6), 4);
  for (int state = 0; state < 40; ++state) {
    std::vector<Vec3> points;
    for (int k = 0; k < 40; ++k) points.emplace_back(cell * Vec3(uniform(random), uniform(random), uniform(random)));
    pairs.add(points, cell);
  }
  for (const auto& row : pairs.rows())  // 31200 pairs, of which 0.4 % are in the first bin: 9 % by chance
    CHECK(row.share == Approx(1).margin(row.from == 0 ? 0.3 : 0.1));
  PairDistribution lattice(Vec3(4, 4, 4), 2);
  lattice.add(std::vector{Vec3(0, 0, 0), Vec3(4, -8, 1.2), Vec3(0, 12, -1.2)}, Vec3(4, 4, 4).asDiagonal());
  // Two pairs at 1.2 and one at 4 - 2.4.
  CHECK(lattice.rows()[0].share == 0);
  CHECK(lattice.rows()[1].share == Approx(3 / (3 / 64.0 * 4 * test::pi / 3 * 7)));
}

TEST_CASE("the stated error of a pair distribution is how far that of points at random is from 1") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  Eigen::Matrix3d cell = Vec3(5, 4, 6).asDiagonal();
  cell(0, 2) = -2;
  std::vector<CentresInCell> states(160);
  for (CentresInCell& s : states) {
    s.cell = cell;
    for (int k = 0; k < 40; ++k) s.centres.emplace_back(cell * Vec3(uniform(random), uniform(random), uniform(random)));
  }
  constexpr int bins = 40;
  const MeanPairs mean = mean_pairs(Vec3(5, 4, 6), bins, states);
  REQUIRE(mean.error.size() == std::size_t(bins));
  double squares = 0;
  int counted = 0;
  for (std::size_t k = 4; k < mean.rows.size(); ++k) {  // bins nearer to 0 hold few pairs or none
    const double away = (mean.rows[k].share - 1) / mean.error[k];
    squares += away * away;
    ++counted;
    if (mean.rows[k].from >= 1) CHECK(std::abs(mean.rows[k].share - 1) < 0.2);  // 650 pairs or more: 4 % by chance
  }
  // Each is Student's t of 7 degrees of freedom squared: mean 7/5, variance 2.2^2, so 0.37 for the mean of 36.
  CHECK(squares / counted == Approx(1.4).margin(1.1));
  CHECK(mean_pairs(Vec3(5, 4, 6), bins, std::span(states).first(1)).error.empty());
}

TEST_CASE("the pair distribution of a cubic lattice has its peaks at 1, root 2, root 3, ... spacings and no error") {
  std::vector<Vec3> centres;
  for (int k = 0; k < 216; ++k) centres.emplace_back(k % 6, k / 6 % 6, k / 36);
  const std::vector<CentresInCell> states(3, {centres, Vec3(6, 6, 6).asDiagonal()});
  constexpr int bins = 60;
  const MeanPairs mean = mean_pairs(Vec3(6, 6, 6), bins, states);
  // Neighbours of a point at the square of a distance: the ways to write it as a sum of three squares.
  const std::vector<int> ways{0, 6, 12, 8, 6, 24, 24, 0, 12};
  std::vector<double> expected(bins, 0);
  for (std::size_t square = 1; square < ways.size(); ++square)
    expected[std::size_t(std::sqrt(double(square)) / 3 * bins + 1e-9)] += ways[square];
  for (std::size_t k = 0; k < mean.rows.size(); ++k) {
    const auto& row = mean.rows[k];
    const double shell = 4 * test::pi / 3 * (std::pow(row.to, 3) - std::pow(row.from, 3));
    CHECK(row.share == Approx(expected[k] * 216 / 215 / shell).margin(1e-12));  // of 215 others in 216
    CHECK(mean.error[k] < 1e-9);
  }
}

TEST_CASE("placements fill the cell and keep their distance from images, too") {
  for (const auto& [kind, orientation] : {std::pair("box", "random"), {"lattice", "as-given"}}) {
    VesicleParameters v = test::vesicle("prolate", 0.9, 6);
    Scene s = scene_of({v}, {7, 5, 4.5}, {shear(1)});
    PlacementParameters p;
    p.kind = kind;
    p.orientation = orientation;
    p.count = kind == std::string("box") ? 8 : 12;
    s.placements = {p};
    const Scene full = placed(s);
    REQUIRE(int(full.vesicles.size()) == p.count);
    Plans plans;
    std::vector<Coefficients> x;
    for (const VesicleParameters& one : full.vesicles) {
      x.push_back(initial_position(one));
      CHECK((one.center.cwiseAbs().array() <= s.cell.size->array() / 2).all());
    }
    const Gap gap = smallest_gap(plans, x, cell_at(s, 0));
    CHECK(!gap.crossing);
    CHECK(gap.distance >= default_placement_gap * (1 - 1e-6));
  }
}

TEST_CASE(
    "vesicles are placed at random at a volume fraction of 0.45, apart, turned every way, the same from one seed") {
  for (const auto& [nu, orientation] :
       {std::pair(0.95, "random"), {0.9, "random"}, {0.9, "as-given"}, {1.0, "random"}}) {
    INFO(nu << ", " << orientation);
    VesicleParameters v = test::vesicle(nu < 1 ? "prolate" : "sphere", nu, 6);
    PlacementParameters p;
    p.kind = "box";
    p.orientation = orientation;
    p.count = 32;
    const double side = std::cbrt(p.count * 4 * test::pi / 3 * nu / 0.45);
    Scene s = scene_of({v}, {side, side, side}, {shear(1)});
    s.placements = {p};
    const Scene full = placed(s), again = placed(s);
    REQUIRE(int(full.vesicles.size()) == p.count);
    Plans plans;
    std::vector<Coefficients> x;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < full.vesicles.size(); ++k) {
      const VesicleParameters& one = full.vesicles[k];
      x.push_back(initial_position(one));
      CHECK((one.center.cwiseAbs().array() <= side / 2).all());
      CHECK(one.center == again.vesicles[k].center);
      if (!one.axis) continue;
      CHECK(*one.axis == *again.vesicles[k].axis);
      axes += *one.axis * one.axis->transpose() / p.count;
    }
    const Gap gap = smallest_gap(plans, x, cell_at(s, 0));
    CHECK(!gap.crossing);
    CHECK(gap.distance >= default_placement_gap * (1 - 1e-6));
    // The tensor of random directions: 1/3 of the unit tensor, entries spread by sqrt(4/45/32) = 0.05.
    if (orientation == std::string("random"))
      CHECK((axes - Eigen::Matrix3d::Identity() / 3).cwiseAbs().maxCoeff() < 0.21);
  }
}

TEST_CASE("pairs of densely placed vesicles lie in all directions alike") {
  VesicleParameters v = test::vesicle("prolate", 0.95, 4);
  PlacementParameters p;
  p.kind = "box";
  p.orientation = "random";
  p.count = 120;
  const double side = std::cbrt(p.count * 4 * test::pi / 3 * 0.95 / 0.45);
  Scene s = scene_of({v}, {side, side, side}, {shear(1)});
  s.placements = {p};
  const Scene full = placed(s);
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero();
  int pairs = 0;
  for (std::size_t i = 0; i < full.vesicles.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      Vec3 away = full.vesicles[i].center - full.vesicles[j].center;
      away -= side * Vec3((away / side).array().round());
      if (away.norm() > 2.6) continue;  // neighbours
      ++pairs;
      directions += away.normalized() * away.normalized().transpose();
    }
  REQUIRE(pairs > 300);
  // Entries of directions at random are spread by sqrt(4/45/pairs) < 0.017.
  CHECK((directions / pairs - Eigen::Matrix3d::Identity() / 3).cwiseAbs().maxCoeff() < 0.085);
}

TEST_CASE("what cannot be moved apart is refused with what is missing, and a search for places can be stopped") {
  VesicleParameters v = test::vesicle("sphere", 1, 4);
  PlacementParameters p;
  p.kind = "box";
  // Two points of a cube and its images are at most half a diagonal apart: two spheres fill 0.680 of it.
  p.count = 2;
  p.gap = 0.0;
  const double side = std::cbrt(p.count * 4 * test::pi / 3 / 0.69);
  Scene s = scene_of({v}, {side, side, side}, {shear(1)});
  s.placements = {p};
  CHECK_THROWS_WITH(placed(s),
                    Catch::Contains("2 vesicles could not be placed at random at a volume fraction of 0.69"));
  int asked = 0;
  CHECK_THROWS_AS(placed(s, [&] { return ++asked > 3; }), std::system_error);
  CHECK(asked == 4);
}

TEST_CASE("streams carry a vesicle the same way on each of their axes, back on every other one, and copies together") {
  constexpr double l = 6;
  FlowParameters streams;
  streams.kind = "streams";
  streams.centreline_velocity = 0.8;
  streams.wavelength = l;
  const auto first_velocity = [&](const std::vector<Vec3>& centres, const Vec3& size) {
    std::vector<VesicleParameters> vesicles;
    for (const Vec3& centre : centres) {
      VesicleParameters v = test::vesicle("prolate", 0.9, 6);
      v.axis = {1, 0.3, 0.2};
      v.center = centre;
      v.viscosity_contrast = 3;
      v.bending_modulus = 0;
      vesicles.push_back(v);
    }
    Plans plans;
    const Scene s = scene_of(vesicles, size, {streams});
    const Model model = make_model(s, plans);
    return Matrix(evaluate(model, initial_dynamics(model)).value().vesicles[0].velocity.values);
  };
  const Vec3 place(0.3, 0.2, -0.4), cell(4, l, l);
  const Matrix here = first_velocity({place}, cell);
  // The mesh of the sums meets a moved vesicle elsewhere: their accuracy, at the tolerance of the solves.
  const double margin = 2e-5 * here.norm();
  CHECK((first_velocity({place + Vec3(0, l / 2, l / 2)}, cell) - here).norm() < margin);
  CHECK((first_velocity({place + Vec3(1, l, 0)}, cell) - here).norm() < margin);
  CHECK((first_velocity({place + Vec3(0, 0, l / 2)}, cell) + here).norm() < margin);
  CHECK((first_velocity({place, place + Vec3(4, 0, 0)}, {8, l, l}) - here).norm() < margin);
}
