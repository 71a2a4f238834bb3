#include "camera.h"

#include "sim/basis.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace render {
namespace {

using sim::Vec3;

constexpr double tangent_of_half_angle = 0.18;  // vertical; a long lens: shapes are hardly distorted
constexpr double fill_width = 0.86,
                 fill_height = 0.74;  // share of the picture that bodies may take; captions get the rest
constexpr double strays = 1.5;        // follow = "auto": drift / extent above which the camera follows

ViewAxes axes_from(const Vec3& back, const Vec3& up) {
  const Vec3 b = back.normalized();
  const Vec3 r = up.cross(b).normalized();
  return {r, b.cross(r), b};
}

// Degrees to the right of and above the flow-gradient view.
ViewAxes turned(double azimuth, double elevation) {
  const double a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
  return axes_from({std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e)}, Vec3::UnitZ());
}

struct Extent {
  Vec3 lower = Vec3::Constant(1e300), upper = Vec3::Constant(-1e300);  // right, up, back
  void add(const Vec3& p) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  Vec3 centre() const { return (lower + upper) / 2; }
  Vec3 size() const { return upper - lower; }
};

}  // namespace

const std::vector<CameraRow>& cameras() {
  static const std::vector<CameraRow> rows{
      {"flow-gradient", "from -y: the flow to the right, its gradient up", turned(0, 0)},
      {"three-quarter", "flow-gradient, from a little to the left and above", turned(-22, 16)},
      {"flow-vorticity", "from above: the flow to the right, vorticity up the picture",
       axes_from(Vec3::UnitZ(), Vec3::UnitY())},
      {"gradient-vorticity", "against the flow: its gradient up", axes_from(Vec3::UnitX(), Vec3::UnitZ())},
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
  summary.points.resize(3, each * static_cast<Eigen::Index>(state.vesicles.size()));
  double area = 0;
  Eigen::Index to = 0;
  for (const sim::VesicleState& vesicle : state.vesicles) {
    const sim::FirstDerivatives x = sim::sample_grid(vesicle.position, theta, phi);
    for (Eigen::Index i = 0; i < each; ++i) {
      const Vec3 p = x.value.row(i), t = x.t.row(i), f = x.f.row(i);
      const double weight = t.cross(f).norm();
      summary.centroid += weight * p;
      area += weight;
      summary.points.col(to++) = p.cast<float>();
    }
  }
  if (area > 0) summary.centroid /= area;
  return summary;
}

Framing frame_trajectory(std::span<const StateSummary> states, const ViewParameters& view) {
  StateSummary sphere;
  sphere.points.resize(3, 6);
  sphere.points << Eigen::Matrix3f::Identity(), -Eigen::Matrix3f::Identity();
  if (states.empty()) states = {&sphere, 1};

  Framing framing;
  framing.axes = find_camera(view.camera).axes;
  framing.perspective = view.projection != "orthographic";
  framing.aspect = static_cast<double>(view.size.at(0)) / view.size.at(1);
  Eigen::Matrix3d to_axes;
  to_axes << framing.axes.right.transpose(), framing.axes.up.transpose(), framing.axes.back.transpose();

  Extent centroids, about_centroid;
  double largest = 0;  // extent of one instant
  for (const StateSummary& state : states) {
    const Vec3 centroid = to_axes * state.centroid;
    centroids.add(centroid);
    Extent now;
    for (Eigen::Index i = 0; i < state.points.cols(); ++i) {
      const Vec3 p = to_axes * state.points.col(i).cast<double>();
      now.add(p);
      about_centroid.add(p - centroid);
    }
    if (state.points.cols() > 0) largest = std::max(largest, now.size().maxCoeff());
  }
  framing.follows = view.follow == "always" || (view.follow == "auto" && centroids.size().norm() > strays * largest);

  Extent all = about_centroid;
  if (!framing.follows) {
    all = Extent{};
    for (const StateSummary& state : states)
      for (Eigen::Index i = 0; i < state.points.cols(); ++i) all.add(to_axes * state.points.col(i).cast<double>());
  }
  const Vec3 centre = to_axes.transpose() * all.centre();
  (framing.follows ? framing.offset : framing.target) = centre;
  framing.depth = std::max(all.size().z() / 2, 1e-3);

  // The picture must hold every point; a nearer one looks larger.
  const double tx = tangent_of_half_angle * framing.aspect * fill_width, ty = tangent_of_half_angle * fill_height;
  double distance = 1e-3, half_height = 1e-3;
  for (const StateSummary& state : states)
    for (Eigen::Index i = 0; i < state.points.cols(); ++i) {
      const Vec3 origin = framing.follows ? Vec3(state.centroid + framing.offset) : framing.target;
      const Vec3 p = to_axes * (state.points.col(i).cast<double>() - origin);
      distance = std::max({distance, p.z() + std::abs(p.x()) / tx, p.z() + std::abs(p.y()) / ty});
      half_height =
          std::max({half_height, std::abs(p.y()) / fill_height, std::abs(p.x()) / (fill_width * framing.aspect)});
    }
  framing.distance = distance / view.zoom;
  framing.half_height = framing.perspective ? framing.distance * tangent_of_half_angle : half_height / view.zoom;
  return framing;
}

Camera make_camera(const Framing& framing, const Vec3& centroid) {
  Camera camera;
  camera.target = framing.follows ? Vec3(centroid + framing.offset) : framing.target;
  camera.right = framing.axes.right;
  camera.up = framing.axes.up;
  camera.back = framing.axes.back;
  camera.half_height = framing.half_height;
  camera.half_width = framing.half_height * framing.aspect;
  camera.perspective = framing.perspective;

  const double reach = 4 * (framing.depth + framing.half_height * std::max(1.0, framing.aspect));
  const double distance = framing.perspective ? framing.distance : 2 * reach;
  const double near = std::max(distance - reach, 0.02 * distance), far = distance + reach;
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.block<1, 3>(0, 0) = camera.right.transpose();
  view.block<1, 3>(1, 0) = camera.up.transpose();
  view.block<1, 3>(2, 0) = camera.back.transpose();
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * camera.target - Vec3(0, 0, distance);
  Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
  if (framing.perspective) {
    projection(0, 0) = distance / camera.half_width;
    projection(1, 1) = distance / camera.half_height;
    projection(2, 2) = -(far + near) / (far - near);
    projection(2, 3) = -2 * far * near / (far - near);
    projection(3, 2) = -1;
  } else {
    projection(0, 0) = 1 / camera.half_width;
    projection(1, 1) = 1 / camera.half_height;
    projection(2, 2) = -2 / (far - near);
    projection(2, 3) = -(far + near) / (far - near);
    projection(3, 3) = 1;
  }
  camera.view = view.cast<float>();
  camera.projection = projection.cast<float>();
  return camera;
}

sim::Matrix arrow_points(const Framing& framing, const Vec3& centroid) {
  const Camera camera = make_camera(framing, centroid);
  // The plane lies just behind the bodies, where a perspective picture is wider.
  const double behind = framing.depth * 1.15 + 0.05 * framing.half_height;
  const double widen = framing.perspective ? (framing.distance + behind) / framing.distance : 1;
  const double height = 2 * camera.half_height * widen, width = 2 * camera.half_width * widen;
  const double step_y = height / 7.5, step_x = height / 4.2;
  // A following camera carries the window over a net at rest.
  const double shift_x = framing.follows ? camera.target.dot(camera.right) : 0;
  const double shift_y = framing.follows ? camera.target.dot(camera.up) : 0;
  const auto first = [](double low, double step, double phase) { return std::ceil(low / step - phase); };
  std::vector<Vec3> points;
  const double phase_x = framing.follows ? 0 : (std::lround(width / step_x) % 2 == 0 ? 0.5 : 0.0);
  // Passing arrows enter from outside the picture, and shrink where captions are (see draw_arrows).
  const double reach_x = framing.follows ? 0.60 * width : 0.47 * width,
               reach_y = framing.follows ? 0.60 * height : 0.41 * height;
  for (double j = first(shift_y - reach_y, step_y, 0.0); j * step_y <= shift_y + reach_y; ++j)
    for (double i = first(shift_x - reach_x, step_x, phase_x); (i + phase_x) * step_x <= shift_x + reach_x; ++i) {
      const double x = (i + phase_x) * step_x - shift_x, y = j * step_y - shift_y;
      const bool under_text = x < -0.24 * width && (y > 0.30 * height || y < -0.36 * height);
      if (under_text && !framing.follows) continue;
      points.push_back(camera.target + x * camera.right + y * camera.up - behind * camera.back);
    }
  sim::Matrix result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t k = 0; k < points.size(); ++k) result.row(static_cast<Eigen::Index>(k)) = points[k].transpose();
  return result;
}

}  // namespace render
