// Figure 5: error of one block iteration against distance.
#include "app/reproduce/reproduce_items.h"

#include "render/figures/plot_marks.h"
#include "sim/surface/shapes.h"
#include "sim/stepping/stepper.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace app {

namespace {

/// Two prolates one above the other, the gap between them marked; R_0 is `unit` points.
void draw_configuration(const render::Pen& pen, double x, double y, double unit) {
  cairo_t* cairo = pen.cairo;
  const sim::Vec3 axes = unit * sim::spheroid_axes(0.85, true);
  constexpr double half_gap = 6;  // pt
  for (const double side : {-1.0, 1.0}) {
    cairo_save(cairo);
    cairo_translate(cairo, x, y + side * (half_gap + axes[1]));
    cairo_scale(cairo, axes[0], axes[1]);
    cairo_new_path(cairo);
    cairo_arc(cairo, 0, 0, 1, 0, 2 * std::numbers::pi);
    cairo_restore(cairo);
    cairo_set_source_rgb(cairo, 0.90, 0.91, 0.93);
    cairo_fill_preserve(cairo);
    cairo_set_source_rgb(cairo, 0.25, 0.28, 0.33);
    cairo_set_line_width(cairo, 1);
    cairo_stroke(cairo);
  }
  cairo_set_source_rgb(cairo, 0.10, 0.10, 0.12);
  cairo_move_to(cairo, x, y - half_gap);
  cairo_line_to(cairo, x, y + half_gap);
  cairo_stroke(cairo);
  render::draw_text(cairo, pen.font, pen.theme.text, x + 6, y + 0.36 * pen.theme.text, "gap");
}

}  // namespace

Report reproduce_block_error(const Effort& effort) {
  const int p = effort.quick ? 6 : 12;
  const std::vector<double> gaps = effort.quick ? std::vector<double>{0.1, 1}
                                                : std::vector<double>{0.01, 0.02, 0.04, 0.08, 0.16, 0.32, 0.64, 1.28, 2.5, 5, 10};
  const std::vector<double> contrasts = effort.quick ? std::vector<double>{10} : std::vector<double>{1, 4, 10};
  Report report;
  report.title = "Figure 5: one block iteration against distance";
  report.setting = {"Two prolates, ν = 0.85, area 4π, long axes along x, one above the other along z (the paper's configuration is "
                    "only pictured), in the shear flow u = z e_x, κ_b = 0.01, γ̇Δt = 0.21.",
                    fmt::format("p = {}. y = (x, σ): y* solves the coupled system (40) to 1e-11, y⁺ is one block Jacobi iteration "
                                "from the present x_n, at rest, and the tension that solves (3) there.", p)};
  TextTable table{"Relative error ‖y⁺ − y*‖/‖y*‖ of the coefficients.", {"gap / R_0"}, {}};
  for (const double contrast : contrasts) table.columns.push_back(fmt::format("λ = {}", contrast));
  sim::Plans plans;
  std::vector<std::vector<double>> errors(contrasts.size());
  double lagged = 0;
  const double half = sim::spheroid_axes(0.85, true)[1];
  for (const double gap : gaps) {
    std::vector<std::string> cells{fmt::format("{:g}", gap)};
    for (std::size_t c = 0; c < contrasts.size(); ++c) {
      stop_if_interrupted();
      effort.progress.show(static_cast<double>(&gap - gaps.data()) / static_cast<double>(gaps.size()),
                           fmt::format("gap {:g}, λ = {}", gap, contrasts[c]));
      sim::Scene scene = sheared_pair(p, contrasts[c]);
      scene.vesicles[0].center = {0, 0, half + gap / 2};
      scene.vesicles[1].center = {0, 0, -half - gap / 2};
      scene.numerics.gmres_tolerance = 1e-11;
      const sim::Model model = sim::make_model(scene, plans);
      sim::Dynamics d = sim::initial_dynamics(model);
      const sim::State now = sim::evaluate(model, d).value();
      for (std::size_t k = 0; k < 2; ++k) d.vesicles[k].motion = {now.vesicles[k].velocity, now.vesicles[k].tension};
      const auto advance = [&](const char* scheme) {
        return sim::find_row(sim::scheme_catalogue(), scheme)->function.advance({model, d, paper_step, scene.flows}).value();
      };
      const sim::Advance exact = advance("globally-implicit");
      const auto error_of = [&](const sim::Advance& block) {
        double difference = 0, size = 0;
        for (std::size_t k = 0; k < 2; ++k) {
          const sim::Moved &is = block.vesicles[k], &should = exact.vesicles[k];
          difference += (is.position.values - should.position.values).squaredNorm() +
                        (is.motion.tension.values - should.motion.tension.values).squaredNorm();
          size += should.position.values.squaredNorm() + should.motion.tension.values.squaredNorm();
        }
        return std::sqrt(difference / size);
      };
      lagged = std::max(lagged, error_of(advance("block-implicit")));
      for (sim::VesicleDynamics& v : d.vesicles) v.motion.velocity.values.setZero();
      errors[c].push_back(error_of(advance("block-implicit")));
      cells.push_back(scientific(errors[c].back(), 3));
    }
    table.rows.push_back(cells);
  }
  report.tables.push_back(table);
  report.findings.push_back(fmt::format("With the double layer of the velocities that solve (3) there, as our block-implicit scheme "
                                        "takes it from the step before, no error above is larger than {}.", scientific(lagged)));

  std::vector<double> all;
  for (const auto& e : errors) all.insert(all.end(), e.begin(), e.end());
  render::Figure figure;
  figure.csv = csv_text(table);
  figure.drawing = {360, 300, [=](cairo_t* cairo, const render::Font& font) {
                      const render::Theme theme = render::find_theme("paper");
                      const render::Pen pen{cairo, font, theme};
                      const render::Panel panel{render::decades(gaps), render::decades(all), 66, 16, 276, 232};
                      std::vector<render::LegendEntry> legend;
                      for (std::size_t c = 0; c < errors.size(); ++c) {
                        const auto x = render::logarithms(gaps), y = render::logarithms(errors[c]);
                        render::draw_polyline(pen, panel, x, y, {render::curve_colour(c)});
                        render::draw_markers(pen, panel, x, y, render::Marker::dot, render::curve_colour(c), 1.5);
                        legend.push_back({fmt::format("λ = {}", contrasts[c]), render::curve_colour(c), {}, false});
                      }
                      const render::Axes axes{{"gap / R_{0}", render::Scale::logarithmic, true, false},
                                              {"relative error", render::Scale::logarithmic, true, false}, 0};
                      render::draw_axes(pen, panel, axes);
                      render::draw_legend(pen, panel, legend, render::Corner::lower_left);
                      draw_configuration(pen, panel.left + panel.width - 40, panel.top + 34, 14);
                    }};
  report.figure = std::move(figure);
  report.picture_text = "Relative error of (x⁺, σ⁺) after one block Jacobi iteration against the gap of two vesicles.";
  return report;
}

}  // namespace app
