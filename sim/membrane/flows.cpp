#include "sim/membrane/flows.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sim {

const std::vector<CatalogueRow<FlowFunction>>& flow_catalogue() {
  static const std::vector<CatalogueRow<FlowFunction>> table{
      {"none", "fluid at rest", {}, [](const FlowParameters&, const Vec3&) -> Vec3 { return Vec3::Zero(); }},
      {"shear",
       "simple shear, u = rate z e_x",
       {"rate"},
       [](const FlowParameters& f, const Vec3& x) -> Vec3 {
         return {f.rate * x[2], 0, 0};
       }},
      {"poiseuille",
       "parabolic tube flow, u_x = U - a (y^2 + z^2)",
       {"curvature", "centreline_velocity"},
       [](const FlowParameters& f, const Vec3& x) -> Vec3 {
         return {f.centreline_velocity - f.curvature * (x[1] * x[1] + x[2] * x[2]), 0, 0};
       }},
      {"streams",
       "streams side by side, every other one back, u_x = U cos(2 pi y/l) cos(2 pi z/l)",
       {"centreline_velocity", "wavelength"},
       [](const FlowParameters& f, const Vec3& x) -> Vec3 {
         const double k = 2 * std::numbers::pi / f.wavelength.value_or(unlimited);
         return {f.centreline_velocity * std::cos(k * x[1]) * std::cos(k * x[2]), 0, 0};
       }},
      {"extension",
       "straining flow, rate (x, 0, -z) planar or rate (x, -y/2, -z/2) uniaxial",
       {"rate", "planar"},
       [](const FlowParameters& f, const Vec3& x) -> Vec3 {
         if (f.planar) return {f.rate * x[0], 0, -f.rate * x[2]};
         return {f.rate * x[0], -f.rate * x[1] / 2, -f.rate * x[2] / 2};
       }},
      {"rotation",
       "rigid rotation, u = omega x r",
       {"angular_velocity"},
       [](const FlowParameters& f, const Vec3& x) -> Vec3 { return f.angular_velocity.cross(x); }},
      {"uniform",
       "the same velocity everywhere",
       {"velocity"},
       [](const FlowParameters& f, const Vec3&) -> Vec3 { return f.velocity; }},
  };
  return table;
}

double time_factor(const FlowParameters& f, double time) {
  if (f.time_factor == "oscillating") return std::cos(2 * std::numbers::pi * f.frequency * time + f.phase);
  if (f.time_factor == "step") return time >= f.from && time < f.until ? 1 : 0;
  return 1;
}

namespace {

bool has_strength(const FlowParameters& f) {
  const auto* row = find_row(flow_catalogue(), f.kind);
  // Three points tell every flow of the catalogue that is not zero: none vanishes at all of them.
  return row && (row->function(f, Vec3(1, 2, 3)).norm() > 0 || row->function(f, Vec3(-3, 1, 0.5)).norm() > 0 ||
                 row->function(f, Vec3::Zero()).norm() > 0);
}

}  // namespace

double oscillation(const FlowParameters& f) {
  return f.time_factor == "oscillating" && has_strength(f) ? f.frequency : 0;
}

bool moves(const FlowParameters& f, double end) {
  if (f.time_factor == "step" && (f.from >= f.until || f.from >= end || f.until <= 0)) return false;
  return has_strength(f);
}

namespace {

/// Fluid at rest and uniform flows neither deform nor turn anything.
bool carries_only(const FlowParameters& f) { return f.kind == "none" || f.kind == "uniform"; }

}  // namespace

std::optional<double> steady_shear_rate(std::span<const FlowParameters> flows) {
  std::optional<double> rate;
  for (const FlowParameters& f : flows) {
    if (carries_only(f)) continue;
    if (rate || f.kind != "shear" || f.time_factor != "constant" || f.rate == 0) return std::nullopt;
    rate = f.rate;
  }
  return rate;
}

std::optional<Vec3> across(std::span<const FlowParameters> flows, const Vec3& position) {
  std::string_view kind;
  for (const FlowParameters& f : flows) {
    if (carries_only(f)) continue;
    if ((f.kind != "shear" && f.kind != "poiseuille" && f.kind != "streams") || (!kind.empty() && kind != f.kind))
      return std::nullopt;
    kind = f.kind;
  }
  if (kind.empty()) return std::nullopt;
  const Vec3 radius(0, position[1], position[2]);
  return kind == "shear" || radius.norm() == 0 ? Vec3::UnitZ() : Vec3(radius.normalized());
}

double next_switch(std::span<const FlowParameters> flows, double time) {
  double next = unlimited;
  for (const FlowParameters& f : flows)
    if (f.time_factor == "step" && f.from < f.until)
      for (const double t : {f.from, f.until})
        if (t > time) next = std::min(next, t);
  return next;
}

std::vector<FlowParameters> acting_flows(std::span<const FlowParameters> flows, double from, double to) {
  std::vector<FlowParameters> acting;
  for (FlowParameters f : flows) {
    if (f.time_factor == "step") {
      if (time_factor(f, (from + to) / 2) == 0) continue;
      f.time_factor = "constant";
    }
    acting.push_back(f);
  }
  return acting;
}

Matrix background_velocity(std::span<const FlowParameters> flows, double time, const Matrix& points) {
  Matrix u = Matrix::Zero(points.rows(), 3);
  for (const FlowParameters& flow : flows) {
    const auto* row = find_row(flow_catalogue(), flow.kind);
    if (!row) throw std::invalid_argument("unknown flow '" + flow.kind + "'");
    const double factor = time_factor(flow, time);
    if (factor == 0) continue;
    for (Eigen::Index k = 0; k < points.rows(); ++k)
      u.row(k) += factor * row->function(flow, points.row(k).transpose()).transpose();
  }
  return u;
}

}  // namespace sim
