#include "app/figures/tank_treading.h"

#include "render/scene/section.h"
#include "sim/measures/diagnostics.h"
#include "sim/sphere/basis.h"
#include "sim/sphere/legendre.h"
#include "sim/surface/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace app {

namespace {

using std::numbers::pi;

/// Contrasts that occur, in order.
std::vector<double> contrasts_of(const std::vector<SteadyPoint>& points) {
  std::vector<double> all;
  for (const SteadyPoint& p : points) all.push_back(p.viscosity_contrast);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Values at the turning points of a curve, the first and last value left out; what is smaller than `least` is no
/// swing.
std::vector<double> turning_points(const std::vector<double>& values, double least) {
  std::vector<double> turns;
  double low = values.front(), high = values.front();  // since the last turn
  int direction = 0;
  for (const double x : values) {
    if (direction >= 0 && x < high - least) {
      if (direction > 0) turns.push_back(high);
      direction = -1;
      low = x;
    } else if (direction <= 0 && x > low + least) {
      if (direction < 0) turns.push_back(low);
      direction = 1;
      high = x;
    }
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return turns;
}

}  // namespace

double unwrapped(double angle, double before) { return angle + 180 * std::round((before - angle) / 180); }

std::string_view text_of(Motion motion) {
  switch (motion) {
    case Motion::tank_treading:
      return "tank-treads";
    case Motion::swinging:
      return "swings";
    case Motion::tumbling:
      return "tumbles";
    case Motion::untold:
      break;
  }
  return "has not settled";
}

Motion motion_of(const std::vector<double>& times, const std::vector<double>& degrees) {
  constexpr double still = 1, least_strain = 2, lasting = 0.9;  // degrees; strain; of a swing to the one before
  if (times.empty() || times.size() != degrees.size()) return Motion::untold;
  const auto [low, high] = std::minmax_element(degrees.begin(), degrees.end());
  if (*high - *low >= 180) return Motion::tumbling;
  const double window = (times.back() - times.front()) / 3;
  if (!(window >= least_strain)) return Motion::untold;
  const auto first = std::lower_bound(times.begin(), times.end(), times.back() - window) - times.begin();
  const auto [least, most] = std::minmax_element(degrees.begin() + first, degrees.end());
  if (times.size() - static_cast<std::size_t>(first) > 2 && *most - *least <= still) return Motion::tank_treading;
  const std::vector<double> turns = turning_points(degrees, still);
  if (turns.size() < 3) return Motion::untold;
  const double last = std::abs(turns[turns.size() - 1] - turns[turns.size() - 2]);
  const double before = std::abs(turns[turns.size() - 2] - turns[turns.size() - 3]);
  return last >= lasting * before ? Motion::swinging : Motion::untold;
}

const std::vector<LiteraturePoint>& literature_angles() {
  static const std::vector<LiteraturePoint> points{
      {1, 0.702, 0.087, 0.002, "Kraus et al. 1996"},    {1, 0.898, 0.155, 0.002, "Kraus et al. 1996"},
      {1, 0.974, 0.206, 0.002, "Kraus et al. 1996"},    {2.7, 0.960, 0.152, 0.002, "Zhao, Shaqfeh 2009"},
      {2.7, 0.901, 0.110, 0.002, "Zhao, Shaqfeh 2009"}, {5.6, 0.980, 0.131, 0.002, "Zhao, Shaqfeh 2009"},
      {5.6, 0.939, 0.068, 0.002, "Zhao, Shaqfeh 2009"}};
  return points;
}

const std::vector<LiteraturePoint>& literature_frequencies() {
  static const std::vector<LiteraturePoint> points{{1, 0.80, 0.33, 0.02, "Kraus et al. 1996"},
                                                   {1, 0.95, 0.454, 0.009, "Kraus et al. 1996"}};
  return points;
}

SteadyPoint steady_point(sim::Plans& plans, const sim::VesicleState& v, double viscosity_contrast, double rate) {
  const sim::VesicleMeasures m = sim::measure(plans, v, 1, 1);
  SteadyPoint point{.reduced_volume = m.reduced_volume,
                    .viscosity_contrast = viscosity_contrast,
                    .angle = m.inclination_deg / 180,
                    .frequency = 0};
  render::CutPlane plane;
  plane.origin = m.center;
  const std::vector<render::ClosedCurve> curves = render::cut(v.position, plane, 96);
  if (curves.empty()) return point;
  const render::ClosedCurve& c = curves.front();
  const sim::Matrix u = sim::sample_points(v.velocity, c.directions);
  const Eigen::Index count = c.points.rows();
  double period = 0;
  const auto along = [&](Eigen::Index i) { return u(i, 0) * c.tangents(i, 0) + u(i, 2) * c.tangents(i, 1); };
  for (Eigen::Index i = 0; i < count; ++i) {  // chords and harmonic means: right to second order in a spacing of 1/200
    const Eigen::Index j = (i + 1) % count;
    period += (c.points.row(j) - c.points.row(i)).norm() * (1 / std::abs(along(i)) + 1 / std::abs(along(j))) / 2;
  }
  point.frequency = 2 * pi / period / rate;
  return point;
}

SteadyPoint keller_skalak(double nu, double lambda) {
  const sim::Vec3 axes = sim::spheroid_axes(nu, true);
  const double r = axes[0] / axes[1], a1 = std::pow(r, 2.0 / 3), a2 = std::pow(r, -1.0 / 3);
  // g = int_0^inf (a1^2 + s)^(-3/2) (a2^2 + s)^(-2) ds with s = x / (1 - x).
  const sim::GaussLegendre rule = sim::gauss_legendre(80);
  double g = 0;
  for (Eigen::Index k = 0; k < rule.theta.size(); ++k) {
    const double x = (1 + std::cos(rule.theta[k])) / 2, s = x / (1 - x);
    g += rule.weight[k] / 2 / ((1 - x) * (1 - x)) * std::pow(a1 * a1 + s, -1.5) * std::pow(a2 * a2 + s, -2);
  }
  const double f2 = g * (a1 * a1 + a2 * a2) / 2, f0 = 2 / (r + 1 / r), f1 = (r - 1 / r) / 2, q = 1 + f2 * (lambda - 1);
  const double b = f0 * (f1 + 1 / (f1 * q));
  const bool treads = b > 1;
  return {.reduced_volume = nu,
          .viscosity_contrast = lambda,
          .angle = treads ? std::acos(1 / b) / 2 / pi : std::nan(""),
          .frequency = treads ? 1 / b / (2 * f1 * q) : 0};
}

namespace {

/// The two panels of the figure, filled in step.
struct Panels {
  render::Plot angle, frequency;
};

Panels empty_panels(double least_volume) {
  Panels panels;
  render::Plot &angle = panels.angle, &frequency = panels.frequency;
  angle.x = frequency.x = {.label = "reduced volume ν", .grid = true};
  angle.y = {.label = "inclination θ / π", .grid = true};
  frequency.y = {.label = "frequency ω / γ̇", .grid = true};
  angle.x_range = frequency.x_range = render::Range{least_volume, 1};
  angle.y_range = render::Range{0, 0.26};
  frequency.y_range = render::Range{0, 0.55};
  angle.legend = render::Corner::upper_left;
  frequency.legend = render::Corner::lower_right;
  return panels;
}

bool has_curve(const render::Plot& plot, std::string_view name) {
  return std::any_of(plot.curves.begin(), plot.curves.end(), [&](const render::Curve& c) { return c.name == name; });
}

/// Keller and Skalak's theory from the least volume to the sphere.
void add_theory(Panels& panels, double least_volume, double contrast, std::size_t colour) {
  render::Curve angle, frequency;
  for (double nu = least_volume; nu < 0.9991; nu += 0.002) {
    const SteadyPoint t = keller_skalak(nu, contrast);
    angle.x.push_back(nu);
    angle.y.push_back(t.angle);
    frequency.x.push_back(nu);
    frequency.y.push_back(t.frequency > 0 ? t.frequency : std::nan(""));
  }
  angle.colour = frequency.colour = colour;
  angle.dashed = frequency.dashed = true;
  angle.csv_name = frequency.csv_name = fmt::format("Keller, Skalak 1982, λ = {}", contrast);
  if (colour == 0) angle.name = "Keller, Skalak 1982";
  panels.angle.curves.push_back(angle);
  panels.frequency.curves.push_back(frequency);
}

/// Our vesicles of one contrast that tank-tread, by volume.
void add_settled(Panels& panels, std::vector<SteadyPoint> points, double contrast, std::size_t colour) {
  std::sort(points.begin(), points.end(),
            [](const SteadyPoint& a, const SteadyPoint& b) { return a.reduced_volume < b.reduced_volume; });
  render::Curve angle;
  angle.colour = colour;
  angle.marker = render::Marker::ring;
  angle.line = points.size() > 2;
  angle.csv_name = fmt::format("Tanktread, λ = {}", contrast);
  render::Curve frequency = angle;
  frequency.name = fmt::format("λ = {}", contrast);
  if (colour == 0) {  // a line of the legend alone
    render::Curve mark;
    mark.name = "Tanktread";
    mark.line = false;
    mark.marker = render::Marker::ring;
    panels.angle.curves.push_back(mark);
  }
  for (const SteadyPoint& p : points) {
    angle.x.push_back(p.reduced_volume);
    angle.y.push_back(p.angle);
    frequency.x.push_back(p.reduced_volume);
    frequency.y.push_back(p.frequency);
  }
  panels.angle.curves.push_back(angle);
  panels.frequency.curves.push_back(frequency);
}

/// Those whose motion was too short to tell.
void add_unsettled(Panels& panels, const std::vector<SteadyPoint>& points, double contrast, std::size_t colour) {
  if (points.empty()) return;
  render::Curve angle;
  angle.colour = colour;
  angle.line = false;
  angle.marker = render::Marker::triangle;
  angle.csv_name = fmt::format("Tanktread, not settled, λ = {}", contrast);
  render::Curve frequency = angle;
  if (!has_curve(panels.angle, "not settled")) angle.name = "not settled";
  for (const SteadyPoint& p : points) {
    angle.x.push_back(p.reduced_volume);
    angle.y.push_back(p.angle);
    frequency.x.push_back(p.reduced_volume);
    frequency.y.push_back(p.frequency);
  }
  panels.angle.curves.push_back(angle);
  panels.frequency.curves.push_back(frequency);
}

/// Points of one contrast, a curve a source.
void add_literature(render::Plot& plot, const std::vector<LiteraturePoint>& all, double contrast, std::size_t colour,
                    bool named) {
  std::string_view source;
  for (const LiteraturePoint& l : all) {
    if (l.viscosity_contrast != contrast) continue;
    if (source != l.source) {
      source = l.source;
      render::Curve fresh;
      fresh.colour = colour;
      fresh.csv_name = fmt::format("{}, λ = {}", source, contrast);
      fresh.line = false;
      fresh.marker = source.starts_with("Kraus") ? render::Marker::diamond : render::Marker::square;
      if (named && !has_curve(plot, source)) fresh.name = source;
      plot.curves.push_back(fresh);
    }
    render::Curve& curve = plot.curves.back();
    curve.x.push_back(l.reduced_volume);
    curve.y.push_back(l.value);
    curve.error.push_back(l.error);
  }
}

}  // namespace

std::vector<render::Plot> tank_treading_plots(const std::vector<SteadyPoint>& points) {
  double least = 0.7;
  for (const SteadyPoint& p : points) least = std::min(least, p.reduced_volume);
  least = std::floor(least * 20 - 1e-9) / 20;
  Panels panels = empty_panels(least);
  const std::vector<double> contrasts = contrasts_of(points);
  for (std::size_t k = 0; k < contrasts.size(); ++k) add_theory(panels, least, contrasts[k], k);
  // Colours tell the contrast, marks the source: sources are named in the first panel, contrasts in the second.
  for (std::size_t k = 0; k < contrasts.size(); ++k) {
    std::vector<SteadyPoint> settled, unsettled;
    for (const SteadyPoint& p : points)
      if (p.viscosity_contrast == contrasts[k]) (p.motion == Motion::tank_treading ? settled : unsettled).push_back(p);
    add_settled(panels, settled, contrasts[k], k);
    add_unsettled(panels, unsettled, contrasts[k], k);
    add_literature(panels.angle, literature_angles(), contrasts[k], k, true);
    add_literature(panels.frequency, literature_frequencies(), contrasts[k], k, false);
  }
  return {panels.angle, panels.frequency};
}

}  // namespace app
