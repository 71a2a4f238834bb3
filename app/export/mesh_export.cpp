#include "app/export/mesh_export.h"

#include "app/base/version.h"
#include "app/scene/output.h"

#include "render/scene/mesh.h"
#include "render/scene/surface.h"
#include "sim/layers/plans.h"
#include "sim/surface/geometry.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <map>

namespace app {

namespace fs = std::filesystem;

namespace {

static_assert(std::endian::native == std::endian::little, "meshes are written in the machine's byte order");

/// One vesicle on the mesh: points x 3, and the columns of mesh_fields side by side.
struct Sampled {
  sim::Matrix points, fields;
};

/// What all states share.
class Sampler {
 public:
  explicit Sampler(int latitudes) : plan_(latitudes, 2 * latitudes) {
    directions_.resize(plan_.vertices(), 3);
    Eigen::Index row = 0;
    for (int j = 0; j < plan_.longitudes(); ++j)
      for (int i = 1; i < plan_.latitudes(); ++i, ++row)
        directions_.row(row) = sim::unit_vector(plan_.theta()[i], plan_.phi()[j]).transpose();
    directions_.row(row++) << 0, 0, 1;
    directions_.row(row) << 0, 0, -1;
  }

  const render::MeshPlan& plan() const { return plan_; }

  Sampled sample(const sim::VesicleState& v, std::size_t number) {
    const render::SurfacePoints surface = render::surface_points(v.position, directions_);
    Sampled result{surface.position, sim::Matrix(plan_.vertices(), 12)};
    sim::Matrix label = at(v.labels);
    label.rowwise().normalize();
    // Evaluated first: what throws between the columns leaves the initializer unfinished, which Eigen asserts against.
    const sim::Matrix velocity = at(v.velocity), tension = at(v.tension), curvature = at(mean_curvature(v.position));
    result.fields << surface.normal, velocity, tension, curvature, label,
        sim::Vector::Constant(plan_.vertices(), static_cast<double>(number));
    return result;
  }

 private:
  sim::Matrix at(const sim::Coefficients& c) {
    auto [functions, fresh] = functions_.try_emplace(c.order);
    if (fresh) functions->second = sim::basis_functions(c.order, directions_);
    return functions->second * c.values;
  }

  /// Of twice the surface's degree: curvature is no polynomial of its coefficients.
  sim::Coefficients mean_curvature(const sim::Coefficients& position) {
    const int fine = 2 * position.order, grid = fine + 8;
    const sim::Geometry g = sim::geometry(plans_.basis(position.order, grid), position);
    return plans_.basis(fine, grid).analyze(sim::Matrix(g.H));
  }

  render::MeshPlan plan_;
  sim::Matrix directions_;
  std::map<int, sim::Matrix> functions_;  ///< by degree
  sim::Plans plans_;
};

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// Length, then data, as VTK wants them.
template <class T>
std::string data_array(const char* type, std::string_view name, int components, const std::vector<T>& values) {
  const std::uint64_t size = values.size() * sizeof(T);
  std::string bytes(reinterpret_cast<const char*>(&size), sizeof size);
  bytes += bytes_of(values);
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}</DataArray>\n",
                     type, name, components, base64(bytes));
}

void append_rows(std::vector<float>& to, const sim::Matrix& rows, Eigen::Index first, Eigen::Index count) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    for (Eigen::Index c = first; c < first + count; ++c) to.push_back(static_cast<float>(rows(i, c)));
}

std::string vtk_text(const sim::State& state, Sampler& sampler) {
  std::vector<double> points;
  std::vector<std::int32_t> corners, ends;
  std::vector<Sampled> vesicles;
  for (std::size_t v = 0; v < state.vesicles.size(); ++v) {
    const auto before = static_cast<std::int32_t>(points.size() / 3);
    vesicles.push_back(sampler.sample(state.vesicles[v], v));
    for (Eigen::Index i = 0; i < vesicles.back().points.rows(); ++i)
      for (Eigen::Index c = 0; c < 3; ++c) points.push_back(vesicles.back().points(i, c));
    for (const std::uint32_t corner : sampler.plan().indices())
      corners.push_back(before + static_cast<std::int32_t>(corner));
  }
  for (std::size_t end = 3; end <= corners.size(); end += 3) ends.push_back(static_cast<std::int32_t>(end));
  std::string fields;
  Eigen::Index column = 0;
  for (const MeshField& field : mesh_fields) {
    std::vector<float> values;
    for (const Sampled& vesicle : vesicles) append_rows(values, vesicle.fields, column, field.components);
    fields += data_array("Float32", field.name, field.components, values);
    column += field.components;
  }
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{}</DataArray>\n"
      "</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n"
      "<PointData Scalars=\"tension\" Vectors=\"velocity\" Normals=\"normal\">\n{}</PointData>\n<Points>\n{}</Points>\n"
      "<Polys>\n{}{}</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n",
      state.time, points.size() / 3, ends.size(), fields, data_array("Float64", "Points", 3, points),
      data_array("Int32", "connectivity", 1, corners), data_array("Int32", "offsets", 1, ends));
}

std::string ply_text(const sim::VesicleState& v, std::size_t number, double time, Sampler& sampler) {
  std::string names = "property float x\nproperty float y\nproperty float z\n";
  for (const MeshField& field : mesh_fields)
    for (int c = 0; c < field.components; ++c)
      names += std::string_view(field.name) == "normal" ? fmt::format("property float n{}\n", "xyz"[c])
               : field.components == 1                  ? fmt::format("property float {}\n", field.name)
                                                        : fmt::format("property float {}_{}\n", field.name, "xyz"[c]);
  const auto indices = sampler.plan().indices();
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment tanktread {}, vesicle {} at time {}\n"
      "element vertex {}\n{}element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      version(), number, time, sampler.plan().vertices(), names, indices.size() / 3);
  const Sampled sampled = sampler.sample(v, number);
  std::vector<float> row;
  for (Eigen::Index i = 0; i < sampled.points.rows(); ++i) {
    row.clear();
    append_rows(row, sampled.points.row(i), 0, 3);
    append_rows(row, sampled.fields.row(i), 0, sampled.fields.cols());
    text += bytes_of(row);
  }
  for (std::size_t k = 0; k < indices.size(); k += 3) {
    text += '\3';
    text += bytes_of(std::vector<std::uint32_t>(indices.begin() + static_cast<std::ptrdiff_t>(k),
                                                indices.begin() + static_cast<std::ptrdiff_t>(k) + 3));
  }
  return text;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("cannot make folder '{}': {}", folder.string(), error.message()));
}

}  // namespace

std::string vtk_name(std::int64_t state) { return fmt::format("state-{:06}.vtp", state); }
std::string ply_name(std::size_t vesicle, std::int64_t state) {
  return fmt::format("vesicle-{}-{:06}.ply", vesicle, state);
}

std::int64_t export_vtk(const sim::TrajectoryReader& trajectory, const MeshExport& how, const sim::FileWriter& write,
                        const ExportProgress& progress) {
  make_folder(how.folder);
  Sampler sampler(how.latitudes);
  std::string series;
  std::int64_t k = how.first;
  for (; k < how.end && progress(k - how.first, how.end - how.first); ++k) {
    const sim::State state = trajectory.state(k);
    const std::string name = vtk_name(k);
    write(how.folder / name, vtk_text(state, sampler));
    series += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", state.time, name);
  }
  write(how.folder / vtk_series,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
        "byte_order=\"LittleEndian\">\n<Collection>\n" +
            series + "</Collection>\n</VTKFile>\n");
  return k - how.first;
}

std::int64_t export_ply(const sim::TrajectoryReader& trajectory, const MeshExport& how, const sim::FileWriter& write,
                        const ExportProgress& progress) {
  make_folder(how.folder);
  Sampler sampler(how.latitudes);
  std::int64_t k = how.first;
  for (; k < how.end && progress(k - how.first, how.end - how.first); ++k) {
    const sim::State state = trajectory.state(k);
    for (std::size_t v = 0; v < state.vesicles.size(); ++v)
      write(how.folder / ply_name(v, k), ply_text(state.vesicles[v], v, state.time, sampler));
  }
  return k - how.first;
}

}  // namespace app
