// Figure 5: error of one block iteration against distance.
#include "app/reproduce/reproduce_items.h"

#include "render/figures/plot_legend.h"
#include "sim/stepping/stepper.h"
#include "sim/surface/shapes.h"

#include <fmt/format.h>

#include <array>
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

/// What the figure and the table show.
struct Errors {
  std::vector<double> gaps, contrasts;      ///< lengths in R_0; viscosity contrasts
  std::vector<std::vector<double>> values;  ///< contrast, gap: relative error of one block iteration
  double lagged = 0;                        ///< largest with the double layer of the velocities before
};

/// Relative, of the coefficients of position and tension.
double difference(const sim::Advance& is, const sim::Advance& should) {
  double difference = 0, size = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const sim::Moved &a = is.vesicles[k], &b = should.vesicles[k];
    difference += (a.position.values - b.position.values).squaredNorm() +
                  (a.motion.tension.values - b.motion.tension.values).squaredNorm();
    size += b.position.values.squaredNorm() + b.motion.tension.values.squaredNorm();
  }
  return std::sqrt(difference / size);
}

/// Adds the errors of one gap and contrast.
void measure(Errors& errors, sim::Plans& plans, int p, double gap, std::size_t contrast) {
  const double half = sim::spheroid_axes(0.85, true)[1];
  sim::Scene scene = sheared_pair(p, errors.contrasts[contrast]);
  scene.vesicles[0].center = {0, 0, half + gap / 2};
  scene.vesicles[1].center = {0, 0, -half - gap / 2};
  scene.numerics.gmres_tolerance = 1e-11;
  const sim::Model model = sim::make_model(scene, plans);
  sim::Dynamics d = sim::initial_dynamics(model);
  const sim::State now = sim::evaluate(model, d).value();
  for (std::size_t k = 0; k < 2; ++k) d.vesicles[k].motion = {now.vesicles[k].velocity, now.vesicles[k].tension};
  const auto advance = [&](const char* scheme) {
    return sim::find_row(sim::scheme_catalogue(), scheme)
        ->function.advance({model, d, paper_step, scene.flows})
        .value();
  };
  const sim::Advance exact = advance("globally-implicit");
  errors.lagged = std::max(errors.lagged, difference(advance("block-implicit"), exact));
  for (sim::VesicleDynamics& v : d.vesicles) v.motion.velocity.values.setZero();
  errors.values[contrast].push_back(difference(advance("block-implicit"), exact));
}

Errors measured_errors(int p, const Effort& effort) {
  Errors errors;
  errors.gaps = effort.quick ? std::vector<double>{0.1, 1}
                             : std::vector<double>{0.01, 0.02, 0.04, 0.08, 0.16, 0.32, 0.64, 1.28, 2.5, 5, 10};
  errors.contrasts = effort.quick ? std::vector<double>{10} : std::vector<double>{1, 4, 10};
  errors.values.resize(errors.contrasts.size());
  sim::Plans plans;
  for (std::size_t k = 0; k < errors.gaps.size(); ++k)
    for (std::size_t c = 0; c < errors.contrasts.size(); ++c) {
      stop_if_interrupted();
      effort.progress.show(static_cast<double>(k) / static_cast<double>(errors.gaps.size()),
                           fmt::format("gap {:g}, λ = {}", errors.gaps[k], errors.contrasts[c]));
      measure(errors, plans, p, errors.gaps[k], c);
    }
  return errors;
}

TextTable table_of(const Errors& errors) {
  TextTable table{
      .caption = "Relative error ‖y⁺ − y*‖/‖y*‖ of the coefficients.", .columns = {"gap / R_0"}, .rows = {}};
  for (const double contrast : errors.contrasts) table.columns.push_back(fmt::format("λ = {}", contrast));
  for (std::size_t k = 0; k < errors.gaps.size(); ++k) {
    std::vector<std::string>& cells = table.rows.emplace_back();
    cells.push_back(fmt::format("{:g}", errors.gaps[k]));
    for (const std::vector<double>& of_contrast : errors.values) cells.push_back(scientific(of_contrast[k], 3));
  }
  return table;
}

void draw(const render::Pen& pen, const Errors& errors) {
  std::vector<double> all;
  for (const std::vector<double>& of_contrast : errors.values)
    all.insert(all.end(), of_contrast.begin(), of_contrast.end());
  const render::Panel panel{
      .x = render::decades(errors.gaps), .y = render::decades(all), .left = 66, .top = 16, .width = 276, .height = 232};
  constexpr std::array markers{render::Marker::dot, render::Marker::square, render::Marker::triangle};
  std::vector<render::LegendEntry> legend;
  for (std::size_t c = 0; c < errors.values.size(); ++c) {
    const auto x = render::logarithms(errors.gaps), y = render::logarithms(errors.values[c]);
    render::draw_polyline(pen, panel, x, y, {render::curve_colour(c)});
    render::draw_markers(pen, panel, x, y, markers[c % markers.size()], render::curve_colour(c), 1.5);
    legend.push_back(
        {fmt::format("λ = {}", errors.contrasts[c]), render::curve_colour(c), markers[c % markers.size()]});
  }
  const render::Axes axes{.x = {.label = "gap / R_{0}", .scale = render::Scale::logarithmic},
                          .y = {.label = "relative error", .scale = render::Scale::logarithmic}};
  render::draw_axes(pen, panel, axes);
  render::draw_legend(pen, panel, legend, render::Corner::lower_left);
  draw_configuration(pen, panel.left + panel.width - 40, panel.top + 34, 14);
}

}  // namespace

Report reproduce_block_error(const Effort& effort) {
  const int p = effort.quick ? 6 : 12;
  const Errors errors = measured_errors(p, effort);
  const TextTable table = table_of(errors);
  Report report;
  report.title = "Figure 5: one block iteration against distance";
  report.setting = {
      "Two prolates, ν = 0.85, area 4π, long axes along x, one above the other along z (the paper's configuration is "
      "only pictured), in the shear flow u = z e_x, κ_b = 0.01, γ̇Δt = 0.21.",
      fmt::format("p = {}. y = (x, σ): y* solves the coupled system (40) to 1e-11, y⁺ is one block Jacobi iteration "
                  "from the present x_n, at rest, and the tension that solves (3) there.",
                  p)};
  report.tables = {table};
  report.findings = {
      fmt::format("With the double layer of the velocities that solve (3) there, as our block-implicit scheme "
                  "takes it from the step before, no error above is larger than {}.",
                  scientific(errors.lagged))};
  render::Figure& figure = report.figure.emplace();
  figure.csv = csv_text(table);
  figure.drawing = {.width = 360, .height = 300, .paint = [errors](cairo_t* cairo, const render::Font& font) {
                      const render::Theme theme = render::find_theme("paper");
                      draw({cairo, font, theme}, errors);
                    }};
  report.picture_text = "Relative error of (x⁺, σ⁺) after one block Jacobi iteration against the gap of two vesicles.";
  return report;
}

}  // namespace app
