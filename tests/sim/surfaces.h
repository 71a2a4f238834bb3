// Surfaces and fields that the tests of sim share.
#pragma once

#include "sim/membrane/cell.h"
#include "sim/membrane/membrane.h"
#include "sim/stepping/stepper.h"
#include "sim/surface/shapes.h"
#include "sim/suspension/gap.h"

#include <cmath>
#include <numbers>
#include <random>

namespace test {

inline constexpr double pi = std::numbers::pi;

inline sim::VesicleParameters vesicle(std::string shape, double nu, int order, double lambda = 1) {
  sim::VesicleParameters v;
  v.shape = std::move(shape);
  if (v.shape != "sphere") v.reduced_volume = nu;
  v.order = order;
  v.viscosity_contrast = lambda;
  return v;
}

inline sim::Coefficients surface(std::string shape, double nu, int order) {
  return sim::initial_position(vesicle(std::move(shape), nu, order));
}

inline sim::Coefficients ellipsoid(const sim::Vec3& axes, int order) {
  sim::VesicleParameters v;
  v.shape = "ellipsoid";
  v.axes = axes;
  v.order = order;
  return sim::initial_position(v);
}

/// A lopsided smooth shape without any symmetry.
inline sim::Coefficients potato(int order) {
  sim::VesicleParameters v;
  v.shape = "harmonics";
  v.coefficients = {{2, 0, 0.3}, {2, 1, 0.15}, {3, -2, 0.1}, {3, 3, -0.12}};
  v.order = order;
  v.axis = sim::Vec3(1, 0.4, -0.3);
  return sim::initial_position(v);
}

/// Random coefficients that fall off by 2^-n, always the same.
inline sim::Coefficients smooth_field(int order, int degree, int fields, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  sim::Coefficients c{order, sim::Matrix::Zero(sim::coefficient_count(order), fields)};
  for (int n = 0; n <= degree; ++n)
    for (int row = n * n; row < (n + 1) * (n + 1); ++row)
      for (int f = 0; f < fields; ++f) c.values(row, f) = uniform(random) * std::pow(2.0, -n);
  return c;
}

/// The right-hand side of (39a) for a vesicle by itself at time 0.
inline sim::Coefficients forcing(const sim::Membrane& m, std::span<const sim::FlowParameters> flows,
                                 const sim::Vec3& gravity) {
  sim::Coefficients r = m.bases.field.analyze(sim::background_velocity(flows, 0, m.geometry.x.value));
  r.values += m.layers.single.apply(sim::known_force(m, gravity)).values;
  return r;
}

inline sim::Coefficients constant_field(int order, const sim::Vec3& value) {
  sim::Coefficients c{order, sim::Matrix::Zero(sim::coefficient_count(order), 3)};
  c.values.row(0) = std::sqrt(4 * pi) * value.transpose();
  return c;
}

inline sim::Motion at_rest(int order) {
  return {{order, sim::Matrix::Zero(sim::coefficient_count(order), 3)},
          {order, sim::Matrix::Zero(sim::coefficient_count(order), 1)}};
}

inline sim::FlowParameters shear(double rate = 1) {
  sim::FlowParameters f;
  f.kind = "shear";
  f.rate = rate;
  return f;
}

inline sim::Scene shear_scene(const sim::VesicleParameters& v, double step, double end, std::string scheme = "bdf2") {
  sim::Scene scene;
  scene.flows.push_back(shear());
  scene.vesicles.push_back(v);
  scene.time.step = step;
  scene.time.end = end;
  scene.time.scheme = std::move(scheme);
  return scene;
}

/// Takes `count` equal steps.
inline sim::Dynamics advanced(const sim::Model& s, sim::Dynamics d, double dt, int count) {
  for (int k = 0; k < count; ++k) d = sim::take_step(s, d, dt).value().dynamics;
  return d;
}

/// Between the vesicles of a scene, as they start, and their images; negative where they cross.
inline double starting_gap(const sim::Scene& scene) {
  std::vector<sim::Coefficients> x;
  for (const sim::VesicleParameters& v : scene.vesicles) x.push_back(sim::initial_position(v));
  sim::Plans plans;
  const sim::Gap gap = sim::smallest_gap(plans, x, sim::cell_at(scene, 0));
  return gap.crossing ? -1 : gap.distance;
}

/// Of the velocity of a fluid, by central differences over 2e-3.
template <class Field>
double divergence(const Field& field, const sim::Vec3& at) {
  constexpr double h = 1e-3;
  sim::Matrix x(6, 3);
  for (int d = 0; d < 3; ++d) {
    x.row(2 * d) = (at + h * sim::Vec3::Unit(d)).transpose();
    x.row(2 * d + 1) = (at - h * sim::Vec3::Unit(d)).transpose();
  }
  const sim::Matrix u = velocity_at(field, x).velocity;
  return (u(0, 0) - u(1, 0) + u(2, 1) - u(3, 1) + u(4, 2) - u(5, 2)) / (2 * h);
}

inline sim::Matrix cross_rows(const sim::Vec3& w, const sim::Matrix& x) {
  sim::Matrix u(x.rows(), 3);
  for (Eigen::Index k = 0; k < x.rows(); ++k) u.row(k) = w.cross(sim::Vec3(x.row(k).transpose())).transpose();
  return u;
}

}  // namespace test
