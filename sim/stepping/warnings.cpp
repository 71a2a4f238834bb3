#include "sim/stepping/warnings.h"

#include "sim/core/digits.h"
#include "sim/membrane/cell.h"
#include "sim/stepping/contrasts.h"
#include "sim/suspension/gap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Whether the order of vesicle k stays what it is, however large the errors.
bool cannot_rise(const Model& s, const Dynamics& d, std::size_t k) {
  return !order_follows(s.scene.time, s.scene.vesicles[k]) ||
         d.vesicles[k].position.order >= s.scene.numerics.most_order;
}

/// What sets the order of vesicle k.
std::string_view order_key(const Model& s, std::size_t k) {
  return order_follows(s.scene.time, s.scene.vesicles[k]) ? "numerics.most_order" : "order";
}

}  // namespace

bool unresolved(const Model& s, const Dynamics& d, std::size_t k) {
  return d.vesicles[k].tail > s.scene.numerics.tail_warning && cannot_rise(s, d, k);
}

std::string resolution_warning(const Model& s, const Dynamics& d, std::size_t k) {
  const VesicleDynamics& v = d.vesicles[k];
  const auto [tail, bound] = told_apart(100 * v.tail, 100 * s.scene.numerics.tail_warning);
  return fmt::format(
      "vesicle {}: order {} does not resolve the shape well ({} % of the mean curvature's spectrum lies in its last "
      "quarter; bound {} %); try {} {}",
      k, v.position.order, tail, bound, order_key(s, k), v.position.order * 3 / 2);
}

bool limited(const Model& s, const Dynamics& d, std::size_t k, double times_allowed) {
  constexpr double tolerable = 2;  // estimates are no better
  return times_allowed > tolerable && cannot_rise(s, d, k);
}

std::string limit_warning(const Model& s, const Dynamics& d, std::size_t k, double times_allowed, std::size_t others) {
  const int order = d.vesicles[k].position.order;
  const std::string more = others == 0 ? "" : fmt::format(" (and {} more, less)", others);
  return fmt::format("vesicle {}{}: order {} leaves errors {:.2g} times as large as the tolerance allows; try {} {}", k,
                     more, order, times_allowed, order_key(s, k), order * 3 / 2);
}

namespace {

constexpr double told_share = 0.25;  ///< error of a gap, over the gap, from which it is no more known

/// The least degree that resolves a gap, in area radii.
int degree_for(double gap) {
  int degree = 1;
  while (film_error(degree, gap) > told_share * gap) ++degree;
  return degree;
}

/// The least gap, in area radii, that a degree resolves.
double least_gap(int degree) {
  double low = 0, high = 1;
  for (int k = 0; k < 40; ++k) {
    const double gap = (low + high) / 2;
    (film_error(degree, gap) > told_share * gap ? low : high) = gap;
  }
  return high;
}

}  // namespace

std::vector<ThinFilm> thin_films(const Model& s, const Dynamics& d) {
  std::vector<ThinFilm> films;
  if (steps_adapt(s.scene.time) || !(d.control.gap > 0)) return films;
  const auto film_of = [&](std::size_t k, double distance) {
    const VesicleDynamics& v = d.vesicles[k];
    const double gap = distance / area_radius({v.area, v.volume});
    return ThinFilm{k, gap, film_error(v.position.order, gap)};
  };
  const auto thin = [](const ThinFilm& film) { return film.error > told_share * film.gap; };
  double reach = 0;
  for (std::size_t k = 0; k < d.vesicles.size(); ++k)
    if (const ThinFilm film = film_of(k, d.control.gap); thin(film)) reach = std::max(reach, d.control.gap / film.gap);
  if (reach == 0) return films;
  const std::vector<double> gaps = gaps_to_neighbours(s.plans, positions(d), reach, cell_at(s.scene, d.time), s.ranks);
  for (std::size_t k = 0; k < gaps.size(); ++k)
    if (const ThinFilm film = film_of(k, gaps[k]); thin(film)) films.push_back(film);
  std::stable_sort(films.begin(), films.end(),
                   [](const ThinFilm& a, const ThinFilm& b) { return a.error / a.gap > b.error / b.gap; });
  return films;
}

std::string film_warning(const Dynamics& d, const ThinFilm& film, std::size_t others) {
  constexpr int far_too_many = 32;
  const std::string more = others == 0 ? "" : fmt::format(" (and {} more)", others);
  const int order = d.vesicles[film.vesicle].position.order, needed = degree_for(film.gap);
  return fmt::format(
      "vesicle {}{}: the nearest neighbour is {:.2g} area radii away, and order {} tells gaps from {:.2g} on: how they "
      "touch is the truncation's; {}",
      film.vesicle, more, film.gap, order, least_gap(order),
      needed > far_too_many ? "begin farther apart" : fmt::format("try order {}", needed));
}

namespace {

/// The table of the scene that a flow stands in, and the keys that give it a strength.
std::string still_flow_warning(const Scene& scene, std::size_t k) {
  const FlowParameters& flow = scene.flows[k];
  const std::string table = scene.flows.size() > 1 ? fmt::format("[[flow]] {}", k) : "[flow]";
  if (flow.time_factor == "step" && (flow.from >= flow.until || flow.from >= scene.time.end || flow.until <= 0))
    return fmt::format("{}: '{}' never acts: from = {}, until = {}, time.end = {}", table, flow.kind, flow.from,
                       flow.until, scene.time.end);
  std::string keys;
  for (std::string_view key : find_row(flow_catalogue(), flow.kind)->keys)
    if (key != "planar") keys += fmt::format("{}flow.{}", keys.empty() ? "" : " or ", key);
  return fmt::format("{}: '{}' moves nothing, its strength is 0; give {}", table, flow.kind, keys);
}

}  // namespace

std::vector<std::string> scene_warnings(const Model& s, const Dynamics& d) {
  const Scene& scene = s.scene;
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < scene.flows.size(); ++k)
    if (scene.flows[k].kind != "none" && scene.time.end > 0 && !moves(scene.flows[k], scene.time.end))
      warnings.push_back(still_flow_warning(scene, k));
  if (!steps_adapt(scene.time))
    if (const double step = fixed_step(scene), longest = longest_step(scene); longest < step)
      warnings.push_back(
          fmt::format("a flow oscillates {:.3g} times in a step of {:.3g}; steps of {:.3g} are taken, 20 a period",
                      step / (20 * longest), step, longest));
  for (std::size_t k = 0; k < d.vesicles.size(); ++k)
    if (unresolved(s, d, k)) warnings.push_back(resolution_warning(s, d, k));
  if (std::string warning = contrast_warning(s, d); !warning.empty()) warnings.push_back(std::move(warning));
  if (const auto films = thin_films(s, d); !films.empty())
    warnings.push_back(film_warning(d, films.front(), films.size() - 1));
  return warnings;
}

}  // namespace sim
