// Surfaces with known shapes, as states of a vesicle.
#pragma once

#include "render/core/parameters.h"
#include "render/image/difference.h"
#include "render/scene/cutaway.h"
#include "render/scene/frame.h"
#include "render/scene/mesh.h"
#include "sim/sphere/basis.h"

#include <cmath>
#include <functional>
#include <memory>

namespace surfaces {

using sim::Vec3;
using Map = std::function<Vec3(const Vec3&)>;

/// Coefficients of degree p of a vector function on the unit sphere; exact when it is a polynomial of that degree.
inline sim::Coefficients coefficients(int order, const Map& f) {
  const sim::Basis basis(order, order + 2);
  sim::Matrix samples(basis.points(), 3);
  for (int j = 0; j < basis.longitudes(); ++j)
    for (int i = 0; i < basis.latitudes(); ++i) {
      const double t = basis.theta()[i], q = basis.phi()[j];
      samples.row(i + basis.latitudes() * j) =
          f({std::sin(t) * std::cos(q), std::sin(t) * std::sin(q), std::cos(t)}).transpose();
    }
  return basis.analyze(samples);
}

/// The dots' directions: the axes, then the corners of the cube.
inline sim::Matrix dots() {
  sim::Matrix s(14, 3);
  Eigen::Index row = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      s.row(row).setZero();
      s(row++, axis) = sign;
    }
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0})
      for (const double z : {1.0, -1.0}) s.row(row++) = Vec3(x, y, z).normalized().transpose();
  return s;
}

inline sim::VesicleState vesicle(
    const Map& position, const Map& label = [](const Vec3& s) { return s; }, int order = 8) {
  sim::VesicleState v;
  v.position = coefficients(order, position);
  v.velocity = v.position;
  v.position_before = v.position;
  v.velocity_before = v.position;
  v.sliding = {order, sim::Matrix::Zero(sim::coefficient_count(order), 3)};
  v.labels = coefficients(4, label);
  v.tracers = dots();
  return v;
}

inline Eigen::Matrix3d turn(double degrees, const Vec3& axis) {
  return Eigen::AngleAxisd(degrees * std::acos(-1.0) / 180, axis.normalized()).toRotationMatrix();
}

inline sim::VesicleState sphere(const Vec3& centre = Vec3::Zero(), double radius = 1) {
  return vesicle([=](const Vec3& s) -> Vec3 { return centre + radius * s; });
}

/// Semi-axes a along the columns of r.
inline sim::VesicleState ellipsoid(const Vec3& a, const Eigen::Matrix3d& r, const Vec3& centre = Vec3::Zero()) {
  return vesicle([=](const Vec3& s) -> Vec3 { return centre + r * a.cwiseProduct(s); });
}

/// The biconcave disc of reduced volume 0.65 and area 4 pi, its axis along the third column of r.
inline sim::VesicleState disc(const Eigen::Matrix3d& r, const Vec3& centre = Vec3::Zero()) {
  return vesicle([=](const Vec3& s) -> Vec3 {
    const double q = s.x() * s.x() + s.y() * s.y(), scale = 1.191602667;
    return centre + r * (scale * Vec3(s.x(), s.y(), 0.5 * 1.022378509 * s.z() * (0.207 + 2.003 * q - 1.123 * q * q)));
  });
}

/// Nothing but the vesicles on white: what pictures are measured on.
inline render::ViewParameters bare_view(int width = 480, int height = 480) {
  render::ViewParameters view;
  view.size = {width, height};
  view.projection = "orthographic";
  view.supersampling = 1;
  view.background = "white";
  view.style = "plain";
  view.outline_width = 0;
  view.tracers = view.flow_arrows = view.time_stamp = view.caption = view.scale_bar = false;
  return view;
}

/// The frame of one state, framed for itself; second vesicle in the second colour, and so on.
inline render::Frame frame_of(const sim::State& state, const render::ViewParameters& view) {
  static const auto plan = std::make_shared<const render::MeshPlan>();
  const render::StateSummary summary = render::summarize(state);
  render::Frame frame;
  for (std::size_t v = 0; v < state.vesicles.size(); ++v)
    frame.bodies.push_back({render::make_mesh(plan, state.vesicles[v]), render::body_colour(v), {}});
  frame.camera = render::make_camera(render::frame_trajectory(std::span(&summary, 1), view), summary.centroid);
  frame.view = view;
  return frame;
}

/// A frame that every style can paint: the field is z, the plane y = 0 takes away the nearer half.
inline render::Frame painted(render::Frame frame, const sim::State& state) {
  render::Legend legend;
  legend.label = "z";
  legend.low = -1;
  legend.colours = render::colour_table(render::find_colour_map("viridis"));
  for (std::size_t v = 0; v < frame.bodies.size(); ++v) {
    render::Body& body = frame.bodies[v];
    for (const glm::dvec3& p : body.mesh.position) body.mesh.scalar.push_back(p.z);
    body.cut = render::make_cut(state.vesicles[v].position, -Vec3::UnitY(), 0);
  }
  frame.legend = legend;
  frame.view.colour_bar = false;
  return frame;
}

inline sim::State state_of(std::vector<sim::VesicleState> vesicles) {
  sim::State state;
  state.vesicles = std::move(vesicles);
  return state;
}

}  // namespace surfaces
