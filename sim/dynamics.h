// Everything that evolves in a simulation, and its exact form as a list of numbers, from which a run continues bit for
// bit. A stepper maps Dynamics to Dynamics.
#pragma once

#include "labels.h"
#include "membrane.h"
#include "trajectory.h"

#include <span>

namespace sim {

struct VesicleDynamics {
  Coefficients position;        ///< x_n
  Coefficients displacement;    ///< w = x_n, before its correction, less x_{n-1} as `carrier` carries it to t_n; in the present parametrisation
  Motion motion;                ///< velocity and tension of the last solve: the next guess
  Frame frame, frame_before;    ///< the motion of its shape at t_n and t_{n-1}
  Frame carrier;                ///< the mean one of the frame of the last step
  Coefficients labels;
  Matrix tracers;               ///< parameters of the tracer dots
  Coefficients saved_position;  ///< of the last saved state, in the present parametrisation
  Coefficients saved_velocity;
  double area = 0, volume = 0;  ///< A0, V0: of the initial surface as represented
  double energy = 0;            ///< E/(8 pi kappa) of x_n
  double tail = 0;              ///< share of the mean curvature's spectrum in its last quarter of degrees
  int upsampling = 2;
  double upsampling_due = 0;    ///< time of the next run of Algorithm 1
  double high_share = 0;        ///< high-degree share of x after the last relabelling, the least since
  std::int64_t relabelled = 0, labels_laid = 0;
  double labels_laid_time = 0;
  bool warned = false;          ///< its order does not resolve it, which has been said: once a vesicle and run
};

struct Dynamics {
  std::int64_t step = 0;        ///< accepted steps
  std::int64_t saves = 0;       ///< saved states, the initial one included
  double time = 0;
  double dt_before = 0;         ///< length of the last step
  double dt_limit = 0;          ///< longest step at present: halved by a failure, doubled after calm steps
  std::int64_t calm = 0;        ///< accepted steps since dt_limit changed
  bool history = false;         ///< displacement is meaningful
  std::vector<VesicleDynamics> vesicles;
};

std::vector<double> serialised(const Dynamics&);
/// The inverse; throws std::runtime_error unless the numbers are the whole state of a run that a trajectory of this layout
/// holds: counts, orders and sizes fit together and within the layout, all numbers are finite, none is left over.
Dynamics deserialised(std::span<const double>, const TrajectoryLayout&);

}  // namespace sim
