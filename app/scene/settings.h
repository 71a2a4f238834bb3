// A whole scene file: the physics that `sim` declares and the pictures that `render` declares.
#pragma once

#include "render/core/parameters.h"
#include "sim/core/parameters.h"

namespace app {

struct Settings {
  sim::Scene scene;
  render::ViewParameters view;
  std::vector<render::KeyFrameParameters> key_frames;
  render::MovieParameters movie;
  std::vector<render::FigureParameters> figures;
};

/// Calls v(const Section&, struct or vector of structs) for each table of a scene file, in its order.
template <class S, class V>
requires std::same_as<std::remove_const_t<S>, Settings>
void visit_sections(S& settings, V&& v) {
  sim::visit_sections(settings.scene, v);
  v(sim::Section{"view", "how a frame looks", false}, settings.view);
  v(sim::Section{"key_frame", "the camera at one time; several make it move", false}, settings.key_frames);
  v(sim::Section{"movie", "which frames there are", false}, settings.movie);
  v(sim::Section{"figure", "one figure a table", false}, settings.figures);
}

/// Limits for one run and one movie. More would take years.
inline constexpr double most_steps = 1e9, most_frames = 1e7;

/// The key whose value determines which other keys of a table are used, e.g. `kind` of [flow].
struct Selector {
  std::string_view section, key, catalogue;
  std::string_view noun;  ///< in messages: flow 'shear'
};
inline constexpr std::array<Selector, 3> selectors{{{"flow", "kind", "flows", "flow"},
                                                    {"vesicle", "shape", "shapes", "shape"},
                                                    {"placement", "kind", "placements", "placement"}}};

/// Keys of the time factor of a flow.
struct TimeFactorKey {
  std::string_view key, factor;
};
inline constexpr std::array<TimeFactorKey, 4> time_factor_keys{
    {{"frequency", "oscillating"}, {"phase", "oscillating"}, {"from", "step"}, {"until", "step"}}};

}  // namespace app
