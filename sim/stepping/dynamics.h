// Everything that evolves in a simulation, and its exact form as a list of numbers, from which a run continues bit for
// bit. A stepper maps Dynamics to Dynamics.
//
// The members of a vesicle's state are said once, in visit(): whoever writes, reads, initialises or relabels a state
// walks it.
#pragma once

#include "sim/core/attempt.h"
#include "sim/core/ranks.h"
#include "sim/membrane/learned.h"
#include "sim/membrane/membrane.h"
#include "sim/stepping/history.h"
#include "sim/surface/labels.h"
#include "sim/trajectory/trajectory.h"

#include <concepts>
#include <span>
#include <type_traits>

namespace sim {

struct VesicleDynamics {
  Coefficients position;  ///< x_n
  History history;        ///< x_{n-1}, ... as far as the scheme looks back; empty at a start
  Motion motion;          ///< velocity and tension of the last solve
  Coefficients sliding;   ///< w_n: velocity of the grid points relative to the membrane, and that of the correction
  Frame frame;            ///< the motion of its shape at t_n
  Coefficients labels;
  Matrix tracers;               ///< parameters of the tracer dots
  Coefficients saved_position;  ///< of the last saved state, in the current parametrisation
  Coefficients saved_velocity;  ///< of its points, sliding included
  double area = 0, volume = 0;  ///< A0, V0: of the initial surface as represented
  double energy = 0;            ///< E/(8 pi kappa) of x_n
  double tail = 0;              ///< share of the mean curvature's spectrum in its last quarter of degrees
  double space_error = 0;       ///< estimated error of position that its degree leaves, a time, in area radii
  double upsampling = 2;
  std::int64_t upsampling_due = 0;  ///< step of the next run of Algorithm 1
  double high_share = 0;            ///< high-degree share of x after the last relabelling, the least since
  std::int64_t relabelled = 0, labels_laid = 0;
  double labels_laid_time = 0;
  bool warned = false;  ///< the warning that its order does not resolve it was given: once per vesicle and run
};

/// What a member is to those who walk the state.
enum class Part {
  vector,   ///< three fields on the parameters, of the order of the position
  scalar,   ///< one field, of that order
  label,    ///< three fields, of the order of the labels
  points,   ///< parameters of material points
  history,  ///< fields at earlier times
  motion,   ///< a frame: of the whole vesicle, not of its points
  number,
};

/// Calls f(part, member) for every member, in the order of the resume record.
template <class Vesicle, class F>
requires std::same_as<std::remove_const_t<Vesicle>, VesicleDynamics>
void visit(Vesicle& v, F&& f) {
  f(Part::vector, v.position);
  f(Part::history, v.history);
  f(Part::vector, v.motion.velocity);
  f(Part::scalar, v.motion.tension);
  f(Part::vector, v.sliding);
  f(Part::label, v.labels);
  f(Part::vector, v.saved_position);
  f(Part::vector, v.saved_velocity);
  f(Part::points, v.tracers);
  f(Part::motion, v.frame);
  f(Part::number, v.area);
  f(Part::number, v.volume);
  f(Part::number, v.energy);
  f(Part::number, v.tail);
  f(Part::number, v.space_error);
  f(Part::number, v.upsampling);
  f(Part::number, v.upsampling_due);
  f(Part::number, v.high_share);
  f(Part::number, v.relabelled);
  f(Part::number, v.labels_laid);
  f(Part::number, v.labels_laid_time);
  f(Part::number, v.warned);
}

/// After a relabelling: everything that belongs to the material at the new parameters. `tracers` follow the surface as
/// points.
void carry(Plans&, const Relabelling&, VesicleDynamics&);

/// Highest order of adaptive steps: higher ones are stable for shorter steps only.
inline constexpr int highest_order = 4;

/// What adaptive steps remember of the past; the next step is as long as the limit of Dynamics.
struct Control {
  int order = 1;
  std::int64_t at_order = 0;        ///< accepted steps of that order
  bool held = false;                ///< the last attempt failed: the step does not grow
  std::int64_t resolution_due = 0;  ///< step of the next estimate of what the degrees of the vesicles leave
  double gap = 0;                   ///< smallest between two membranes after the last step; 0: not known
};

struct Dynamics {
  std::int64_t step = 0;   ///< accepted steps
  std::int64_t saves = 0;  ///< saved states, the initial one included
  double time = 0;
  double dt_limit = 0;    ///< longest step at present; of fixed ones halved by a failure, doubled after calm steps
  std::int64_t calm = 0;  ///< of fixed steps those since a failure, of adaptive ones those that were hopelessly short
  Control control;
  std::vector<VesicleDynamics> vesicles;
  Lessons learned;           ///< what the last solve has left for the next; empty, or an entry a vesicle
  std::vector<int> keepers;  ///< the rank that has it, by vesicle; empty: each rank has all. No part of a record
};
/// What was learned, each vesicle's on the rank that a division gives it, alone.
Lessons delivered(const Lessons&, std::span<const int> keepers, const Division&);

/// Form of the resume record; a record of another version is refused.
inline constexpr int resume_version = 6;
/// More levels than any scheme looks back.
inline constexpr int most_past_levels = 8;

std::vector<double> serialised(const Dynamics&);
/// How many numbers serialised() may come to while a scheme looks back over so many levels.
std::size_t resume_numbers(const Dynamics&, int past_levels);
/// Counts and orders of a state: the part of a layout that does not depend on how long a run is.
TrajectoryLayout layout_of(const Dynamics&);
/// Of one vesicle, and of what may have been rejected, between ranks.
void transfer(Parcel&, VesicleDynamics&);
template <class T, class Transfer>
void transfer(Parcel& parcel, Attempt<T>& attempt, Transfer&& transfer_value) {
  bool rejected = !attempt;
  parcel(rejected);
  if (!rejected) return transfer_value(parcel, *attempt);
  Rejection rejection = attempt ? Rejection{} : attempt.rejection();
  parcel(rejection.reason), parcel(rejection.final);
  attempt = std::move(rejection);
}
/// The first rank's state for all ranks.
void from_first(const Ranks&, Dynamics&);

/// The inverse; throws std::runtime_error unless the numbers are the whole state of a run that a trajectory of this
/// layout holds: counts, orders and sizes fit together and within the layout, all numbers are finite, none is left
/// over.
Dynamics deserialised(std::span<const double>, const TrajectoryLayout&);

}  // namespace sim
