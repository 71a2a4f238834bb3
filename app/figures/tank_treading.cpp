#include "app/figures/tank_treading.h"

#include "render/scene/section.h"
#include "sim/measures/diagnostics.h"
#include "sim/sphere/basis.h"
#include "sim/sphere/legendre.h"
#include "sim/surface/shapes.h"
#include "sim/suspension/velocity.h"

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

}  // namespace

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

double membrane_frequency(const sim::Coefficients& position, const sim::Coefficients& velocity, const sim::Vec3& centre,
                          double turning) {
  render::CutPlane plane;
  plane.origin = centre;
  const std::vector<render::ClosedCurve> curves = render::cut(position, plane);
  if (curves.empty()) return std::nan("");
  const render::ClosedCurve& c = curves.front();
  const sim::Matrix u = sim::sample_points(velocity, c.directions);
  const Eigen::Index count = c.points.rows();
  sim::Vector along(count);  // the shape turns by the angle from x to z: its own velocity is turning (-z, x)
  for (Eigen::Index i = 0; i < count; ++i)
    along[i] = (u(i, 0) + turning * c.points(i, 1)) * c.tangents(i, 0) +
               (u(i, 2) - turning * c.points(i, 0)) * c.tangents(i, 1);
  if (!(along.minCoeff() > 0) && !(along.maxCoeff() < 0)) return 0;  // no point goes round
  // The time of passage per length, as a function of the length along the section, some points more than once round.
  std::vector<double> lengths{0}, slowness;
  const auto more = static_cast<std::size_t>(count) + 3;
  for (std::size_t k = 0; k < more; ++k) {
    const auto i = static_cast<Eigen::Index>(k) % count, j = (i + 1) % count;
    const double turn = std::acos(std::clamp(c.tangents.row(i).dot(c.tangents.row(j)), -1.0, 1.0)) / 2;
    const double chord = (c.points.row(j) - c.points.row(i)).norm();
    slowness.push_back(1 / along[i]);
    if (k + 1 < more) lengths.push_back(lengths.back() + chord * (turn > 1e-4 ? turn / std::sin(turn) : 1));
  }
  const double begin = lengths[1], end = lengths[static_cast<std::size_t>(count) + 1];
  return -2 * pi / ((end - begin) * sim::mean_over(lengths, slowness, begin, end));  // tangents run from x to z
}

SteadyPoint steady_point(sim::Plans& plans, const sim::VesicleState& v, double viscosity_contrast, double rate) {
  const sim::VesicleMeasures m = sim::measure(plans, v, 1, 1);
  sim::Coefficients velocity = v.velocity;
  velocity.values.row(0) -= std::sqrt(sim::default_area) * sim::centroid_velocity(plans, v).transpose();
  return {.reduced_volume = m.reduced_volume,
          .viscosity_contrast = viscosity_contrast,
          .angle = m.inclination_deg / 180,
          .frequency = std::abs(membrane_frequency(v.position, velocity, m.center, 0)) / rate};
}

KellerSkalakFactors keller_skalak_factors(double r) {
  const double a1 = std::pow(r, 2.0 / 3), a2 = std::pow(r, -1.0 / 3);
  // g = int_0^inf (a1^2 + s)^(-3/2) (a2^2 + s)^(-2) ds with s = x / (1 - x).
  const sim::GaussLegendre rule = sim::gauss_legendre(80);
  double g = 0;
  for (Eigen::Index k = 0; k < rule.theta.size(); ++k) {
    const double x = (1 + std::cos(rule.theta[k])) / 2, s = x / (1 - x);
    g += rule.weight[k] / 2 / ((1 - x) * (1 - x)) * std::pow(a1 * a1 + s, -1.5) * std::pow(a2 * a2 + s, -2);
  }
  return {.f0 = 2 / (r + 1 / r), .f1 = (r - 1 / r) / 2, .f2 = g * (a1 * a1 + a2 * a2) / 2};
}

SteadyPoint keller_skalak(double nu, double lambda) {
  const sim::Vec3 axes = sim::spheroid_axes(nu, true);
  const KellerSkalakFactors f = keller_skalak_factors(axes[0] / axes[1]);
  const double b = f.b(lambda);
  const bool treads = b > 1;
  return {.reduced_volume = nu,
          .viscosity_contrast = lambda,
          .angle = treads ? std::acos(1 / b) / 2 / pi : std::nan(""),
          .frequency = treads ? 1 / b / (2 * f.f1 * f.q(lambda)) : 0};
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
  angle.dash = frequency.dash = 1;
  angle.ink_in_legend = true;
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
  // Entries of the legend alone.
  render::Curve hue;
  hue.name = fmt::format("λ = {}", contrast);
  hue.colour = colour;
  panels.angle.curves.push_back(hue);
  if (colour == 0) {
    render::Curve mark;
    mark.name = "Tanktread";
    mark.line = false;
    mark.marker = render::Marker::ring;
    mark.ink_in_legend = true;
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
  angle.ink_in_legend = true;
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
      fresh.ink_in_legend = true;
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
      if (p.viscosity_contrast == contrasts[k])
        (p.motion == sim::AxisMotion::tank_treading ? settled : unsettled).push_back(p);
    add_settled(panels, settled, contrasts[k], k);
    add_unsettled(panels, unsettled, contrasts[k], k);
    add_literature(panels.angle, literature_angles(), contrasts[k], k, true);
    add_literature(panels.frequency, literature_frequencies(), contrasts[k], k, false);
  }
  return {panels.angle, panels.frequency};
}

}  // namespace app
