#include "sim/measures/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace sim {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN(), never = std::numeric_limits<double>::infinity();
constexpr double still = 1, half_turn = 180;  // degrees
/// Degrees between two states: a longer way may have been the other one round.
constexpr double farthest = 60;

using Numbers = std::span<const double>;

/// Numbers of the turning points of a curve, the first and last value left out; what is smaller than `still` is no
/// swing.
std::vector<std::size_t> turning_points(Numbers values) {
  std::vector<std::size_t> turns;
  std::size_t low = 0, high = 0;  // since the last turn
  int direction = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (direction >= 0 && values[k] < values[high] - still) {
      if (direction > 0) turns.push_back(high);
      direction = -1;
      low = k;
    } else if (direction <= 0 && values[k] > values[low] + still) {
      if (direction < 0) turns.push_back(low);
      direction = 1;
      high = k;
    }
    if (values[k] < values[low]) low = k;
    if (values[k] > values[high]) high = k;
  }
  return turns;
}

/// The last time at which the curve passes a level, rising or falling, up to `end`.
std::optional<double> last_pass(Numbers times, Numbers values, double level, bool rising, double end) {
  for (std::size_t k = times.size() - 1; k > 0; --k) {
    if (times[k - 1] >= end) continue;
    if ((values[k - 1] < level) != rising || (values[k] < level) == rising) continue;
    double a = times[k - 1], b = times[k];
    for (int round = 0; round < 60; ++round) {
      const double middle = (a + b) / 2;
      ((cubic_at(times, values, middle) < level) == rising ? a : b) = middle;
    }
    if (b < end) return b;
  }
  return std::nullopt;
}

/// Where the curve is largest beside one of its points, or least for sign = -1.
double time_of_turn(Numbers times, Numbers values, std::size_t k, double sign) {
  double a = times[k - 1], b = times[k + 1];
  for (int round = 0; round < 100; ++round) {
    const double c = a + (b - a) / 3, d = b - (b - a) / 3;
    if (sign * cubic_at(times, values, c) < sign * cubic_at(times, values, d))
      a = c;
    else
      b = d;
  }
  return (a + b) / 2;
}

void measure_tumbling(Numbers times, Numbers degrees, MotionPeriod& m) {
  const std::size_t last = times.size() - 1;
  const double way = degrees[last] < degrees[0] ? -1 : 1;
  double fastest = 0, level = degrees[last];
  for (std::size_t k = last; k > 0 && std::abs(degrees[k] - degrees[last]) < half_turn; --k)
    if (const double speed = way * (degrees[k] - degrees[k - 1]) / (times[k] - times[k - 1]); speed > fastest) {
      fastest = speed;
      level = (degrees[k] + degrees[k - 1]) / 2;
    }
  const bool rising = way > 0;
  std::optional<double> to = last_pass(times, degrees, level, rising, never);
  std::optional<double> from;
  if (to) from = last_pass(times, degrees, level - way * half_turn, rising, *to);
  if (!from) {
    to = times[last];
    from = last_pass(times, degrees, degrees[last] - way * half_turn, rising, *to);
  }
  if (!from) return;
  m.from = *from;
  m.to = *to;
  m.period = 2 * (*to - *from);
}

void measure_swinging(Numbers times, Numbers degrees, MotionPeriod& m) {
  const std::vector<std::size_t> turns = turning_points(degrees);
  const std::size_t last = turns.back(), before = turns[turns.size() - 2], first = turns[turns.size() - 3];
  const double middle = (degrees[last] + degrees[before]) / 2, sign = degrees[last] > degrees[before] ? 1 : -1;
  const double turned = time_of_turn(times, degrees, last, sign);
  m.from = time_of_turn(times, degrees, first, sign);
  m.to = turned;
  for (const bool rising : {degrees.back() > middle, degrees.back() <= middle}) {  // the later pass first
    const std::optional<double> to = last_pass(times, degrees, middle, rising, never);
    const std::optional<double> from = to ? last_pass(times, degrees, middle, rising, *to) : std::nullopt;
    if (!from) continue;
    m.from = *from;
    m.to = *to;
    break;
  }
  m.period = m.to - m.from;
  const double one = cubic_at(times, degrees, turned);
  const double other = cubic_at(times, degrees, time_of_turn(times, degrees, before, -sign));
  m.least = std::min(one, other);
  m.most = std::max(one, other);
}

}  // namespace

double unwrapped(double angle, double before) { return angle + half_turn * std::round((before - angle) / half_turn); }

std::string_view text_of(AxisMotion motion) {
  switch (motion) {
    case AxisMotion::tank_treading:
      return "tank-treads";
    case AxisMotion::swinging:
      return "swings";
    case AxisMotion::tumbling:
      return "tumbles";
    case AxisMotion::untold:
      break;
  }
  return "has not settled";
}

std::string_view name_of(AxisMotion motion) {
  switch (motion) {
    case AxisMotion::tank_treading:
      return "tank-treading";
    case AxisMotion::swinging:
      return "swinging";
    case AxisMotion::tumbling:
      return "tumbling";
    case AxisMotion::untold:
      break;
  }
  return "untold";
}

bool can_be_followed(std::span<const double> times, std::span<const double> degrees) {
  if (times.empty() || times.size() != degrees.size()) return false;
  for (std::size_t k = 0; k < times.size(); ++k)
    if (!std::isfinite(times[k]) || !std::isfinite(degrees[k])) return false;
  for (std::size_t k = 1; k < times.size(); ++k)
    if (!(times[k] > times[k - 1]) || std::abs(degrees[k] - degrees[k - 1]) > farthest) return false;
  return true;
}

AxisMotion motion_of(std::span<const double> times, std::span<const double> degrees) {
  constexpr double least_strain = 2, lasting = 0.9;  // of a swing to the one before
  if (!can_be_followed(times, degrees)) return AxisMotion::untold;
  const auto [low, high] = std::minmax_element(degrees.begin(), degrees.end());
  if (*high - *low >= half_turn) return AxisMotion::tumbling;
  const double window = (times.back() - times.front()) / 3;
  if (!(window >= least_strain)) return AxisMotion::untold;
  const auto first = std::lower_bound(times.begin(), times.end(), times.back() - window) - times.begin();
  const auto [least, most] = std::minmax_element(degrees.begin() + first, degrees.end());
  if (times.size() - static_cast<std::size_t>(first) > 2 && *most - *least <= still) return AxisMotion::tank_treading;
  const std::vector<std::size_t> turns = turning_points(degrees);
  if (turns.size() < 3) return AxisMotion::untold;
  const double last = std::abs(degrees[turns[turns.size() - 1]] - degrees[turns[turns.size() - 2]]);
  const double before = std::abs(degrees[turns[turns.size() - 2]] - degrees[turns[turns.size() - 3]]);
  return last >= lasting * before ? AxisMotion::swinging : AxisMotion::untold;
}

MotionPeriod motion_period(std::span<const double> times, std::span<const double> degrees) {
  MotionPeriod m{.motion = motion_of(times, degrees),
                 .period = none,
                 .from = none,
                 .to = none,
                 .least = none,
                 .most = none,
                 .mean = none};
  if (times.empty()) return m;
  m.to = times.back();
  m.from = times.back() - (times.back() - times.front()) / 3;
  switch (m.motion) {
    case AxisMotion::tumbling:
      measure_tumbling(times, degrees, m);
      return m;
    case AxisMotion::swinging:
      measure_swinging(times, degrees, m);
      break;
    case AxisMotion::tank_treading: {
      const auto first = std::lower_bound(times.begin(), times.end(), m.from) - times.begin();
      const auto [least, most] = std::minmax_element(degrees.begin() + first, degrees.end());
      m.least = *least;
      m.most = *most;
      break;
    }
    case AxisMotion::untold:
      return m;
  }
  m.mean = mean_over(times, degrees, m.from, m.to);
  return m;
}

double cubic_at(std::span<const double> times, std::span<const double> values, double time) {
  const std::size_t n = times.size();
  if (n < 2) return n == 1 ? values[0] : none;
  const auto after = std::upper_bound(times.begin() + 1, times.end() - 1, time);
  const auto b = static_cast<std::size_t>(after - times.begin()), a = b - 1;
  // Of points that are much nearer to each other than these two, the slope is noise.
  const double apart = 0.1 * (times[b] - times[a]);
  std::vector<std::size_t> left, right;
  for (std::size_t k = a; k-- > 0 && left.size() < 2;)
    if (times[left.empty() ? a : left.back()] - times[k] >= apart) left.push_back(k);
  for (std::size_t k = b + 1; k < n && right.size() < 2; ++k)
    if (times[k] - times[right.empty() ? b : right.back()] >= apart) right.push_back(k);
  std::vector<std::size_t> nodes{a, b};
  for (std::size_t k = 0; k < 2 && nodes.size() < 4; ++k) {  // one on each side, or two on one
    if (k < left.size()) nodes.push_back(left[k]);
    if (k < right.size() && nodes.size() < 4) nodes.push_back(right[k]);
  }
  double sum = 0;
  for (const std::size_t i : nodes) {
    double term = values[i];
    for (const std::size_t j : nodes)
      if (j != i) term *= (time - times[j]) / (times[i] - times[j]);
    sum += term;
  }
  return sum;
}

double mean_over(std::span<const double> times, std::span<const double> values, double from, double to) {
  if (times.empty() || !(to >= from)) return none;
  if (to == from) return cubic_at(times, values, to);
  double sum = 0;
  for (std::size_t k = 1; k < times.size(); ++k) {
    const double a = std::max(times[k - 1], from), b = std::min(times[k], to);
    if (!(b > a)) continue;
    sum += (b - a) / 6 *  // Simpson's rule, exact for cubics
           (cubic_at(times, values, a) + 4 * cubic_at(times, values, (a + b) / 2) + cubic_at(times, values, b));
  }
  return sum / (to - from);
}

}  // namespace sim
