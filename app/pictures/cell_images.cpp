#include "app/pictures/cell_images.h"

#include "sim/membrane/cell.h"

#include <cmath>
#include <numbers>

namespace app {

namespace {

const double coefficient_of_one = std::sqrt(4 * std::numbers::pi);

sim::Vec3 middle_of(const sim::VesicleState& v) { return v.position.values.row(0).transpose() / coefficient_of_one; }

}  // namespace

sim::VesicleState moved(sim::VesicleState v, const sim::Vec3& shift) {
  const Eigen::RowVector3d change = coefficient_of_one * shift.transpose();
  v.position.values.row(0) += change;
  v.position_before.values.row(0) += change;
  return v;
}

sim::State boxed(const sim::Scene& scene, sim::State state) {
  if (!scene.cell.size) return state;
  for (sim::VesicleState& v : state.vesicles) {
    const sim::Vec3 middle = middle_of(v), shift = sim::into_box(scene, state.time, middle);
    if (shift.isZero(0)) continue;
    v = moved(std::move(v), shift);
    sim::Matrix both(2, 3);
    both << (middle + shift).transpose(), middle.transpose();
    const sim::Matrix u = sim::background_velocity(scene.flows, state.time, both);
    v.velocity.values.row(0) += coefficient_of_one * (u.row(0) - u.row(1));
  }
  return state;
}

std::optional<render::FaceBox> faces_of(const sim::Scene& scene, const render::ViewParameters& view) {
  if (!scene.cell.size || view.faces != "cut") return {};
  render::FaceBox box;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto axis = static_cast<glm::length_t>(d);
    box.high[axis] = (view.copies[d] + 0.5) * (*scene.cell.size)[static_cast<Eigen::Index>(d)];
    box.low[axis] = -box.high[axis];
  }
  return box;
}

std::vector<sim::Vec3> shifts_into(const Eigen::Matrix3d& sides, const sim::Box& vesicle,
                                   const render::FaceBox& shown) {
  const sim::Vec3 low = render::to_sim(shown.low), high = render::to_sim(shown.high);
  // Of shifts by k sides along axis d, on top of `before`: the first and the last that meet the box there.
  const auto first = [&](int d, const sim::Vec3& before) {
    return static_cast<int>(std::ceil((low[d] - vesicle.high[d] - before[d]) / sides(d, d)));
  };
  const auto last = [&](int d, const sim::Vec3& before) {
    return static_cast<int>(std::floor((high[d] - vesicle.low[d] - before[d]) / sides(d, d)));
  };
  std::vector<sim::Vec3> shifts;
  const sim::Vec3 zero = sim::Vec3::Zero();
  for (int c = first(2, zero); c <= last(2, zero); ++c) {
    const sim::Vec3 up = c * sides.col(2);  // leans along x
    for (int b = first(1, up); b <= last(1, up); ++b) {
      const sim::Vec3 across = up + b * sides.col(1);
      for (int a = first(0, across); a <= last(0, across); ++a) shifts.push_back(across + a * sides.col(0));
    }
  }
  return shifts;
}

std::size_t cells_shown(const sim::Scene& scene, const render::ViewParameters& view) {
  std::size_t cells = 1;
  if (scene.cell.size)
    for (const int copies : view.copies) cells *= 2 * static_cast<std::size_t>(copies) + 1;
  return cells;
}

render::StateSummary summary_of(const sim::Scene& scene, const sim::State& state) {
  render::StateSummary summary = render::summarize(state);
  if (scene.cell.size) summary.centroid = glm::dvec3(0);
  return summary;
}

Whereabouts whereabouts_of(const sim::VesicleState& vesicle, const std::array<glm::dvec3, 2>& bounds) {
  return {middle_of(vesicle), {render::to_sim(bounds[0]), render::to_sim(bounds[1])}};
}

std::vector<Shown> shown_of(const sim::Scene& scene, const render::ViewParameters& view,
                            const std::vector<Whereabouts>& vesicles, double time) {
  std::vector<Shown> all;
  const sim::CellSides sides = sim::cell_at(scene, time);
  if (const std::optional<render::FaceBox> faces = faces_of(scene, view)) {
    for (std::size_t v = 0; v < vesicles.size(); ++v)
      for (const sim::Vec3& shift : shifts_into(*sides, vesicles[v].bounds, *faces)) all.push_back({v, shift});
    return all;
  }
  for (std::size_t v = 0; v < vesicles.size(); ++v) all.push_back({v, sim::Vec3::Zero()});
  if (!sides) return all;
  const std::vector<int>& most = view.copies;
  for (int c = -most[2]; c <= most[2]; ++c)
    for (std::size_t v = 0; v < vesicles.size(); ++v) {
      // A layer above leans to one side; what leaves the box there comes back on the other.
      const double length = (*sides)(0, 0), lean = c * (*sides)(0, 2);
      const double back = c == 0 ? 0 : -std::floor((vesicles[v].middle[0] + lean) / length + 0.5);
      for (int b = -most[1]; b <= most[1]; ++b)
        for (int a = -most[0]; a <= most[0]; ++a)
          if (a != 0 || b != 0 || c != 0) all.push_back({v, *sides * sim::Vec3(a + back, b, c)});
    }
  return all;
}

std::vector<render::FlowLines::Line> edges_of_cell(const sim::Scene& scene) {
  std::vector<render::FlowLines::Line> edges;
  if (!scene.cell.size) return edges;
  const sim::Vec3 half = *scene.cell.size / 2;
  for (int along = 0; along < 3; ++along)
    for (const double b : {-1.0, 1.0})
      for (const double c : {-1.0, 1.0}) {
        render::FlowLines::Line& edge = edges.emplace_back();
        constexpr int parts = 24;  // each fades on its own under what lies over the picture
        for (int k = 0; k <= parts; ++k) {
          sim::Vec3 point;
          point[along] = (2.0 * k / parts - 1) * half[along];
          point[(along + 1) % 3] = b * half[(along + 1) % 3];
          point[(along + 2) % 3] = c * half[(along + 2) % 3];
          edge.points.push_back(render::to_glm(point));
        }
      }
  return edges;
}

}  // namespace app
