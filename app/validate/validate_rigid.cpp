// Rigid motions: carried by a stream, turned with the fluid, held round, sinking.
#include "app/validate/theory.h"
#include "app/validate/validations.h"

#include "sim/sphere/basis.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace app {

Section validate_rigid_motions(Trials& trials) {
  Section s{
      "A prolate of reduced volume 0.85, askew, carried by a uniform stream U and by turning fluid ω (γ̇ = 0) for a "
      "time of 2 in steps of 0.1: what its centre misses, relative to the way, and by how much its energy E/(8πκ) "
      "and mean tension differ from a run at rest. The largest over U, ω = 1, 10, 100. The motion is a rigid one, "
      "which the scheme takes exactly: what is left is rounding, 1e-9 of the way, and 1e-8 of energy and tension, "
      "whose third derivatives of the position raise it."};
  s.table({"λ", "p", "stream: centre", "energy", "tension", "turning: centre", "energy", "tension", ""});
  for (const double contrast : {0.1, 10.0, 100.0, 1000.0})
    for (const int order : {6, 8, 12}) {
      const Changes base{fmt::format("vesicle.viscosity_contrast={}", contrast),
                         fmt::format("vesicle.order={}", order),
                         "vesicle.axis=[1,0.2,0.1]",
                         "vesicle.center=[1,0,2]",
                         "vesicle.shape=prolate",
                         "vesicle.reduced_volume=0.85",
                         "vesicle.bending_modulus=0.01",
                         "time.end=2",
                         "time.step=0.1",
                         "time.save_every=2"};
      const Sample still = trials.last("relaxation", base);
      const double x = still.center[0], z = still.center[2];
      std::vector<std::string> cells{fmt::format("{}", contrast), fmt::format("{}", order)};
      bool good = true;
      for (const bool turns : {false, true}) {
        double centre = 0, energy = 0, tension = 0;
        for (const int size : {1, 10, 100}) {
          const double way = 2.0 * size, c = std::cos(way), n = std::sin(way);
          const Changes flow = turns
                                   ? Changes{"flow.kind=rotation", fmt::format("flow.angular_velocity=[0,{},0]", size)}
                                   : Changes{"flow.kind=uniform", fmt::format("flow.velocity=[{},0,0]", size)};
          const Sample last = trials.last("relaxation", base + flow);
          const double to_x = turns ? x * c + z * n : x + way, to_z = turns ? z * c - x * n : z;
          centre = std::max(centre, std::hypot(last.center[0] - to_x, last.center[2] - to_z) / way);
          energy = std::max(energy, std::abs(last.energy - still.energy));
          tension = std::max(tension, std::abs(last.tension_mean - still.tension_mean));
        }
        good = good && centre < 1e-9 && energy < 1e-8 && tension < 1e-8;
        for (const double miss : {centre, energy, tension}) cells.push_back(fmt::format("{:.0e}", miss));
      }
      cells.push_back(s.verdict(good));
      s.row(cells);
    }
  return s;
}

Section validate_spheres(Trials& trials) {
  Section s{
      "Spheres and nearly round prolates in shear for a time of 2, p = 8: longest axis less 1, over √(1 − ν) where "
      "there is an excess; area error and mean tension. A sphere's constant tension is given, and so is that of 1 − "
      "ν below 2e-6, which is held round: to 3e-5, and a tenth more is allowed. Beyond, the whole excess is in the "
      "ellipsoid along the flow's axis of strain, whose longest axis exceeds 1 by √(5/4) √(1 − ν), and the mean "
      "tension is as one over the root of the excess, both but for the next order: asked for are 0.005 + 2 √(1 − ν) "
      "of the one and, from the smallest excess on, of the other. Areas keep to 1e-8, the rounding of a sphere's "
      "shape."};
  s.table({"λ", "1 − ν", "Δt", "longest axis − 1", "over √(1 − ν)", "area error", "mean tension", ""});
  const double limit = std::sqrt(1.25);
  std::vector<double> excesses, longer_axes;
  for (const double contrast : {0.1, 1.0, 10.0}) {
    double first_product = 0;
    for (const double excess : {0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3})
      for (const double step : {0.1, 0.02}) {
        const Sample last =
            trials.last("tank-treading", {fmt::format("vesicle.viscosity_contrast={}", contrast), "vesicle.order=8",
                                          "time.end=2", fmt::format("vesicle.reduced_volume={:.12f}", 1 - excess),
                                          fmt::format("time.step={}", step), "time.save_every=2"});
        const double longer = last.axes[0] - 1, share = longer / std::sqrt(excess);
        const bool held = excess < 2e-6;
        const double product = last.tension_mean * std::sqrt(excess);
        if (!held && first_product == 0) first_product = product;
        const double next_order = 0.005 + 2 * std::sqrt(excess);
        const bool good =
            held ? longer < 3.3e-5
                 : std::abs(share / limit - 1) < next_order && std::abs(product / first_product - 1) < next_order;
        if (contrast == 1 && step == 0.02 && excess > 0) {
          excesses.push_back(excess);
          longer_axes.push_back(longer);
        }
        s.row({fmt::format("{}", contrast), fmt::format("{:g}", excess), fmt::format("{}", step),
               fmt::format("{:.1e}", longer), held ? "" : fmt::format("{:.2f}", share),
               fmt::format("{:.0e}", last.area_error), fmt::format("{:.4g}", last.tension_mean),
               s.verdict(good && std::abs(last.area_error) < 1e-8)});
      }
  }
  render::Plot plot;
  plot.x = {.label = "1 − ν", .scale = render::Scale::logarithmic, .grid = true};
  plot.y = {.label = "longest axis / R_{0} − 1", .scale = render::Scale::logarithmic, .grid = true};
  std::vector<double> roots;
  for (const double excess : excesses) roots.push_back(limit * std::sqrt(excess));
  plot.curves = {line_curve("√(5/4) √(1 − ν)", excesses, roots, 1, 1),
                 point_curve("Tanktread, λ = 1", excesses, longer_axes, 0, render::Marker::ring)};
  s.figure = panels({plot});
  s.caption = "The longest axis over the excess, Δt = 0.02: round below 2e-6, with the root of the excess beyond.";
  return s;
}

Section validate_sedimentation(Trials& trials) {
  Section s{
      "A sinking sphere (`scenes/sedimentation.toml` with `vesicle.reduced_volume=1`, `vesicle.axis=[1,0,0]`, Δρ = "
      "1, g = 1 along −z) for a time of 2. A spherical membrane that cannot stretch neither deforms nor, by "
      "symmetry, flows: it sinks as a rigid sphere, with Stokes' (2/9) Δρ g R²/μ, whatever λ and κ_b, and with a "
      "tension of (3/2) μ U cos θ, θ from the lower pole, whose largest value is Δρ g R²/3 (derived from the "
      "traction (3/2) μU/R on a rigid sphere). Linear solves to 1e-12 and orders that represent a sphere exactly "
      "leave rounding and quadrature: 1e-8, also of the tension between the points of the grid, on a mesh of 1986 "
      "points."};
  s.table({"λ", "R", "p", "speed / ((2/9) Δρ g R²) − 1", "sideways speed / speed", "largest tension / (Δρ g R²/3) − 1",
           "tension on the mesh, largest error", ""});
  struct Case {
    double contrast, radius;
    int order;
  };
  const sim::Matrix directions = mesh_directions();
  for (const Case& c :
       {Case{0.1, 1, 8}, {1, 1, 8}, {10, 1, 8}, {100, 1, 8}, {5, 0.5, 8}, {5, 2, 8}, {5, 1, 6}, {5, 1, 12}}) {
    const Trial trial = trials.run(
        "sedimentation",
        {fmt::format("vesicle.viscosity_contrast={}", c.contrast), fmt::format("vesicle.radius={}", c.radius),
         fmt::format("vesicle.order={}", c.order), "vesicle.reduced_volume=1", "vesicle.axis=[1,0,0]",
         "numerics.gmres_tolerance=1e-12", "time.end=2", "time.save_every=1"});
    const Samples rows = trials.history(trial);
    const Sample& last = rows.back();
    const double speed = 2.0 / 9 * c.radius * c.radius, highest = c.radius * c.radius / 3;
    const double sink = (rows[0].center[2] - last.center[2]) / 2 / speed - 1;
    const double sideways = std::hypot(last.center[0], last.center[1]) / 2 / speed;
    const double tension = last.tension_max / highest - 1;
    const sim::State state = trial.last();
    const sim::Vector z = sim::sample_points(state.vesicles[0].position, directions).col(2);
    const sim::Vector on_mesh = sim::sample_points(state.vesicles[0].tension, directions).col(0);
    const double mesh = (on_mesh / highest + ((z.array() - last.center[2]) / c.radius).matrix()).cwiseAbs().maxCoeff();
    const bool good = std::max({std::abs(sink), sideways, std::abs(tension), mesh}) < 1e-8;
    s.row({fmt::format("{}", c.contrast), fmt::format("{}", c.radius), fmt::format("{}", c.order),
           fmt::format("{:.0e}", sink), fmt::format("{:.0e}", sideways), fmt::format("{:.0e}", tension),
           fmt::format("{:.0e}", mesh), s.verdict(good)});
  }
  return s;
}

Section validate_faxen(Trials& trials) {
  constexpr double a = 0.1;  // of the flow
  Section s{
      "A vesicle beside the axis of a parabolic flow u_x = −a (y² + z²), a = 0.1 (`scenes/relaxation.toml` with "
      "`flow.kind=\"poiseuille\"`, p = 8, up to t = 20). A sphere without force moves, by Faxén's law, with u + "
      "(R²/6) ∇²u = u − (2/3) a R² at its centre, of any radius in this flow, whose ∇⁴u is zero; a membrane that "
      "cannot stretch adds only flows on the sphere that have no divergence, and those carry no force. Spheres are "
      "held round to 3e-5 R₀ at the full strength of the flow, so the speed is allowed an error of 1e-4 times 2 a R "
      "max(z₀, R), and so is the one across. Deformed vesicles lag less; the lag over Faxén's, over the last ten "
      "time units, less 1, must vanish with the excess area: like Δ, so that its share of Δ is the same for ν = "
      "0.999, 0.99 and 0.95 to within 20 %, for λ = 1. They drift towards the axis."};
  s.table({"ν", "R", "z₀", "λ", "lag / ((2/3) a R²) − 1", "over Δ", "drift across, dz/dt", ""});
  struct Case {
    double nu, radius, z, contrast;
  };
  std::vector<double> excesses, lags;
  double first_share = 0;
  for (const Case& c : {Case{1, 0.5, 1, 1},
                        {1, 1, 1, 1},
                        {1, 1, 1, 10},
                        {1, 2, 1, 1},
                        {1, 1, 3, 1},
                        {1, 1, 0, 1},
                        {0.999, 1, 1, 1},
                        {0.99, 1, 1, 1},
                        {0.95, 1, 1, 1},
                        {0.95, 0.25, 1, 1}}) {
    const Samples all = trials.history(
        "relaxation",
        {"flow.kind=poiseuille", fmt::format("flow.curvature={}", a), fmt::format("vesicle.radius={}", c.radius),
         fmt::format("vesicle.viscosity_contrast={}", c.contrast), fmt::format("vesicle.reduced_volume={}", c.nu),
         "vesicle.order=8", fmt::format("vesicle.center=[0,0,{}]", c.z), "vesicle.bending_modulus=0.01", "time.end=20",
         "time.save_every=0.1", "vesicle.axis=[1,0,0]"});
    const std::size_t from = all.size() / 2;
    const double time = all.back().time - all[from].time;
    double undisturbed = 0;  // how far the flow at its centre goes meanwhile
    for (std::size_t k = from; k + 1 < all.size(); ++k)
      undisturbed -=
          a * (std::pow(all[k].center[2], 2) + std::pow(all[k + 1].center[2], 2)) / 2 * (all[k + 1].time - all[k].time);
    const double law = 2.0 / 3 * a * c.radius * c.radius;
    const double lag = (undisturbed - all.back().center[0] + all[from].center[0]) / time / law - 1;
    const double drift = (all.back().center[2] - all[from].center[2]) / time;
    bool good = false;
    std::string share_text;
    if (c.nu == 1) {
      const double allowed = 1e-4 * 2 * a * c.radius * std::max(c.z, c.radius);
      good = std::abs(lag) * law < allowed && std::abs(drift) < allowed;
    } else {
      const double share = lag / excess_area(c.nu);
      if (first_share == 0) first_share = share;
      good = drift < 0 && std::abs(share / first_share - 1) < 0.2;
      share_text = fmt::format("{:.3f}", share);
      if (c.radius == 1) {
        excesses.push_back(excess_area(c.nu));
        lags.push_back(-lag);
      }
    }
    s.row({fmt::format("{}", c.nu), fmt::format("{}", c.radius), fmt::format("{}", c.z), fmt::format("{}", c.contrast),
           fmt::format("{:.1e}", lag), share_text, fmt::format("{:.1e}", drift), s.verdict(good)});
  }
  render::Plot plot;
  plot.x = {.label = "excess area Δ", .scale = render::Scale::logarithmic, .grid = true};
  plot.y = {.label = "1 − lag / Faxén's", .scale = render::Scale::logarithmic, .grid = true};
  std::vector<double> proportional;
  for (const double excess : excesses) proportional.push_back(lags[0] / excesses[0] * excess);
  plot.curves = {line_curve("proportional to Δ", excesses, proportional, 1, 1),
                 point_curve("Tanktread, λ = 1", excesses, lags, 0, render::Marker::ring)};
  s.figure = panels({plot});
  s.caption = "What deformed vesicles lag less than a sphere, R = 1, against their excess area.";
  return s;
}

}  // namespace app
