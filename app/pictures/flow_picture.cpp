#include "app/pictures/flow_picture.h"

#include "app/base/interrupt.h"
#include "app/pictures/cell_images.h"
#include "app/pictures/scales.h"

#include "render/scene/detail.h"
#include "render/scene/surface.h"
#include "sim/suspension/velocity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace app {

namespace {

using Vec2 = Eigen::Vector2d;

/// Samples on a net of squares over a window and a little beyond.
struct Net {
  static constexpr int border = 2;  // nodes beyond the window, for the stencil
  double step, x, y;
  int columns, rows;
  sim::Matrix velocity;  ///< in the plane: nodes x 2
  sim::Vector distance;  ///< to the nearest membrane, or less

  Net(const render::Range& across, const render::Range& up, double size)
      : step(size),
        x(across.low - border * size),
        y(up.low - border * size),
        columns(static_cast<int>(std::ceil(across.size() / size)) + 2 * border + 1),
        rows(static_cast<int>(std::ceil(up.size() / size)) + 2 * border + 1),
        velocity(Eigen::Index{columns} * rows, 2),
        distance(Eigen::Index{columns} * rows) {}

  Eigen::Index index(int column, int row) const { return Eigen::Index{row} * columns + column; }
  Vec2 node(Eigen::Index k) const {
    const Eigen::Index row = k / columns, column = k % columns;
    return {x + static_cast<double>(column) * step, y + static_cast<double>(row) * step};
  }

  struct Value {
    Vec2 velocity;
    double distance;  ///< to the nearest membrane, or less
  };
  /// By cubics over 4 x 4 nodes, unless a membrane may pass between them.
  std::optional<Value> at(const Vec2& p) const {
    const double a = (p.x() - x) / step, b = (p.y() - y) / step;
    const int c = static_cast<int>(std::floor(a)), r = static_cast<int>(std::floor(b));
    if (c < 1 || r < 1 || c + 2 >= columns || r + 2 >= rows) return {};
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) nearest = std::min(nearest, distance[index(c + i, r + j)]);
    if (nearest < 2.9 * step) return {};  // from a corner of the cell to the farthest of the nodes: sqrt(8) steps
    const auto weights = [](double t) {
      return std::array<double, 4>{-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                                   -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
    };
    const auto wx = weights(a - c), wy = weights(b - r);
    Vec2 v = Vec2::Zero();
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        v += wx[i] * wy[j] * velocity.row(index(c - 1 + static_cast<int>(i), r - 1 + static_cast<int>(j))).transpose();
    return Value{v, nearest - 1.5 * step};
  }
};

/// Velocity in the plane at any point of a window: a coarse net, a fine one, near a membrane the layer potentials
/// themselves.
class PlaneSampler {
 public:
  PlaneSampler(const sim::FlowField& field, const FlowRequest& request, double step)
      : field_(field),
        request_(request),
        coarse_(request.x, request.y, step),
        fine_(request.x, request.y, step / finer) {
    std::vector<Eigen::Index> all(static_cast<std::size_t>(coarse_.distance.size()));
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<Eigen::Index>(k);
    sample(coarse_, all);
    std::vector<Eigen::Index> near;
    for (Eigen::Index k = 0; k < fine_.distance.size(); ++k)
      if (const auto value = coarse_.at(fine_.node(k))) {
        fine_.velocity.row(k) = value->velocity.transpose();
        fine_.distance[k] = value->distance;
      } else {
        near.push_back(k);
      }
    sample(fine_, near);
  }

  Vec2 operator()(const Vec2& p) const {
    if (const auto smooth = coarse_.at(p)) return smooth->velocity;
    if (const auto smooth = fine_.at(p)) return smooth->velocity;
    return in_plane(sim::velocity_at(field_, in_space(p).transpose()).velocity).row(0).transpose();
  }

  /// Speeds at the nodes of the fine net within the window, row 0 at the top, and the window of the cells round them.
  std::pair<sim::Matrix, std::array<render::Range, 2>> speeds() const {
    constexpr int b = Net::border;
    const int columns = fine_.columns - 2 * b, rows = fine_.rows - 2 * b;
    sim::Matrix speed(rows, columns);
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) speed(rows - 1 - r, c) = fine_.velocity.row(fine_.index(c + b, r + b)).norm();
    const double half = fine_.step / 2, x = fine_.x + b * fine_.step, y = fine_.y + b * fine_.step;
    return {speed,
            {render::Range{x - half, x + (columns - 1) * fine_.step + half},
             render::Range{y - half, y + (rows - 1) * fine_.step + half}}};
  }

 private:
  static constexpr int finer = 3;

  sim::Vec3 in_space(const Vec2& p) const {
    return request_.plane.origin + p.x() * request_.plane.right + p.y() * request_.plane.up;
  }
  sim::Matrix in_plane(const sim::Matrix& velocity) const {
    sim::Matrix v(velocity.rows(), 2);
    const sim::Matrix relative = velocity.rowwise() - request_.frame_velocity.transpose();
    v.col(0) = relative * request_.plane.right;
    v.col(1) = relative * request_.plane.up;
    return v;
  }
  void sample(Net& net, const std::vector<Eigen::Index>& nodes) const {
    sim::Matrix points(static_cast<Eigen::Index>(nodes.size()), 3);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      points.row(static_cast<Eigen::Index>(k)) = in_space(net.node(nodes[k])).transpose();
    constexpr Eigen::Index portion = 512;  // a fraction of a second: a signal is obeyed in between
    for (Eigen::Index first = 0; first < points.rows(); first += portion) {
      stop_if_interrupted();
      const Eigen::Index count = std::min(portion, points.rows() - first);
      const sim::FlowSamples samples = sim::velocity_at(field_, points.middleRows(first, count));
      const sim::Matrix v = in_plane(samples.velocity);
      for (Eigen::Index k = 0; k < count; ++k) {
        const Eigen::Index node = nodes[static_cast<std::size_t>(first + k)];
        net.velocity.row(node) = v.row(k);
        net.distance[node] = samples.distance[k];
      }
    }
  }

  const sim::FlowField& field_;
  const FlowRequest& request_;
  Net coarse_, fine_;
};

}  // namespace

WindowMembranes membranes_in(const sim::Scene& scene, const sim::State& state, const FlowRequest& request) {
  WindowMembranes found{state, {}};
  if (!scene.cell.size) return found;
  found.state.vesicles.clear();
  std::vector<render::Sketch> sketches;
  for (const sim::VesicleState& vesicle : state.vesicles) sketches.push_back(render::sketch_of(vesicle));
  // As many cells as the window reaches into, and one more for what lies across a face.
  const sim::Vec3 size = *scene.cell.size;
  const double reach = std::max({-request.x.low, request.x.high, -request.y.low, request.y.high});
  render::ViewParameters view;
  view.faces = "whole";
  for (std::size_t d = 0; d < 3; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    view.copies[d] = 1 + static_cast<int>(std::ceil((std::abs(request.plane.origin[axis]) + reach) / size[axis] - 0.5));
  }
  std::vector<Whereabouts> places;
  for (std::size_t v = 0; v < state.vesicles.size(); ++v)
    places.push_back(whereabouts_of(state.vesicles[v], render::bounds_of(sketches[v])));
  for (const Shown& s : shown_of(scene, view, places, state.time)) {
    const render::Sketch& sketch = sketches[s.vesicle];
    const sim::Vec3 from = render::to_sim(sketch.centre) + s.shift - request.plane.origin;
    const double x = from.dot(request.plane.right), y = from.dot(request.plane.up), r = sketch.radius;
    if (std::abs(from.dot(request.plane.normal)) > r || x + r < request.x.low || x - r > request.x.high ||
        y + r < request.y.low || y - r > request.y.high)
      continue;
    found.state.vesicles.push_back(moved(state.vesicles[s.vesicle], s.shift));
    found.owners.push_back(s.vesicle);
  }
  return found;
}

sim::Vec3 frame_velocity(sim::Plans& plans, const sim::State& state) {
  sim::Vec3 sum = sim::Vec3::Zero();
  for (const sim::VesicleState& vesicle : state.vesicles) sum += sim::centroid_velocity(plans, vesicle);
  return sum / static_cast<double>(state.vesicles.size());
}

FlowRequest flow_request(sim::Plans& plans, const sim::State& state, const render::FigureParameters& p, double length) {
  FlowRequest request;
  sim::Vec3 middle = sim::Vec3::Zero();
  for (const sim::VesicleState& vesicle : state.vesicles) middle += render::volume_moments(vesicle.position).centroid;
  middle /= static_cast<double>(state.vesicles.size());
  request.plane = render::plane_of(p, middle);
  // Coordinates of the plane count from the scene's origin, as those of cross-sections do.
  request.plane.origin = request.plane.origin.dot(request.plane.normal) * request.plane.normal;
  Vec2 low = Vec2::Constant(1e300), high = -low;
  for (const sim::VesicleState& vesicle : state.vesicles)
    for (const render::ClosedCurve& curve : render::cut(vesicle.position, request.plane)) {
      low = low.cwiseMin(curve.points.colwise().minCoeff().transpose());
      high = high.cwiseMax(curve.points.colwise().maxCoeff().transpose());
    }
  if (low.x() > high.x()) throw std::invalid_argument("the plane of the streamlines cuts no vesicle");
  const Vec2 margin = Vec2::Constant(p.margin * length);
  request.x = {low.x() - margin.x(), high.x() + margin.x()};
  request.y = {low.y() - margin.y(), high.y() + margin.y()};
  // No window narrower than half of its length.
  const auto widen = [](render::Range& r, double size) {
    const double more = std::max(0.0, size - r.size()) / 2;
    r = {r.low - more, r.high + more};
  };
  widen(request.y, request.x.size() / 2);
  widen(request.x, request.y.size() / 1.5);
  if (p.frame == "vesicle") request.frame_velocity = frame_velocity(plans, state);
  request.spacing = p.spacing * length;
  request.length = length;
  request.with_speed = p.background == "speed";
  return request;
}

render::FlowPicture flow_picture(sim::Plans& plans, const sim::Scene& scene, const sim::State& state,
                                 const FlowRequest& request) {
  sim::FlowFieldOptions accuracy;
  accuracy.near_order = {32, 40};  // errors below 1e-3 at the closest: a hundredth of a line's width
  const sim::FlowField field = sim::flow_field(plans, scene, state, accuracy);
  const double longest = std::max(request.x.size(), request.y.size());
  const PlaneSampler sampler(field, request, std::max(0.3 * request.spacing, longest / 250));
  render::FlowPicture picture;
  picture.plane = request.plane;
  picture.x = request.x;
  picture.y = request.y;
  picture.spacing = request.spacing;
  // The first lines hug the membranes from both sides, where one looks first.
  std::vector<Vec2> seeds;
  for (const sim::VesicleState& vesicle : membranes_in(scene, state, request).state.vesicles)
    for (const render::ClosedCurve& curve : render::cut(vesicle.position, request.plane)) {
      Eigen::Index at = 0;
      curve.points.col(0).maxCoeff(&at);
      const Vec2 inward(-curve.tangents(at, 1), curve.tangents(at, 0));
      for (const double side : {-0.6, 0.6})
        seeds.push_back(curve.points.row(at).transpose() + side * request.spacing * inward);
    }
  render::StreamlineOptions options;
  options.spacing = request.spacing;
  options.rest = natural_scales(scene, state, request.length).rounding_of(sim::FieldScale::velocity);
  const auto flow = [&](const Vec2& p) {
    stop_if_interrupted();
    return sampler(p);
  };
  picture.lines = render::streamlines(flow, request.x, request.y, options, seeds);
  if (request.with_speed) std::tie(picture.speed, picture.speed_window) = sampler.speeds();
  if (request.with_speed && picture.speed.maxCoeff() <= options.rest) picture.speed.setZero();
  const sim::Vec3& o = request.plane.origin;
  const sim::Vec3& n = request.plane.normal;
  const sim::Vec3& u = request.frame_velocity;
  picture.remarks = {fmt::format("plane through ({:.6g}, {:.6g}, {:.6g}) with normal ({:.6g}, {:.6g}, {:.6g})", o[0],
                                 o[1], o[2], n[0], n[1], n[2]),
                     fmt::format("velocity of the frame: ({:.6g}, {:.6g}, {:.6g})", u[0], u[1], u[2])};
  return picture;
}

}  // namespace app
