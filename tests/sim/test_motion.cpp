// Motions of the long axis against curves whose kind and period are known.
#include "sim/measures/motion.h"

#include "tests/support/catch.h"

#include <cmath>
#include <numbers>

using namespace sim;

namespace {

constexpr double pi = std::numbers::pi;

struct Curve {
  std::vector<double> times, degrees;
};

/// A function of time at instants that are not evenly spaced, about `spacing` apart.
template <class Angle>
Curve curve_of(double end, double spacing, Angle angle) {
  Curve c;
  for (double t = 0; t < end; t += spacing * (1 + 0.5 * std::sin(7 * t))) {
    c.times.push_back(t);
    c.degrees.push_back(c.degrees.empty() ? angle(t) : unwrapped(angle(t), c.degrees.back()));
  }
  return c;
}

MotionPeriod period_of(const Curve& c) { return motion_period(c.times, c.degrees); }

/// Jeffery's spheroid of ratio r in shear of rate 1: half a turn takes pi (r + 1/r).
double jeffery(double r, double t) { return std::atan(r * std::tan(-t / (r + 1 / r))) * 180 / pi; }

}  // namespace

TEST_CASE("the period of Jeffery's spheroid is found between the states, wherever the run ends") {
  for (const double ratio : {1.2, 2.0, 4.0})
    for (const double turns : {1.05, 1.6, 2.3, 4.1}) {
      const double exact = 2 * pi * (ratio + 1 / ratio);
      const MotionPeriod m =
          period_of(curve_of(turns * exact / 2 + 0.3, 0.1, [&](double t) { return jeffery(ratio, t); }));
      INFO("ratio " << ratio << ", half turns " << turns);
      CHECK(m.motion == AxisMotion::tumbling);
      // The angle turns by at most 1 rad/time; cubics through points 0.15 apart err by 0.15^4 of that.
      CHECK(m.period == Approx(exact).epsilon(2e-4));
      CHECK(m.to - m.from == Approx(m.period / 2));
      CHECK(std::isnan(m.mean));
    }
}

TEST_CASE("the period and the extremes of a swing are found between the states") {
  for (const double end : {10.0, 13.0, 20.0, 41.0}) {
    const MotionPeriod m =
        period_of(curve_of(end, 0.2, [](double t) { return 5 + 20 * std::sin(t) - std::cos(2 * t); }));
    INFO("end " << end);
    CHECK(m.motion == AxisMotion::swinging);
    CHECK(m.period == Approx(2 * pi).epsilon(1e-3));  // cubics through points 0.3 apart
    CHECK(m.most == Approx(26).margin(0.02));
    CHECK(m.least == Approx(-14).margin(0.02));
    CHECK(m.mean == Approx(5).margin(0.05));
  }
}

TEST_CASE("a steady angle is that of the last third, and has no period") {
  const MotionPeriod m = period_of(curve_of(30, 0.5, [](double t) { return 24 - 60 * std::exp(-t); }));
  CHECK(m.motion == AxisMotion::tank_treading);
  CHECK(m.mean == Approx(24).margin(0.01));
  CHECK(std::isnan(m.period));
  CHECK(m.from == Approx(m.to * 2 / 3));
}

TEST_CASE("what cannot be told is not told: no state, one, damaged numbers, states too far apart") {
  const double nan = std::nan("");
  CHECK(motion_period({}, {}).motion == AxisMotion::untold);
  for (const auto& [times, degrees] : std::vector<std::pair<std::vector<double>, std::vector<double>>>{
           {{0}, {24}},
           {{0, 10}, {24, 24}},
           {{0, nan, 20, 30}, {24, 24, 24, 24}},
           {{0, 10, 20, 30}, {24, nan, 24, 24}},
           {{0, 10, 10, 30}, {24, 24, 24, 24}},
           {{30, 20, 10, 0}, {24, 24, 24, 24}},
           {{0, 10, 20, 30, 40}, {0, -80, -160, -240, -320}}}) {
    const MotionPeriod m = motion_period(times, degrees);
    CHECK(m.motion == AxisMotion::untold);
    CHECK(std::isnan(m.period));
  }
  // Half a turn that the run only just holds, in few states: a kind without more ado.
  const std::vector<double> times{0, 1, 2, 3, 4}, degrees{0, -50, -100, -150, -200};
  CHECK(motion_period(times, degrees).period == Approx(7.2));
}

TEST_CASE("means are those of the curve, cubics exactly, on any spacing of the points") {
  const std::vector<double> times{0, 1e-9, 0.3, 1, 1.1, 2.5, 3};
  std::vector<double> values;
  const auto cubic = [](double t) { return 1 - t + 2 * t * t - 0.5 * t * t * t; };
  for (const double t : times) values.push_back(cubic(t));
  const auto whole = [](double t) { return t - t * t / 2 + 2 * t * t * t / 3 - t * t * t * t / 8; };
  CHECK(cubic_at(times, values, 0.7) == Approx(cubic(0.7)));
  CHECK(mean_over(times, values, 0.5, 2.9) == Approx((whole(2.9) - whole(0.5)) / 2.4));
  CHECK(std::isnan(mean_over({}, {}, 0, 1)));
  CHECK(mean_over(std::vector<double>{0.0}, std::vector<double>{7.0}, 0, 0) == 7);
}
