#include "render/scene/camera.h"

#include "sim/sphere/basis.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>
#include <stdexcept>

namespace render {
namespace {

using glm::dvec3;

constexpr double tangent_of_half_angle = 0.18;  // vertical; a long lens: shapes are hardly distorted
constexpr double fill_width = 0.86,
                 fill_height = 0.74;  // share of the picture that bodies may take; captions get the rest
constexpr double strays = 1.5;        // follow = "auto": drift / extent above which the camera follows

ViewAxes axes_from(const dvec3& back, const dvec3& up) {
  const dvec3 b = glm::normalize(back), r = glm::normalize(glm::cross(up, b));
  return {r, glm::cross(b, r), b};
}

// Degrees to the right of and above the flow-gradient view.
ViewAxes turned(double azimuth, double elevation) {
  const double a = glm::radians(azimuth), e = glm::radians(elevation);
  return axes_from({std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e)}, {0, 0, 1});
}

struct Extent {
  dvec3 lower{1e300}, upper{-1e300};  // right, up, back
  void add(const dvec3& p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  dvec3 centre() const { return (lower + upper) / 2.0; }
  dvec3 size() const { return upper - lower; }
};

}  // namespace

const std::vector<CameraRow>& cameras() {
  static const std::vector<CameraRow> rows{
      {"flow-gradient", "from -y: the flow to the right, its gradient up", turned(0, 0)},
      {"three-quarter", "flow-gradient, from a little to the left and above", turned(-22, 16)},
      {"flow-vorticity", "from above: the flow to the right, vorticity up the picture", axes_from({0, 0, 1}, {0, 1, 0})},
      {"gradient-vorticity", "against the flow: its gradient up", axes_from({1, 0, 0}, {0, 0, 1})},
      {"along-flow", "with the flow, from behind: its gradient up", axes_from({-1, 0, 0}, {0, 0, 1})},
  };
  return rows;
}

const CameraRow& find_camera(std::string_view name) {
  if (const CameraRow* row = sim::find_row(cameras(), name)) return *row;
  throw std::invalid_argument("unknown camera '" + std::string(name) + "'" +
                              sim::suggestion(name, sim::row_names(cameras())));
}

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

CameraKey camera_at(std::span<const CameraKey> keys, double time) {
  if (keys.empty()) return {};
  if (time <= keys.front().time) return keys.front();
  if (time >= keys.back().time) return keys.back();
  std::size_t k = 0;
  while (keys[k + 1].time <= time) ++k;
  const CameraKey &from = keys[k], &to = keys[k + 1];
  const double h = to.time - from.time, u = (time - from.time) / h, rest = 1 - u;
  // Tangents by Fritsch and Butland's harmonic mean: no overshoot; none at the ends and where the motion turns back.
  const auto value = [&](double CameraKey::*member) {
    const auto secant = [&](std::size_t i) { return (keys[i + 1].*member - keys[i].*member) / (keys[i + 1].time - keys[i].time); };
    const auto tangent = [&](std::size_t i) {
      if (i == 0 || i + 1 == keys.size()) return 0.0;
      const double before = secant(i - 1), after = secant(i);
      return before * after > 0 ? 2 * before * after / (before + after) : 0.0;
    };
    return rest * rest * (1 + 2 * u) * from.*member + u * u * (3 - 2 * u) * to.*member +
           h * u * rest * (rest * tangent(k) - u * tangent(k + 1));
  };
  return {time, value(&CameraKey::azimuth), value(&CameraKey::elevation), value(&CameraKey::zoom)};
}

ViewAxes Framing::axes_at(double time) const {
  ViewAxes result = axes;
  if (!keys.empty()) {
    const CameraKey key = camera_at(keys, time);
    result = turned(key.azimuth, key.elevation);
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

constexpr double neighbourhood = 1.7;  // times the vesicle that is followed: room for what happens beside it

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

}  // namespace

Framing frame_trajectory(std::span<const StateSummary> states, const ViewParameters& view,
                         std::span<const KeyFrameParameters> key_frames) {
  StateSummary sphere;
  sphere.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  sphere.centroids = {dvec3(0)};
  if (states.empty()) states = {&sphere, 1};

  Framing framing;
  framing.axes = find_camera(view.camera).axes;
  framing.perspective = view.projection != "orthographic";
  framing.aspect = static_cast<double>(view.size.at(0)) / view.size.at(1);
  framing.orbit = view.eye ? 0 : glm::radians(view.orbit);
  if (!view.eye)
    for (const KeyFrameParameters& k : key_frames) framing.keys.push_back({k.time, k.azimuth, k.elevation, k.zoom});
  std::stable_sort(framing.keys.begin(), framing.keys.end(),
                   [](const CameraKey& a, const CameraKey& b) { return a.time < b.time; });
  for (std::size_t k = 1; k < framing.keys.size(); ++k)
    if (framing.keys[k].time == framing.keys[k - 1].time)
      throw std::invalid_argument(fmt::format("two key frames have the same time, {:.6g}", framing.keys[k].time));
  const std::size_t vesicles = states[0].centroids.size();
  if (view.follow == "vesicle") {
    framing.vesicle = view.follow_vesicle;
    if (static_cast<std::size_t>(view.follow_vesicle) >= vesicles)
      throw std::invalid_argument("view.follow_vesicle is " + std::to_string(view.follow_vesicle) +
                                  ", but the vesicles are numbered from 0 to " + std::to_string(vesicles - 1));
  }
  // Boxes along the axes of the picture; of the scene when the camera turns.
  const glm::dmat3 from_axes = framing.turns() ? glm::dmat3(1) : glm::dmat3(framing.axes.right, framing.axes.up, framing.axes.back);
  const glm::dmat3 to_axes = glm::transpose(from_axes);
  // What the picture must hold: all points, or those of the vesicle that is followed.
  const auto shown = [&](const StateSummary& state) {
    if (framing.vesicle < 0) return std::views::iota(std::size_t{0}, state.points.size());
    const std::size_t each = state.points.size() / vesicles, first = each * static_cast<std::size_t>(framing.vesicle);
    return std::views::iota(first, first + each);
  };

  Extent centroids, about_centroid;
  double largest = 0;  // extent of one instant
  for (const StateSummary& state : states) {
    const dvec3 centroid = to_axes * framing.moment(state).centre;
    centroids.add(centroid);
    Extent now;
    for (const std::size_t k : shown(state)) {
      const dvec3 p = to_axes * state.point(k);
      now.add(p);
      about_centroid.add(p - centroid);
    }
    const dvec3 size = now.size();
    largest = std::max({largest, size.x, size.y, size.z});
  }
  framing.follows = !view.eye && !view.target &&
                    (view.follow == "always" || view.follow == "vesicle" ||
                     (view.follow == "auto" && glm::length(centroids.size()) > strays * largest));

  Extent all = about_centroid;
  if (!framing.follows) {
    all = Extent{};
    for (const StateSummary& state : states)
      for (std::size_t k = 0; k < state.points.size(); ++k) all.add(to_axes * state.point(k));
  }
  const dvec3 centre = view.target ? to_glm(*view.target) : from_axes * all.centre();
  (framing.follows ? framing.offset : framing.target) = centre;
  framing.depth = (framing.turns() ? glm::length(all.size()) : all.size().z) / 2;
  if (framing.vesicle >= 0 || view.target || view.eye) {  // others may lie farther off
    for (const StateSummary& state : states)
      for (std::size_t k = 0; k < state.points.size(); ++k)
        framing.depth = std::max(framing.depth, glm::distance(state.point(k), framing.follows ? framing.moment(state).centre + framing.offset
                                                                                     : framing.target));
  }
  if (view.eye) {
    place_eye(framing, view);
    return framing;
  }

  // The picture must hold every point; a nearer one looks larger.
  const double margin = framing.vesicle >= 0 ? neighbourhood : 1;
  const double tx = tangent_of_half_angle * framing.aspect * fill_width / margin, ty = tangent_of_half_angle * fill_height / margin;
  double distance = 0, half_height = 0;
  for (const StateSummary& state : states) {
    const ViewAxes axes = framing.axes_at(state.time);
    const glm::dmat3 to_picture = glm::transpose(glm::dmat3(axes.right, axes.up, axes.back));
    for (const std::size_t k : shown(state)) {
      const dvec3 origin = framing.follows ? framing.moment(state).centre + framing.offset : framing.target;
      const dvec3 p = to_picture * (state.point(k) - origin);
      distance = std::max({distance, p.z + std::abs(p.x) / tx, p.z + std::abs(p.y) / ty});
      half_height = std::max({half_height, margin * std::abs(p.y) / fill_height,
                              margin * std::abs(p.x) / (fill_width * framing.aspect)});
    }
  }
  if (!(distance > 0 && half_height > 0)) distance = half_height = 1;  // a point; any picture of it will do
  framing.distance = distance / view.zoom;
  framing.half_height = framing.perspective ? framing.distance * tangent_of_half_angle : half_height / view.zoom;
  return framing;
}

void check_framing(const Framing& framing, std::span<const StateSummary> states) {
  bool seen = false;
  for (const StateSummary& state : states) {
    const Camera camera = make_camera(framing, framing.moment(state));
    for (std::size_t k = 0; k < state.points.size(); ++k) {
      const glm::dvec4 clip = camera.clip(state.point(k));
      seen = seen || (clip.w > 0 && std::max(std::abs(clip.x), std::abs(clip.y)) < clip.w);
    }
    if (!framing.perspective || state.areas.size() != state.points.size()) continue;
    // The solid angle of a closed surface is 4 pi from inside and 0 from outside.
    const std::size_t vesicles = state.centroids.size(), each = state.points.size() / std::max<std::size_t>(vesicles, 1);
    for (std::size_t v = 0; v < vesicles; ++v) {
      double angle = 0;
      for (std::size_t i = v * each; i < (v + 1) * each; ++i) {
        const dvec3 away = state.point(i) - camera.eye;
        const double distance = glm::length(away);
        if (distance > 0) angle += glm::dot(away / distance, dvec3(state.areas[i]) / distance / distance);
      }
      if (angle > 2 * std::numbers::pi)
        throw std::invalid_argument(fmt::format("the camera is inside vesicle {} at t = {:.6g}; {}", v, state.time,
                                                framing.placed ? "move view.eye" : "lower view.zoom"));
    }
  }
  if (!seen)
    throw std::invalid_argument("this view shows nothing: no vesicle comes into the picture; change view.eye, view.target or "
                                "view.zoom");
}

Camera make_camera(const Framing& framing, const Moment& moment) {
  Camera camera;
  const ViewAxes axes = framing.axes_at(moment.time);
  const double zoom = camera_at(framing.keys, moment.time).zoom;
  camera.target = framing.follows ? moment.centre + framing.offset : framing.target;
  camera.half_height = framing.half_height / zoom;
  camera.half_width = framing.half_height / zoom * framing.aspect;
  camera.perspective = framing.perspective;
  camera.follows = framing.follows;

  const double reach = 4 * (framing.depth + framing.half_height * std::max(1.0, framing.aspect));
  // Keys come nearer; a placed eye stays and sees a narrower field.
  const double distance = framing.perspective ? framing.distance / zoom : 2 * reach;
  const double near = std::max(distance - reach, 0.02 * distance), far = distance + reach;
  camera.eye = camera.target + distance * axes.back;
  const double unit = camera.half_height, w = framing.aspect;
  camera.view = glm::lookAt(distance / unit * axes.back, dvec3(0), axes.up);
  const double share = near / distance;  // of the near plane's size in that of the target
  camera.projection = framing.perspective ? glm::frustum(-w * share, w * share, -share, share, near / unit, far / unit)
                                          : glm::ortho(-w, w, -1.0, 1.0, near / unit, far / unit);
  return camera;
}

glm::dvec2 Camera::picture_place(const dvec3& point) const {
  const glm::dvec4 seen = clip(point);
  return glm::dvec2(seen) / seen.w;
}

namespace {

/// The coordinate axis that a vector follows most.
int leading(const dvec3& v) {
  const dvec3 a = glm::abs(v);
  return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}

}  // namespace

sim::Matrix arrow_points(const Framing& framing, const Moment& moment) {
  const Camera camera = make_camera(framing, moment);
  // The coordinate plane that faces the viewer most, through the target: there the velocity is what it seems to be.
  const ViewAxes& axes = framing.axes;  // of a camera that turns: its first view, so that the plane does not change
  const auto unit = [](int axis) {
    dvec3 e(0);
    e[axis] = 1;
    return e;
  };
  const int normal = leading(axes.back);
  dvec3 in_plane = axes.right;
  in_plane[normal] = 0;
  const int across = leading(in_plane), along = 3 - normal - across;
  const dvec3 e1 = unit(across), e2 = unit(along);

  const double height = 2 * camera.half_height, width = 2 * camera.half_width;
  const double step1 = height / 4.2, step2 = height / 7.5;
  // A following camera carries the window over a net at rest; passing arrows enter from outside the picture.
  const double shift1 = framing.follows ? camera.target[across] : 0, shift2 = framing.follows ? camera.target[along] : 0;
  const double phase1 = framing.follows ? 0 : (std::lround(width / step1) % 2 == 0 ? 0.5 : 0.0);
  const glm::dvec2 reach = framing.follows ? glm::dvec2(1.2, 1.2) : glm::dvec2(0.94, 0.86);
  const auto first = [](double middle, double extent, double step) { return std::floor((middle - extent) / step); };
  std::vector<dvec3> points;
  for (double j = first(shift2, height, step2); j * step2 <= shift2 + height; ++j)
    for (double i = first(shift1, width, step1); (i + phase1) * step1 <= shift1 + width; ++i) {
      const dvec3 point = camera.target + ((i + phase1) * step1 - shift1) * e1 + (j * step2 - shift2) * e2;
      const glm::dvec2 place = camera.picture_place(point);
      if (std::abs(place.x) > reach.x || std::abs(place.y) > reach.y) continue;
      if (!framing.follows && clear_of_captions(place) < 1) continue;
      points.push_back(point);
    }
  sim::Matrix result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t k = 0; k < points.size(); ++k) result.row(static_cast<Eigen::Index>(k)) = to_sim(points[k]).transpose();
  return result;
}

double arrows_shown(const Framing& framing, const Moment& moment) {
  if (!framing.turns()) return 1;
  return glm::smoothstep(0.2, 0.45, std::abs(framing.axes_at(moment.time).back[leading(framing.axes.back)]));
}

int panel_columns(int count, int width, int height) {
  int best = 1;
  double least = 1e300;
  for (int columns = 1; columns <= count; ++columns) {
    const int rows = (count + columns - 1) / columns;
    const double aspect = static_cast<double>(width) * rows / (static_cast<double>(height) * columns);
    const double cost = std::abs(std::log(aspect / 1.33)) + 0.3 * (rows * columns - count);  // empty places look unfinished
    if (cost < least - 1e-12) {
      least = cost;
      best = columns;
    }
  }
  return best;
}

double clear_of_captions(const glm::dvec2& place) {
  constexpr double ramp = 0.12;
  const double right = (place.x + 0.60) / ramp, below = (0.72 - place.y) / ramp, above = (place.y + 0.78) / 0.06;
  return glm::smoothstep(0.0, 1.0, std::max(right, std::min(below, above)));
}

}  // namespace render
