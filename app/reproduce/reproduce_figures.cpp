// Figures 2 and 3: aliasing, and the spectra that make it matter.
#include "app/reproduce/reproduce_items.h"

#include "render/figures/plot_legend.h"
#include "render/scene/section.h"
#include "sim/sphere/legendre.h"
#include "sim/sphere/norms.h"
#include "sim/stepping/simulate.h"
#include "sim/stepping/stepper.h"
#include "sim/surface/dealias.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace app {

namespace {

/// P_nm at z, normalised to unit integral of its square over [-1, 1].
std::vector<double> legendre_at(int n, int m, const std::vector<double>& z) {
  sim::Vector theta(static_cast<Eigen::Index>(z.size()));
  for (std::size_t k = 0; k < z.size(); ++k) theta[static_cast<Eigen::Index>(k)] = std::acos(z[k]);
  const sim::LegendreTable table = sim::legendre_table(n, theta, 0);
  const sim::Vector values = table.value.col(sim::legendre_index(n, n, m));
  return {values.data(), values.data() + values.size()};
}

struct Alias {
  int n, m;
  std::vector<double> z, values, at_nodes;  ///< scaled to P_41's size and sign at the nodes
  double scale = 1, deviation = 0;
};

}  // namespace

Report reproduce_aliasing(const Effort&) {
  constexpr int nodes = 7, points = 1201;
  const sim::GaussLegendre rule = sim::gauss_legendre(nodes);
  std::vector<double> at, fine;
  for (int i = 0; i < nodes; ++i) at.push_back(std::cos(rule.theta[i]));
  for (int i = 0; i < points; ++i) fine.push_back(-1 + 2.0 * i / (points - 1));
  const std::vector<double> low = legendre_at(4, 1, fine), low_at = legendre_at(4, 1, at);
  std::vector<Alias> aliases;
  for (const auto& [n, m] : {std::pair{19, 2}, std::pair{64, 1}}) {
    Alias a{n, m, fine, legendre_at(n, m, fine), legendre_at(n, m, at)};
    double cross = 0, own = 0, size = 0, miss = 0;
    for (int i = 0; i < nodes; ++i) {
      const auto k = static_cast<std::size_t>(i);
      cross += rule.weight[i] * low_at[k] * a.at_nodes[k];
      own += rule.weight[i] * a.at_nodes[k] * a.at_nodes[k];
      size += rule.weight[i] * low_at[k] * low_at[k];
    }
    a.scale = cross / own;
    for (double& v : a.values) v *= a.scale;
    for (double& v : a.at_nodes) v *= a.scale;
    for (int i = 0; i < nodes; ++i) {
      const auto k = static_cast<std::size_t>(i);
      miss += rule.weight[i] * (a.at_nodes[k] - low_at[k]) * (a.at_nodes[k] - low_at[k]);
    }
    a.deviation = std::sqrt(miss / size);
    aliases.push_back(std::move(a));
  }
  Report report;
  report.title = "Figure 2: aliasing of associated Legendre functions";
  report.setting = {"P_n^m(z) normalised to unit square integral over [−1, 1]; 7-point Gauss-Legendre grid.",
                    "Each high function is multiplied by the factor that fits P_4^1 best at the nodes."};
  TextTable table{"Values at the nodes; in the last row the root mean square deviation from P_4^1, relative.",
                  {"z", "P_4^1", "P_19^2, scaled", "P_64^1, scaled"},
                  {}};
  const auto tidy = [](double v) { return fmt::format("{:.6f}", std::abs(v) < 5e-7 ? 0 : v); };
  for (std::size_t k = 0; k < at.size(); ++k)
    table.rows.push_back({tidy(at[k]), tidy(low_at[k]), tidy(aliases[0].at_nodes[k]), tidy(aliases[1].at_nodes[k])});
  table.rows.push_back({"deviation", "0", scientific(aliases[0].deviation, 3), scientific(aliases[1].deviation, 3)});
  report.tables.push_back(table);
  report.findings = {
      fmt::format("On these seven nodes the two functions are indistinguishable from P_4^1 by eye, as in the "
                  "paper's plot, but not the same: they deviate by {:.1f} % and {:.1f} % (factors {:.4f} and {:.4f}).",
                  100 * aliases[0].deviation, 100 * aliases[1].deviation, aliases[0].scale, aliases[1].scale)};
  render::Figure figure;
  figure.csv = "z,P_4_1,P_19_2_scaled,P_64_1_scaled\n";
  for (std::size_t k = 0; k < fine.size(); ++k)
    figure.csv +=
        fmt::format("{:.10g},{:.10g},{:.10g},{:.10g}\n", fine[k], low[k], aliases[0].values[k], aliases[1].values[k]);
  figure.drawing = {.width = 510, .height = 236, .paint = [=](cairo_t* cairo, const render::Font& font) {
                      const render::Theme theme = render::find_theme("paper");
                      const render::Pen pen{cairo, font, theme};
                      for (std::size_t k = 0; k < aliases.size(); ++k) {
                        const render::Panel panel{.x = {-1, 1},
                                                  .y = {-2.6, 2.6},
                                                  .left = 50 + 240 * static_cast<double>(k),
                                                  .top = 30,
                                                  .width = 204,
                                                  .height = 160};
                        constexpr render::Colour grey{0.62, 0.66, 0.72};
                        render::draw_polyline(pen, panel, fine, aliases[k].values, {grey, 0.6});
                        render::draw_polyline(pen, panel, fine, low, {render::curve_colour(0), 1.15});
                        render::draw_markers(pen, panel, at, low_at, render::Marker::dot, render::curve_colour(1), 2);
                        render::Axes axes;
                        axes.x.label = "z";
                        axes.y.numbers = k == 0;
                        render::draw_axes(pen, panel, axes);
                        render::draw_title(pen, panel, k == 0 ? "(a)" : "(b)");
                        render::draw_legend_line(
                            pen, panel.left + panel.width, 23,
                            {{"P_{4}^{1}", render::curve_colour(0), {}},
                             {fmt::format("P_{{{}}}^{{{}}}", aliases[k].n, aliases[k].m), grey, {}}});
                      }
                    }};
  report.figure = std::move(figure);
  report.picture_text = "P_4^1 (blue) and a high function (grey) that takes its values at the seven nodes (dots).";
  return report;
}

namespace {

constexpr double least_shown = 1e-12;  // degrees that a symmetry empties are smaller

/// A shape and the norms of its coefficients by degree n; NaN beyond its order.
struct Spectra {
  int order = 0, fine = 0;  ///< highest degrees of the position, and of the grid for its mean curvature
  sim::Coefficients shape;
  std::vector<double> of_x, of_h;
  std::vector<double> of_folded;  ///< of the mean curvature from the grid of the position's own order
  double in_band = 0;             ///< relative error of that mean curvature in the degrees of the position
};

/// A shape that fills its band: a biconcave disc after some time in Poiseuille flow.
sim::Coefficients full_shape(sim::Plans& plans, int order, double end, const Effort& effort) {
  sim::Scene scene;
  sim::FlowParameters flow;
  flow.kind = "poiseuille";
  flow.curvature = 0.1;
  scene.flows = {flow};
  sim::VesicleParameters vesicle;
  vesicle.shape = "biconcave";
  vesicle.reduced_volume = 0.65;
  vesicle.order = order;
  scene.vesicles = {vesicle};
  const sim::Model model = sim::make_model(scene, plans);
  sim::Dynamics dynamics = sim::initial_dynamics(model);
  while (dynamics.time < end * (1 - 1e-9)) {
    stop_if_interrupted();
    effort.progress.show(dynamics.time / end, "the shape");
    dynamics = sim::take_step(model, dynamics, 0.05).value().dynamics;
  }
  return dynamics.vesicles[0].position;
}

Spectra spectra_of(sim::Plans& plans, const sim::Coefficients& x, int fine) {
  const int p = x.order;
  const sim::Coefficients h = sim::mean_curvature(plans, sim::resized(x, fine), fine);
  // The same from the p-grid alone: everything above p is folded back.
  const sim::Coefficients folded = sim::mean_curvature(plans, x, p);
  Spectra s;
  s.order = p;
  s.fine = fine;
  s.shape = x;
  for (int n = 0; n <= fine; ++n) {
    s.of_x.push_back(n <= p ? sim::modular_norm(x, n) : std::nan(""));
    s.of_h.push_back(sim::modular_norm(h, n));
    s.of_folded.push_back(n <= p ? sim::modular_norm(folded, n) : std::nan(""));
  }
  s.in_band = (folded.values - sim::resized(h, p).values).norm() / sim::resized(h, p).values.norm();
  return s;
}

TextTable table_of(const Spectra& s) {
  TextTable table{.caption = "", .columns = {"n", "E_n(x)", "E_n(H)", "E_n(H) from the p-grid"}, .rows = {}};
  for (std::size_t n = 0; n < s.of_h.size(); ++n)
    table.rows.push_back(
        {std::to_string(n), scientific(s.of_x[n], 6), scientific(s.of_h[n], 6), scientific(s.of_folded[n], 6)});
  return table;
}

TextTable every_eighth(const TextTable& table) {
  TextTable excerpt{.caption = "Every eighth degree.", .columns = table.columns, .rows = {}};
  for (std::size_t n = 0; n < table.rows.size(); n += 8) excerpt.rows.push_back(table.rows[n]);
  return excerpt;
}

constexpr std::array spectrum_markers{render::Marker::dot, render::Marker::square};

void draw_spectrum(const render::Pen& pen, const render::Panel& panel, const std::vector<double>& norms,
                   std::size_t colour) {
  std::vector<double> n, y;
  for (std::size_t k = 0; k < norms.size(); ++k)
    if (norms[k] > least_shown) {
      n.push_back(static_cast<double>(k));
      y.push_back(std::log10(norms[k]));
    }
  render::draw_polyline(pen, panel, n, y, {render::curve_colour(colour), 0.75});
  render::draw_markers(pen, panel, n, y, spectrum_markers[colour], render::curve_colour(colour), 1.25);
}

void draw_spectra(const render::Pen& pen, const Spectra& s, const std::vector<render::ClosedCurve>& section) {
  std::vector<double> all = s.of_h;
  for (const double v : s.of_x)
    if (v > least_shown) all.push_back(v);
  for (double& v : all) v = std::max(v, least_shown);
  const render::Panel panel{.x = {0, static_cast<double>(s.fine)},
                            .y = render::decades(all),
                            .left = 66,
                            .top = 16,
                            .width = 318,
                            .height = 232};
  draw_spectrum(pen, panel, s.of_h, 1);
  draw_spectrum(pen, panel, s.of_x, 0);
  render::draw_axes(pen, panel,
                    {.x = {.label = "degree n"}, .y = {.label = "E_{n}", .scale = render::Scale::logarithmic}});
  // The section of the shape, in the upper right.
  const render::Panel inset{.x = {-1.7, 1.7},
                            .y = {-1.7, 1.7},
                            .left = panel.left + panel.width - 92,
                            .top = panel.top + 8,
                            .width = 84,
                            .height = 84};
  for (const render::ClosedCurve& curve : section) {
    const Eigen::Vector2d middle =
        0.5 * (curve.points.colwise().maxCoeff() + curve.points.colwise().minCoeff()).transpose();
    render::draw_closed_curve(pen, inset, curve, -middle, {{0.25, 0.28, 0.33}, 0.75}, 0.12);
  }
  render::draw_legend(pen, panel,
                      {{"position", render::curve_colour(0), spectrum_markers[0]},
                       {"mean curvature", render::curve_colour(1), spectrum_markers[1]}},
                      render::Corner::lower_left);
}

}  // namespace

Report reproduce_spectra(const Effort& effort) {
  const int p = effort.quick ? 8 : 16, q = effort.quick ? 24 : 64;
  const double end = effort.quick ? 0.2 : 4;
  sim::Plans plans;
  const Spectra spectra = spectra_of(plans, full_shape(plans, p, end, effort), q);
  const TextTable table = table_of(spectra);
  Report report;
  report.title = "Figure 3: spectra of position and mean curvature";
  report.setting = {
      fmt::format(
          "The paper's shape is only pictured; ours is a biconcave disc, ν = 0.65, p = {}, κ_b = 0.01, λ = 1, after "
          "t = {} in the Poiseuille flow u_x = −0.1 (y² + z²) (bdf2, Δt = 0.05).",
          p, end),
      fmt::format("E_n of Eq. (18): norm of the coefficients of degree n; H computed on the {}-grid.", q)};
  const std::vector<double>& of_h = spectra.of_h;
  report.findings = {fmt::format(
      "x ends at n = {}; at n = {} H has still {} of its largest E_n. Taken from the {}-grid alone, H "
      "is wrong by {} in its coefficients n ≤ {}.",
      p, q, scientific(of_h.back() / *std::max_element(of_h.begin(), of_h.end())), p, scientific(spectra.in_band), p)};
  report.tables.push_back(every_eighth(table));
  const std::vector<render::ClosedCurve> section = render::cut(spectra.shape, {});
  render::Figure& figure = report.figure.emplace();
  figure.csv = csv_text(table);
  figure.drawing = {.width = 400, .height = 300, .paint = [spectra, section](cairo_t* cairo, const render::Font& font) {
                      const render::Theme theme = render::find_theme("paper");
                      draw_spectra({cairo, font, theme}, spectra, section);
                    }};
  report.picture_text = "Modular norms of position and mean curvature, and the section of the shape.";
  return report;
}

}  // namespace app
