#include "sim/membrane/cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sim {

namespace {

/// Integral of the time factor from 0 to t.
double acting_time(const FlowParameters& f, double time) {
  if (f.time_factor == "step") return std::max(0.0, std::min(time, f.until) - std::max(0.0, f.from));
  if (f.time_factor == "oscillating") {
    const double w = 2 * std::numbers::pi * f.frequency;
    if (w == 0) return time * std::cos(f.phase);
    return (std::sin(w * time + f.phase) - std::sin(f.phase)) / w;
  }
  return time;
}

/// Whether a flow takes copies of a cell to copies of a cell whose first two sides do not change.
bool keeps_lattice(const FlowParameters& f) {
  return f.kind == "none" || f.kind == "uniform" || f.kind == "shear" || f.kind == "streams";
}

/// Whether both sides across are whole numbers of wavelengths.
bool fits(double wavelength, const Vec3& size) {
  constexpr double rounding = 1e-9;
  const auto whole = [&](double side) {
    return side / wavelength > 0.5 && std::abs(std::remainder(side, wavelength)) < rounding * side;
  };
  return whole(size[1]) && whole(size[2]);
}

}  // namespace

double shear_strain(std::span<const FlowParameters> flows, double time) {
  double strain = 0;
  for (const FlowParameters& f : flows)
    if (f.kind == "shear") strain += f.rate * acting_time(f, time);
  return strain;
}

CellSides cell_at(const Scene& scene, double time) {
  if (!scene.cell.size) return std::nullopt;
  const Vec3& size = *scene.cell.size;
  const double lean = (scene.start.strain.value_or(0) + shear_strain(scene.flows, time)) * size[2];
  Eigen::Matrix3d sides = size.asDiagonal();
  sides(0, 2) = lean - size[0] * std::round(lean / size[0]);
  return sides;
}

double cell_volume(const Scene& scene) {
  return scene.cell.size ? scene.cell.size->prod() : std::numeric_limits<double>::infinity();
}

Vec3 into_box(const Scene& scene, double time, const Vec3& place) {
  const CellSides sides = cell_at(scene, time);
  if (!sides) return Vec3::Zero();
  Vec3 shift = Vec3::Zero();
  for (int d = 2; d >= 0; --d) shift -= std::floor((place[d] + shift[d]) / (*sides)(d, d) + 0.5) * sides->col(d);
  return shift;
}

std::optional<SceneObjection> scene_objection(const Scene& scene) {
  for (const FlowParameters& f : scene.flows)
    if (f.kind == "streams" && !f.wavelength)
      return SceneObjection{"flow", "kind", "the flow 'streams' needs its 'wavelength'"};
  if (!scene.cell.size) return std::nullopt;
  for (const FlowParameters& f : scene.flows)
    if (f.kind == "streams" && !fits(*f.wavelength, *scene.cell.size))
      return SceneObjection{
          "flow", "wavelength",
          fmt::format("the sides of the [cell] along y and z must be multiples of the wavelength {:g}", *f.wavelength)};
  for (const FlowParameters& f : scene.flows)
    if (!keeps_lattice(f))
      return SceneObjection{
          "flow", "kind",
          fmt::format("the flow '{}' does not keep a [cell] periodic; 'shear', 'streams', 'uniform' and 'none' do",
                      f.kind)};
  if (scene.numerics.far_field == "direct")
    return SceneObjection{"numerics", "far_field",
                          "the copies of a [cell] are too many for far_field = \"direct\"; leave it \"auto\""};
  return std::nullopt;
}

}  // namespace sim
