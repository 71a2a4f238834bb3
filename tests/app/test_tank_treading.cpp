// What the figure of tank-treading is made of.
#include "app/tank_treading.h"
#include "sim/shapes.h"
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
  CHECK(p.frequency == Approx(0.31 / 0.5).epsilon(2e-3));  // chords and a trapezoidal rule over some 400 points
  CHECK(app::steady_point(plans, treading(1, 1, 0, 0.5), 1, 1).frequency == Approx(0.5).epsilon(1e-3));
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
