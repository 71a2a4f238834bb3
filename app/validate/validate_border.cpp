// The borders of tank-treading and tumbling over reduced volume and viscosity contrast.
#include "app/validate/theory.h"
#include "app/validate/validations.h"

#include "sim/surface/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace app {

namespace {

/// Where `beyond` becomes true between two values, to half a width.
template <class Beyond>
double bisected(double low, double high, double width, Beyond&& beyond) {
  while (high - low > width) {
    const double middle = (low + high) / 2;
    (beyond(middle) ? high : low) = middle;
  }
  return (low + high) / 2;
}

constexpr const char* leaning = "vesicle.axis=[0.966,0,0.259]";  // +15 degrees

Changes up_to_100(double nu, double modulus, double contrast) {
  return {fmt::format("vesicle.reduced_volume={}", nu), fmt::format("vesicle.bending_modulus={}", modulus),
          fmt::format("vesicle.viscosity_contrast={}", contrast), "time.save_every=0.5", "time.end=100"};
}

double end_of_treading(Trials& trials, double nu, double modulus, double low, double high, double width) {
  return bisected(low, high, width, [&](double contrast) {
    const Changes changes = up_to_100(nu, modulus, contrast) + Changes{"vesicle.order=8", leaning};
    return least_angle(trials.history("tumbling", changes)) < 0;
  });
}

double begin_of_tumbling(Trials& trials, double nu, double modulus, double low, double high, double width) {
  return bisected(low, high, width, [&](double contrast) {
    const Changes changes = up_to_100(nu, modulus, contrast) + Changes{"vesicle.order=8"};
    return least_angle(trials.history("tumbling", changes)) < -90;
  });
}

constexpr std::array volumes{0.8, 0.9, 0.95};
constexpr std::array moduli{0.1, 0.01};
constexpr std::size_t columns = volumes.size();
using Border = std::map<std::pair<double, double>, double>;  // over (nu, kappa_b)

double border_of_ellipsoid(double nu) {
  const sim::Vec3 axes = sim::spheroid_axes(nu, true);
  return keller_skalak_border(axes[0] / axes[1]);
}

/// Smallest of f(b) - f(a) from one reduced volume to the next.
template <class F>
double least_growth(F&& f) {
  double least = f(volumes[1]) - f(volumes[0]);
  for (std::size_t k = 2; k < columns; ++k) least = std::min(least, f(volumes[k]) - f(volumes[k - 1]));
  return least;
}

/// Both borders with the two theories, against the excess area's reduced volume.
render::Figure border_figure(const Border& treading, const Border& tumbling, const Border& nearly_spheres) {
  std::vector<double> nu, ellipsoid, quasi, found, found_tumbling;
  for (double v = 0.75; v < 0.9976; v += 0.0025) {
    nu.push_back(v);
    ellipsoid.push_back(border_of_ellipsoid(v));
    quasi.push_back(v < 0.949 ? std::nan("") : quasi_spherical_border(excess_area(v)));
  }
  std::vector<double> x;
  for (const double v : volumes) {
    x.push_back(v);
    found.push_back(treading.at({v, 0.01}));
    found_tumbling.push_back(tumbling.at({v, 0.01}));
  }
  std::vector<double> x_all = x;
  for (const auto& [key, value] : nearly_spheres)
    if (key.first < 0.9976) {
      x_all.push_back(key.first);
      found.push_back(value);
    }
  render::Plot plot;
  plot.x = {.label = "reduced volume ν", .grid = true};
  plot.y = {.label = "viscosity contrast λ", .grid = true};
  plot.y_range = render::Range{0, 20};
  plot.x_range = render::Range{0.75, 1};
  plot.curves = {line_curve("Keller, Skalak 1982", nu, ellipsoid, 2, 1),
                 line_curve("quasi-spherical limit", nu, quasi, 3, 2),
                 point_curve("treading ends", x_all, found, 0, render::Marker::ring, true),
                 point_curve("tumbling begins", x, found_tumbling, 1, render::Marker::triangle, true)};
  return panels({plot});
}

}  // namespace

Section validate_border(Trials& trials) {
  Section s{
      "Where a prolate in shear stops tank-treading, and where it begins to tumble, over (ν, λ): "
      "`scenes/tumbling.toml` with p = 8 (tolerance 1e-3), γ̇ = 1, up to γ̇t = 100, by bisection of λ to ± 0.01 and "
      "± 0.02. The motion is told by the unwrapped inclination. Treading: started at +15° it settles at a positive "
      "angle and never falls below 0. Tumbling: started along the flow it passes −90°. Between the two the angle "
      "swings about 0 with a shape that breathes (vacillating breathing or trembling; Abreu et al. 2014, "
      "arXiv:1311.7341, review it). Starts matter there, since the swing dies out slowly if at all, and the second "
      "border is that of this start, within the shear plane. Keller and Skalak's ellipsoid of fixed shape knows one "
      "border only (B = 1), and no κ_b. Expected: both borders grow with ν and hardly depend on κ_b (3 %), since "
      "both capillary numbers, 10 and 100, are large; vesicles, which deform, tread up to a higher λ than Keller "
      "and Skalak's ellipsoid for ν ≤ 0.9, and come nearer to it as ν grows. No theory tells by how much: the share "
      "of 25 % is a bound for gross errors only. The quasi-spherical theory in strong shear ends treading at λ = "
      "(120 √(2π/15)/√Δ − 32)/23, where its angle is 0. It is the limit Δ → 0, which Keller and Skalak's is not: at "
      "ν = 0.99 and 0.999 the border must tend to it with an error like √Δ, the next order of that theory, and lies "
      "below Keller and Skalak there (14.07 and 41.98)."};
  s.table({"ν", "κ_b", "treading up to λ", "tumbling from λ", "Keller, Skalak", "first border over theirs"});
  Border treading, tumbling;
  std::map<double, double> theory;
  for (const double nu : volumes) {
    const double ellipsoid = theory[nu] = border_of_ellipsoid(nu);
    for (const double modulus : moduli) {
      const std::pair key{nu, modulus};
      treading[key] = end_of_treading(trials, nu, modulus, 0.9 * ellipsoid, 1.4 * ellipsoid, 0.02);
      tumbling[key] = begin_of_tumbling(trials, nu, modulus, 1.3 * ellipsoid, 2 * ellipsoid, 0.04);
      s.row({fmt::format("{}", nu), fmt::format("{}", modulus), fmt::format("{:.2f}", treading[key]),
             fmt::format("{:.2f}", tumbling[key]), fmt::format("{:.3f}", ellipsoid),
             fmt::format("{:.3f}", treading[key] / ellipsoid)});
    }
  }
  s.checks();
  for (const double modulus : moduli) {
    const std::string where = fmt::format("κ_b = {}", modulus);
    const double ends = least_growth([&](double nu) { return treading[{nu, modulus}]; });
    s.check_texts(where + ": end of treading, least growth from one ν to the next", fmt::format("{:.2f}", ends),
                  "above 0", ends > 0);
    const double begins = least_growth([&](double nu) { return tumbling[{nu, modulus}]; });
    s.check_texts(where + ": begin of tumbling, least growth from one ν to the next", fmt::format("{:.2f}", begins),
                  "above 0", begins > 0);
    const auto above = [&](double nu) { return treading[{nu, modulus}] / theory[nu] - 1; };
    double farthest = 0;
    for (const double nu : volumes) farthest = std::abs(above(nu)) > std::abs(farthest) ? above(nu) : farthest;
    s.check(where + ": end of treading over Keller and Skalak's, less 1, farthest from 0", farthest, 0, 0.25, 3);
    const double nears = least_growth([&](double nu) { return -above(nu); });
    s.check_texts(where + ": its least decrease from one ν to the next", fmt::format("{:.3f}", nears), "above 0",
                  nears > 0);
    for (const double nu : {0.8, 0.9}) {
      const double beyond = treading[{nu, modulus}] - theory[nu];
      s.check_texts(fmt::format("{}, ν = {}: end of treading less Keller and Skalak's", where, nu),
                    fmt::format("{:.2f}", beyond), "above 0", beyond > 0);
    }
  }
  for (const double away : {-0.05, 0.05}) {
    const double contrast = treading[{0.9, 0.1}] + away;
    const double lowest = least_angle(trials.history(
        "tumbling", up_to_100(0.9, 0.1, contrast) + Changes{"vesicle.order=12", "time.tolerance=1e-4", leaning}));
    s.check_texts(fmt::format("κ_b = 0.1, ν = 0.9, p = 12, tolerance 1e-4: least angle at λ = {:.2f}", contrast),
                  fmt::format("{:.2f}", lowest), away > 0 ? "below 0" : "above 0", (lowest < 0) == (away > 0));
  }
  for (const double nu : volumes)
    s.check(fmt::format("ν = {}: end of treading at κ_b = 0.1 over that at 0.01, less 1", nu),
            treading[{nu, 0.1}] / treading[{nu, 0.01}] - 1, 0, 0.03, 3);
  Border nearly_spheres;
  std::map<double, double> errors;
  for (const double nu : {0.99, 0.999}) {
    const double excess = excess_area(nu), limit = quasi_spherical_border(excess);
    const double found = end_of_treading(trials, nu, 0.01, 0.8 * limit, 1.6 * limit, 0.005 * limit);
    nearly_spheres[{nu, 0.01}] = found;
    errors[nu] = (found / limit - 1) / std::sqrt(excess);
    s.check(fmt::format("κ_b = 0.01, ν = {}: end of treading (λ) against the quasi-spherical limit", nu), found,
            rounded(limit, 2), rounded(1.1 * std::sqrt(excess) * limit, 2), 2);
  }
  s.check("its error over √Δ at ν = 0.99 over that at 0.999", errors[0.99] / errors[0.999], 1, 0.25, 2);
  s.figure = border_figure(treading, tumbling, nearly_spheres);
  s.caption = "The borders at κ_b = 0.01 over reduced volume, with both theories.";
  return s;
}

}  // namespace app
