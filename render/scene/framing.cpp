#include "render/scene/framing.h"

#include "render/core/places.h"
#include "render/core/style.h"

#include "sim/sphere/basis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace render {

using glm::dvec3;

StateSummary summarize(const sim::State& state) {
  constexpr Eigen::Index latitudes = 10, longitudes = 20;
  const double step = std::numbers::pi / latitudes;
  const sim::Vector theta = sim::Vector::LinSpaced(latitudes, step / 2, std::numbers::pi - step / 2);
  const sim::Vector phi = sim::Vector::LinSpaced(longitudes + 1, 0, 2 * std::numbers::pi).head(longitudes);
  StateSummary summary;
  summary.time = state.time;
  const Eigen::Index each = latitudes * longitudes;
  summary.points.reserve(static_cast<std::size_t>(each) * state.vesicles.size());
  double area = 0;
  dvec3 moment(0);  // of all, about the first
  for (const sim::VesicleState& vesicle : state.vesicles) {
    const sim::FirstDerivatives x = sim::sample_grid(vesicle.position, theta, phi);
    const dvec3 origin = to_glm(x.value.row(0));  // far from the scene's own, digits would be lost
    dvec3 sum(0);
    double own = 0;
    for (Eigen::Index i = 0; i < each; ++i) {
      const dvec3 normal = glm::cross(to_glm(x.t.row(i)), to_glm(x.f.row(i)));
      const double weight = glm::length(normal);
      sum += weight * (to_glm(x.value.row(i)) - origin);
      own += weight;
      summary.areas.emplace_back(step * step * normal);
    }
    const dvec3 centroid = own > 0 ? origin + sum / own : origin;
    for (Eigen::Index i = 0; i < each; ++i) summary.points.emplace_back(to_glm(x.value.row(i)) - centroid);
    summary.centroids.push_back(centroid);
    moment += own * (centroid - summary.centroids.front());
    area += own;
  }
  if (!summary.centroids.empty()) summary.centroid = summary.centroids.front();
  if (area > 0) summary.centroid += moment / area;
  return summary;
}

ViewAxes Framing::axes_at(double time) const {
  ViewAxes result = axes;
  if (!keys.empty()) {
    const CameraKey key = camera_at(keys, time);
    result = axes_turned(key.azimuth, key.elevation);
  }
  if (orbit != 0) {
    const double c = std::cos(orbit * time), s = std::sin(orbit * time);
    for (dvec3* v : {&result.right, &result.up, &result.back}) *v = {c * v->x - s * v->y, s * v->x + c * v->y, v->z};
  }
  return result;
}

Moment Framing::moment(const StateSummary& state) const {
  return {vesicle < 0 ? state.centroid : state.centroids.at(static_cast<std::size_t>(vesicle)), state.time};
}

namespace {

constexpr double tangent_of_half_angle = 0.18;  // vertical; a long lens: shapes are hardly distorted
constexpr double strays = 0.5;                  // follow = "auto": drift / extent above which the camera follows
constexpr double neighbourhood = 1.7;           // times the vesicle that is followed: room for what happens beside it

struct Extent {
  dvec3 lower{1e300}, upper{-1e300};
  void add(const dvec3& p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  dvec3 centre() const { return (lower + upper) / 2.0; }
  dvec3 size() const { return upper - lower; }
};

// What is framed when there is no state.
StateSummary unit_sphere() {
  StateSummary sphere;
  sphere.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  sphere.centroids = {dvec3(0)};
  return sphere;
}

std::vector<CameraKey> sorted_keys(std::span<const KeyFrameParameters> key_frames) {
  std::vector<CameraKey> keys;
  for (const KeyFrameParameters& k : key_frames)
    keys.push_back({.time = k.time, .azimuth = k.azimuth, .elevation = k.elevation, .zoom = k.zoom});
  std::stable_sort(keys.begin(), keys.end(), [](const CameraKey& a, const CameraKey& b) { return a.time < b.time; });
  for (std::size_t k = 1; k < keys.size(); ++k)
    if (keys[k].time == keys[k - 1].time)
      throw std::invalid_argument(fmt::format("two key frames have the same time, {:.6g}", keys[k].time));
  return keys;
}

// Directions, lens and motion of the camera; a placed eye does not move.
Framing directed(const ViewParameters& view, std::span<const KeyFrameParameters> key_frames) {
  Framing framing;
  framing.axes = find_camera(view.camera).axes;
  framing.perspective = view.projection != "orthographic";
  framing.aspect = static_cast<double>(view.size.at(0)) / view.size.at(1);
  if (view.eye) return framing;
  framing.orbit = glm::radians(view.orbit);
  framing.keys = sorted_keys(key_frames);
  return framing;
}

// -1: none.
int followed_vesicle(const ViewParameters& view, std::size_t vesicles) {
  if (view.follow != "vesicle") return -1;
  if (static_cast<std::size_t>(view.follow_vesicle) >= vesicles)
    throw std::invalid_argument("view.follow_vesicle is " + std::to_string(view.follow_vesicle) +
                                ", but the vesicles are numbered from 0 to " + std::to_string(vesicles - 1));
  return view.follow_vesicle;
}

// The points that the picture must hold, all or those of the vesicle that is followed: the first, and the end.
std::pair<std::size_t, std::size_t> shown_points(const Framing& framing, const StateSummary& state) {
  if (framing.vesicle < 0) return {0, state.points.size()};
  const std::size_t each = state.points_of_each(), first = each * static_cast<std::size_t>(framing.vesicle);
  return {first, first + each};
}

// Columns: the axes of the boxes below, those of the picture; of the scene when the camera turns.
glm::dmat3 box_axes(const Framing& framing) {
  if (framing.turns()) return glm::dmat3(1);
  return {framing.axes.right, framing.axes.up, framing.axes.back};
}

// How far the vesicles extend and move.
struct Spread {
  Extent centroids;       // of what the camera would follow, over all instants
  Extent about_centroid;  // of what the picture must hold, relative to it
  double largest = 0;     // edge of the box of one instant
};
Spread spread_of(const Framing& framing, std::span<const StateSummary> states) {
  const glm::dmat3 to_axes = glm::transpose(box_axes(framing));
  Spread spread;
  for (const StateSummary& state : states) {
    const dvec3 centroid = to_axes * framing.moment(state).centre;
    spread.centroids.add(centroid);
    Extent now;
    for (auto [k, end] = shown_points(framing, state); k < end; ++k) {
      const dvec3 p = to_axes * state.point(k);
      now.add(p);
      spread.about_centroid.add(p - centroid);
    }
    const dvec3 size = now.size();
    spread.largest = std::max({spread.largest, size.x, size.y, size.z});
  }
  return spread;
}

bool camera_follows(const ViewParameters& view, const Spread& spread) {
  if (view.eye || view.target) return false;
  if (view.follow == "always" || view.follow == "vesicle") return true;
  return view.follow == "auto" && glm::length(spread.centroids.size()) > strays * spread.largest;
}

// In the middle of the box that the picture must hold, or where the scene says; and the depth of that box.
void set_target(Framing& framing, const ViewParameters& view, std::span<const StateSummary> states,
                const Extent& about_centroid) {
  const glm::dmat3 from_axes = box_axes(framing), to_axes = glm::transpose(from_axes);
  Extent all = about_centroid;
  if (!framing.follows) {
    all = Extent{};
    for (const StateSummary& state : states)
      for (std::size_t k = 0; k < state.points.size(); ++k) all.add(to_axes * state.point(k));
  }
  const dvec3 centre = view.target ? to_glm(*view.target) : from_axes * all.centre();
  (framing.follows ? framing.offset : framing.target) = centre;
  framing.depth = (framing.turns() ? glm::length(all.size()) : all.size().z) / 2;
  if (framing.vesicle < 0 && !view.target && !view.eye) return;
  for (const StateSummary& state : states) {  // others may lie farther off
    const dvec3 target = framing.target_at(framing.moment(state));
    for (std::size_t k = 0; k < state.points.size(); ++k)
      framing.depth = std::max(framing.depth, glm::distance(state.point(k), target));
  }
}

// The eye and its target as the scene gives them.
void place_eye(Framing& framing, const ViewParameters& view) {
  const dvec3 eye = to_glm(*view.eye);
  const double distance = glm::distance(eye, framing.target);
  if (!(distance > 0)) throw std::invalid_argument("view.eye and view.target are the same point");
  const dvec3 back = (eye - framing.target) / distance, up = to_glm(view.up);
  if (glm::length(glm::cross(up, back)) <= 1e-6 * glm::length(up))
    throw std::invalid_argument("view.up must not point along the line of sight");
  framing.axes = axes_from(back, up);
  framing.distance = distance;
  framing.half_height = distance * tangent_of_half_angle / view.zoom;
  framing.placed = true;
}

// The picture must hold every point; a nearer one looks larger.
void fit(Framing& framing, const ViewParameters& view, std::span<const StateSummary> states) {
  const double zoom = view.zoom;
  const double margin = framing.vesicle >= 0 ? neighbourhood : 1;
  double width = view.flow_profile ? bodies_width_beside_profile : bodies_width;
  constexpr double least = 0.6;  // narrow pictures may have no bar
  if (view.colour_bar && (find_style(view.style).field || view.colour_by != "order"))
    width = std::min(width, std::max(1 - 2 * colour_bar_room(view.size.at(1)) / view.size.at(0), least));
  const double tx = tangent_of_half_angle * framing.aspect * width / margin;
  const double ty = tangent_of_half_angle * bodies_height / margin;
  double distance = 0, half_height = 0;
  for (const StateSummary& state : states) {
    const ViewAxes axes = framing.axes_at(state.time);
    const glm::dmat3 to_picture = glm::transpose(glm::dmat3(axes.right, axes.up, axes.back));
    const dvec3 origin = framing.target_at(framing.moment(state));
    for (auto [k, end] = shown_points(framing, state); k < end; ++k) {
      const dvec3 p = to_picture * (state.point(k) - origin);
      distance = std::max({distance, p.z + std::abs(p.x) / tx, p.z + std::abs(p.y) / ty});
      half_height = std::max(
          {half_height, margin * std::abs(p.y) / bodies_height, margin * std::abs(p.x) / (width * framing.aspect)});
    }
  }
  if (!(distance > 0 && half_height > 0)) distance = half_height = 1;  // a point; any picture of it will do
  framing.distance = distance / zoom;
  framing.half_height = framing.perspective ? framing.distance * tangent_of_half_angle : half_height / zoom;
}

}  // namespace

Framing frame_trajectory(std::span<const StateSummary> states, const ViewParameters& view,
                         std::span<const KeyFrameParameters> key_frames) {
  const StateSummary sphere = unit_sphere();
  if (states.empty()) states = {&sphere, 1};
  Framing framing = directed(view, key_frames);
  framing.vesicle = followed_vesicle(view, states[0].centroids.size());
  const Spread spread = spread_of(framing, states);
  framing.follows = camera_follows(view, spread);
  set_target(framing, view, states, spread.about_centroid);
  if (view.eye)
    place_eye(framing, view);
  else
    fit(framing, view, states);
  return framing;
}

}  // namespace render
