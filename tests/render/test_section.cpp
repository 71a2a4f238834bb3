// Plane sections of spectral surfaces, and moments of the volume inside.
#include "render/scene/section.h"
#include "render/scene/surface.h"

#include "surfaces.h"
#include "tests/support/catch.h"

#include <cmath>
#include <numbers>

using render::ClosedCurve;
using render::CutPlane;
using sim::Vec3;
using surfaces::turn;

namespace {

/// Circumference of an ellipse by the arithmetic-geometric mean.
double circumference(double a, double b) {
  double x = a, y = b, sum = 0, power = 0.5;
  for (int i = 0; i < 6; ++i) {  // quadratic convergence; more would only add rounding
    const double c = x * x - y * y;
    sum += power * c;
    power *= 2;
    const double mean = (x + y) / 2;
    y = std::sqrt(x * y);
    x = mean;
  }
  return 2 * std::numbers::pi / x * (a * a - sum);
}

}  // namespace

TEST_CASE("a section of an ellipsoid is one ellipse of the right area and circumference") {
  for (const double y : {0.0, 0.31, -0.7}) {
    CutPlane plane;
    plane.origin = {0.2, y, -0.4};
    const sim::Coefficients x = surfaces::ellipsoid({1.6, 1.0, 0.7}, turn(0, {0, 0, 1})).position;
    const std::vector<ClosedCurve> curves = render::cut(x, plane);
    REQUIRE(curves.size() == 1);
    const double f = std::sqrt(1 - y * y);
    CHECK(render::enclosed_area(curves[0]) == Approx(std::numbers::pi * 1.6 * 0.7 * f * f).epsilon(1e-5));
    CHECK(render::length(curves[0]) == Approx(circumference(1.6 * f, 0.7 * f)).epsilon(1e-5));
    for (Eigen::Index i = 0; i < curves[0].points.rows(); ++i) {  // every point lies on the ellipse
      const double u = (curves[0].points(i, 0) + 0.2) / 1.6, w = (curves[0].points(i, 1) - 0.4) / 0.7;
      CHECK(u * u + w * w == Approx(f * f).epsilon(1e-10));
      CHECK(std::abs(curves[0].tangents(i, 0) * u / 1.6 + curves[0].tangents(i, 1) * w / 0.7) < 1e-6);
    }
  }
}

TEST_CASE("the circumference of a circle is 2 pi r") { CHECK(circumference(2, 2) == Approx(4 * std::numbers::pi)); }

TEST_CASE("a section does not depend on where the parametrisation has its pole") {
  const Eigen::Matrix3d r = turn(30, {0, 1, 0});
  std::vector<double> areas;
  for (const Eigen::Matrix3d& q : {turn(0, {0, 0, 1}), turn(90, {1, 0, 0}), turn(90, {0, 1, 0}), turn(40, {1, 2, 3})}) {
    const auto x =
        surfaces::vesicle([&](const Vec3& s) -> Vec3 { return r * Vec3(1.5, 0.8, 0.9).cwiseProduct(q * s); });
    const std::vector<ClosedCurve> curves = render::cut(x.position, {});
    REQUIRE(curves.size() == 1);
    areas.push_back(render::enclosed_area(curves[0]));
  }
  for (const double area : areas) CHECK(area == Approx(std::numbers::pi * 1.5 * 0.9).epsilon(1e-5));
}

TEST_CASE("the biconcave disc is cut along its profile") {
  const std::vector<ClosedCurve> curves = render::cut(surfaces::disc(turn(0, {0, 0, 1})).position, {});
  REQUIRE(curves.size() == 1);
  double area = 0;  // of the profile, by the trapezoidal rule, exponentially convergent
  for (int i = 0; i < 400; ++i) {
    const double t = std::numbers::pi * i / 200, q = std::sin(t) * std::sin(t), k = 1.191602667;
    const double z = k * 0.5 * 1.022378509 * std::cos(t) * (0.207 + 2.003 * q - 1.123 * q * q);
    area += z * k * std::cos(t) * std::numbers::pi / 200;
  }
  CHECK(render::enclosed_area(curves[0]) == Approx(area).epsilon(1e-5));
}

TEST_CASE("a bent shape that the plane cuts twice gives two closed curves") {
  const auto banana = surfaces::vesicle([](const Vec3& s) -> Vec3 {
    return {1.8 * s.x(), 0.45 * s.y() + 1.1 * s.x() * s.x(), 0.45 * s.z()};
  });
  CutPlane plane;
  plane.origin = {0, 0.8, 0};
  const std::vector<ClosedCurve> curves = render::cut(banana.position, plane);
  REQUIRE(curves.size() == 2);
  CHECK(render::enclosed_area(curves[0]) == Approx(render::enclosed_area(curves[1])).epsilon(1e-6));
  CHECK(render::enclosed_area(curves[0]) > 0.05);
  const double left = std::min(curves[0].points.col(0).mean(), curves[1].points.col(0).mean());
  const double right = std::max(curves[0].points.col(0).mean(), curves[1].points.col(0).mean());
  CHECK(left == Approx(-right).epsilon(0.02));
  CHECK(right > 1);
}

TEST_CASE("a plane off the axis of a biconcave disc, across its dimples, cuts two closed curves") {
  // Perpendicular to the axis at a height above the dimple's bottom: a ring, whose inner edge runs the other way.
  CutPlane across;
  across.normal = Vec3::UnitZ();
  across.right = Vec3::UnitX();
  across.up = -Vec3::UnitY();
  across.origin = {0.05, -0.02, 0.25};
  const std::vector<ClosedCurve> ring = render::cut(surfaces::disc(turn(0, {0, 0, 1})).position, across);
  REQUIRE(ring.size() == 2);
  CHECK(render::length(ring[0]) > 1.3 * render::length(ring[1]));
  CHECK(render::enclosed_area(ring[0]) * render::enclosed_area(ring[1]) < 0);
  // Tilted by a little: still two, of other shapes. Curves are circles in the first case.
  for (Eigen::Index i = 0; i < ring[1].points.rows(); ++i) {
    const double r = std::hypot(ring[1].points(i, 0) + 0.05, ring[1].points(i, 1) + 0.02);
    CHECK(r == Approx(std::hypot(ring[1].points(0, 0) + 0.05, ring[1].points(0, 1) + 0.02)).epsilon(1e-9));
  }
  CHECK(render::cut(surfaces::disc(turn(4, {0, 1, 0})).position, across).size() == 2);
}

TEST_CASE("points of a section lie where their parameters say") {
  const auto x = surfaces::disc(turn(20, {0, 1, 0}), {0.3, 0, -1}).position;
  CutPlane plane;
  plane.origin = {0, 0.2, 0};
  for (const ClosedCurve& curve : render::cut(x, plane)) {
    const sim::Matrix p = sim::sample_points(x, curve.directions);
    CHECK((p.col(0) - curve.points.col(0)).norm() + (p.col(2) - curve.points.col(1)).norm() < 1e-10);
  }
}

TEST_CASE("a plane that misses the vesicle gives no curve") {
  CutPlane plane;
  plane.origin = {0, 1.2, 0};
  CHECK(render::cut(surfaces::sphere().position, plane).empty());
}

TEST_CASE(
    "volume, centre of mass and second moments of an ellipsoid are exact, and keep their digits far from the origin") {
  struct Place {
    Vec3 centre;
    double tolerance;
  };
  // Far away a coordinate has 1e-16 of 5e4 only; about the scene's origin the second moments would lose another 1e-16
  // of (5e4)^2.
  for (const Place& place : {Place{{0.3, -4, 2}, 1e-11}, Place{{3e4, -4e4, 2e4}, 1e-9}}) {
    INFO("at " << place.centre.transpose());
    const Vec3 a(1.6, 1.1, 0.5);
    const Eigen::Matrix3d r = turn(48, {1, 1, 2});
    const render::VolumeMoments m = render::volume_moments(surfaces::ellipsoid(a, r, place.centre).position);
    CHECK(m.volume == Approx(4 * std::numbers::pi / 3 * a.prod()).epsilon(place.tolerance));
    CHECK((m.centroid - place.centre).norm() < place.tolerance);
    const Eigen::Matrix3d exact = r * Vec3(a.cwiseProduct(a) / 5).asDiagonal() * r.transpose();
    CHECK((m.second - exact).norm() < place.tolerance);
  }
}

TEST_CASE("normals of the surface are those of the ellipsoid, poles included") {
  const Vec3 a(1.4, 0.8, 0.6);
  const auto x = surfaces::ellipsoid(a, turn(0, {0, 0, 1}));
  sim::Matrix s(5, 3);
  s << 0, 0, 1, 0, 0, -1, 1, 0, 0, 0.6, 0, 0.8, -0.48, 0.6, -0.64;
  const render::SurfacePoints points = render::surface_points(x.position, s);
  for (Eigen::Index i = 0; i < s.rows(); ++i) {
    const Vec3 exact = Vec3(s.row(i).transpose().cwiseQuotient(a)).normalized();
    CHECK((Vec3(points.normal.row(i)) - exact).norm() < 1e-6);
  }
}
