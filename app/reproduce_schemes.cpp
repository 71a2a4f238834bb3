// Tables 4 and 5 and Figure 5: how far the time stepping schemes carry, and what they cost.
#include "reproduce_items.h"
#include "render/plot_marks.h"

#include "sim/shapes.h"
#include "sim/stepper.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace app {

namespace {

constexpr double paper_step = 0.21, sqrt_half = 0.70710678118654752440;

/// The ladder of steps: 0.21 times powers of sqrt(2); rung 0 is 0.21.
double rung_step(int rung) { return paper_step * std::pow(sqrt_half, rung); }

struct FixedRun {
  bool stable = false;
  std::string reason;
  double time = 0;
  double area_error = 0;  ///< largest of the vesicles at the end
  double gap = std::numeric_limits<double>::infinity();  ///< smallest on the way
};

/// Equal steps of the scene's scheme to time `end`, none repeated.
FixedRun run_fixed(const sim::Scene& scene, sim::Plans& plans, double step, double end) {
  FixedRun run;
  const sim::Setting setting = sim::make_setting(scene, plans);
  sim::Dynamics dynamics = sim::initial_dynamics(setting);
  try {
    while (dynamics.time < end * (1 - 1e-12)) {
      stop_if_interrupted();
      sim::Step taken = sim::take_step(setting, dynamics, step);
      dynamics = std::move(taken.dynamics);
      run.time = dynamics.time;
      run.gap = std::min(run.gap, taken.record.gap);
      run.area_error = 0;
      for (const sim::VesicleStep& vesicle : taken.record.vesicles)
        run.area_error = std::max(run.area_error, std::abs(vesicle.area_error));
    }
    run.stable = true;
  } catch (const sim::StepFailure& failure) {
    run.reason = failure.what();
  }
  return run;
}

struct Ladder {
  int first = -4, last = 0;  ///< rungs, coarse to fine
};

struct StableStep {
  double step = std::numeric_limits<double>::quiet_NaN();  ///< largest on the ladder without a stop; not a number: none
  bool top = false;                                        ///< ... and no larger one was tried
  double tried = 0;                                        ///< the smallest step tried
  std::string reason;                                      ///< why the next larger one stopped
  FixedRun run;
};

/// From the coarsest rung down: a run that will not live ends early, so this is cheaper than bisection from below.
StableStep stable_step(const sim::Scene& scene, sim::Plans& plans, const Ladder& ladder, double end, const Effort& effort,
                       const std::string& what) {
  StableStep result;
  for (int rung = ladder.first; rung <= ladder.last; ++rung) {
    result.tried = rung_step(rung);
    effort.progress.show(0.5, fmt::format("{}, χΔt = {:.2g}", what, result.tried));
    result.run = run_fixed(scene, plans, result.tried, end);
    if (result.run.stable) {
      result.step = result.tried;
      result.top = rung == ladder.first;
      return result;
    }
    result.reason = fmt::format("t = {:.3g}: {}", result.run.time, result.run.reason);
  }
  return result;
}

std::string cell_of(const StableStep& s) {
  if (!std::isfinite(s.step)) return fmt::format("< {}", scientific(s.tried));
  return fmt::format("{}{}", s.top ? "≥ " : "", scientific(s.step));
}

double fitted_slope(const std::vector<double>& x, const std::vector<double>& y) {
  double mean_x = 0, mean_y = 0, top = 0, bottom = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    mean_x += x[k] / static_cast<double>(x.size());
    mean_y += y[k] / static_cast<double>(y.size());
  }
  for (std::size_t k = 0; k < x.size(); ++k) {
    top += (x[k] - mean_x) * (y[k] - mean_y);
    bottom += (x[k] - mean_x) * (x[k] - mean_x);
  }
  return top / bottom;
}

std::vector<int> orders_of(const Effort& effort) {
  if (effort.quick) return {6};
  if (effort.full) return {8, 12, 16, 24, 32};
  return {8, 12, 16};
}

std::vector<std::string> order_columns(const std::vector<int>& orders, std::vector<std::string> before) {
  for (const int p : orders) before.push_back(fmt::format("p = {}", p));
  return before;
}

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

constexpr const char* prolate_text = "One vesicle: prolate, ν = 0.85, area 4π, long axis along x, in the shear flow u = χ z "
                                     "e_x, κ_b = 0.01, χ = 1 (lengths in R_0: the paper does not state its own).";
constexpr const char* pair_text = "Two vesicles: two such prolates, λ = 10, centres ∓(1.2, 0, −0.5).";

}  // namespace

Report reproduce_stable_steps(const Effort& effort) {
  struct Row {
    const char* scheme;
    double contrast;
    Ladder ladder;
    bool correction;
    const char* paper;
    double modulus = 0.01;
  };
  const std::vector<Row> rows = effort.quick ? std::vector<Row>{{"explicit", 1, {0, 2}, false, "2.7e-2 at p = 8"},
                                                                {"globally-implicit", 10, {0, 0}, true, "2.1e-1"}}
                                             : std::vector<Row>{{"explicit", 1, {-4, 20}, false, "2.7e-2, 6.7e-3, 1.7e-3, 8.4e-4, 2.1e-4"},
                                                                {"explicit", 1, {-4, 20}, false, "", 0.1},
                                                                {"block-jacobi", 1, {-4, 10}, true, "5.4e-2"},
                                                                {"block-jacobi", 4, {-4, 10}, true, ""},
                                                                {"block-jacobi", 10, {-4, 10}, true, ""},
                                                                {"globally-implicit", 1, {-2, 4}, true, "2.1e-1"},
                                                                {"globally-implicit", 4, {-2, 4}, true, "2.1e-1"},
                                                                {"globally-implicit", 10, {-2, 4}, true, "2.1e-1"},
                                                                {"bdf2", 1, {-2, 4}, true, ""},
                                                                {"bdf2", 4, {-2, 4}, true, ""},
                                                                {"bdf2", 10, {-2, 4}, true, ""}};
  const std::vector<int> orders = orders_of(effort);
  const double end = effort.quick ? 1 : 10;
  sim::Plans plans;
  Report report;
  report.title = "Table 4: stable time steps";
  report.setting = {prolate_text, pair_text,
                    fmt::format("Stable: steps of one length to T = {}/χ without a stop (GMRES, |ΔA| ≤ 2 % and |ΔE| ≤ 50 % a "
                                "step, gap, area correction). Steps are 0.21 times powers of √2, from the largest downward.", end),
                    "Linear solves to 1e-8, aliasing tolerance 1e-4, reparametrization when due. Area and volume correction off "
                    "for the explicit scheme, as in the paper, on for the others; its effect is the second table."};
  TextTable stable{"Largest stable χΔt on the ladder; ≥: larger steps were not tried, <: none so large is stable.",
                   order_columns(orders, {"scheme", "λ", "κ_b"}), {}};
  stable.columns.push_back("paper (p = 8, 12, 16, 24, 32)");
  TextTable errors{"Relative error of the area at T with that step and no correction; 'stops' where the run then stops.",
                   order_columns(orders, {"scheme", "λ", "κ_b"}), {}};
  TextTable stops{"Why the next larger step stops.", {"scheme", "λ", "κ_b", "p", "at"}, {}};
  for (const Row& row : rows) {
    std::vector<std::string> cells{row.scheme, fmt::format("{}", row.contrast), fmt::format("{}", row.modulus)},
        error_cells = cells;
    Ladder ladder = row.ladder;
    std::vector<double> log_p, log_step;
    for (const int p : orders) {
      if (p > 16 && (std::string_view(row.scheme) == "explicit" || std::string_view(row.scheme) == "block-jacobi")) {  // hours
        cells.push_back("not run");
        error_cells.push_back("-");
        continue;
      }
      sim::Scene scene = sheared_prolate(p, row.contrast);
      scene.time.scheme = row.scheme;
      scene.time.end = end;
      scene.vesicles[0].bending_modulus = row.modulus;
      scene.numerics.gmres_tolerance = 1e-8;
      scene.numerics.correction = row.correction;
      const std::string what = fmt::format("{}, λ = {}, p = {}", row.scheme, row.contrast, p);
      const StableStep found = stable_step(scene, plans, ladder, end, effort, what);
      cells.push_back(cell_of(found));
      if (!found.reason.empty())
        stops.rows.push_back({row.scheme, fmt::format("{}", row.contrast), fmt::format("{}", row.modulus), std::to_string(p), found.reason});
      if (!std::isfinite(found.step)) {
        error_cells.push_back("-");
        continue;
      }
      FixedRun bare = found.run;
      if (row.correction) {
        scene.numerics.correction = false;
        bare = run_fixed(scene, plans, found.step, end);
      } else {
        log_p.push_back(std::log(p));
        log_step.push_back(std::log(found.step));
        ladder.first = std::max(row.ladder.first, static_cast<int>(std::lround(2 * std::log2(paper_step / found.step))) - 1);
      }
      error_cells.push_back(bare.stable ? scientific(bare.area_error) : fmt::format("stops at t = {:.2g}", bare.time));
    }
    if (log_p.size() > 1)
      report.findings.push_back(fmt::format("Explicit, κ_b = {}: a fit of Δt ~ p^-a gives a = {:.2f}, between the two highest orders "
                                            "{:.2f}; the paper's five values give 3.5.",
                                            row.modulus, -fitted_slope(log_p, log_step),
                                            -fitted_slope({log_p.end() - 2, log_p.end()}, {log_step.end() - 2, log_step.end()})));
    cells.push_back(row.paper);
    stable.rows.push_back(cells);
    errors.rows.push_back(error_cells);
  }
  report.tables = {stable, errors, stops};

  report.findings.push_back("For λ ≠ 1 the explicit scheme as printed has no double layer at all (in (43) and the update D x cancels "
                            "against r). Ours keeps that of the step before; it is shown for λ = 1 only, as in the paper.");
  TextTable pair{"Two vesicles, λ = 10.", {"scheme", "p", "stable χΔt", "smallest gap", "the next larger step stops", "paper"}, {}};
  const std::vector<int> pair_orders = effort.quick ? std::vector<int>{6} : effort.full ? std::vector<int>{8, 16} : std::vector<int>{8};
  struct PairRow {
    const char *scheme, *paper;
  };
  constexpr PairRow pair_rows[] = {{"block-jacobi", "none"}, {"block-implicit", "none"}, {"globally-implicit", "2.1e-1"}, {"bdf2", ""}};
  for (const PairRow& row : pair_rows)
    for (const int p : pair_orders) {
      if (effort.quick && std::string_view(row.scheme) != "bdf2") continue;
      sim::Scene scene = sheared_pair(p, 10);
      scene.time.scheme = row.scheme;
      scene.numerics.gmres_tolerance = 1e-8;
      const Ladder ladder = effort.quick ? Ladder{0, 0} : Ladder{-2, 4};
      const StableStep found = stable_step(scene, plans, ladder, end, effort, fmt::format("two vesicles, {}, p = {}", row.scheme, p));
      pair.rows.push_back({row.scheme, std::to_string(p), cell_of(found),
                           found.run.stable ? fmt::format("{:.3f}", found.run.gap) : "-",
                           found.reason.empty() ? "-" : found.reason, row.paper});
    }
  report.tables.push_back(pair);
  return report;
}

Report reproduce_cost(const Effort& effort) {
  const std::vector<int> orders = orders_of(effort);
  const double end = effort.quick ? 0.42 : 5.04;
  constexpr double bdf2_step = paper_step * 2 / 3;
  constexpr int parts = 4;  // steps of the motion from one multiple of 0.21 to the next
  const int every = effort.quick ? 1 : 4;
  constexpr double tolerances[] = {1e-4, 1e-6, 1e-8, 1e-10};
  struct Paper {
    double contrast;
    int singular[5], iterations[5];
  };
  constexpr Paper paper[] = {{1, {203, 258, 268, 283, 290}, {42, 54, 56, 59, 60}},
                             {4, {133, 138, 134, 136, 137}, {27, 28, 28, 28, 28}},
                             {10, {88, 82, 82, 84, 84}, {18, 17, 17, 17, 17}}};
  constexpr int paper_orders[] = {8, 12, 16, 24, 32};
  Report report;
  report.title = "Table 5: iterations and singular integrals";
  report.setting = {prolate_text,
                    fmt::format("The system of bdf2 at χΔt = 0.21 (c = 0.14), with operators at shapes {} time units apart on the way "
                                "to T = {}/χ; averages. The shapes come from bdf2 with χΔt = 0.0525 and area and volume correction: "
                                "none of them is spoilt by a step that is too long.", every * paper_step, end),
                    "Iterations of GMRES to the relative residual in the column's head, from zero or from the velocity and "
                    "tension 0.21 earlier; corrected spectral preconditioner. The paper does not state its tolerance.",
                    "Singular integrals per unit time, counted as the paper seems to: iterations / χΔt. Here S and D are "
                    "matrices, assembled once a step, so an iteration costs a product, not an integral."};
  TextTable table{"GMRES iterations per step.", {"λ", "p"}, {}};
  for (const double t : tolerances) table.columns.push_back(fmt::format("{}, zero guess", scientific(t, 1)));
  for (const double t : tolerances) table.columns.push_back(fmt::format("{}, last step", scientific(t, 1)));
  table.columns.insert(table.columns.end(), {"block self solve, 1e-8", "paper"});
  TextTable cost{"Singular integrals per unit time.", {"λ", "p", "1e-4", "1e-8", "paper"}, {}};
  sim::Plans plans;
  double most = 0, widest = 0, most_block = 0;
  for (const Paper& reference : paper) {
    double least_here = 1e300, most_here = 0;
    for (const int p : orders) {
      sim::Scene scene = sheared_prolate(p, reference.contrast);
      scene.time.scheme = "bdf2";
      const sim::Setting setting = sim::make_setting(scene, plans);
      sim::Dynamics dynamics = sim::initial_dynamics(setting);
      std::vector<double> sums(9, 0);
      int samples = 0;
      const int steps = static_cast<int>(std::lround(end / paper_step));
      for (int k = 0; k < steps; ++k) {
        stop_if_interrupted();
        effort.progress.show(static_cast<double>(k) / steps, fmt::format("λ = {}, p = {}", reference.contrast, p));
        const sim::Motion before = dynamics.vesicles[0].motion;
        for (int part = 0; part < parts; ++part) dynamics = sim::take_step(setting, dynamics, paper_step / parts).dynamics;
        if (k % every == every - 1) {
          const sim::VesicleDynamics& v = dynamics.vesicles[0];
          const std::vector<sim::Coefficients> x{v.position};
          const std::vector<int> rates{v.upsampling};
          const std::vector<sim::Coefficients> tensions{v.motion.tension};
          const sim::Suspension s = sim::freeze_suspension(plans, setting.materials, x, rates, {}, tensions);
          const auto r = sim::suspension_forcing(s, scene.flows, 0, sim::Vec3::Zero());
          const sim::Motion zero{{p, sim::Matrix::Zero(sim::coefficient_count(p), 3)},
                                 {p, sim::Matrix::Zero(sim::coefficient_count(p), 1)}};
          const std::vector<sim::Motion> from_zero{zero}, from_last{before};
          for (std::size_t t = 0; t < 4; ++t) {
            sums[t] += sim::solve_suspension(s, bdf2_step, r, from_zero, tolerances[t], sim::Preconditioner::spectral).iterations;
            sums[4 + t] += sim::solve_suspension(s, bdf2_step, r, from_last, tolerances[t], sim::Preconditioner::spectral).iterations;
          }
          sums[8] += sim::solve_suspension(s, bdf2_step, r, from_zero, 1e-8, sim::Preconditioner::block).iterations;
          ++samples;
        }
      }
      for (double& sum : sums) sum /= samples;
      least_here = std::min(least_here, sums[2]);
      most_here = std::max(most_here, sums[2]);
      most_block = std::max(most_block, sums[8]);
      std::string there = "-", there_cost = "-";
      for (int k = 0; k < 5; ++k)
        if (paper_orders[k] == p) {
          there = std::to_string(reference.iterations[k]);
          there_cost = std::to_string(reference.singular[k]);
        }
      std::vector<std::string> cells{fmt::format("{}", reference.contrast), std::to_string(p)};
      for (const double sum : sums) cells.push_back(fmt::format("{:.1f}", sum));
      cells.push_back(there);
      table.rows.push_back(cells);
      cost.rows.push_back({cells[0], cells[1], fmt::format("{:.0f}", sums[0] / paper_step),
                           fmt::format("{:.0f}", sums[2] / paper_step), there_cost});
    }
    most = std::max(most, most_here);
    widest = std::max(widest, most_here / least_here - 1);
  }
  report.tables = {table, cost};
  report.findings.push_back(fmt::format("At 1e-8 from zero: at most {:.1f} iterations (required: 30); for one λ they vary over p "
                                        "by at most {:.0f} % (required: less than a third). With the block self solve at most {:.1f}.",
                                        most, 100 * widest, most_block));

  // Two vesicles: the block self solve when they are far apart, and near.
  const int p = effort.quick ? 6 : 8;
  TextTable pair{fmt::format("Two vesicles side by side along x, λ = 10, p = {}: iterations to 1e-8 from zero.", p),
                 {"distance of the centres", "spectral", "block self solve"}, {}};
  for (const double distance : {100.0, 10.0, 5.0, 3.5}) {
    stop_if_interrupted();
    sim::Scene scene = sheared_pair(p, 10);
    scene.vesicles[0].center = {-distance / 2, 0, 0};
    scene.vesicles[1].center = {distance / 2, 0, 0};
    const sim::Setting setting = sim::make_setting(scene, plans);
    const sim::Dynamics d = sim::initial_dynamics(setting);
    const std::vector<sim::Coefficients> x{d.vesicles[0].position, d.vesicles[1].position};
    const std::vector<int> rates{d.vesicles[0].upsampling, d.vesicles[1].upsampling};
    const sim::Suspension s = sim::freeze_suspension(plans, setting.materials, x, rates, {});
    const auto r = sim::suspension_forcing(s, scene.flows, 0, sim::Vec3::Zero());
    const std::vector<sim::Motion> zero{d.vesicles[0].motion, d.vesicles[1].motion};
    pair.rows.push_back({fmt::format("{}", distance),
                         std::to_string(sim::solve_suspension(s, paper_step, r, zero, 1e-8, sim::Preconditioner::spectral).iterations),
                         std::to_string(sim::solve_suspension(s, paper_step, r, zero, 1e-8, sim::Preconditioner::block).iterations)});
  }
  report.tables.push_back(pair);
  return report;
}

Report reproduce_block_error(const Effort& effort) {
  const int p = effort.quick ? 6 : 12;
  const std::vector<double> gaps = effort.quick ? std::vector<double>{0.1, 1}
                                                : std::vector<double>{0.01, 0.02, 0.04, 0.08, 0.16, 0.32, 0.64, 1.28, 2.5, 5, 10};
  const std::vector<double> contrasts = effort.quick ? std::vector<double>{10} : std::vector<double>{1, 4, 10};
  Report report;
  report.title = "Figure 5: one block iteration against distance";
  report.setting = {"Two prolates, ν = 0.85, area 4π, long axes along x, one above the other along z (the paper's configuration is "
                    "only pictured), in the shear flow u = z e_x, κ_b = 0.01, χΔt = 0.21.",
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
      const sim::Setting setting = sim::make_setting(scene, plans);
      sim::Dynamics d = sim::initial_dynamics(setting);
      const sim::State now = sim::evaluate(setting, d);
      for (std::size_t k = 0; k < 2; ++k) d.vesicles[k].motion = {now.vesicles[k].velocity, now.vesicles[k].tension};
      const auto advance = [&](const char* scheme) {
        return sim::find_row(sim::scheme_catalogue(), scheme)->function(setting, d, paper_step);
      };
      const sim::Advance exact = advance("globally-implicit");
      const auto error_of = [&](const sim::Advance& block) {
        double difference = 0, size = 0;
        for (std::size_t k = 0; k < 2; ++k) {
          difference += (block.positions[k].values - exact.positions[k].values).squaredNorm() +
                        (block.motions[k].tension.values - exact.motions[k].tension.values).squaredNorm();
          size += exact.positions[k].values.squaredNorm() + exact.motions[k].tension.values.squaredNorm();
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
