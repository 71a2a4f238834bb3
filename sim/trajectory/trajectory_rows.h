// How a state and a step record become rows of a trajectory: the columns, in file order, and the 8-byte words of one
// row. Every number takes 8 bytes, a little-endian double or unsigned integer. Internal to the trajectory.
#pragma once

#include "sim/trajectory/trajectory.h"

#include <bit>
#include <stdexcept>

namespace sim::rows {

static_assert(std::endian::native == std::endian::little, "trajectories are written in the machine's byte order");

struct Column {
  std::string name, meaning;
  bool integer = false;
  std::vector<std::uint64_t> shape;  ///< of one row; empty: one number
};

/// Numbers in one row of a column.
std::uint64_t width(const Column&);

/// Numbers that are not a row of such a trajectory; the message says why.
struct Unfit : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The bits of a whole row, column after column.
using Words = std::vector<std::uint64_t>;

std::vector<Column> state_columns(const TrajectoryLayout&);
/// A state must fit the layout: vesicles, orders, tracers; otherwise std::runtime_error.
Words pack(const State&, const TrajectoryLayout&);
/// Throws Unfit for orders beyond the layout, negative counts, NaN and infinity.
State unpack_state(const Words&, const TrajectoryLayout&);

std::vector<Column> step_columns(const TrajectoryLayout&);
Words pack(const StepRecord&, const TrajectoryLayout&);
StepRecord unpack_step(const Words&, const TrajectoryLayout&);

/// 2^32 | crc32(row number, bytes): never 0, which marks a row that was never written.
std::uint64_t checksum(std::uint64_t row, std::span<const std::byte> bytes);

}  // namespace sim::rows
