#include "app/pictures/painting.h"

#include "app/pictures/captions.h"
#include "app/pictures/scales.h"

#include "render/core/colormap.h"
#include "render/core/style.h"
#include "sim/measures/diagnostics.h"
#include "sim/membrane/cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {

namespace {

/// 1 where the bending modulus or the rate is 0: then the units of the scene are left.
double scale_of(const Painting& p, double bending_modulus) {
  const double length = p.length, modulus = bending_modulus > 0 ? bending_modulus : 1, rate = p.rate > 0 ? p.rate : 1;
  switch (p.field->scale) {
    case sim::FieldScale::length:
      return 1 / length;
    case sim::FieldScale::curvature:
      return length;
    case sim::FieldScale::square_curvature:
      return length * length;
    case sim::FieldScale::tension:
      return length * length / modulus;
    case sim::FieldScale::force:
      return length * length * length / modulus;
    case sim::FieldScale::velocity:
      return p.rate > 0 ? 1 / (length * rate) : 1;
  }
  return 1;
}

std::string label_of(const Painting& p, const sim::Scene& scene) {
  const bool bends = std::all_of(scene.vesicles.begin(), scene.vesicles.end(),
                                 [](const sim::VesicleParameters& v) { return v.bending_modulus > 0; });
  const std::string_view per_modulus = bends ? "/κ_{b}" : "";
  switch (p.field->scale) {
    case sim::FieldScale::length:
      return fmt::format("{} / R_{{0}}", p.field->symbol);
    case sim::FieldScale::curvature:
      return fmt::format("{} R_{{0}}", p.field->symbol);
    case sim::FieldScale::square_curvature:
      return fmt::format("{} R_{{0}}^{{2}}", p.field->symbol);
    case sim::FieldScale::tension:
      return fmt::format("{} R_{{0}}^{{2}}{}", p.field->symbol, per_modulus);
    case sim::FieldScale::force:
      return fmt::format("{} R_{{0}}^{{3}}{}", p.field->symbol, per_modulus);
    case sim::FieldScale::velocity:
      return p.rate > 0 ? fmt::format("{} / {}R_{{0}}", p.field->symbol, scene.flows[0].kind == "shear" ? "γ̇" : "χ")
                        : std::string(p.field->symbol);
  }
  return {};
}

/// Values at points that stand for equal shares of the parameter sphere.
void collect(const sim::Coefficients& field, std::vector<double>& values) {
  constexpr Eigen::Index latitudes = 32, longitudes = 48;
  sim::Vector theta(latitudes);
  for (Eigen::Index i = 0; i < latitudes; ++i)
    theta[i] = std::acos(1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(latitudes));
  const sim::Vector phi = sim::Vector::LinSpaced(longitudes + 1, 0, 2 * std::numbers::pi).head(longitudes);
  const sim::Matrix samples = sim::sample_grid(field, theta, phi).value;
  values.insert(values.end(), samples.data(), samples.data() + samples.size());
}

double quantile(std::vector<double>& values, double share) {
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

/// Of a field, in the units of its legend.
struct FieldSize {
  double natural = 1;   ///< how large it would be if it were neither zero nor extreme
  double rounding = 0;  ///< smaller differences mean nothing
  bool nonnegative = false;
};

/// Both ends moved outward to round numbers. A field that is one value up to rounding gets a range about that value.
std::pair<double, double> rounded(double low, double high, const FieldSize& size) {
  const double largest = std::max(std::abs(low), std::abs(high));
  if (high - low <= std::max(2 * size.rounding, 1e-6 * largest)) {
    const bool zero = largest <= 2 * size.rounding;
    const double middle = zero ? 0 : (low + high) / 2, room = zero ? size.natural : 0.1 * std::abs(middle);
    low = zero && size.nonnegative ? 0 : middle - room;
    high = middle + room;
  }
  const double width = high - low, power = std::pow(10, std::floor(std::log10(width / 10)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= width / 10 * (1 - 1e-9)) step = factor * power;
  return {step * std::floor(low / step + 1e-9), step * std::ceil(high / step - 1e-9)};
}

/// Whatever the values: a field looks the same in every picture.
const render::ColourMapRow& map_for(const render::ViewParameters& view, bool has_sign) {
  return render::find_colour_map(view.colour_map.value_or(has_sign ? "blue-red" : "viridis"));
}

/// Lowest and highest value, but for the outermost 0.5 %. Of no values 0 and 1.
std::pair<double, double> extent_of(std::vector<double>& values) {
  constexpr double outermost = 0.005;
  if (values.empty()) return {0, 1};
  return {quantile(values, outermost), quantile(values, 1 - outermost)};
}

/// `all` of the movie, or what follows its first tenth (`later`) where that has a much smaller extent: what happens at
/// the start and never again does not set the range.
std::pair<double, double> steady_extent(std::vector<double>& all, std::vector<double>& later) {
  constexpr double much = 1.5;
  const auto whole = extent_of(all);
  if (later.empty()) return whole;
  const auto rest = extent_of(later);
  const auto reach = [](const std::pair<double, double>& e) {
    return std::max({e.second - e.first, std::abs(e.first), std::abs(e.second)});
  };
  return reach(whole) > much * reach(rest) ? rest : whole;
}

/// extent: of what is shown, without outliers. `shown`: all values of the picture or the movie. `end`: an automatic
/// range ends there at the latest, unless all values are larger.
void give_range(render::Legend& legend, const render::ViewParameters& view, std::pair<double, double> extent,
                const std::vector<double>& shown, bool has_sign, const FieldSize& size,
                double end = std::numeric_limits<double>::infinity()) {
  auto [low, high] = extent;
  if (size.nonnegative) low = std::max(low, 0.0);  // between grid points a degree p may undershoot
  if (low < end) high = std::min(high, end);
  const render::ColourMapRow& map = map_for(view, has_sign);
  if (!view.field_range.given()) {
    if (map.kind == render::MapKind::diverging && has_sign) {
      const bool uniform = high - low <= 2 * size.rounding + 1e-6 * std::abs(high);
      high = (uniform ? 1.2 : 1) * std::max(std::abs(low), std::abs(high));  // one value is not the end of the bar
      low = -high;
    }
    std::tie(low, high) = rounded(low, high, size);
  } else {
    low = view.field_range.ends[0];
    high = view.field_range.ends[1];
  }
  legend.low = low;
  legend.high = high;
  legend.colours = render::colour_table(map);
  // Only a range about zero puts zero where the map turns.
  legend.mirrored = map.kind == render::MapKind::diverging && std::abs(low + high) <= 1e-9 * (high - low);
  const double slack = view.field_range.given() ? size.rounding : 0.005 * (high - low);
  const auto [least, most] = std::minmax_element(shown.begin(), shown.end());
  legend.below = least != shown.end() && *least < low - slack;
  legend.above = most != shown.end() && *most > high + slack;
}

struct Quantity {
  std::string_view name, label;
  double (*of)(const sim::VesicleParameters&, const sim::VesicleMeasures&);
};
constexpr Quantity quantities[] = {
    {"viscosity_contrast", "λ",
     [](const sim::VesicleParameters& v, const sim::VesicleMeasures&) { return v.viscosity_contrast; }},
    {"bending_modulus", "κ_{b}",
     [](const sim::VesicleParameters& v, const sim::VesicleMeasures&) { return v.bending_modulus; }},
    {"density_difference", "Δρ",
     [](const sim::VesicleParameters& v, const sim::VesicleMeasures&) { return v.density_difference; }},
    {"reduced_volume", "ν",
     [](const sim::VesicleParameters&, const sim::VesicleMeasures& m) { return m.reduced_volume; }},
};

void colour_by_quantity(Painting& p, const Quantity& quantity, const Settings& settings, const sim::State& state) {
  sim::Plans plans;
  std::vector<double> values;
  for (std::size_t k = 0; k < state.vesicles.size(); ++k)
    values.push_back(quantity.of(settings.scene.vesicles[k], sim::measure(plans, state.vesicles[k], 1, 1)));
  render::Legend legend;
  legend.label = quantity.label;
  render::ViewParameters view = settings.view;
  view.field_range = {};
  give_range(legend, view,
             {*std::min_element(values.begin(), values.end()), *std::max_element(values.begin(), values.end())}, values,
             false, {});
  legend.mirrored = false;  // whole bodies have one value each: no dots
  for (const double value : values)
    p.bodies.push_back(render::mapped(legend.colours, (value - legend.low) / (legend.high - legend.low)));
  p.legend = legend;
}

}  // namespace

Painting plan_painting(const sim::TrajectoryReader& trajectory, const std::vector<std::int64_t>& states,
                       const Settings& settings, double area_radius, const sim::State* still) {
  const render::ViewParameters& view = settings.view;
  Painting p;
  p.length = area_radius;
  p.rate = flow_rate(settings.scene, area_radius);
  const sim::State first = trajectory.state(0);
  for (const Quantity& quantity : quantities)
    if (quantity.name == view.colour_by) colour_by_quantity(p, quantity, settings, first);
  for (std::size_t k = p.bodies.size(); k < first.vesicles.size(); ++k)
    p.bodies.push_back(view.colours.empty() ? render::body_colour(k)
                                            : render::parse_colour(view.colours[k % view.colours.size()]));
  if (!render::find_style(view.style).field) return p;

  p.field = &sim::find_field(view.field);
  if (p.field->needs_neighbours && first.vesicles.size() < 2 && !settings.scene.cell.size)
    throw std::invalid_argument(fmt::format("the field '{}' needs two vesicles or more", p.field->name));
  std::vector<double> values, later;  // of what is shown, and of that after the start
  sim::Plans plans;
  const auto add = [&](const sim::State& state, std::vector<double>& to) {
    sim::Surroundings surroundings(sim::cell_at(settings.scene, state.time));
    for (std::size_t v = 0; v < state.vesicles.size(); ++v)
      collect(painted_field(plans, p, settings, state, v, surroundings), to);
  };
  if (still) {
    add(*still, values);
  } else if (!states.empty()) {
    const double start = trajectory.time(states.front()), end = trajectory.time(states.back());
    for (const std::int64_t k : states) {
      const sim::State state = trajectory.state(k);
      const std::size_t before = values.size();
      add(state, values);
      if (state.time >= start + 0.1 * (end - start) && states.size() >= 20)
        later.insert(later.end(), values.begin() + static_cast<std::ptrdiff_t>(before), values.end());
    }
  }
  const NaturalScales scales = natural_scales(settings.scene, first, area_radius);
  const double unit = scale_of(p, settings.scene.vesicles.front().bending_modulus);
  p.legend.emplace();
  p.legend->label = label_of(p, settings.scene);
  const std::vector<double> shown = values;  // quantiles reorder
  give_range(*p.legend, view, steady_extent(values, later), shown, p.field->has_sign,
             {unit * scales.size_of(p.field->scale), unit * scales.rounding_of(p.field->scale), !p.field->has_sign},
             p.field->automatic_end);
  return p;
}

sim::Coefficients painted_field(sim::Plans& plans, const Painting& p, const Settings& settings, const sim::State& state,
                                std::size_t vesicle, sim::Surroundings& surroundings) {
  const double modulus = settings.scene.vesicles[vesicle].bending_modulus;
  sim::Coefficients field = sim::membrane_field(plans, *p.field, state, vesicle, modulus, surroundings);
  field.values *= scale_of(p, modulus);
  return field;
}

void share_legend(const std::vector<Painting*>& paintings, const render::FieldRange& range) {
  const sim::FieldRow* field = paintings.front()->field;
  for (const Painting* p : paintings)
    if (p->field != field) {
      if (!range.shared) return;
      const auto name = [](const sim::FieldRow* f) { return f ? fmt::format("'{}'", f->name) : "no field"; };
      throw std::invalid_argument(fmt::format(
          "view.field_range = \"{}\" needs one field in all: one shows {}, another {}; choose it by view.style and "
          "view.field",
          render::range_words[0], name(field), name(p->field)));
    }
  if (!field) return;
  const auto mirrored =
      std::find_if(paintings.begin(), paintings.end(), [](const Painting* p) { return p->legend->mirrored; });
  render::Legend all = *(mirrored != paintings.end() ? *mirrored : paintings.front())->legend;
  for (const Painting* p : paintings) {
    all.low = std::min(all.low, p->legend->low);
    all.high = std::max(all.high, p->legend->high);
    all.below = all.below || p->legend->below;
    all.above = all.above || p->legend->above;
  }
  if (all.mirrored && !range.given()) {
    all.high = std::max(std::abs(all.low), std::abs(all.high));
    all.low = -all.high;
  }
  all.mirrored = all.mirrored && all.low == -all.high;
  for (Painting* p : paintings) p->legend = all;
}

}  // namespace app
