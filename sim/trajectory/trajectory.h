// The trajectory file: one HDF5 file that is readable at any time and survives a kill at any time.
//
// All HDF5 metadata is written once, at creation, in a draft, which is renamed when header and state 0 are complete.
// Afterwards rows are written with pwrite at the offsets HDF5 returned, and an 8-byte counter, written last, commits
// them. A state that append() has returned from is in the file, whatever happens next. See docs/trajectory.md.
#pragma once

#include "sim/core/types.h"

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// Version of the file layout. Files of earlier ones can be read, not continued. The first lacks the sliding of the
/// grid, and the order and the error of steps; the second the order of each vesicle in a step and the error that it
/// leaves. They are then zero.
inline constexpr int trajectory_format = 3;

/// Highest order of any field or label in a file.
inline constexpr int largest_order = 128;

/// Sizes that are fixed for one file. States, steps and resume grow by themselves when they are exceeded.
struct TrajectoryLayout {
  int vesicles = 1;
  int order = 8;            ///< room for fields of so high an order; it grows, too
  int label_order = 24;     ///< likewise of the labels
  int tracers = 14;         ///< dots of each vesicle
  std::int64_t states = 1;  ///< rows for saved states, state 0 included
  std::int64_t steps = 1;   ///< rows for step records
  std::int64_t resume = 1;  ///< numbers in a resume payload
  int format = trajectory_format;
};

/// Metadata of a file, fixed at creation.
struct TrajectoryHeader {
  std::string scene;                  ///< the resolved scene, TOML
  std::string program;                ///< version of the program
  std::string build;                  ///< compiler and options
  std::vector<std::string> warnings;  ///< known before the first step, one sentence each
};

/// Diagnostics of one vesicle after one step.
struct VesicleStep {
  double area_error = 0, volume_error = 0, energy = 0, upsampling = 0, tail = 0, correction = 0, relabelled = 0;
  double degree = 0, space_error = 0;
};

/// Diagnostics of one accepted step; steps are numbered from 1 (0: the initial state).
struct StepRecord {
  double step = 0, time = 0, dt = 0, iterations = 0, residual = 0, retries = 0, gap = 0, order = 0, error = 0;
  std::vector<VesicleStep> vesicles;
};

/// The columns of the step records, declared once: v(name, meaning, double&).
template <class R, class V>
requires std::same_as<std::remove_const_t<R>, StepRecord>
void visit(R& r, V&& v) {
  v("step", "number of the step, from 1", r.step);
  v("time", "at the end of the step", r.time);
  v("dt", "length of the step", r.dt);
  v("iterations", "of the linear solver", r.iterations);
  v("residual", "relative, of the linear solver", r.residual);
  v("retries", "rejected attempts with longer steps", r.retries);
  v("gap", "least distance between two vesicles; infinite for one", r.gap);
  v("order", "of the scheme in this step", r.order);
  v("error", "estimated error of position that the step leaves, in area radii", r.error);
}
/// ... and of each vesicle.
template <class R, class V>
requires std::same_as<std::remove_const_t<R>, VesicleStep>
void visit(R& r, V&& v) {
  v("area_error", "A / A0 - 1", r.area_error);
  v("volume_error", "V / V0 - 1", r.volume_error);
  v("energy", "bending energy / (8 pi kappa)", r.energy);
  v("upsampling", "grid factor of differentiation", r.upsampling);
  v("tail", "share of the mean curvature's spectrum in its tail", r.tail);
  v("correction", "largest shift of the area and volume correction", r.correction);
  v("relabelled", "1 when this step moved the grid points along the membrane", r.relabelled);
  v("degree", "order of the vesicle in this step", r.degree);
  v("space_error", "estimated error of position that the step leaves because of that order, in area radii",
    r.space_error);
}

/// Whether this file is a trajectory of this program, damaged or not; false also when it does not exist or cannot be
/// read.
bool holds_trajectory(const std::filesystem::path&);

/// Writes one trajectory and holds a lock on the file, so that a second writer is refused under any name.
class TrajectoryWriter {
 public:
  /// A new file with its first state; an existing trajectory is replaced, a link is followed, anything else is left
  /// unchanged. `ready` is called when only the name is missing; if it throws, the file is not created. Errors are
  /// std::runtime_error with one sentence.
  static TrajectoryWriter create(const std::filesystem::path&, const TrajectoryLayout&, const TrajectoryHeader&,
                                 const State& first, std::span<const double> resume_payload,
                                 const std::function<void()>& ready = {});
  /// Continues an existing file after its last state.
  static TrajectoryWriter resume(const std::filesystem::path&);

  TrajectoryWriter(TrajectoryWriter&&) noexcept;
  TrajectoryWriter& operator=(TrajectoryWriter&&) noexcept;
  ~TrajectoryWriter();

  const TrajectoryHeader& header() const;
  const TrajectoryLayout& layout() const;
  std::int64_t count() const;  ///< states in the file
  double last_time() const;    ///< time of the last of them

  /// The latest intact payload of write_resume().
  std::vector<double> resume_payload() const;

  /// Whether the file is that of a run after `step` steps, at `time`, with `saves` saved states.
  bool holds(std::int64_t step, double time, std::int64_t saves) const;
  /// Continues with another scene and room for at least so many rows: the file is rewritten and then replaced
  /// atomically.
  void continue_as(std::string_view scene, const TrajectoryLayout& room);
  /// Room for fields of higher orders: the file is rewritten and replaced likewise where it has none.
  void make_room(const TrajectoryLayout& room);

  /// Appends records, then the state, and returns when both are committed. After a resume the steps between the
  /// resume payload and the end of the file are repeated: states and records not newer than the file's last are
  /// skipped.
  void append(const State&, std::span<const StepRecord> = {});
  void append_steps(std::span<const StepRecord>);
  /// What the stepper needs to continue bit for bit; two slots in turn, so that one is always complete. Call it after
  /// the append of the same step, at least once a second.
  void write_resume(std::span<const double> payload);
  /// The final record of a run that ends after `step` steps: fills both slots, so that the bytes of the file do not
  /// depend on how often the record was renewed before.
  void finish_resume(std::span<const double> payload, std::int64_t step);
  /// A note of the run (a warning, why it stopped): at most 255 bytes, 64 in a file, equal ones only once.
  void note(std::string_view);

 private:
  struct Impl;
  explicit TrajectoryWriter(std::unique_ptr<Impl>);
  std::unique_ptr<Impl> impl_;
};

/// Reads a trajectory, also while it is being written.
class TrajectoryReader {
 public:
  explicit TrajectoryReader(const std::filesystem::path&);
  TrajectoryReader(TrajectoryReader&&) noexcept;
  TrajectoryReader& operator=(TrajectoryReader&&) noexcept;
  ~TrajectoryReader();

  const TrajectoryHeader& header() const;
  const TrajectoryLayout& layout() const;
  std::int64_t count() const;         ///< states at the last refresh()
  std::int64_t refresh();             ///< reads the counter again and returns count()
  State state(std::int64_t k) const;  ///< 0 <= k < count(); a damaged row is an error that names it
  double time(std::int64_t k) const;  ///< of that state, cheaply
  std::vector<StepRecord> steps() const;
  std::vector<std::string> notes() const;
  std::vector<double> resume_payload() const;
  /// Whether the last write was a complete finish_resume() after so many steps.
  bool finished_after(std::int64_t step) const;
  /// States whose checksum does not match.
  std::vector<std::int64_t> damaged() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sim
