// Everything that evolves in a simulation, and its exact serialisation, from which a run continues bit for bit. A
// stepper maps Dynamics to Dynamics.
#pragma once

#include "labels.h"
#include "membrane.h"
#include "trajectory.h"

#include <span>

namespace sim {

struct VesicleDynamics {
  Coefficients position;        ///< x_n
  Coefficients displacement;    ///< w = uncorrected x_n - x_{n-1} carried to t_n by `carrier`; current parametrisation
  Motion motion;                ///< velocity and tension of the last solve: the next guess
  Frame frame, frame_before;    ///< rigid motion of the shape at t_n and t_{n-1}
  Frame carrier;                ///< mean frame of the last step
  Coefficients labels;
  Matrix tracers;               ///< parameters of the tracer dots
  Coefficients saved_position;  ///< of the last saved state, in the current parametrisation
  Coefficients saved_velocity;
  double area = 0, volume = 0;  ///< A0, V0: of the initial surface as represented
  double energy = 0;            ///< E/(8 pi kappa) of x_n
  double tail = 0;              ///< share of the mean curvature's spectrum in its last quarter of degrees
  int upsampling = 2;
  double upsampling_due = 0;    ///< time of the next run of Algorithm 1
  double high_share = 0;        ///< high-degree share of x after the last relabelling, the least since
  std::int64_t relabelled = 0, labels_laid = 0;
  double labels_laid_time = 0;
  bool warned = false;          ///< the warning that its order does not resolve it was given: once per vesicle and run
};

struct Dynamics {
  std::int64_t step = 0;        ///< accepted steps
  std::int64_t saves = 0;       ///< saved states, the initial one included
  double time = 0;
  double dt_before = 0;         ///< length of the last step
  double dt_limit = 0;          ///< current longest step: halved after a failure, doubled after calm steps
  std::int64_t calm = 0;        ///< accepted steps since dt_limit changed
  bool history = false;         ///< displacement is valid
  std::vector<VesicleDynamics> vesicles;
};

std::vector<double> serialised(const Dynamics&);
/// The inverse; throws std::runtime_error unless the numbers are the complete state of a run for a trajectory of this
/// layout: counts, orders and sizes are consistent and within the layout, all numbers are finite, none is left over.
Dynamics deserialised(std::span<const double>, const TrajectoryLayout&);

}  // namespace sim
