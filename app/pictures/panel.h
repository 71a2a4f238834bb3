// A panel: one view of one trajectory, with all that its frames share. A value; production.h makes it.
#pragma once

#include "app/pictures/captions.h"
#include "app/pictures/painting.h"

#include "sim/trajectory/trajectory.h"

namespace app {

/// One trajectory with its scene, whose picture settings may have been changed.
struct PictureSource {
  const sim::TrajectoryReader& trajectory;
  const Settings& settings;
};

/// One view of one trajectory, a part of a picture or all of it.
struct ViewPanel {
  PictureSource source;
  render::ViewParameters view;  ///< with the panel's own size and camera
  render::Framing framing = {};
  int arrow_net = 1;               ///< how much finer than usual, as for render::arrow_points()
  double arrow_speed = 0;          ///< of the longest arrow, in the scene's units; 0: there are none
  glm::dvec2 inset_centre{0};      ///< (x, z) of the inset; relative to what a following camera follows
  glm::dvec2 inset_half{1};        ///< half of the extent it must contain
  render::Captions captions = {};  ///< without the time
  Painting painting = {};
  bool stamped = true;            ///< shows the time and notes
  std::vector<double> laid = {};  ///< times at which labels were reset on any vesicle
  double notice = 0;              ///< how long before and after a reset a note is shown, in scene time
  TimeFormat time_format = {};
  std::vector<sim::StepRecord> steps = {};  ///< where their errors are shown
};

}  // namespace app
