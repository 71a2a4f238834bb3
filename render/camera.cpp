#include "camera.h"

#include "sim/basis.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>
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
  const Eigen::Index each = latitudes * longitudes;
  summary.points.reserve(static_cast<std::size_t>(each) * state.vesicles.size());
  double area = 0;
  for (const sim::VesicleState& vesicle : state.vesicles) {
    const sim::FirstDerivatives x = sim::sample_grid(vesicle.position, theta, phi);
    for (Eigen::Index i = 0; i < each; ++i) {
      const dvec3 p = to_glm(x.value.row(i));
      const double weight = glm::length(glm::cross(to_glm(x.t.row(i)), to_glm(x.f.row(i))));
      summary.centroid += weight * p;
      area += weight;
      summary.points.emplace_back(p);
    }
  }
  if (area > 0) summary.centroid /= area;
  return summary;
}

Framing frame_trajectory(std::span<const StateSummary> states, const ViewParameters& view) {
  StateSummary sphere;
  sphere.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  if (states.empty()) states = {&sphere, 1};

  Framing framing;
  framing.axes = find_camera(view.camera).axes;
  framing.perspective = view.projection != "orthographic";
  framing.aspect = static_cast<double>(view.size.at(0)) / view.size.at(1);
  const glm::dmat3 from_axes(framing.axes.right, framing.axes.up, framing.axes.back);
  const glm::dmat3 to_axes = glm::transpose(from_axes);

  Extent centroids, about_centroid;
  double largest = 0;  // extent of one instant
  for (const StateSummary& state : states) {
    const dvec3 centroid = to_axes * state.centroid;
    centroids.add(centroid);
    Extent now;
    for (const dvec3 point : state.points) {
      const dvec3 p = to_axes * point;
      now.add(p);
      about_centroid.add(p - centroid);
    }
    const dvec3 size = now.size();
    largest = std::max({largest, size.x, size.y, size.z});
  }
  framing.follows = view.follow == "always" || (view.follow == "auto" && glm::length(centroids.size()) > strays * largest);

  Extent all = about_centroid;
  if (!framing.follows) {
    all = Extent{};
    for (const StateSummary& state : states)
      for (const dvec3 point : state.points) all.add(to_axes * point);
  }
  const dvec3 centre = from_axes * all.centre();
  (framing.follows ? framing.offset : framing.target) = centre;
  framing.depth = std::max(all.size().z / 2, 1e-3);

  // The picture must hold every point; a nearer one looks larger.
  const double tx = tangent_of_half_angle * framing.aspect * fill_width, ty = tangent_of_half_angle * fill_height;
  double distance = 1e-3, half_height = 1e-3;
  for (const StateSummary& state : states)
    for (const dvec3 point : state.points) {
      const dvec3 origin = framing.follows ? state.centroid + framing.offset : framing.target;
      const dvec3 p = to_axes * (point - origin);
      distance = std::max({distance, p.z + std::abs(p.x) / tx, p.z + std::abs(p.y) / ty});
      half_height = std::max({half_height, std::abs(p.y) / fill_height, std::abs(p.x) / (fill_width * framing.aspect)});
    }
  framing.distance = distance / view.zoom;
  framing.half_height = framing.perspective ? framing.distance * tangent_of_half_angle : half_height / view.zoom;
  return framing;
}

Camera make_camera(const Framing& framing, const dvec3& centroid) {
  Camera camera;
  camera.target = framing.follows ? centroid + framing.offset : framing.target;
  camera.half_height = framing.half_height;
  camera.half_width = framing.half_height * framing.aspect;
  camera.perspective = framing.perspective;
  camera.follows = framing.follows;

  const double reach = 4 * (framing.depth + framing.half_height * std::max(1.0, framing.aspect));
  const double distance = framing.perspective ? framing.distance : 2 * reach;
  const double near = std::max(distance - reach, 0.02 * distance), far = distance + reach;
  camera.view = glm::lookAt(camera.target + distance * framing.axes.back, camera.target, framing.axes.up);
  const double w = camera.half_width, h = camera.half_height;
  const double share = near / distance;  // of the near plane's size in that of the target
  camera.projection = framing.perspective ? glm::frustum(-w * share, w * share, -h * share, h * share, near, far)
                                          : glm::ortho(-w, w, -h, h, near, far);
  return camera;
}

glm::dvec2 Camera::picture_place(const dvec3& point) const {
  const glm::vec4 clip = projection * (view * glm::vec4(point, 1));
  return glm::dvec2(clip) / static_cast<double>(clip.w);
}

sim::Matrix arrow_points(const Framing& framing, const dvec3& centroid) {
  const Camera camera = make_camera(framing, centroid);
  // The coordinate plane that faces the viewer most, through the target: there the velocity is what it seems to be.
  const ViewAxes& axes = framing.axes;
  const auto leading = [](const dvec3& v) {
    const dvec3 a = glm::abs(v);
    return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  };
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

double clear_of_captions(const glm::dvec2& place) {
  constexpr double ramp = 0.12;
  const double right = (place.x + 0.60) / ramp, below = (0.72 - place.y) / ramp, above = (place.y + 0.78) / 0.06;
  return glm::smoothstep(0.0, 1.0, std::max(right, std::min(below, above)));
}

}  // namespace render
