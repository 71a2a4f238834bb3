// Motions of the vesicles of a trajectory: which kind, its period, and what other measures are on average over it.
#pragma once

#include "sim/core/parameters.h"
#include "sim/measures/motion.h"
#include "sim/trajectory/trajectory.h"

#include <limits>
#include <string>
#include <vector>

namespace app {

/// Of one vesicle, times in units of the scene; NaN: not known.
struct VesicleMotion : sim::MotionPeriod {
  std::string_view why = {};  ///< it is untold
  /// Means from..to.
  double frequency = std::numeric_limits<double>::quiet_NaN(), intrinsic_viscosity = frequency,
         normal_stress_1 = frequency, normal_stress_2 = frequency, migration = frequency;
};

/// The columns of a table of motions behind `vesicle` and `motion`, declared once: v(name, meaning, value).
template <class V>
void visit(const VesicleMotion& m, V&& v) {
  v("period", "of swinging, or of a full turn of the axis", m.period);
  v("from", "begin of the time over which means are taken: the last period of the shape, or the last third", m.from);
  v("to", "end of that time", m.to);
  v("angle_mean", "mean inclination, degrees; nan for tumbling", m.mean);
  v("angle_min", "least inclination, degrees; nan for tumbling", m.least);
  v("angle_max", "largest inclination, degrees; nan for tumbling", m.most);
  v("frequency", "mean angular frequency of the membrane relative to the shape, rad/time", m.frequency);
  v("intrinsic_viscosity", "mean", m.intrinsic_viscosity);
  v("normal_stress_1", "mean", m.normal_stress_1);
  v("normal_stress_2", "mean", m.normal_stress_2);
  v("migration", "mean", m.migration);
}

/// Kinds and periods of all vesicles, from the angles alone. States that cannot be read are left out, or are errors.
enum class Damage { is_error, is_left_out };
std::vector<VesicleMotion> motions_of(const sim::TrajectoryReader&, const sim::Scene&, Damage = Damage::is_error);
/// Adds the means.
std::vector<VesicleMotion> motions_with_means(const sim::TrajectoryReader&, const sim::Scene&);

/// "tumbling, period 26.11 (half turn 13.055)"; the frequency in units of the rate.
std::string motion_text(const VesicleMotion&, double rate);
/// What `info` says: one line for all vesicles that do the same, at most some lines. Empty without states.
std::vector<std::string> motion_lines(const sim::TrajectoryReader&, const sim::Scene&);

}  // namespace app
