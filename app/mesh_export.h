// `tanktread export --vtk` and `--ply`: saved states as triangle meshes with fields, for ParaView and for Blender.
#pragma once

#include "sim/result_file.h"
#include "sim/trajectory.h"

#include <filesystem>
#include <functional>
#include <string>

namespace app {

struct MeshExport {
  std::filesystem::path folder;
  std::int64_t first = 0, end = 0;  ///< numbers of the states: first, ..., end - 1
  int latitudes = 64;  ///< triangles a vesicle: 4 x latitudes x (latitudes - 1)
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

/// Hears (states written, of states) before each; false stops.
using ExportProgress = std::function<bool(std::int64_t, std::int64_t)>;

/// Names in the folder.
std::string vtk_name(std::int64_t state);
inline constexpr const char vtk_series[] = "series.pvd";
std::string ply_name(std::size_t vesicle, std::int64_t state);

/// FOLDER/state-000000.vtp, ... with all vesicles, and FOLDER/series.pvd with the times. The series names whole files only;
/// it is written last. Returns the number of states written.
std::int64_t export_vtk(const sim::TrajectoryReader&, const MeshExport&, const sim::FileWriter&, const ExportProgress&);
/// FOLDER/vesicle-0-000000.ply, ...: one file a vesicle and state, binary.
std::int64_t export_ply(const sim::TrajectoryReader&, const MeshExport&, const sim::FileWriter&, const ExportProgress&);

}  // namespace app
