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
      {"flow-vorticity", "from above: the flow to the right, vorticity up the picture",
       axes_from({0, 0, 1}, {0, 1, 0})},
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
      half_height =
          std::max({half_height, std::abs(p.y) / fill_height, std::abs(p.x) / (fill_width * framing.aspect)});
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

  const double reach = 4 * (framing.depth + framing.half_height * std::max(1.0, framing.aspect));
  const double distance = framing.perspective ? framing.distance : 2 * reach;
  const double near = std::max(distance - reach, 0.02 * distance), far = distance + reach;
  camera.view =
      glm::lookAt(camera.target + distance * framing.axes.back, camera.target, framing.axes.up);
  const double w = camera.half_width, h = camera.half_height;
  const double share = near / distance;  // of the near plane's size in that of the target
  camera.projection = framing.perspective ? glm::frustum(-w * share, w * share, -h * share, h * share, near, far)
                                          : glm::ortho(-w, w, -h, h, near, far);
  return camera;
}

sim::Matrix arrow_points(const Framing& framing, const dvec3& centroid) {
  const Camera camera = make_camera(framing, centroid);
  // The plane lies just behind the bodies, where a perspective picture is wider.
  const double behind = framing.depth * 1.15 + 0.05 * framing.half_height;
  const double widen = framing.perspective ? (framing.distance + behind) / framing.distance : 1;
  const double height = 2 * camera.half_height * widen, width = 2 * camera.half_width * widen;
  const double step_y = height / 7.5, step_x = height / 4.2;
  // A following camera carries the window over a net at rest.
  const double shift_x = framing.follows ? glm::dot(camera.target, framing.axes.right) : 0;
  const double shift_y = framing.follows ? glm::dot(camera.target, framing.axes.up) : 0;
  const auto first = [](double low, double step, double phase) { return std::ceil(low / step - phase); };
  std::vector<dvec3> points;
  const double phase_x = framing.follows ? 0 : (std::lround(width / step_x) % 2 == 0 ? 0.5 : 0.0);
  // Passing arrows enter from outside the picture, and shrink where captions are (see draw_arrows).
  const double reach_x = framing.follows ? 0.60 * width : 0.47 * width,
               reach_y = framing.follows ? 0.60 * height : 0.41 * height;
  for (double j = first(shift_y - reach_y, step_y, 0.0); j * step_y <= shift_y + reach_y; ++j)
    for (double i = first(shift_x - reach_x, step_x, phase_x); (i + phase_x) * step_x <= shift_x + reach_x; ++i) {
      const double x = (i + phase_x) * step_x - shift_x, y = j * step_y - shift_y;
      const bool under_text = x < -0.24 * width && (y > 0.30 * height || y < -0.36 * height);
      if (under_text && !framing.follows) continue;
      points.push_back(camera.target + x * framing.axes.right + y * framing.axes.up - behind * framing.axes.back);
    }
  sim::Matrix result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t k = 0; k < points.size(); ++k) 
    result.row(static_cast<Eigen::Index>(k)) = to_sim(points[k]).transpose();
  return result;
}

}  // namespace render
