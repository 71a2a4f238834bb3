// Evenly spaced streamlines of flows whose lines are known.
#include "render/figures/streamlines.h"
#include "tests/support/catch.h"

#include <cmath>
#include <numbers>

using Eigen::Vector2d;
using render::Streamline;

namespace {

const render::Range window{-2, 2};

/// Least distance between points of two lines.
double apart(const Streamline& a, const Streamline& b) {
  double least = 1e300;
  for (Eigen::Index i = 0; i < a.points.rows(); ++i)
    least = std::min(least, (b.points.rowwise() - a.points.row(i)).rowwise().norm().minCoeff());
  return least;
}

}  // namespace

TEST_CASE("streamlines of a rotation are closed circles") {
  render::StreamlineOptions o;
  o.spacing = 0.2;
  const auto lines = render::streamlines([](const Vector2d& p) { return Vector2d(p.y(), -p.x()); }, window, window, o);
  REQUIRE(lines.size() > 8);
  int closed = 0;
  for (const Streamline& line : lines) {
    const double r = line.points.row(0).norm();
    CHECK((line.points.rowwise().norm().array() - r).abs().maxCoeff() < 2e-3 * o.spacing * line.points.rows() / 10);
    CHECK((line.speed.array() - r).abs().maxCoeff() < 1e-2);
    closed += line.closed;
    if (line.closed)
      CHECK(r < 2);
    else
      CHECK(r > 1.9);  // those that leave through the corners
  }
  CHECK(closed >= 8);
}

TEST_CASE("neighbouring streamlines keep their distance and leave no gap") {
  render::StreamlineOptions o;
  o.spacing = 0.25;
  const auto flow = [](const Vector2d& p) {
    return Vector2d(1 + 0.3 * std::sin(2 * p.y()), 0.4 * std::cos(1.5 * p.x()));
  };
  const auto lines = render::streamlines(flow, window, window, o);
  REQUIRE(lines.size() > 10);
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) CHECK(apart(lines[i], lines[j]) > 0.8 * o.nearest * o.spacing);
  for (double x = -1.9; x < 2; x += 0.1)
    for (double y = -1.9; y < 2; y += 0.1) {
      double least = 1e300;
      for (const Streamline& line : lines)
        least = std::min(least, (line.points.rowwise() - Eigen::RowVector2d(x, y)).rowwise().norm().minCoeff());
      CHECK(least < 2.2 * o.spacing);
    }
}

TEST_CASE("a streamline keeps the stream function, through slow and fast") {
  // psi = y - y^3/3 - x^2/2: a saddle at (0, -1) and a centre at (0, 1).
  const auto psi = [](double x, double y) { return y - y * y * y / 3 - x * x / 2; };
  const auto flow = [](const Vector2d& p) { return Vector2d(1 - p.y() * p.y(), p.x()); };
  render::StreamlineOptions o;
  o.spacing = 0.2;
  for (const Streamline& line : render::streamlines(flow, window, window, o)) {
    const double value = psi(line.points(0, 0), line.points(0, 1));
    for (Eigen::Index i = 0; i < line.points.rows(); ++i)
      CHECK(psi(line.points(i, 0), line.points(i, 1)) == Approx(value).margin(2e-3));
  }
}

TEST_CASE("the first seeds get their lines") {
  render::StreamlineOptions o;
  o.spacing = 0.5;
  const auto lines =
      render::streamlines([](const Vector2d&) { return Vector2d(1, 0); }, window, window, o, {{0.1, 0.337}});
  CHECK(lines.front().points.col(1).isConstant(0.337, 1e-12));
  CHECK(lines.front().points(0, 0) < -2);
  CHECK(lines.front().points(lines.front().points.rows() - 1, 0) > 2);
}

TEST_CASE("fluid at rest has no streamlines, and points of rest end them") {
  CHECK(render::streamlines([](const Vector2d&) { return Vector2d(0, 0); }, window, window, {}).empty());
  const auto lines =
      render::streamlines([](const Vector2d& p) { return Vector2d(-p.x(), -p.y()); }, window, window, {});
  CHECK(lines.size() > 8);
}

TEST_CASE("arrow heads stand on the line, one at least") {
  const auto lines = render::streamlines([](const Vector2d&) { return Vector2d(1, 0.2); }, window, window, {});
  for (const Streamline& line : lines) {
    const auto places = render::arrow_places(line, 3);
    CHECK(places.size() <= 2);
    for (const Eigen::Index k : places) CHECK((k > 0 && k + 1 < line.points.rows()));
  }
  CHECK(render::arrow_places(lines.front(), 100).empty());
}
