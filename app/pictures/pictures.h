// Pictures: the frame of one instant, drawn; and stills as panels of figures.
#pragma once

#include "app/base/options.h"
#include "app/pictures/instants.h"
#include "app/pictures/production.h"

#include "render/draw/draw.h"
#include "render/scene/detail.h"
#include "render/scene/section.h"
#include "sim/layers/plans.h"

#include <optional>

namespace app {

/// Renderer, meshes and plans, shared by all pictures.
struct Studio {
  render::Renderer renderer;
  render::MeshLevels meshes;
  sim::Plans plans;
  std::optional<render::SectionPlan> sections;  ///< of the style that opens membranes
  render::Font font = render::caption_font();
  Studio(const render::GlChoice&, const std::filesystem::path& shader_dir, int picture_height);
};

/// RGB, or RGBA without a ground; production.width x production.height.
render::Image draw_picture(Studio&, const Production&, double time);

/// For stills of any size.
Studio studio_of_stills(const Options&);

/// One instant as a panel of a figure: orthographic, without captions, `half_height` above and below `target`.
struct Still {
  double time = 0;
  sim::Vec3 target = sim::Vec3::Zero();
  double half_height = 2;
  int width = 600, height = 400;
  bool alone = false;  ///< only the first vesicle
};
struct DrawnStills {
  std::vector<render::Image> images;
  std::optional<render::Legend> legend;  ///< of the field they show
};
/// background: as view.background; legend: of the field, where it is shared with others; else that of the movie.
DrawnStills draw_stills(Studio&, const PictureSource&, const std::optional<render::Legend>& legend,
                        const std::string& background, const std::vector<Still>&);
/// That of the movies of all; nothing where their range is not to be shared, or they show no field.
std::optional<render::Legend> shared_legend(const std::vector<PictureSource>&);

}  // namespace app
