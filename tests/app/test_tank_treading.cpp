// What the figure of tank-treading is made of.
#include "app/figures/tank_treading.h"
#include "sim/surface/shapes.h"
#include "tests/support/catch.h"

#include <cmath>
#include <numbers>

namespace {

constexpr double pi = std::numbers::pi;

/// An ellipsoid whose points run round ellipses about y with angular velocity w: the fluid of Keller and Skalak.
sim::VesicleState treading(double a, double b, double degrees, double w) {
  sim::VesicleParameters v;
  v.shape = "ellipsoid";
  v.axes = sim::Vec3(a, 0.8, b);
  const double t = degrees * pi / 180;
  v.axis = sim::Vec3(std::cos(t), 0, std::sin(t));
  v.order = 8;
  sim::VesicleState state;
  state.position = sim::initial_position(v);
  state.velocity = state.position;
  const sim::Vec3 along(std::cos(t), 0, std::sin(t)), across(-std::sin(t), 0, std::cos(t));
  for (Eigen::Index k = 0; k < state.position.values.rows(); ++k) {
    const sim::Vec3 x = state.position.values.row(k).transpose();
    state.velocity.values.row(k) = (w * (x.dot(across) * a / b * along - x.dot(along) * b / a * across)).transpose();
  }
  state.tension = {8, sim::Matrix::Zero(81, 1)};
  return state;
}

}  // namespace

TEST_CASE("angle and frequency of an ellipsoid that tank-treads exactly are what it was made with") {
  sim::Plans plans;
  const app::SteadyPoint p = app::steady_point(plans, treading(1.5, 0.7, 23, 0.31), 2.5, 0.5);
  CHECK(p.viscosity_contrast == 2.5);
  CHECK(p.angle == Approx(23.0 / 180).margin(1e-9));
  CHECK(p.frequency == Approx(0.31 / 0.5).epsilon(1e-5));  // cubics through some 200 points
  CHECK(app::steady_point(plans, treading(1, 1, 0, 0.5), 1, 1).frequency == Approx(0.5).epsilon(1e-5));
}

TEST_CASE("the frequency of a membrane does not depend on how its vesicle moves and turns as a whole") {
  const double w = 0.31, turning = -0.7;
  sim::VesicleState v = treading(1.5, 0.7, 23, w);
  const auto frequency = [&] { return app::membrane_frequency(v.position, v.velocity, sim::Vec3::Zero(), turning); };
  const auto turned = [&](double factor) {  // by the velocity of the shape, turning (-z, x)
    for (Eigen::Index k = 0; k < v.position.values.rows(); ++k) {
      const sim::Vec3 x = v.position.values.row(k).transpose();
      v.velocity.values.row(k) = factor * v.velocity.values.row(k) + turning * Eigen::RowVector3d(-x[2], 0, x[0]);
    }
  };
  turned(1);
  CHECK(frequency() == Approx(w).epsilon(1e-5));  // cubics; positive: as shear goes round
  v = treading(1.5, 0.7, 23, w);
  turned(-1);
  CHECK(frequency() == Approx(-w).epsilon(1e-5));
  v = treading(1.5, 0.7, 23, w);
  turned(0);
  CHECK(frequency() == Approx(0).margin(1e-12));  // a rigid body's membrane does not go round
  // A vesicle far off the axis of a shear flow.
  v = treading(1.5, 0.7, 23, w);
  v.velocity.values.row(0) += std::sqrt(4 * pi) * Eigen::RowVector3d(50, 1, -2);
  sim::Plans plans;
  CHECK(app::steady_point(plans, v, 1, 1).frequency == Approx(w).epsilon(1e-5));
}

TEST_CASE("the theory of Keller and Skalak has its known limits") {
  // As the excess area goes to zero, cos 2θ / sqrt(Δ) tends to 0.669 at λ = 1, and the frequency to one half.
  const double nu = 0.9999, excess = 4 * pi * (std::pow(nu, -2.0 / 3) - 1);
  const app::SteadyPoint p = app::keller_skalak(nu, 1);
  CHECK(std::cos(2 * pi * p.angle) / std::sqrt(excess) == Approx(0.669).epsilon(0.01));
  CHECK(p.frequency == Approx(0.5).epsilon(0.02));
  CHECK(app::keller_skalak(0.85, 10).frequency == 0);  // tumbles
  CHECK(std::isnan(app::keller_skalak(0.85, 10).angle));
}

TEST_CASE("the figure of tank-treading shows every published point of the contrasts it has") {
  const auto plots = app::tank_treading_plots({{0.85, 1, 0.134, 0.36}, {0.95, 1, 0.18, 0.44}, {0.96, 2.7, 0.15, 0.4}});
  REQUIRE(plots.size() == 2);
  std::size_t published = 0;
  for (const render::Curve& curve : plots[0].curves)
    if (curve.marker && curve.marker != render::Marker::ring) published += curve.x.size();
  CHECK(published == 5);  // three of Kraus et al., two of Zhao and Shaqfeh at 2.7
}

namespace {

/// Of a function of time, at n + 1 instants up to an end.
template <class Angle>
sim::AxisMotion motion_under(double end, int n, Angle angle) {
  std::vector<double> times, degrees;
  for (int k = 0; k <= n; ++k) {
    times.push_back(end * k / n);
    degrees.push_back(degrees.empty() ? angle(times.back()) : sim::unwrapped(angle(times.back()), degrees.back()));
  }
  return sim::motion_of(times, degrees);
}

}  // namespace

TEST_CASE("the motion of a vesicle is told from its inclination, where the run is long enough") {
  using sim::AxisMotion;
  CHECK(motion_under(20, 40, [](double) { return 24.0; }) == AxisMotion::tank_treading);
  CHECK(motion_under(20, 40, [](double t) { return 24 - 60 * std::exp(-t); }) ==
        AxisMotion::tank_treading);  // 0.08 degrees are left
  CHECK(motion_under(60, 300, [](double t) { return 5 + 20 * std::sin(t); }) == AxisMotion::swinging);
  CHECK(motion_under(40, 200, [](double t) { return -std::fmod(10 * t, 180.0); }) ==
        AxisMotion::tumbling);  // with jumps
  // Jeffery's ellipsoid of ratio 4: tan θ = r tan(-t r / (r² + 1)), a turn of 180 degrees in π (r + 1/r) = 13.4.
  const auto jeffery = [](double t) { return std::atan(4 * std::tan(-t * 4 / 17)) * 180 / pi; };
  CHECK(motion_under(14, 100, jeffery) == AxisMotion::tumbling);
  CHECK(motion_under(12, 100, jeffery) == AxisMotion::untold);  // not yet half round
  // Too short, still settling, spiralling in, one swing, nothing at all.
  CHECK(motion_under(0.3, 3, [](double) { return 24.0; }) == AxisMotion::untold);
  CHECK(motion_under(20, 40, [](double t) { return 24 - 60 * std::exp(-0.1 * t); }) == AxisMotion::untold);
  CHECK(motion_under(20, 200, [](double t) { return 24 + 60 * std::exp(-0.1 * t) * std::sin(t); }) ==
        AxisMotion::untold);
  CHECK(motion_under(7, 70, [](double t) { return 5 + 20 * std::sin(t); }) == AxisMotion::untold);
  CHECK(sim::motion_of({}, {}) == AxisMotion::untold);
  CHECK(sim::motion_of(std::vector<double>{0}, std::vector<double>{24}) == AxisMotion::untold);
}

TEST_CASE("in the figure of tank-treading what has not settled is marked, joined to no curve, and named") {
  const auto plots = app::tank_treading_plots({{0.85, 1, 0.134, 0.36},
                                               {0.9, 1, 0.16, 0.4, sim::AxisMotion::untold},
                                               {0.93, 1, 0.17, 0.42},
                                               {0.95, 1, 0.18, 0.44}});
  for (const render::Plot& plot : plots) {
    std::size_t marked = 0;
    for (const render::Curve& curve : plot.curves) {
      if (!curve.x.empty()) CHECK_FALSE(curve.csv_name.empty());
      if (curve.csv_name == "Tanktread, λ = 1") CHECK(curve.x == std::vector<double>{0.85, 0.93, 0.95});
      if (curve.marker != render::Marker::triangle) continue;
      ++marked;
      CHECK(curve.x == std::vector<double>{0.9});
      CHECK_FALSE(curve.line);
    }
    CHECK(marked == 1);
  }
}
