// Table 4: stable time steps of the schemes.
#include "app/reproduce/reproduce_items.h"

#include "sim/stepping/stepper.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace app {

const char* const prolate_setting =
    "One vesicle: prolate, ν = 0.85, area 4π, long axis along x, in the shear flow u = γ̇ z "
    "e_x, κ_b = 0.01, γ̇ = 1 (lengths in R_0: the paper does not state its own).";

std::vector<int> table_orders(const Effort& effort) {
  if (effort.quick) return {6};
  if (effort.full) return {8, 12, 16, 24, 32};
  return {8, 12, 16};
}

namespace {

constexpr double sqrt_half = 0.70710678118654752440;

/// The ladder of steps: 0.21 times powers of sqrt(2); rung 0 is 0.21.
double rung_step(int rung) { return paper_step * std::pow(sqrt_half, rung); }

struct FixedRun {
  bool stable = false;
  std::string reason;
  double time = 0;
  double area_error = 0;                                 ///< largest of the vesicles at the end
  double gap = std::numeric_limits<double>::infinity();  ///< smallest on the way
};

/// Equal steps of the scene's scheme to time `end`, none repeated.
FixedRun run_fixed(const sim::Scene& scene, sim::Plans& plans, double step, double end) {
  FixedRun run;
  const sim::Model model = sim::make_model(scene, plans);
  sim::Dynamics dynamics = sim::initial_dynamics(model);
  while (dynamics.time < end * (1 - 1e-12)) {
    stop_if_interrupted();
    sim::Attempt<sim::Step> taken = sim::take_step(model, dynamics, step);
    if (!taken) {
      run.reason = taken.rejection().reason;
      return run;
    }
    dynamics = std::move(taken->dynamics);
    run.time = dynamics.time;
    run.gap = std::min(run.gap, taken->record.gap);
    run.area_error = 0;
    for (const sim::VesicleStep& vesicle : taken->record.vesicles)
      run.area_error = std::max(run.area_error, std::abs(vesicle.area_error));
  }
  run.stable = true;
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
StableStep stable_step(const sim::Scene& scene, sim::Plans& plans, const Ladder& ladder, double end,
                       const Effort& effort, const std::string& what) {
  StableStep result;
  for (int rung = ladder.first; rung <= ladder.last; ++rung) {
    result.tried = rung_step(rung);
    effort.progress.show(0.5, fmt::format("{}, γ̇Δt = {:.2g}", what, result.tried));
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

std::vector<std::string> order_columns(const std::vector<int>& orders, std::vector<std::string> before) {
  for (const int p : orders) before.push_back(fmt::format("p = {}", p));
  return before;
}

constexpr const char* pair_text = "Two vesicles: two such prolates, λ = 10, centres ∓(1.2, 0, −0.5).";

/// A row of the first table: a scheme at one viscosity contrast.
struct SchemeRow {
  const char* scheme;
  double contrast;
  Ladder ladder;
  bool correction;    ///< of area and volume
  const char* paper;  ///< its steps
  double modulus = 0.01;

  bool slow() const { return std::string_view(scheme) == "explicit" || std::string_view(scheme) == "block-jacobi"; }
};

std::vector<SchemeRow> scheme_rows(const Effort& effort) {
  if (effort.quick)
    return {{"explicit", 1, {0, 2}, false, "2.7e-2 at p = 8"}, {"globally-implicit", 10, {0, 0}, true, "2.1e-1"}};
  return {{"explicit", 1, {-4, 20}, false, "2.7e-2, 6.7e-3, 1.7e-3, 8.4e-4, 2.1e-4"},
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
}

/// Logarithms of orders and of their stable steps.
struct Fit {
  std::vector<double> log_p, log_step;
};

std::string fit_text(const Fit& fit, double modulus) {
  const Fit last{.log_p = {fit.log_p.end() - 2, fit.log_p.end()},
                 .log_step = {fit.log_step.end() - 2, fit.log_step.end()}};
  return fmt::format(
      "Explicit, κ_b = {}: a fit of Δt ~ p^-a gives a = {:.2f}, between the two highest orders "
      "{:.2f}; the paper's five values give 3.5.",
      modulus, -fitted_slope(fit.log_p, fit.log_step), -fitted_slope(last.log_p, last.log_step));
}

/// The tables of one vesicle.
struct StepTables {
  TextTable stable, errors, stops;
};

StepTables empty_tables(const std::vector<int>& orders) {
  StepTables tables;
  tables.stable = {
      .caption = "Largest stable γ̇Δt on the ladder; ≥: larger steps were not tried, <: none so large is stable.",
      .columns = order_columns(orders, {"scheme", "λ", "κ_b"}),
      .rows = {}};
  tables.stable.columns.emplace_back("paper (p = 8, 12, 16, 24, 32)");
  tables.errors = {
      .caption = "Relative error of the area at T with that step and no correction; 'stops' where the run then stops.",
      .columns = order_columns(orders, {"scheme", "λ", "κ_b"}),
      .rows = {}};
  tables.stops = {
      .caption = "Why the next larger step stops.", .columns = {"scheme", "λ", "κ_b", "p", "at"}, .rows = {}};
  return tables;
}

sim::Scene scene_of(const SchemeRow& row, int p, double end) {
  sim::Scene scene = sheared_prolate(p, row.contrast);
  scene.time.scheme = row.scheme;
  scene.time.step = 0.1;  // of the start; the steps are chosen here
  scene.time.end = end;
  scene.vesicles[0].bending_modulus = row.modulus;
  scene.numerics.gmres_tolerance = 1e-8;
  scene.numerics.correction = row.correction;
  return scene;
}

/// Adds a row to each table. Runs without correction go into the fit.
Fit add_row(StepTables& tables, const SchemeRow& row, sim::Plans& plans, double end, const Effort& effort) {
  std::vector<std::string> cells{row.scheme, fmt::format("{}", row.contrast), fmt::format("{}", row.modulus)},
      error_cells = cells;
  Ladder ladder = row.ladder;
  Fit fit;
  for (const int p : table_orders(effort)) {
    if (p > 16 && row.slow()) {  // hours
      cells.push_back("not run");
      error_cells.push_back("-");
      continue;
    }
    sim::Scene scene = scene_of(row, p, end);
    const std::string what = fmt::format("{}, λ = {}, p = {}", row.scheme, row.contrast, p);
    const StableStep found = stable_step(scene, plans, ladder, end, effort, what);
    cells.push_back(cell_of(found));
    if (!found.reason.empty())
      tables.stops.rows.push_back({cells[0], cells[1], cells[2], std::to_string(p), found.reason});
    if (!std::isfinite(found.step)) {
      error_cells.push_back("-");
      continue;
    }
    FixedRun bare = found.run;
    if (row.correction) {
      scene.numerics.correction = false;
      bare = run_fixed(scene, plans, found.step, end);
    } else {
      fit.log_p.push_back(std::log(p));
      fit.log_step.push_back(std::log(found.step));
      ladder.first =
          std::max(row.ladder.first, static_cast<int>(std::lround(2 * std::log2(paper_step / found.step))) - 1);
    }
    error_cells.push_back(bare.stable ? scientific(bare.area_error) : fmt::format("stops at t = {:.2g}", bare.time));
  }
  cells.push_back(row.paper);
  tables.stable.rows.push_back(cells);
  tables.errors.rows.push_back(error_cells);
  return fit;
}

TextTable pair_table(sim::Plans& plans, double end, const Effort& effort) {
  struct PairRow {
    const char *scheme, *paper;
  };
  constexpr PairRow rows[] = {
      {"block-jacobi", "none"}, {"block-implicit", "none"}, {"globally-implicit", "2.1e-1"}, {"bdf2", ""}};
  const std::vector<int> orders = effort.quick  ? std::vector<int>{6}
                                  : effort.full ? std::vector<int>{8, 16}
                                                : std::vector<int>{8};
  const Ladder ladder = effort.quick ? Ladder{0, 0} : Ladder{-2, 4};
  TextTable table{.caption = "Two vesicles, λ = 10.",
                  .columns = {"scheme", "p", "stable γ̇Δt", "smallest gap", "the next larger step stops", "paper"},
                  .rows = {}};
  for (const PairRow& row : rows)
    for (const int p : orders) {
      if (effort.quick && std::string_view(row.scheme) != "bdf2") continue;
      sim::Scene scene = sheared_pair(p, 10);
      scene.time.scheme = row.scheme;
      scene.time.step = 0.1;  // of the start; the steps are chosen here
      scene.numerics.gmres_tolerance = 1e-8;
      const StableStep found =
          stable_step(scene, plans, ladder, end, effort, fmt::format("two vesicles, {}, p = {}", row.scheme, p));
      table.rows.push_back({row.scheme, std::to_string(p), cell_of(found),
                            found.run.stable ? fmt::format("{:.3f}", found.run.gap) : "-",
                            found.reason.empty() ? "-" : found.reason, row.paper});
    }
  return table;
}

}  // namespace

Report reproduce_stable_steps(const Effort& effort) {
  const double end = effort.quick ? 1 : 10;
  sim::Plans plans;
  Report report;
  report.title = "Table 4: stable time steps";
  report.setting = {
      prolate_setting, pair_text,
      fmt::format("Stable: steps of one length to T = {}/γ̇ without a stop (GMRES, |ΔA| ≤ 2 % and |ΔE| ≤ 50 % a "
                  "step, gap, area correction). Steps are 0.21 times powers of √2, from the largest downward.",
                  end),
      "Linear solves to 1e-8, aliasing tolerance 1e-4, reparametrization when due. Area and volume correction off "
      "for the explicit scheme, as in the paper, on for the others; its effect is the second table."};
  StepTables tables = empty_tables(table_orders(effort));
  for (const SchemeRow& row : scheme_rows(effort)) {
    const Fit fit = add_row(tables, row, plans, end, effort);
    if (fit.log_p.size() > 1) report.findings.push_back(fit_text(fit, row.modulus));
  }
  report.findings.emplace_back(
      "For λ ≠ 1 the explicit scheme as printed has no double layer at all (in (43) and the update D x cancels "
      "against r). Ours keeps that of the step before; it is shown for λ = 1 only, as in the paper.");
  report.tables = {tables.stable, tables.errors, tables.stops, pair_table(plans, end, effort)};
  return report;
}

}  // namespace app
