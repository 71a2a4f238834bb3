// The velocity of the fluid between and inside the vesicles of a periodic cell.
#include "sim/membrane/cell.h"
#include "sim/suspension/velocity.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <random>

using namespace sim;

namespace {

constexpr double shear_rate = 0.8;

/// Two vesicles of different insides that reach out of a cell which shears.
Scene scene_in_cell() {
  Scene scene;
  FlowParameters shear;
  shear.kind = "shear";
  shear.rate = shear_rate;
  scene.flows = {shear};
  for (const int k : {0, 1}) {
    VesicleParameters v = test::vesicle("prolate", 0.9, 8, k == 0 ? 1 : 4);
    v.axis = k == 0 ? Vec3(1, 0.2, 0.3) : Vec3(0.3, 1, -0.2);
    v.center = k == 0 ? Vec3(0.4, 0.1, 1.9) : Vec3(-0.3, 1.7, -0.6);
    v.bending_modulus = 0.2;
    scene.vesicles.push_back(v);
  }
  scene.cell.size = Vec3(4.4, 4.1, 4.8);
  return scene;
}

State solved(Plans& plans, const Scene& scene) {
  const Model model = make_model(scene, plans);
  return evaluate(model, initial_dynamics(model)).value();
}

void move(Coefficients& x, const Vec3& by) { x.values.row(0) += std::sqrt(4 * test::pi) * by.transpose(); }

/// The image of all vesicles so many sides away, which moves as the shear does there.
std::vector<VesicleState> image_of(const Scene& scene, const State& state, const Vec3& number) {
  const Vec3 shift = *cell_at(scene, state.time) * number;
  std::vector<VesicleState> all = state.vesicles;
  for (VesicleState& v : all) {
    move(v.position, shift);
    move(v.velocity, {shear_rate * shift[2], 0, 0});
  }
  return all;
}

/// Anywhere in the cell and beyond, in vesicles and out of them, and some very near to membranes.
Matrix points_in(const Scene& scene, const State& state) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1, 1);
  Matrix x(60, 3);
  for (Eigen::Index k = 0; k < 40; ++k)
    for (int d = 0; d < 3; ++d) x(k, d) = 0.9 * (*scene.cell.size)[d] * place(random);
  for (Eigen::Index k = 40; k < 60; ++k) {
    const Vec3 direction = Vec3(place(random), place(random), place(random)).normalized();
    const Coefficients& surface = state.vesicles[std::size_t(k % 2)].position;
    const Vec3 middle = surface.values.row(0).transpose() / std::sqrt(4 * test::pi);
    const Vec3 at = sample_points(surface, direction.transpose()).row(0).transpose();
    x.row(k) = (at + (k % 3 == 0 ? 1e-3 : k % 3 == 1 ? -0.05 : 0.2) * (at - middle)).transpose();
  }
  return x;
}

}  // namespace

TEST_CASE("the velocity in a cell that leans is that in a cell of two cells, along any side, also near membranes") {
  Plans plans;
  const Scene scene = scene_in_cell();
  State state = solved(plans, scene);
  state.time = 0.3;  // leans by a quarter of the height: what is computed holds for any motion and tension
  const Matrix x = points_in(scene, state);
  const FlowSamples one = velocity_at(flow_field(plans, scene, state), x);
  REQUIRE(std::count_if(one.within.begin(), one.within.end(), [](int k) { return k >= 0; }) > 8);
  for (int d = 0; d < 3; ++d) {
    INFO("along " << d);
    Scene twice = scene;
    (*twice.cell.size)[d] *= 2;
    for (const VesicleParameters& v : scene.vesicles) twice.vesicles.push_back(v);
    State more = state;
    for (const VesicleState& v : image_of(scene, state, Vec3::Unit(d))) more.vesicles.push_back(v);
    const FlowSamples two = velocity_at(flow_field(plans, twice, more), x);
    // The sums are made to 1e-6 of the velocities that membranes make.
    CHECK((one.velocity - two.velocity).cwiseAbs().maxCoeff() < 1e-5);
    for (std::size_t k = 0; k < one.within.size(); ++k) {
      const int inside = two.within[k] < 0 ? -1 : two.within[k] % 2;
      CHECK(one.within[k] == inside);
    }
  }
}

TEST_CASE("the fluid of a cell moves with the membranes that it touches, those of images, too") {
  Plans plans;
  const Scene scene = scene_in_cell();
  State state = solved(plans, scene);
  const FlowField field = flow_field(plans, scene, state);
  Matrix s(4, 3);
  s << 0.1, 0.2, 1, 0.5, -0.7, 0.3, -0.4, 0.2, -0.8, 0.3, 1, 0.6;
  s.rowwise().normalize();
  for (const Vec3& number : {Vec3(0, 0, 0), Vec3(1, 0, -1), Vec3(0, -2, 1)}) {
    const std::vector<VesicleState> all = image_of(scene, state, number);
    for (std::size_t k = 0; k < 2; ++k) {
      const Matrix at = sample_points(all[k].position, s), own = sample_points(all[k].velocity, s);
      const Vec3 middle = all[k].position.values.row(0).transpose() / std::sqrt(4 * test::pi);
      for (const double beside : {0.0, 1e-3, -1e-3}) {
        const Matrix x = at + beside * (at.rowwise() - middle.transpose());
        const FlowSamples u = velocity_at(field, x);
        INFO("image " << number.transpose() << " of vesicle " << k << ", " << beside);
        // Velocities change by some 1e-3 over this distance; the order 8 of the steps leaves as much.
        CHECK((u.velocity - own).rowwise().norm().maxCoeff() < 6e-3);
        CHECK(u.distance.maxCoeff() < 3e-3);
        if (beside != 0) CHECK(u.within == std::vector<int>(4, beside < 0 ? int(k) : -1));
      }
    }
  }
}

TEST_CASE("between the vesicles of a cell the velocity is the fast sum of what they do, whatever that is") {
  Plans plans;
  const Scene scene = scene_in_cell();
  State state = solved(plans, scene);
  // A motion whose double layer has a moment, which a cell of fluid at rest on the whole has to make up for.
  state.vesicles[1].velocity.values += test::smooth_field(8, 3, 3, 5).values;
  const FlowField field = flow_field(plans, scene, state);
  FastSetting setting = fast_setting(1e-8, true);
  setting.cutoff = 1.7;
  setting.cell = *cell_at(scene, state.time);
  std::vector<FastBody> bodies;
  std::vector<FastStrengths> strengths;
  const double unit = field.images->cutoff;
  for (const SpreadSurface& s : field.images->spread) {
    bodies.push_back({s.sources.points.transpose(), {}, 0});
    strengths.push_back({unit * s.strengths.force, unit * unit * s.strengths.dual});
  }
  Matrix x = points_in(scene, state).topRows(40);
  const FlowSamples samples = velocity_at(field, x);
  FastParts parts;
  const FastSum sum = plan_fast_sum(setting, bodies, {{x.transpose(), -1}}, {}, true, parts);
  const Matrix disturbed = fast_velocity(sum, strengths, std::vector<FastStrengths>(bodies.size())).front().transpose();
  const Matrix whole = disturbed + background_velocity(field.flows, field.time, x);
  int compared = 0;
  for (Eigen::Index k = 0; k < x.rows(); ++k) {
    if (samples.within[std::size_t(k)] >= 0 || samples.distance[k] < 0.7) continue;  // grids of that order are coarse
    ++compared;
    CHECK((samples.velocity.row(k) - whole.row(k)).norm() < 2e-5);
  }
  CHECK(compared > 5);
}

TEST_CASE("the fluid of a cell conserves its volume, and its mean velocity is that of the flow") {
  Plans plans;
  const Scene scene = scene_in_cell();
  const State state = solved(plans, scene);
  const FlowField field = flow_field(plans, scene, state);
  for (const Vec3& at : {Vec3(0, 0.3, 0.2), Vec3(0.4, 0.2, 1.8), Vec3(2.2, 2.05, 2.4), Vec3(-0.3, 1.8, -0.5)})
    CHECK(std::abs(test::divergence(field, at)) < 2e-3);  // differences of 1e-6 over 2e-3
  constexpr int side = 16;
  Matrix x(side * side * side, 3);
  for (int k = 0; k < x.rows(); ++k) {
    const Vec3 place(k % side + 0.5, k / side % side + 0.5, k / side / side + 0.5);
    x.row(k) = (scene.cell.size->cwiseProduct(place / side - Vec3::Constant(0.5))).transpose();
  }
  const Matrix disturbed = velocity_at(field, x).velocity - background_velocity(field.flows, field.time, x);
  // The sum over a net errs where gradients jump, at membranes, by the square of its step and of the shear rate.
  CHECK(disturbed.cwiseAbs().maxCoeff() > 0.1);
  CHECK(disturbed.colwise().mean().cwiseAbs().maxCoeff() < 2e-3);
}

TEST_CASE("in a dilute cell the velocity is that of unbounded fluid, the nearer the larger the cell") {
  Plans plans;
  Scene scene = scene_in_cell();
  scene.cell.size.reset();
  const State state = solved(plans, scene);
  Matrix x(5, 3);
  x << 3, 0, 1, -1, 4, 2, 0, -3, -3, 2, 2, 3, -4, 1, 0;
  const Matrix open = velocity_at(flow_field(plans, scene, state), x).velocity;
  const auto difference = [&](double side) {
    scene.cell.size = Vec3::Constant(side);
    return (velocity_at(flow_field(plans, scene, state), x).velocity - open).cwiseAbs().maxCoeff();
  };
  const double near = difference(20), far = difference(40);
  // Images are force dipoles: the velocity of a lattice of them grows as the distance over the volume.
  CHECK(far < 2e-3);
  CHECK(near / far == Approx(8).epsilon(0.2));
}
