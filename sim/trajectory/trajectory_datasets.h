// What stands in the file of a trajectory: its datasets with their extents, from the layout alone.
// Internal to the trajectory.
#pragma once

#include "sim/trajectory/trajectory_rows.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sim::file {

inline constexpr std::string_view content = "tanktread trajectory";  ///< what the file says that it is
inline constexpr std::string_view signature = "\211HDF\r\n\032\n";   ///< with which an HDF5 file begins
inline constexpr std::uint64_t metadata_bytes = 65536;               ///< of HDF5, at the head of the file
inline constexpr std::uint64_t most_warning_bytes = 24 << 10;        ///< of all that are kept
inline constexpr std::uint64_t note_bytes = 256, note_rows = 64;

enum class Kind { real, integer, text };

struct Dataset {
  std::string name, meaning;
  Kind kind = Kind::real;
  std::vector<std::uint64_t> shape;  ///< rows first; empty: one number
  std::uint64_t text_bytes = 0;      ///< of one string

  std::uint64_t rows() const { return shape.empty() ? 1 : shape.front(); }
  std::uint64_t row_bytes() const {
    std::uint64_t size = kind == Kind::text ? text_bytes : 8;
    for (std::size_t i = 1; i < shape.size(); ++i) size *= shape[i];
    return size;
  }
};

/// All of them, small ones first: a truncated file then keeps its index. A scene of 0 bytes takes one.
std::vector<Dataset> datasets(const TrajectoryLayout&, std::uint64_t scene_bytes);

/// The sizes of a layout as attributes: v(name, number, least, largest); beyond, a file is damaged.
template <class L, class V>
void visit_layout(L& layout, V&& v) {
  constexpr std::int64_t many = 1 << 24, rows = std::int64_t{1} << 40;
  v("vesicles", layout.vesicles, 1, many);
  v("highest_order", layout.order, 0, largest_order);
  v("highest_label_order", layout.label_order, 0, largest_order);
  v("tracers_per_vesicle", layout.tracers, 0, many);
  v("state_rows", layout.states, 0, rows);
  v("step_rows", layout.steps, 0, rows);
  v("resume_numbers", layout.resume, 0, rows);
}

std::uint64_t scene_checksum(const std::string& scene);

}  // namespace sim::file
