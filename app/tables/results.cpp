#include "app/tables/results.h"

#include "sim/layers/near.h"
#include "sim/measures/motion.h"
#include "sim/sphere/basis.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Times at which the value passes first + 180, 360, ... to one side or the other: each once, in order.
std::vector<double> half_turns(const History& h) {
  std::vector<double> times;
  for (std::size_t k = 0; k + 1 < h.values.size(); ++k) {
    const double level = 180.0 * static_cast<double>(times.size() + 1);
    if (std::abs(h.values[k + 1] - h.values[0]) < level) continue;
    const double target = h.values[0] + std::copysign(level, h.values[k + 1] - h.values[0]);
    double low = h.times[k], high = h.times[k + 1];
    const bool falls = h.values[k + 1] < h.values[k];
    for (int i = 0; i < 60; ++i) {  // to rounding
      const double middle = (low + high) / 2;
      ((sim::cubic_at(h.times, h.values, middle) > target) == falls ? low : high) = middle;
    }
    times.push_back((low + high) / 2);
  }
  return times;
}

/// Extremum of the parabola through a point and its neighbours: time and value.
std::pair<double, double> vertex(const History& h, std::size_t k) {
  const double a = h.times[k] - h.times[k - 1], b = h.times[k + 1] - h.times[k];
  const double left = (h.values[k] - h.values[k - 1]) / a, right = (h.values[k + 1] - h.values[k]) / b;
  const double slope = (left * b + right * a) / (a + b), bend = 2 * (right - left) / (a + b);
  if (bend == 0) return {h.times[k], h.values[k]};
  return {h.times[k] - slope / bend, h.values[k] - slope * slope / (2 * bend)};
}

double largest(const History& h) {
  if (h.values.empty()) return none;
  const auto k = static_cast<std::size_t>(std::max_element(h.values.begin(), h.values.end()) - h.values.begin());
  if (k == 0 || k + 1 == h.values.size() || !std::isfinite(h.values[k])) return h.values[k];
  return vertex(h, k).second;
}

double least(const History& h) {
  History mirrored = h;
  for (double& v : mirrored.values) v = -v;
  return -largest(mirrored);
}

double last(const History& h) { return h.values.empty() ? none : h.values.back(); }

double mean_from(const History& h, double from) {
  return h.times.size() > 1 ? sim::mean_over(h.times, h.values, from, h.times.back()) : none;
}

double mean(const History& h) { return h.times.empty() ? none : mean_from(h, h.times.front()); }

double half_turn(const History& h) {
  const std::vector<double> turns = half_turns(h);
  return turns.empty() ? none : turns.front();
}

double period(const History& h) { return sim::motion_period(h.times, h.values).period; }

double steady_angle(const History& h) {
  if (h.times.empty() || !half_turns(h).empty()) return none;
  return mean_from(h, h.times.front() + 2 * (h.times.back() - h.times.front()) / 3);
}

/// Root of the mean square, over the area of the membrane, of the distance to the nearest point of the reference.
double shape_distance(const sim::VesicleState& v, const sim::VesicleState& reference, double length) {
  const int q = std::max(v.position.order, 8);
  const sim::Basis basis(v.position.order, q), search(reference.position.order, reference.position.order);
  const sim::FirstDerivatives x = basis.first(v.position);
  const sim::Matrix starts = search.synthesize(reference.position).values;
  const sim::PointSampler surface(reference.position);
  double sum = 0, area = 0;
  for (Eigen::Index k = 0; k < x.value.rows(); ++k) {
    const sim::Vec3 point = x.value.row(k).transpose();
    Eigen::Index start = 0;
    (starts.rowwise() - point.transpose()).rowwise().squaredNorm().minCoeff(&start);
    const sim::NearestPoint nearest = sim::nearest_point(surface, point, sim::grid_direction(search, start));
    const sim::Vec3 t = x.t.row(k).transpose(), f = x.f.row(k).transpose();
    const double element = t.cross(f).norm() / basis.sin_theta()[k] * basis.weights()[k];
    sum += element * nearest.distance * nearest.distance;
    area += element;
  }
  return std::sqrt(sum / area) / length;
}

double dot_distance(const sim::VesicleState& v, const sim::VesicleState& reference, double length) {
  if (v.tracers.rows() != reference.tracers.rows() || v.tracers.rows() == 0) return none;
  const sim::Matrix apart =
      sim::sample_points(v.position, v.tracers) - sim::sample_points(reference.position, reference.tracers);
  return std::sqrt(apart.rowwise().squaredNorm().mean()) / length;
}

}  // namespace

const std::vector<ReductionRow>& reductions() {
  static const std::vector<ReductionRow> rows{{"final", "value at the end of the run; may be left out", last},
                                              {"least", "smallest value of the run", least},
                                              {"largest", "largest value of the run", largest},
                                              {"mean", "mean over the time of the run", mean}};
  return rows;
}

const std::vector<ResultRow>& results() {
  static const std::vector<ResultRow> rows{
      {"half-turn", "time at which the long axis has turned by 180 degrees from where it began",
       OfQuantity{"inclination", half_turn, true}},
      {"period", "of tumbling a full turn of the axis, of swinging one swing: the last of the run",
       OfQuantity{"inclination", period, true}},
      {"steady-angle", "mean inclination over the last third of a run without a half turn",
       OfQuantity{"inclination", steady_angle}},
      {"shape-distance",
       "of the final membrane from that of the most accurate run: root mean square over the area, wherever its points "
       "are",
       OfMembranes{"final shape", shape_distance}},
      {"dot-distance", "of the dots that move with the final membrane from those of the most accurate run",
       OfMembranes{"final dots", dot_distance}}};
  return rows;
}

}  // namespace app
