#include "app/tables/quantities.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace app {

namespace {

using Measures = VesicleSample;
using Units = QuantityUnits;
using Values = std::vector<double>;
using render::Scale;

double tension_unit(const Units& u) { return u.bending_modulus > 0 ? u.bending_modulus / (u.length * u.length) : 1; }
double velocity_unit(const Units& u) { return u.rate > 0 ? u.rate * u.length : 1; }

}  // namespace

const std::vector<QuantityRow>& quantities() {
  static const std::vector<QuantityRow> rows{
      {"inclination", "angle of the long axis in the shear plane, continued over ±90°", "inclination θ (°)", Scale::degrees, {"θ"},
       [](const Measures& m, const Units&) -> Values { return {m.inclination_deg}; }, nullptr},
      {"inclination-rate", "its rate of change in units of the flow's rate", "(dθ/dt) / γ̇", Scale::linear, {"dθ/dt"},
       [](const Measures& m, const Units&) -> Values { return {m.inclination_deg * std::numbers::pi / 180}; }, nullptr, true, true,
       Scaling::rate, "dθ/dt"},
      {"axes", "semi-axes of the ellipsoid with the same second moments", "axes / R_{0}", Scale::linear, {"a_{1}", "a_{2}", "a_{3}"},
       [](const Measures& m, const Units& u) -> Values { return {m.axes[0] / u.length, m.axes[1] / u.length, m.axes[2] / u.length}; },
       nullptr},
      {"deformation", "Taylor's, (L - B) / (L + B) with the axes of the second moments in the shear plane", "deformation D", Scale::linear,
       {"D"}, [](const Measures& m, const Units&) -> Values { return {m.deformation}; }, nullptr},
      {"axis-ratio", "a2 / a1", "a_{2} / a_{1}", Scale::linear, {"a_{2}/a_{1}"},
       [](const Measures& m, const Units&) -> Values { return {m.axes[1] / m.axes[0]}; }, nullptr},
      {"energy", "bending energy, 1 for a sphere", "E / 8πκ", Scale::linear, {"energy"},
       [](const Measures& m, const Units&) -> Values { return {m.energy}; }, nullptr},
      {"errors", "relative errors of area and volume, by size", "relative error", Scale::logarithmic, {"area", "volume"},
       [](const Measures& m, const Units&) -> Values { return {std::abs(m.area_error), std::abs(m.volume_error)}; }, nullptr},
      {"reduced-volume", "nu", "ν", Scale::linear, {"ν"},
       [](const Measures& m, const Units&) -> Values { return {m.reduced_volume}; }, nullptr},
      {"position", "centre of the volume", "position / R_{0}", Scale::linear, {"x_{c}", "y_{c}", "z_{c}"},
       [](const Measures& m, const Units& u) -> Values { return {m.center[0] / u.length, m.center[1] / u.length, m.center[2] / u.length}; },
       nullptr},
      {"height", "z of the centre", "z_{c} / R_{0}", Scale::linear, {"z_{c}"},
       [](const Measures& m, const Units& u) -> Values { return {m.center[2] / u.length}; }, nullptr},
      {"tension", "mean, least and largest", "σR_{0}^{2}/κ_{b}", Scale::linear, {"mean", "least", "largest"},
       [](const Measures& m, const Units& u) -> Values {
         return {m.tension_mean / tension_unit(u), m.tension_min / tension_unit(u), m.tension_max / tension_unit(u)};
       },
       nullptr, true, false, Scaling::bending, "σ"},
      {"normal-velocity", "root of its mean square over the membrane, relative to the centre: 0 when the shape neither changes nor turns", "⟨(u·n)^{2}⟩^{1/2} / γ̇R_{0}",
       Scale::linear, {"u·n"},
       [](const Measures& m, const Units& u) -> Values { return {m.normal_velocity_l2 / std::sqrt(m.area) / velocity_unit(u)}; },
       nullptr, true, false, Scaling::rate, "⟨(u·n)^{2}⟩^{1/2}"},
      {"gap", "least distance between two membranes", "gap / R_{0}", Scale::linear, {"gap"}, nullptr,
       [](const sim::StepRecord& r, std::size_t, const Units& u) -> Values { return {r.gap / u.length}; }, false},
      {"iterations", "of the linear solver, a step", "iterations", Scale::linear, {"iterations"}, nullptr,
       [](const sim::StepRecord& r, std::size_t, const Units&) -> Values { return {r.iterations}; }, false},
      {"step", "length of the time steps", "γ̇Δt", Scale::linear, {"γ̇Δt"}, nullptr,
       [](const sim::StepRecord& r, std::size_t, const Units& u) -> Values { return {u.rate > 0 ? u.rate * r.dt : r.dt}; }, false, false,
       Scaling::rate, "Δt"},
      {"residual", "of the linear solver, relative", "residual", Scale::logarithmic, {"residual"}, nullptr,
       [](const sim::StepRecord& r, std::size_t, const Units&) -> Values { return {r.residual}; }, false},
      {"upsampling", "grid factor of differentiation", "upsampling", Scale::linear, {"upsampling"}, nullptr,
       [](const sim::StepRecord& r, std::size_t v, const Units&) -> Values { return {r.vesicles[v].upsampling}; }},
      {"tail", "share of the mean curvature's spectrum in its last quarter", "spectrum tail", Scale::linear, {"tail"}, nullptr,
       [](const sim::StepRecord& r, std::size_t v, const Units&) -> Values { return {r.vesicles[v].tail}; }},
  };
  return rows;
}

std::string axis_label(const QuantityRow& row, const QuantityUnits& units) {
  const bool bare = (row.scaling == Scaling::rate && units.rate == 0) ||
                    (row.scaling == Scaling::bending && units.bending_modulus == 0);
  return bare ? row.bare_axis : row.axis;
}

const QuantityRow& find_quantity(std::string_view name) {
  if (const QuantityRow* row = sim::find_row(quantities(), name)) return *row;
  throw std::invalid_argument("unknown quantity '" + std::string(name) + "'" +
                              sim::suggestion(name, sim::row_names(quantities())));
}

}  // namespace app
