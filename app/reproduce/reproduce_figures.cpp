// Figures 2 and 3: aliasing, and the spectra that make it matter.
#include "app/reproduce/reproduce_items.h"

#include "render/figures/plot_marks.h"
#include "render/scene/section.h"
#include "sim/surface/dealias.h"
#include "sim/sphere/legendre.h"
#include "sim/sphere/norms.h"
#include "sim/stepping/simulate.h"
#include "sim/stepping/stepper.h"

#include <fmt/format.h>

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
                  {"z", "P_4^1", "P_19^2, scaled", "P_64^1, scaled"}, {}};
  const auto tidy = [](double v) { return fmt::format("{:.6f}", std::abs(v) < 5e-7 ? 0 : v); };
  for (std::size_t k = 0; k < at.size(); ++k)
    table.rows.push_back({tidy(at[k]), tidy(low_at[k]), tidy(aliases[0].at_nodes[k]), tidy(aliases[1].at_nodes[k])});
  table.rows.push_back({"deviation", "0", scientific(aliases[0].deviation, 3), scientific(aliases[1].deviation, 3)});
  report.tables.push_back(table);
  report.findings = {fmt::format("On these seven nodes the two functions are indistinguishable from P_4^1 by eye, as in the "
                                 "paper's plot, but not the same: they deviate by {:.1f} % and {:.1f} % (factors {:.4f} and {:.4f}).",
                                 100 * aliases[0].deviation, 100 * aliases[1].deviation, aliases[0].scale, aliases[1].scale)};
  render::Figure figure;
  figure.csv = "z,P_4_1,P_19_2_scaled,P_64_1_scaled\n";
  for (std::size_t k = 0; k < fine.size(); ++k)
    figure.csv += fmt::format("{:.10g},{:.10g},{:.10g},{:.10g}\n", fine[k], low[k], aliases[0].values[k], aliases[1].values[k]);
  figure.drawing = {510, 236, [=](cairo_t* cairo, const render::Font& font) {
                      const render::Theme theme = render::find_theme("paper");
                      const render::Pen pen{cairo, font, theme};
                      for (std::size_t k = 0; k < aliases.size(); ++k) {
                        const render::Panel panel{{-1, 1}, {-2.6, 2.6}, 50 + 240 * static_cast<double>(k), 30, 204, 160};
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
                            {{"P_{4}^{1}", render::curve_colour(0), {}, false},
                             {fmt::format("P_{{{}}}^{{{}}}", aliases[k].n, aliases[k].m), grey, {}, false}});
                      }
                    }};
  report.figure = std::move(figure);
  report.picture_text = "P_4^1 (blue) and a high function (grey) that takes its values at the seven nodes (dots).";
  return report;
}

Report reproduce_spectra(const Effort& effort) {
  const int p = effort.quick ? 8 : 16, q = effort.quick ? 24 : 64;
  const double end = effort.quick ? 0.2 : 4;
  // A shape that fills its band: a biconcave disc after some time in Poiseuille flow.
  sim::Scene scene;
  sim::FlowParameters flow;
  flow.kind = "poiseuille";
  flow.curvature = 0.1;
  scene.flows = {flow};
  sim::VesicleParameters vesicle;
  vesicle.shape = "biconcave";
  vesicle.reduced_volume = 0.65;
  vesicle.order = p;
  scene.vesicles = {vesicle};
  sim::Plans plans;
  const sim::Model model = sim::make_model(scene, plans);
  sim::Dynamics dynamics = sim::initial_dynamics(model);
  while (dynamics.time < end * (1 - 1e-9)) {
    stop_if_interrupted();
    effort.progress.show(dynamics.time / end, "the shape");
    dynamics = sim::take_step(model, dynamics, 0.05).value().dynamics;
  }
  sim::Coefficients x = dynamics.vesicles[0].position;
  const sim::Coefficients fine = sim::resized(x, q), h = sim::mean_curvature(plans, fine, q);
  // The same from the p-grid alone: everything above p is folded back.
  const sim::Coefficients folded = sim::mean_curvature(plans, x, p);
  TextTable table{"", {"n", "E_n(x)", "E_n(H)", "E_n(H) from the p-grid"}, {}};
  std::vector<double> degrees, of_x, of_h, of_folded;
  for (int n = 0; n <= q; ++n) {
    degrees.push_back(n);
    of_x.push_back(n <= p ? sim::modular_norm(x, n) : std::nan(""));
    of_h.push_back(sim::modular_norm(h, n));
    of_folded.push_back(n <= p ? sim::modular_norm(folded, n) : std::nan(""));
    table.rows.push_back({std::to_string(n), scientific(of_x.back(), 6), scientific(of_h.back(), 6), scientific(of_folded.back(), 6)});
  }
  Report report;
  report.title = "Figure 3: spectra of position and mean curvature";
  report.setting = {fmt::format("The paper's shape is only pictured; ours is a biconcave disc, ν = 0.65, p = {}, κ_b = 0.01, λ = 1, after "
                                "t = {} in the Poiseuille flow u_x = −0.1 (y² + z²) (bdf2, Δt = 0.05).", p, end),
                    fmt::format("E_n of Eq. (18): norm of the coefficients of degree n; H computed on the {}-grid.", q)};
  const double in_band = (folded.values - sim::resized(h, p).values).norm() / sim::resized(h, p).values.norm();
  report.findings = {fmt::format("x ends at n = {}; at n = {} H has still {} of its largest E_n. Taken from the {}-grid alone, H "
                                 "is wrong by {} in its coefficients n ≤ {}.", p, q, scientific(of_h.back() / *std::max_element(of_h.begin(), of_h.end())),
                                 p, scientific(in_band), p)};
  render::Figure figure;
  figure.csv = csv_text(table);
  std::vector<double> all = of_h;
  for (const double v : of_x)
    if (v > 1e-12) all.push_back(v);
  for (double& v : of_x)
    if (v < 1e-12) v = std::nan("");  // odd or even degrees that symmetry empties
  for (double& v : all) v = std::max(v, 1e-12);
  const auto curves = render::cut(x, {.origin = render::CutPlane().origin});
  figure.drawing = {400, 300, [=](cairo_t* cairo, const render::Font& font) {
                      const render::Theme theme = render::find_theme("paper");
                      const render::Pen pen{cairo, font, theme};
                      const render::Panel panel{{0, static_cast<double>(q)}, render::decades(all), 66, 16, 318, 232};
                      const auto show = [&](const std::vector<double>& values, std::size_t c) {
                        std::vector<double> n, y;
                        for (std::size_t k = 0; k < values.size(); ++k)
                          if (values[k] > 1e-12) {
                            n.push_back(degrees[k]);
                            y.push_back(std::log10(values[k]));
                          }
                        render::draw_polyline(pen, panel, n, y, {render::curve_colour(c), 0.75});
                        render::draw_markers(pen, panel, n, y, render::Marker::dot, render::curve_colour(c), 1.25);
                      };
                      show(of_h, 1);
                      show(of_x, 0);
                      render::Axes axes;
                      axes.x.label = "degree n";
                      axes.y.label = "E_{n}";
                      axes.y.scale = render::Scale::logarithmic;
                      render::draw_axes(pen, panel, axes);
                      // The section of the shape, in the upper right.
                      render::Panel inset{{-1.7, 1.7}, {-1.7, 1.7}, panel.left + panel.width - 92, panel.top + 8, 84, 84};
                      for (const render::ClosedCurve& curve : curves) {
                        const Eigen::Vector2d middle = 0.5 * (curve.points.colwise().maxCoeff() + curve.points.colwise().minCoeff()).transpose();
                        render::draw_closed_curve(pen, inset, curve, -middle, {{0.25, 0.28, 0.33}, 0.75}, 0.12);
                      }
                      render::draw_legend(pen, panel,
                                          {{"position x", render::curve_colour(0), {}, false},
                                           {"mean curvature H", render::curve_colour(1), {}, false}},
                                          render::Corner::lower_left);
                    }};
  TextTable excerpt{"Every eighth degree.", table.columns, {}};
  for (std::size_t n = 0; n < table.rows.size(); n += 8) excerpt.rows.push_back(table.rows[n]);
  report.tables.push_back(excerpt);
  report.figure = std::move(figure);
  report.picture_text = "Modular norms of position and mean curvature, and the section of the shape.";
  return report;
}

}  // namespace app
