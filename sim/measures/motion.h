// The motion of a vesicle in steady shear, told from how the angle of its long axis goes with time: which of the three
// known motions it is, its period, and the last stretch of time over which other measures have a meaningful mean.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace sim {

/// Motion of the long axis in a steady shear flow.
enum class AxisMotion { untold, tank_treading, swinging, tumbling };

/// Unwraps an angle in degrees of an axis, modulo 180 degrees, next to the previous one.
double unwrapped(double angle, double before);

/// Whether times increase and no angle is farther from the one before than 60 degrees; of steps of more than 90 the
/// sense is not known.
bool can_be_followed(std::span<const double> times, std::span<const double> degrees);

/// Determined from times, in units of 1/rate, and unwrapped inclinations in degrees:
///   tumbling       it turned by half a turn or more; between two angles at rest there is less
///   tank_treading  over the last third, which spans a strain of 2 at least, it stays within one degree
///   swinging       its last two swings are larger than a degree, and the last no smaller than 9/10 of the one before
/// Otherwise untold: the run is too short, or still settling, or its states are too far apart to follow the angle.
AxisMotion motion_of(std::span<const double> times, std::span<const double> degrees);
/// "tumbles", "tumbling", for messages.
std::string_view text_of(AxisMotion);
std::string_view name_of(AxisMotion);

/// What is known of a motion beside its kind; NaN: not known. Times are in the unit of the input.
struct MotionPeriod {
  AxisMotion motion = AxisMotion::untold;
  double period = 0;        ///< NaN unless it swings or tumbles; of tumbling a full turn, twice that of the shape
  double from = 0, to = 0;  ///< the last period of the shape, or the last third of the time
  double least = 0, most = 0, mean = 0;  ///< angle from..to, in degrees; of tumbling NaN
};
/// Angles between the states are those of cubics through four of them. Tumbling: the last half turn that begins and
/// ends where the axis turns fastest, or else the last before the end. Swinging: the last two passes of the middle the
/// same way, or else the last two turning points of one kind.
MotionPeriod motion_period(std::span<const double> times, std::span<const double> degrees);

/// Value at a time of the cubic through the four nearest of the points; times increase. Fewer points: of lower degree.
double cubic_at(std::span<const double> times, std::span<const double> values, double time);
/// Mean of that curve from one time to another.
double mean_over(std::span<const double> times, std::span<const double> values, double from, double to);

}  // namespace sim
