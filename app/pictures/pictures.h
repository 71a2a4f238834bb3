// Pictures: the frame of one instant, drawn; and stills as panels of figures.
#pragma once

#include "app/base/options.h"
#include "app/pictures/instants.h"
#include "app/pictures/production.h"

#include "render/draw/draw.h"
#include "render/scene/detail.h"
#include "sim/layers/plans.h"

namespace app {

/// Renderer, meshes and plans, shared by all pictures.
struct Studio {
  render::Renderer renderer;
  render::MeshLevels meshes;
  sim::Plans plans;
  render::Font font = render::Font();
  Studio(const render::GlChoice&, const std::filesystem::path& shader_dir, int picture_height);
};

/// RGB, or RGBA without a ground; production.width x production.height.
render::Image draw_picture(Studio&, const Production&, double time);

/// One instant as a panel of a figure: orthographic, without captions, `half_height` above and below `target`.
struct Still {
  double time = 0;
  sim::Vec3 target = sim::Vec3::Zero();
  double half_height = 2;
  int width = 600, height = 400;
};
struct DrawnStills {
  std::vector<render::Image> images;
  std::optional<render::Legend> legend;  ///< of the field they show
};
/// background: as view.background.
DrawnStills draw_stills(const sim::TrajectoryReader&, const Settings&, const std::string& background,
                        const std::vector<Still>&, const Options&);

}  // namespace app
