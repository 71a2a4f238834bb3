// From a trajectory to single pictures: what all frames of a movie share, and the picture of one instant.
#pragma once

#include "app/pictures/captions.h"
#include "app/pictures/painting.h"
#include "app/base/options.h"

#include "render/draw/draw.h"

namespace app {

/// The state at any time of a trajectory: cubic Hermite interpolation between saved states; the first and last state
/// outside.
sim::State state_at(const sim::TrajectoryReader&, double time);

/// One trajectory with its scene, whose picture settings may have been changed.
struct PictureSource {
  const sim::TrajectoryReader& trajectory;
  const Settings& settings;
};

/// One view of one trajectory, a part of a picture or all of it.
struct ViewPanel {
  PictureSource source;
  render::ViewParameters view;  ///< with the panel's own size and camera
  render::Framing framing;
  double arrow_speed = 0;
  glm::dvec2 inset_centre{0};  ///< (x, z) of the inset; relative to what a following camera follows
  glm::dvec2 inset_half{1};    ///< half of the extent it must contain
  render::Captions captions;  ///< without the time
  Painting painting;
  bool stamped = true;  ///< shows the time and notes
  std::vector<double> laid;  ///< times at which labels were reset on any vesicle
  double notice = 0;         ///< how long before and after a reset a note is shown, in scene time
  TimeFormat time_format = {};
};

struct Production {
  std::vector<ViewPanel> panels;  ///< row by row
  int columns = 1, rows = 1;
  int width = 0, height = 0;  ///< of the whole picture
  std::string hash;           ///< of everything that a picture depends on except its time
};

/// Passes over each trajectory once. Several sources are drawn side by side, with one row per source if there are
/// several views; size and style of the whole are those of the first. `still`: the time of the only picture. Throws
/// std::invalid_argument with one sentence when nothing would be visible.
Production prepare_pictures(const std::vector<PictureSource>&, std::optional<double> still = {});

/// Renderer, mesh and plans, shared by all pictures.
struct Studio {
  render::Renderer renderer;
  std::shared_ptr<const render::MeshPlan> mesh;
  sim::Plans plans;
  Studio(const render::GlChoice&, const std::filesystem::path& shader_dir, int picture_height);
};

render::Image draw_picture(Studio&, const Production&, double time);

/// One instant as a panel of a figure: orthographic, without captions, `half_height` above and below `target`.
struct Still {
  double time = 0;
  sim::Vec3 target = sim::Vec3::Zero();
  double half_height = 2;
  int width = 600, height = 400;
};
std::vector<render::Image> draw_stills(const sim::TrajectoryReader&, const Settings&, const std::vector<Still>&,
                                       const Options&);

}  // namespace app
