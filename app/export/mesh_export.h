// `tanktread export --vtk` and `--ply`: saved states as triangle meshes with fields, for ParaView and for Blender.
#pragma once

#include "sim/core/result_file.h"
#include "sim/trajectory/trajectory.h"

#include <filesystem>
#include <functional>
#include <string>

namespace app {

struct MeshExport {
  std::filesystem::path folder;
  std::int64_t first = 0, end = 0;  ///< indices of the states: first, ..., end - 1
  int latitudes = 64;               ///< triangles per vesicle: 4 x latitudes x (latitudes - 1)
};

/// Fields of every point, in the order of the files.
struct MeshField {
  const char *name, *meaning;
  int components;
};
inline constexpr MeshField mesh_fields[] = {
    {"normal", "outward unit normal", 3},
    {"velocity", "of the membrane", 3},
    {"tension", "sigma", 1},
    {"mean_curvature", "H, -1/R on a sphere", 1},
    {"label", "material label: where the point started, a unit vector", 3},
    {"vesicle", "number of the vesicle, from 0", 1},
};

/// Called with (states written, total) before each state; false stops.
using ExportProgress = std::function<bool(std::int64_t, std::int64_t)>;

/// File names in the folder.
std::string vtk_name(std::int64_t state);
inline constexpr const char vtk_series[] = "series.pvd";
std::string ply_name(std::size_t vesicle, std::int64_t state);

/// FOLDER/state-000000.vtp, ... with all vesicles, and FOLDER/series.pvd with the times. The series refers only to
/// complete files; it is written last. Returns the number of states written.
std::int64_t export_vtk(const sim::TrajectoryReader&, const MeshExport&, const sim::FileWriter&, const ExportProgress&);
/// FOLDER/vesicle-0-000000.ply, ...: one file per vesicle and state, binary.
std::int64_t export_ply(const sim::TrajectoryReader&, const MeshExport&, const sim::FileWriter&, const ExportProgress&);

}  // namespace app
