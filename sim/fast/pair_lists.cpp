#include "sim/fast/pair_lists.h"

#include "sim/core/cells.h"
#include "sim/core/lanes.h"
#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace sim {

Box box_of(const Points& points) {
  if (points.cols() == 0) return empty_box();
  return {points.rowwise().minCoeff(), points.rowwise().maxCoeff()};
}

namespace {

constexpr int source_patch = 8;

PairLists::Level level_of(const Points& points, const Vec3& centre) {
  if (points.cols() > std::numeric_limits<std::uint16_t>::max())
    throw std::invalid_argument("a body of the fast sum has at most 65535 points");
  PairLists::Level level{divide(points, source_patch), Points(3, points.cols())};
  for (Eigen::Index k = 0; k < points.cols(); ++k)
    level.points.col(k) = points.col(level.patches.order[std::size_t(k)]) - centre;
  level.patches.centres.colwise() -= centre;
  return level;
}

/// What a patch of targets sees of a body, appended to the list of its group.
template <class Real>
void see(PairLists::Group& group, int patch, int number, const PairLists::Body& body, const Vec3& shift,
         double fine_within, std::uint32_t seeing) {
  const Vec3 middle = group.patches.centres.col(patch) - body.centre - shift;
  const double radius = group.patches.radii[std::size_t(patch)];
  const auto away = [&](const PairLists::Level& level, int b) {
    return (level.patches.centres.col(b) - middle).norm() - level.patches.radii[std::size_t(b)] - radius;
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (int b = 0; b < body.levels[0].patches.count(); ++b) nearest = std::min(nearest, away(body.levels[0], b));
  if (nearest > 1) return;
  const int finely = nearest < fine_within && body.levels[1].points.cols() > 0;
  const PairLists::Level& level = body.levels[std::size_t(finely)];
  const PatchLanes<Real> targets = lanes_of<Real>(group.points, group.patches.members(patch), body.centre + shift);
  const std::size_t first = group.sources.size();
  for (int b = 0; b < level.patches.count(); ++b) {
    if (away(level, b) > 1) continue;
    for (int k = level.patches.first[std::size_t(b)]; k < level.patches.first[std::size_t(b) + 1]; ++k) {
      LaneOf<Real> square{};
      for (int d = 0; d < 3; ++d) {
        const LaneOf<Real> r = targets.x[d] - static_cast<Real>(level.points(d, k));
        square += r * r;
      }
      Real least = square[0];
      for (int l = 1; l < lane_count<Real>; ++l) least = std::min(least, square[l]);
      if (least < 1) group.sources.push_back(static_cast<std::uint16_t>(k));
    }
  }
  if (group.sources.size() == first) return;
  while ((group.sources.size() - first) % PairLists::multiple != 0)
    group.sources.push_back(static_cast<std::uint16_t>(level.points.cols()));
  group.segments.push_back(
      {number, patch, finely, static_cast<int>(group.sources.size() - first), seeing, first, shift});
}

/// Lanes of a patch that are not among the excluded targets, which ascend.
std::uint32_t seeing_lanes(const Patches& patches, int patch, const Exclusion* excluded) {
  std::uint32_t seeing = 0;
  const std::span<const int> members = patches.members(patch);
  for (std::size_t l = 0; l < members.size(); ++l)
    if (!excluded || !std::binary_search(excluded->targets.begin(), excluded->targets.end(), members[l]))
      seeing |= std::uint32_t(1) << l;
  return seeing;
}

/// An image of a body that a group may see.
struct Image {
  int body;
  Eigen::Vector3i lattice;
};

/// By group, the images of bodies within the cut-off of its box, by body and image.
std::vector<std::vector<Image>> seen_images(std::span<const Box> bodies, std::span<const Box> groups,
                                            const std::optional<Eigen::Matrix3d>& cell) {
  const Eigen::Matrix3d sides = cell.value_or(Eigen::Matrix3d::Zero());
  const Eigen::Matrix3d inverse = cell ? Eigen::Matrix3d(cell->inverse()) : sides;
  const auto moved = [](const Box& box, const Vec3& by) { return Box{box.low + by, box.high + by}; };
  const auto home = [&](const Box& box) {  // number of the cell that holds its centre
    return Eigen::Vector3i((inverse * (0.5 * (box.low + box.high))).array().floor().matrix().cast<int>());
  };
  std::vector<std::vector<Image>> seen(groups.size());
  double widest = 0;
  for (const Box& box : bodies)
    if (!is_empty(box)) widest = std::max(widest, (box.high - box.low).norm());
  std::vector<int> here;  // groups that have points
  std::vector<Box> boxes;
  Box all = empty_box();
  for (int g = 0; g < std::ssize(groups); ++g) {
    const Box& box = groups[std::size_t(g)];
    if (is_empty(box)) continue;
    here.push_back(g);
    widest = std::max(widest, (box.high - box.low).norm());
    boxes.push_back(moved(box, -(sides * home(box).cast<double>())));
    all = united(all, boxes.back());
  }
  if (here.empty()) return seen;
  Eigen::Vector3i most = Eigen::Vector3i::Zero();
  for (int d = 0; cell && d < 3; ++d) most[d] = static_cast<int>(std::ceil((1 + widest) * inverse.row(d).norm())) + 1;
  std::vector<Image> images;
  for (int j = 0; j < std::ssize(bodies); ++j) {
    if (is_empty(bodies[std::size_t(j)])) continue;
    const Eigen::Vector3i from = home(bodies[std::size_t(j)]);
    for (int x = -most[0]; x <= most[0]; ++x)
      for (int y = -most[1]; y <= most[1]; ++y)
        for (int z = -most[2]; z <= most[2]; ++z) {
          const Eigen::Vector3i lattice = Eigen::Vector3i(x, y, z) - from;
          const Box box = moved(bodies[std::size_t(j)], sides * lattice.cast<double>());
          if (distance(box, all) > 1) continue;
          images.push_back({j, lattice});
          boxes.push_back(box);
        }
  }
  const auto first = static_cast<int>(here.size());
  for (const auto& [i, k] : near_pairs(boxes, 1))
    if (i < first && k >= first) {
      const Image& image = images[std::size_t(k - first)];
      const auto g = std::size_t(here[std::size_t(i)]);
      seen[g].push_back({image.body, image.lattice + home(groups[g])});
    }
  return seen;
}

}  // namespace

double PairLists::pairs() const {
  double sum = 0;
  for (const Group& group : groups)
    sum += static_cast<double>(group.sources.size()) * (single_precision ? lane_count<float> : lane_count<double>);
  return sum;
}

std::vector<char> near_bodies(std::span<const Box> bodies, std::span<const Box> groups,
                              const std::optional<Eigen::Matrix3d>& cell) {
  std::vector<char> near(bodies.size());
  for (const auto& images : seen_images(bodies, groups, cell))
    for (const Image& image : images) near[std::size_t(image.body)] = 1;
  return near;
}

PairLists plan_pairs(const std::vector<FastBody>& bodies, const std::vector<FastGroup>& groups,
                     const std::vector<Exclusion>& exclusions, bool single_precision,
                     const std::optional<Eigen::Matrix3d>& cell) {
  PairLists lists;
  lists.single_precision = single_precision;
  lists.bodies.resize(bodies.size());
  lists.groups.resize(groups.size());
  std::vector<Box> boxes, group_boxes;
  for (const FastBody& body : bodies) boxes.push_back(united(box_of(body.coarse), box_of(body.fine)));
  for (const FastGroup& group : groups) group_boxes.push_back(group.wanted ? box_of(group.points) : empty_box());
  const std::vector<std::vector<Image>> seen = seen_images(boxes, group_boxes, cell);
  std::vector<char> needed(bodies.size());
  for (const auto& images : seen)
    for (const Image& image : images) needed[std::size_t(image.body)] = 1;
  for (const FastGroup& group : groups)
    if (group.wanted && group.body >= 0) needed[std::size_t(group.body)] = 1;
  for (const Exclusion& e : exclusions)
    if (groups[std::size_t(e.group)].wanted) needed[std::size_t(e.surface)] = 1;
  parallel_for(static_cast<int>(bodies.size()), [&](int i) {
    const auto j = std::size_t(i);
    if (!needed[j]) return;
    const Vec3 centre = 0.5 * (boxes[j].low + boxes[j].high);
    lists.bodies[j] = {centre, {level_of(bodies[j].coarse, centre), level_of(bodies[j].fine, centre)}};
  });
  const auto shift_of = [&](const Eigen::Vector3i& image) {
    return cell ? Vec3(*cell * image.cast<double>()) : Vec3(Vec3::Zero());
  };
  std::vector<std::vector<const Exclusion*>> excluded(groups.size());
  for (const Exclusion& e : exclusions) excluded[std::size_t(e.group)].push_back(&e);
  parallel_for(static_cast<int>(groups.size()), [&](int i) {
    const auto g = std::size_t(i);
    if (!groups[g].wanted) return;
    const int own = groups[g].body;
    PairLists::Group& group = lists.groups[g];
    group.points = groups[g].points;
    group.patches = divide(group.points, single_precision ? lane_count<float> : lane_count<double>);
    if (own >= 0) group.taken.push_back({own, Vec3::Zero(), group.patches.order});
    for (const Exclusion* e : excluded[g])
      if (e->surface != own || !e->image.isZero()) group.taken.push_back({e->surface, shift_of(e->image), e->targets});
    for (const Image& image : seen[g]) {
      const auto j = std::size_t(image.body);
      if (image.body == own && image.lattice.isZero()) continue;
      const Exclusion* without = nullptr;
      for (const Exclusion* e : excluded[g])
        if (e->surface == image.body && e->image == image.lattice) without = e;
      const Vec3 shift = shift_of(image.lattice);
      for (int patch = 0; patch < group.patches.count(); ++patch) {
        if (distance(boxes[j], group.patches.centres.col(patch) - shift) > 1 + group.patches.radii[std::size_t(patch)])
          continue;
        const std::uint32_t seeing = seeing_lanes(group.patches, patch, without);
        if (seeing == 0) continue;
        const auto look = single_precision ? see<float> : see<double>;
        look(group, patch, image.body, lists.bodies[j], shift, bodies[j].fine_within, seeing);
      }
    }
  });
  return lists;
}

}  // namespace sim
