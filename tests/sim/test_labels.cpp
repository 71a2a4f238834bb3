#include "sim/layers/near.h"

#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;
using test::pi;

namespace {

/// A prolate whose grid has been twisted by the flow: something a relabelling has work to do on.
Dynamics twisted(const Model& s, int steps = 12) { return test::advanced(s, initial_dynamics(s), 0.1, steps); }

Scene twist_scene(const char* mode) {
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 12), 0.1, 10);
  scene.numerics.reparametrization = mode;
  return scene;
}

/// Parameters s where the label field has the value `label`, near `start`: Newton on the sphere with sampled slopes.
Vec3 where_label_is(const Coefficients& labels, const Vec3& label, Vec3 s) {
  const auto value = [&](const Vec3& at) {
    return Vec3(sample_points(labels, at.normalized().transpose()).row(0).normalized().transpose());
  };
  for (int k = 0; k < 30; ++k) {
    const Vec3 a = s.unitOrthogonal(), b = s.cross(a);
    const double h = 1e-5;
    Eigen::Matrix<double, 3, 2> slope;
    slope << (value(s + h * a) - value(s - h * a)) / (2 * h), (value(s + h * b) - value(s - h * b)) / (2 * h);
    const Eigen::Vector2d step = slope.colPivHouseholderQr().solve(label - value(s));
    s = (s + step[0] * a + step[1] * b).normalized();
  }
  return s;
}

}  // namespace

TEST_CASE("relabelling lowers the high degrees and leaves the surface where it was") {
  Plans plans;
  const Scene scene = twist_scene("off");
  const Model model = make_model(scene, plans);
  const Coefficients x = twisted(model, 20).vesicles[0].position;
  const Relabelling r = relabel(plans, x, 24);
  CHECK(r.high_after < 0.75 * r.high_before);
  const Coefficients y = pulled_back(plans, r, x);
  // Every point of the new surface lies on the old one, up to the truncation to degree p that r.lost reports.
  const Basis& grid = plans.basis(12, 24);
  const Matrix on_surface = sample_points(x, mapped(r, grid));
  CHECK((grid.synthesize(y).values - on_surface).rowwise().norm().maxCoeff() < 20 * r.lost + 1e-12);
  const AreaVolume before = area_volume(plans.basis(12, 40), x), after = area_volume(plans.basis(12, 40), y);
  CHECK(after.volume == Approx(before.volume).epsilon(10 * r.lost + 1e-12));
}

TEST_CASE("what is carried through a relabelling stays at its material point") {
  Plans plans;
  const Scene scene = twist_scene("off");
  const Model model = make_model(scene, plans);
  const Coefficients x = twisted(model, 20).vesicles[0].position;
  const Relabelling r = relabel(plans, x, 24);
  const Coefficients y = pulled_back(plans, r, x), labels = pulled_back(plans, r, fresh_labels(24));
  const Matrix dots = tracer_directions(), carried = carried_points(r, x, y, dots);
  CHECK((sample_points(y, carried) - sample_points(x, dots)).rowwise().norm().maxCoeff() < 20 * r.lost + 1e-10);
  // The same material points found through the label field.
  for (int k = 0; k < dots.rows(); ++k) {
    const Vec3 s = where_label_is(labels, dots.row(k).transpose(), carried.row(k).transpose());
    CHECK((s - Vec3(carried.row(k).transpose())).norm() < 1e-3);  // truncation of the labels to degree 24
  }
}

TEST_CASE("a labelled point followed with relabelling at every step and without ends at the same place") {
  const auto dots_after = [](const char* mode, bool by_labels) {
    Plans plans;
    const Scene scene = twist_scene(mode);
    const Model s = make_model(scene, plans);
    const VesicleDynamics v = twisted(s).vesicles[0];
    if (std::string(mode) == "always") REQUIRE(v.relabelled >= 5);
    if (!by_labels) return Matrix(sample_points(v.position, v.tracers));
    Matrix parameters = v.tracers;
    const Matrix start = tracer_directions();
    for (int k = 0; k < start.rows(); ++k)
      parameters.row(k) = where_label_is(v.labels, start.row(k).transpose(), v.tracers.row(k).transpose()).transpose();
    return Matrix(sample_points(v.position, parameters));
  };
  const Matrix grid = dots_after("off", false);
  // Twelve relabellings, each truncated at p = 12: the bound is their sum; the points have moved by 0.4 meanwhile.
  CHECK((dots_after("always", false) - grid).rowwise().norm().maxCoeff() < 5e-3);
  CHECK((dots_after("always", true) - grid).rowwise().norm().maxCoeff() < 5e-3);
}

TEST_CASE("fresh labels are the sphere itself and count as resolved") {
  const Coefficients labels = fresh_labels(24);
  const Matrix dots = tracer_directions();
  CHECK((sample_points(labels, dots) - dots).norm() < 1e-13);
  CHECK_FALSE(labels_wound_up(labels));
  CHECK(labels_wound_up(test::smooth_field(4, 4, 3, 1)));
}

TEST_CASE("the two ends of an interpolation are given in one parametrisation") {
  Plans plans;
  Scene scene = twist_scene("always");
  const Model s = make_model(scene, plans);
  Dynamics d = initial_dynamics(s);
  mark_saved(d, evaluate(s, d).value());
  d = test::advanced(s, d, 0.1, 5);
  const State state = evaluate(s, d).value();
  const VesicleState& v = state.vesicles[0];
  REQUIRE(v.relabelled > 0);
  // The same material point at the earlier time: x_before(s) must be where its label started, on the first surface.
  const Coefficients first = initial_dynamics(s).vesicles[0].position;
  const Matrix start = sample_points(first, tracer_directions());
  CHECK((sample_points(v.position_before, v.tracers) - start).rowwise().norm().maxCoeff() < 5e-3);
}

namespace {

/// Between two saved states in the later one's parametrisation: the cubic that has both positions and velocities.
Coefficients between(const VesicleState& b, double h, double u, bool rate) {
  const Matrix &x0 = b.position_before.values, &x1 = b.position.values, &v0 = b.velocity_before.values,
               &v1 = b.velocity.values;
  const double r = 1 - u;
  if (rate) return {b.position.order, 6 * u * r / h * (x1 - x0) + r * (1 - 3 * u) * v0 + u * (3 * u - 2) * v1};
  return {b.position.order, r * r * (1 + 2 * u) * x0 + u * u * (3 - 2 * u) * x1 + h * u * r * (r * v0 - u * v1)};
}

}  // namespace

TEST_CASE("labels are material: over a tank-treading period they stay with points carried by the membrane's velocity") {
  Plans plans;
  Scene scene = test::shear_scene(test::vesicle("prolate", 0.85, 12), 0.1, 20);
  const Model model = make_model(scene, plans);
  Dynamics d = initial_dynamics(model);
  mark_saved(d, evaluate(model, d).value());
  const Matrix dots = tracer_directions();
  Matrix carried = sample_points(d.vesicles[0].position, dots),
         near = dots;  // points in space, and parameters to start from
  double worst = 0, turned = 0;
  Vec3 before = carried.row(0).transpose();
  // Until the dot that started at +x, which lies in the plane of shear, has gone once round.
  while (turned < 2 * test::pi && d.time < 30) {
    const double start = d.time;
    // At this order it is seldom due; here it is done every unit of time.
    scene.numerics.reparametrization = d.step % 10 == 0 ? "always" : "off";
    d = test::advanced(model, d, 0.1, 2);
    const State state = evaluate(model, d).value();
    mark_saved(d, state);
    const VesicleState& b = state.vesicles[0];
    const double h = d.time - start;
    const Coefficients first = between(b, h, 0, false), middle = between(b, h, 0.5, false),
                       end = between(b, h, 1, false);
    const Coefficients first_rate = between(b, h, 0, true), middle_rate = between(b, h, 0.5, true),
                       end_rate = between(b, h, 1, true);
    for (Eigen::Index k = 0; k < carried.rows(); ++k) {
      Vec3 s = b.tracers.row(k).transpose();  // only where the search for the nearest point begins
      const auto velocity = [&](const Coefficients& x, const Coefficients& rate, const Vec3& at) {
        s = nearest_point(PointSampler(x), at, s).parameter;
        return Vec3(sample_points(rate, s.transpose()).row(0));
      };
      const Vec3 p = carried.row(k).transpose();
      const Vec3 k1 = velocity(first, first_rate, p), k2 = velocity(middle, middle_rate, p + h / 2 * k1);
      const Vec3 k3 = velocity(middle, middle_rate, p + h / 2 * k2), k4 = velocity(end, end_rate, p + h * k3);
      carried.row(k) += (h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)).transpose();
      near.row(k) = s.transpose();
    }
    const Vec3 now = carried.row(0).transpose();
    turned +=
        std::abs(std::atan2(before.z() * now.x() - before.x() * now.z(), before.x() * now.x() + before.z() * now.z()));
    before = now;
    worst = std::max(worst, (sample_points(b.position, b.tracers) - carried).rowwise().norm().maxCoeff());
  }
  CHECK(turned >= 2 * test::pi);
  const VesicleDynamics& v = d.vesicles[0];
  CHECK(v.relabelled > 0);
  INFO("period " << d.time << ", relabelled " << v.relabelled << " times, laid anew " << v.labels_laid
                 << " times, dots " << worst);
  CHECK(worst < 1e-3);  // R0 = 1; what thirty relabellings lose at p = 12 is part of it
  // By the label field, where it is resolved: the point whose label is a dot's direction.
  REQUIRE(v.labels_laid == 0);
  double by_label = 0;
  for (Eigen::Index k = 0; k < dots.rows(); ++k) {
    const Vec3 s = where_label_is(v.labels, dots.row(k).transpose(), near.row(k).transpose());
    by_label =
        std::max(by_label, (Vec3(sample_points(v.position, s.transpose()).row(0)) - Vec3(carried.row(k))).norm());
  }
  INFO("by labels " << by_label);
  CHECK(by_label < 1e-3);
}
