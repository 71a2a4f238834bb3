#include "app/tables/quantities.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace app {

namespace {

using Sample = VesicleSample;
using Step = sim::StepRecord;
using Suspension = sim::SuspensionMeasures;
using Units = QuantityUnits;
using render::Scale;

double tension_unit(const Units& u) { return u.bending_modulus > 0 ? u.bending_modulus / (u.length * u.length) : 1; }
double velocity_unit(const Units& u) { return u.rate > 0 ? u.rate * u.length : 1; }
double stresslet_unit(const Units& u) { return std::pow(u.length, 3) * (u.rate > 0 ? u.rate : 1); }

}  // namespace

const std::vector<QuantityRow>& quantities() {
  static const std::vector<QuantityRow> rows{
      {.name = "inclination",
       .meaning = "angle of the long axis in the shear plane, continued over ±90°",
       .axis = "inclination θ (°)",
       .scale = Scale::degrees,
       .curves = StateCurves{{"θ", [](const Sample& m, const Units&) { return m.inclination_deg; }}}},
      {.name = "inclination-rate",
       .meaning = "its rate of change in units of the flow's rate",
       .axis = "(dθ/dt) / γ̇",
       .scale = Scale::linear,
       .curves = StateCurves{{"dθ/dt", [](const Sample& m,
                                          const Units&) { return m.inclination_deg * std::numbers::pi / 180; }}},
       .differentiate = true,
       .scaling = Scaling::rate,
       .bare_axis = "dθ/dt"},
      {.name = "axes",
       .meaning = "semi-axes of the ellipsoid with the same second moments",
       .axis = "axes / R_{0}",
       .scale = Scale::linear,
       .curves = StateCurves{{"a_{1}", [](const Sample& m, const Units& u) { return m.axes[0] / u.length; }},
                             {"a_{2}", [](const Sample& m, const Units& u) { return m.axes[1] / u.length; }},
                             {"a_{3}", [](const Sample& m, const Units& u) { return m.axes[2] / u.length; }}}},
      {.name = "deformation",
       .meaning = "Taylor's, (L - B) / (L + B) with the axes of the second moments in the shear plane",
       .axis = "D = (L − B) / (L + B)",
       .scale = Scale::linear,
       .curves = StateCurves{{"D", [](const Sample& m, const Units&) { return m.deformation; }}}},
      {.name = "axis-ratio",
       .meaning = "a2 / a1",
       .axis = "a_{2} / a_{1}",
       .scale = Scale::linear,
       .curves = StateCurves{{"a_{2}/a_{1}", [](const Sample& m, const Units&) { return m.axes[1] / m.axes[0]; }}}},
      {.name = "energy",
       .meaning = "bending energy, 1 for a sphere",
       .axis = "E / 8πκ",
       .scale = Scale::linear,
       .curves = StateCurves{{"energy", [](const Sample& m, const Units&) { return m.energy; }}}},
      {.name = "errors",
       .meaning = "relative errors of area and volume, by size",
       .axis = "relative error",
       .scale = Scale::logarithmic,
       .curves = StateCurves{{"area", [](const Sample& m, const Units&) { return std::abs(m.area_error); }},
                             {"volume", [](const Sample& m, const Units&) { return std::abs(m.volume_error); }}}},
      {.name = "reduced-volume",
       .meaning = "nu",
       .axis = "ν",
       .scale = Scale::linear,
       .curves = StateCurves{{"ν", [](const Sample& m, const Units&) { return m.reduced_volume; }}}},
      {.name = "position",
       .meaning = "centre of the volume",
       .axis = "position / R_{0}",
       .scale = Scale::linear,
       .curves = StateCurves{{"x_{c}", [](const Sample& m, const Units& u) { return m.center[0] / u.length; }},
                             {"y_{c}", [](const Sample& m, const Units& u) { return m.center[1] / u.length; }},
                             {"z_{c}", [](const Sample& m, const Units& u) { return m.center[2] / u.length; }}}},
      {.name = "height",
       .meaning = "z of the centre",
       .axis = "z_{c} / R_{0}",
       .scale = Scale::linear,
       .curves = StateCurves{{"z_{c}", [](const Sample& m, const Units& u) { return m.center[2] / u.length; }}}},
      {.name = "tension",
       .meaning = "mean, least and largest",
       .axis = "σR_{0}^{2}/κ_{b}",
       .scale = Scale::linear,
       .curves =
           StateCurves{{"mean", [](const Sample& m, const Units& u) { return m.tension_mean / tension_unit(u); }},
                       {"least", [](const Sample& m, const Units& u) { return m.tension_min / tension_unit(u); }},
                       {"largest", [](const Sample& m, const Units& u) { return m.tension_max / tension_unit(u); }}},
       .scaling = Scaling::bending,
       .bare_axis = "σ"},
      {.name = "normal-velocity",
       .meaning = "root of its mean square over the membrane, relative to the centre: 0 when the shape neither changes "
                  "nor turns",
       .axis = "⟨(u·n)^{2}⟩^{1/2} / γ̇R_{0}",
       .scale = Scale::linear,
       .curves = StateCurves{{"u·n",
                              [](const Sample& m, const Units& u) {
                                return m.normal_velocity_l2 / std::sqrt(m.area) / velocity_unit(u);
                              }}},
       .scaling = Scaling::rate,
       .bare_axis = "⟨(u·n)^{2}⟩^{1/2}"},
      {.name = "viscosity",
       .meaning = "intrinsic viscosity of a dilute suspension in this state, S_xz / γ̇V; 5/2 for a sphere",
       .axis = "intrinsic viscosity [η]",
       .scale = Scale::linear,
       .curves = StateCurves{{"[η]", [](const Sample& m, const Units&) { return m.flow.intrinsic_viscosity; }}},
       .needs = Needs::forces},
      {.name = "normal-stresses",
       .meaning = "first and second difference of a dilute suspension in this state, over γ̇ and the share of vesicles",
       .axis = "N / γ̇φ",
       .scale = Scale::linear,
       .curves = StateCurves{{"N_{1}", [](const Sample& m, const Units&) { return m.flow.normal_stress_1; }},
                             {"N_{2}", [](const Sample& m, const Units&) { return m.flow.normal_stress_2; }}},
       .needs = Needs::forces},
      {.name = "stresslet",
       .meaning = "in the shear plane, about the centre, without trace",
       .axis = "S / γ̇R_{0}^{3}",
       .scale = Scale::linear,
       .curves =
           StateCurves{
               {"S_{xx}", [](const Sample& m, const Units& u) { return m.flow.stresslet(0, 0) / stresslet_unit(u); }},
               {"S_{xz}", [](const Sample& m, const Units& u) { return m.flow.stresslet(0, 2) / stresslet_unit(u); }},
               {"S_{zz}", [](const Sample& m, const Units& u) { return m.flow.stresslet(2, 2) / stresslet_unit(u); }}},
       .scaling = Scaling::rate,
       .bare_axis = "S / R_{0}^{3}",
       .needs = Needs::forces},
      {.name = "velocity",
       .meaning = "of the centre",
       .axis = "velocity / γ̇R_{0}",
       .scale = Scale::linear,
       .curves =
           StateCurves{
               {"U_{x}", [](const Sample& m, const Units& u) { return m.flow.center_velocity[0] / velocity_unit(u); }},
               {"U_{y}", [](const Sample& m, const Units& u) { return m.flow.center_velocity[1] / velocity_unit(u); }},
               {"U_{z}", [](const Sample& m, const Units& u) { return m.flow.center_velocity[2] / velocity_unit(u); }}},
       .scaling = Scaling::rate,
       .bare_axis = "velocity",
       .needs = Needs::velocity},
      {.name = "migration",
       .meaning = "velocity of the centre across the flow: along z in shear, away from the axis in Poiseuille flow",
       .axis = "migration / γ̇R_{0}",
       .scale = Scale::linear,
       .curves = StateCurves{{"migration",
                              [](const Sample& m, const Units& u) { return m.flow.migration / velocity_unit(u); }}},
       .scaling = Scaling::rate,
       .bare_axis = "migration velocity",
       .needs = Needs::velocity},
      {.name = "frequency",
       .meaning = "angular, of the membrane round the section with the shear plane, relative to the turning shape",
       .axis = "frequency ω / γ̇",
       .scale = Scale::linear,
       .curves =
           StateCurves{{"ω", [](const Sample& m, const Units& u) { return m.frequency / (u.rate > 0 ? u.rate : 1); }}},
       .scaling = Scaling::rate,
       .bare_axis = "frequency ω",
       .needs = Needs::velocity},
      {.name = "relative-viscosity",
       .meaning = "of the suspension in a periodic cell in steady shear",
       .axis = "relative viscosity η_{r}",
       .scale = Scale::linear,
       .curves = SuspensionCurves{{"η_{r}", [](const Suspension& m, const Units&) { return m.relative_viscosity; }}},
       .per_vesicle = false,
       .needs = Needs::forces},
      {.name = "normal-stress-differences",
       .meaning = "first and second, of the suspension in a periodic cell in steady shear",
       .axis = "N / γ̇",
       .scale = Scale::linear,
       .curves = SuspensionCurves{{"N_{1}", [](const Suspension& m, const Units&) { return m.normal_stress_1; }},
                                  {"N_{2}", [](const Suspension& m, const Units&) { return m.normal_stress_2; }}},
       .per_vesicle = false,
       .needs = Needs::forces},
      {.name = "alignment",
       .meaning = "mean inclination of all vesicles, and its spread among them",
       .axis = "inclination θ (°)",
       .scale = Scale::linear,
       .curves = SuspensionCurves{{"mean", [](const Suspension& m, const Units&) { return m.inclination_mean; }},
                                  {"spread", [](const Suspension& m, const Units&) { return m.inclination_spread; }}},
       .per_vesicle = false},
      {.name = "diffusion",
       .meaning = "mean squares of how far centres have moved since the start, along the vorticity and the gradient of "
                  "a shear: twice the self-diffusivity times the time",
       .axis = "⟨Δ^{2}⟩ / R_{0}^{2}",
       .scale = Scale::linear,
       .curves =
           SuspensionCurves{
               {"Δy", [](const Suspension& m, const Units& u) { return m.displacement[1] / (u.length * u.length); }},
               {"Δz", [](const Suspension& m, const Units& u) { return m.displacement[2] / (u.length * u.length); }}},
       .per_vesicle = false},
      {.name = "gap",
       .meaning = "least distance between two membranes",
       .axis = "gap / R_{0}",
       .scale = Scale::linear,
       .curves = StepCurves{{"gap", [](const Step& r, std::size_t, const Units& u) { return r.gap / u.length; }}},
       .per_vesicle = false},
      {.name = "iterations",
       .meaning = "of the linear solver, a step",
       .axis = "iterations",
       .scale = Scale::linear,
       .curves = StepCurves{{"iterations", [](const Step& r, std::size_t, const Units&) { return r.iterations; }}},
       .per_vesicle = false},
      {.name = "step",
       .meaning = "length of the time steps",
       .axis = "γ̇Δt",
       .scale = Scale::linear,
       .curves = StepCurves{{"γ̇Δt", [](const Step& r, std::size_t,
                                       const Units& u) { return u.rate > 0 ? u.rate * r.dt : r.dt; }}},
       .per_vesicle = false,
       .scaling = Scaling::rate,
       .bare_axis = "Δt"},
      {.name = "residual",
       .meaning = "of the linear solver, relative",
       .axis = "residual",
       .scale = Scale::logarithmic,
       .curves = StepCurves{{"residual", [](const Step& r, std::size_t, const Units&) { return r.residual; }}},
       .per_vesicle = false},
      {.name = "upsampling",
       .meaning = "grid factor of differentiation",
       .axis = "upsampling",
       .scale = Scale::linear,
       .curves = StepCurves{{"upsampling",
                             [](const Step& r, std::size_t v, const Units&) { return r.vesicles.at(v).upsampling; }}}},
      {.name = "tail",
       .meaning = "share of the mean curvature's spectrum in its last quarter",
       .axis = "spectrum tail",
       .scale = Scale::linear,
       .curves =
           StepCurves{{"tail", [](const Step& r, std::size_t v, const Units&) { return r.vesicles.at(v).tail; }}}},
  };
  return rows;
}

std::vector<const char*> curve_names(const QuantityRow& row) {
  std::vector<const char*> names;
  std::visit(
      [&](const auto& curves) {
        for (const auto& curve : curves) names.push_back(curve.name);
      },
      row.curves);
  return names;
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
