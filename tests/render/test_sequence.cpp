// Frames between saved states.
#include "render/scene/sequence.h"

#include "render/scene/mesh.h"
#include "render/scene/surface.h"

#include "surfaces.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using sim::Vec3;
using surfaces::turn;

namespace {

/// Two consecutive states of a motion x(s, t) with velocity v(s, t), the second `h` later than the first, at `start`.
std::pair<sim::State, sim::State> two_states(const std::function<Vec3(const Vec3&, double)>& x,
                                             const std::function<Vec3(const Vec3&, double)>& v, double start,
                                             double h) {
  const auto at = [&](double t) { return surfaces::coefficients(8, [&](const Vec3& s) { return x(s, t); }); };
  const auto rate = [&](double t) { return surfaces::coefficients(8, [&](const Vec3& s) { return v(s, t); }); };
  sim::VesicleState a = surfaces::sphere(), b = surfaces::sphere();
  a.position = a.position_before = at(start);
  a.velocity = a.velocity_before = rate(start);
  a.tension = b.tension = {8, sim::Matrix::Constant(sim::coefficient_count(8), 1, 2.0)};
  b.tension.values *= 3;
  b.position_before = a.position;
  b.velocity_before = a.velocity;
  b.position = at(start + h);
  b.velocity = rate(start + h);
  std::pair<sim::State, sim::State> states{surfaces::state_of({a}), surfaces::state_of({b})};
  states.first.time = start;
  states.second.time = start + h;
  states.first.step = 4;
  states.second.step = 5;
  return states;
}

std::pair<sim::State, sim::State> rotating_ellipsoid(double h) {
  const Vec3 axes(1.6, 0.8, 0.7), spin(0, 1, 0);
  const auto x = [=](const Vec3& s, double t) -> Vec3 {
    return turn(t * 180 / std::acos(-1.0), spin) * axes.cwiseProduct(s);
  };
  return two_states(
      x, [=](const Vec3& s, double t) -> Vec3 { return spin.cross(x(s, t)); }, 0.4, h);
}

double largest(const sim::Matrix& m) { return m.cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("points that slide move by velocity and sliding together, and take labels and dots halfway with them") {
  // Points at x(s, t) = s + t (a + b), of which b is their sliding along the membrane.
  const Vec3 a(1, 0, 0.5), b(0, 0.25, 0);
  auto [first, second] = two_states([&](const Vec3& s, double t) -> Vec3 { return s + t * (a + b); },
                                    [&](const Vec3&, double) -> Vec3 { return a + b; }, 0, 0.4);
  sim::VesicleState &before = first.vesicles[0], &after = second.vesicles[0];
  const auto uniform = [](const Vec3& v) { return surfaces::coefficients(8, [&](const Vec3&) { return v; }); };
  before.velocity = after.velocity = uniform(a);
  before.sliding = after.sliding = uniform(b);
  after.labels.values *= 3;
  after.tracers.row(0) = Vec3(0, 1, 0).transpose();
  before.tracers.row(0) = Vec3(1, 0, 0).transpose();
  const sim::VesicleState between = render::interpolated(first, second, 0.2).vesicles[0];
  CHECK(largest(between.velocity.values - uniform(a).values) < 1e-13);
  CHECK(largest(between.sliding.values - uniform(b).values) < 1e-15);
  CHECK(largest(between.labels.values - 2 * before.labels.values) < 1e-15);
  CHECK(largest(between.tracers.row(0) - Vec3(1, 1, 0).normalized().transpose()) < 1e-15);
  // Labels that are laid anew in between stay those of before, and what is relabelled is known at its end only.
  after.labels_laid = 1;
  CHECK(largest(render::interpolated(first, second, 0.2).vesicles[0].labels.values - before.labels.values) < 1e-15);
  after.relabelled = 1;
  CHECK(largest(render::interpolated(first, second, 0.2).vesicles[0].labels.values - after.labels.values) < 1e-15);
}

TEST_CASE("a motion that is cubic in time is interpolated exactly, and so is its velocity") {
  const auto x = [](const Vec3& s, double t) -> Vec3 {
    return s + t * Vec3(1, 0, s.z()) + t * t * Vec3(s.x() * s.y(), 0, 1) - t * t * t * Vec3(0, s.z() * s.z(), s.x());
  };
  const auto v = [](const Vec3& s, double t) -> Vec3 {
    return Vec3(1, 0, s.z()) + 2 * t * Vec3(s.x() * s.y(), 0, 1) - 3 * t * t * Vec3(0, s.z() * s.z(), s.x());
  };
  const auto [a, b] = two_states(x, v, 1.5, 0.7);
  for (const double u : {0.01, 0.3, 0.5, 0.99}) {
    const double t = 1.5 + 0.7 * u;
    const sim::State middle = render::interpolated(a, b, t);
    const sim::Coefficients position = surfaces::coefficients(8, [&](const Vec3&s) { return x(s, t); }),
                            velocity = surfaces::coefficients(8, [&](const Vec3&s) { return v(s, t); });
    CHECK(middle.time == t);
    CHECK(largest(middle.vesicles[0].position.values - position.values) < 1e-12);
    CHECK(largest(middle.vesicles[0].velocity.values - velocity.values) < 1e-11);
    CHECK(middle.vesicles[0].tension.values(0, 0) == Approx(2 + 4 * u));
  }
}

TEST_CASE("a turning ellipsoid is interpolated with an error of fourth order in the step") {
  double previous = 0;
  for (const double h : {0.4, 0.2, 0.1}) {
    const auto [a, b] = rotating_ellipsoid(h);
    const sim::State middle = render::interpolated(a, b, a.time + h / 2);
    const sim::State exact = rotating_ellipsoid(h / 2).second;  // starts at the same instant
    REQUIRE(exact.time == Approx(middle.time));
    const double error = largest(middle.vesicles[0].position.values - exact.vesicles[0].position.values);
    INFO("step " << h << " error " << error);
    if (previous > 0) CHECK(previous / error == Approx(16).epsilon(0.1));
    previous = error;
  }
  CHECK(previous < 1e-5);
}

TEST_CASE("between two states the membrane stays smooth, closed and as large as it was") {
  const auto [a, b] = rotating_ellipsoid(0.2);
  const double volume = render::volume_moments(a.vesicles[0].position).volume;
  for (const double u : {0.25, 0.5, 0.75}) {
    const sim::State middle = render::interpolated(a, b, a.time + 0.2 * u);
    CHECK(render::volume_moments(middle.vesicles[0].position).volume == Approx(volume).epsilon(1e-4));
    // an ellipsoid is of first degree, and nothing else has come in
    const sim::Matrix& values = middle.vesicles[0].position.values;
    CHECK(largest(values.bottomRows(values.rows() - 4)) < 1e-13);
  }
}

TEST_CASE("labels and dots between two states are those of the later one, and labels lie on the unit sphere") {
  auto [a, b] = rotating_ellipsoid(0.2);
  b.vesicles[0].labels = surfaces::coefficients(4, [](const Vec3& s) -> Vec3 { return turn(30, {1, 1, 0}) * s; });
  b.vesicles[0].tracers = surfaces::dots().bottomRows(3);
  b.vesicles[0].relabelled = 1;
  b.vesicles[0].labels_laid = 2;
  b.vesicles[0].labels_laid_time = 0.5;
  const sim::State middle = render::interpolated(a, b, 0.5);
  CHECK(middle.vesicles[0].labels.values == b.vesicles[0].labels.values);
  CHECK(middle.vesicles[0].tracers == b.vesicles[0].tracers);
  CHECK(middle.vesicles[0].relabelled == 1);
  CHECK(middle.vesicles[0].labels_laid == 2);
  CHECK(middle.vesicles[0].labels_laid_time == 0.5);
  CHECK(middle.vesicles[0].tension.values == b.vesicles[0].tension.values);  // a's stands in another parametrisation
  const render::Mesh mesh = render::make_mesh(std::make_shared<const render::MeshPlan>(), middle.vesicles[0]);
  float furthest = 0;
  for (const glm::vec3& label : mesh.label) furthest = std::max(furthest, std::abs(glm::length(label) - 1));
  CHECK(furthest < 1e-6F);
}

TEST_CASE("at its ends the interval gives the saved states themselves") {
  const auto [a, b] = rotating_ellipsoid(0.2);
  for (const double before : {a.time, a.time - 1})
    CHECK(render::interpolated(a, b, before).vesicles[0].position.values == a.vesicles[0].position.values);
  for (const double after : {b.time, b.time + 1})
    CHECK(render::interpolated(a, b, after).vesicles[0].position.values == b.vesicles[0].position.values);
  CHECK(render::interpolated(a, b, a.time).step == 4);
  sim::State more = b;
  more.vesicles.push_back(more.vesicles[0]);
  CHECK_THAT(support::message_of([&, &first = a] { render::interpolated(first, more, 0.5); }),
             Catch::Contains("numbers of vesicles"));
}
