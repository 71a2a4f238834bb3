#include "app/scene/catalogues.h"

#include "app/tables/movie_formats.h"
#include "app/tables/quantities.h"
#include "app/tables/results.h"

#include "render/core/colormap.h"
#include "render/core/style.h"
#include "render/figures/figure.h"
#include "render/figures/theme.h"
#include "render/scene/view.h"
#include "sim/measures/fields.h"
#include "sim/membrane/flows.h"
#include "sim/stepping/stepper.h"
#include "sim/surface/shapes.h"
#include "sim/suspension/placements.h"

namespace app {

namespace {

template <class Row>
std::vector<sim::CatalogueRow<int>> words(const std::vector<Row>& table) {
  std::vector<sim::CatalogueRow<int>> rows;
  for (const Row& row : table) {
    rows.push_back({row.name, row.meaning, {}});
    if constexpr (requires { row.keys; }) rows.back().keys = {row.keys.begin(), row.keys.end()};
  }
  return rows;
}

}  // namespace

const std::vector<Catalogue>& catalogues() {
  static const std::vector<Catalogue> all{
      {"flows", "background flows", words(sim::flow_catalogue())},
      {"shapes", "initial shapes", words(sim::shape_catalogue())},
      {"placements", "ways to place many vesicles", words(sim::placement_catalogue())},
      {"schemes", "time stepping schemes", words(sim::scheme_catalogue())},
      {"cameras", "directions of view", words(render::cameras())},
      {"styles", "ways to paint a vesicle", words(render::styles())},
      {"fields", "scalars on a membrane, for the style field", words(sim::field_catalogue())},
      {"colour_maps", "colours of a field", words(render::colour_maps())},
      {"colours", "colours of vesicles, in the order in which they are given out", words(render::body_colours())},
      {"formats", "movie files", words(movie_formats())},
      {"figures", "figures drawn from a trajectory", words(render::figures())},
      {"themes", "looks of a figure", words(render::themes())},
      {"quantities", "what figures show against time and in phase portraits", words(quantities())},
      {"results", "numbers that a run ends in, for converge, besides quantities", words(results())},
      {"reductions", "numbers made from a quantity over a run, for converge", words(reductions())}};
  return all;
}

}  // namespace app
