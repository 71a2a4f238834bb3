#include "sim/stepping/resolution.h"
#include "sim/stepping/stepper.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <random>

using namespace sim;

namespace {

constexpr int size = 40;

Matrix random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Matrix::NullaryExpr(rows, columns, [&] { return uniform(random); });
}

/// A solve has met so many directions of A, of any scale.
Searched searched(const Matrix& A, int count, unsigned seed, double scale = 1) {
  Searched s;
  for (int k = 0; k < count; ++k) {
    s.directions.emplace_back(scale * random_matrix(size, 1, seed + unsigned(k)).col(0));
    s.images.emplace_back(A * s.directions.back());
  }
  return s;
}

Matrix some_operator(unsigned seed) { return Matrix::Identity(size, size) + 0.1 * random_matrix(size, size, seed); }

const LinearMap halves = [](const Vector& v) { return Vector(0.5 * v); };

/// Iterations of so many steps, with what was learned, or forgetting it before each.
std::pair<int, Dynamics> iterations(const Scene& scene, double dt, int steps, bool forgets) {
  Plans plans;
  const Model s = make_model(scene, plans);
  Dynamics d = initial_dynamics(s);
  int sum = 0;
  for (int k = 0; k < steps; ++k) {
    if (forgets) d.learned.clear();
    const Step step = take_step(s, d, dt).value();
    d = step.dynamics;
    sum += step.record.iterations;
  }
  return {sum, d};
}

}  // namespace

TEST_CASE(
    "an inverse is exact on the directions that a solve has met, and the given one on what is orthogonal to them") {
  const Matrix A = some_operator(1);
  for (const double scale : {1e-12, 1.0, 1e9}) {
    const Searched s = searched(A, 6, 10, scale);
    const auto known = learned(nullptr, s, 6, 20);
    REQUIRE(known);
    CHECK(known->images.cols() == 6);
    for (std::size_t k = 0; k < 6; ++k) {
      const Vector found = precondition(known.get(), halves, s.images[k]);
      CHECK((found - s.directions[k]).norm() < 1e-5 * s.directions[k].norm());  // single precision
    }
    Vector rest = random_matrix(size, 1, 99).col(0);
    const Matrix U = known->images.cast<double>();
    rest -= U * U.householderQr().solve(rest);
    CHECK((precondition(known.get(), halves, rest) - 0.5 * rest).norm() < 1e-5 * rest.norm());
  }
  CHECK(precondition(nullptr, halves, Vector::Ones(size)) == Vector::Constant(size, 0.5));
}

TEST_CASE("what is newer comes first, what adds nothing is left out, and no more is kept than is asked for") {
  const Matrix A = some_operator(2), B = some_operator(3);
  const auto old = learned(nullptr, searched(A, 5, 20), 5, 20);
  const Searched newer = searched(B, 3, 20);  // the same directions as three of the five, of another operator
  const auto both = learned(old.get(), newer, 3, 20);
  CHECK(both->images.cols() == 8);
  for (std::size_t k = 0; k < 3; ++k)
    CHECK((precondition(both.get(), halves, newer.images[k]) - newer.directions[k]).norm() <
          1e-5 * newer.directions[k].norm());
  CHECK(learned(both.get(), newer, 3, 20)->images.cols() == 8);
  CHECK(learned(both.get(), newer, 3, 4)->images.cols() == 4);
  CHECK(learned(nullptr, newer, 2, 20)->images.cols() == 2);
  CHECK(learned(old.get(), {}, 0, 20)->images == old->images);
  CHECK_FALSE(learned(nullptr, {}, 0, 20));
  Searched bad = searched(A, 2, 30);
  bad.directions[0].setConstant(std::numeric_limits<double>::quiet_NaN());
  CHECK(learned(nullptr, bad, 2, 20)->images.cols() == 1);
}

TEST_CASE("what was learned of a block of another size is not used") {
  const auto known = learned(nullptr, searched(some_operator(4), 5, 40), 5, 20);
  CHECK(precondition(known.get(), halves, Vector::Ones(size + 4)) == Vector::Constant(size + 4, 0.5));
}

TEST_CASE("directions tell of more than rounding as long as the residual is large") {
  CHECK(telling(std::vector<double>{1e-2, 1e-3, 1e-4, 1e-6, 1e-9}) == 3);
  CHECK(telling(std::vector<double>{}) == 0);
}

TEST_CASE("with what earlier solves have learned a run takes at most two thirds of the iterations, to the same end") {
  for (const double lambda : {0.1, 1.0, 10.0}) {
    INFO("viscosity contrast " << lambda);
    Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 6, lambda), 0.1, 100);
    const auto [alone, forgetful] = iterations(scene, 0.1, 20, true);
    const auto [fewer, taught] = iterations(scene, 0.1, 20, false);
    CHECK(3 * fewer <= 2 * alone);
    // A ten-thousandth of the error of each step, some 1e-3 R0, is what a solve may leave (docs/stepping.md).
    CHECK((taught.vesicles[0].position.values - forgetful.vesicles[0].position.values).norm() < 2e-5);
  }
}

TEST_CASE("a symmetric shape stays symmetric over many steps with what was learned") {
  Plans plans;
  const Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 6, 4), 0.1, 100);
  const Model s = make_model(scene, plans);
  const Dynamics d = test::advanced(s, initial_dynamics(s), 0.1, 60);
  double even = 0;  // x(-s) = -x(s) holds exactly when the even degrees vanish
  for (int n = 0; n <= 6; n += 2)
    even = std::max(even, d.vesicles[0].position.values.middleRows(n * n, 2 * n + 1).norm());
  CHECK(even < 1e-9);  // the sliding velocity leaves some 1e-11 a step
}

TEST_CASE("a relabelling and a change of order forget what was learned in other coefficients") {
  Plans plans;
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 6, 1), 0.05, 100, "adaptive");
  const Model s = make_model(scene, plans);
  Dynamics d = test::advanced(s, initial_dynamics(s), 0.05, 2);
  REQUIRE(d.learned.at(0));
  const Dynamics changed = in_orders(s, d, std::vector<int>{8}).value();
  CHECK_FALSE(changed.learned.at(0));
  CHECK(in_orders(s, d, std::vector<int>{6}).value().learned.at(0) == d.learned[0]);
  CHECK_NOTHROW(take_step(s, changed, 0.05).value());

  scene.numerics.reparametrization = "always";
  Dynamics jumping = initial_dynamics(s);
  bool jumped = false;
  for (int k = 0; k < 60 && !jumped; ++k) {
    const Step step = take_step(s, jumping, 0.05).value();
    jumping = step.dynamics;
    jumped = step.record.vesicles[0].relabelled > 0;
    CHECK(bool(jumping.learned.at(0)) != jumped);
  }
  CHECK(jumped);
}

TEST_CASE("a state is written and read with what was learned, and one that does not fit is refused") {
  Plans plans;
  const Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 4, 1), 0.1, 100);
  const Model s = make_model(scene, plans);
  Dynamics d = test::advanced(s, initial_dynamics(s), 0.1, 3);
  d.saves = 1;
  const Dynamics again = deserialised(serialised(d), layout_of(d));
  CHECK(again.learned.at(0)->directions == d.learned.at(0)->directions);
  CHECK(again.learned.at(0)->images == d.learned.at(0)->images);
  const auto with = [&](Eigen::Index rows, Eigen::Index columns, float value = 1) {
    Dynamics other = d;
    const Eigen::MatrixXf m = Eigen::MatrixXf::Constant(rows, columns, value);
    other.learned[0] = std::make_shared<const Learned>(Learned{m, m});
    return serialised(other);
  };
  const Eigen::Index rows = unknowns(4);
  CHECK_NOTHROW(deserialised(with(rows, 3), layout_of(d)));
  CHECK_THROWS_WITH(deserialised(with(rows - 4, 3), layout_of(d)), Catch::Contains("what it has learned does not fit"));
  CHECK_THROWS_WITH(deserialised(with(rows, 1000), layout_of(d)), Catch::Contains("what it has learned does not fit"));
  CHECK_THROWS_WITH(deserialised(with(rows, 3, std::numeric_limits<float>::infinity()), layout_of(d)),
                    Catch::Contains("impossible"));
}
