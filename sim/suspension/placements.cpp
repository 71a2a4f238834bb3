#include "sim/suspension/placements.h"

#include "sim/core/input_file.h"
#include "sim/surface/geometry.h"
#include "sim/surface/shapes.h"
#include "sim/suspension/gap.h"
#include "sim/suspension/packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace sim {

namespace {

using std::numbers::pi;

/// Uniform in [0, 1), the same on every platform (std::uniform_real_distribution is not).
double uniform(std::mt19937_64& random) { return double(random() >> 11) * 0x1.0p-53; }

Vec3 random_direction(std::mt19937_64& random) {
  const double z = 2 * uniform(random) - 1, f = 2 * pi * uniform(random), r = std::sqrt(1 - z * z);
  return {r * std::cos(f), r * std::sin(f), z};
}

/// A surface about the origin: volume, and the radii of the spheres about the origin that hold it and that it holds.
struct Extent {
  double volume, reach, core;
  double radius;  ///< of the sphere of the same area
  Vec3 size;      ///< of the box about it
};
Extent extent(const VesicleParameters& v) {
  VesicleParameters centred = v;
  centred.center.setZero();
  const Coefficients x = initial_position(centred);
  const Basis basis(x.order, 2 * x.order + 8);
  const Matrix points = basis.synthesize(x).values;
  const Vector distance = points.rowwise().norm();
  const AreaVolume size = area_volume(basis, x);
  return {size.volume, distance.maxCoeff(), distance.minCoeff(), std::sqrt(size.area / (4 * pi)),
          (points.colwise().maxCoeff() - points.colwise().minCoeff()).transpose()};
}

double gap_of(const PlacementParameters& p, const Extent& e) {
  return p.gap.value_or(default_placement_gap * e.radius);
}

/// Positions that have been taken, and whether another one keeps its distance from all of them and from all images.
struct Occupied {
  double gap;
  Extent extent;
  std::optional<Vec3> cell;
  std::vector<Vec3> centers;
  std::vector<Coefficients> surfaces;
  Plans plans;

  bool free(const Vec3& center, const Coefficients& x) {
    for (std::size_t k = 0; k < centers.size(); ++k)
      for (const Vec3& shift : images(centers[k] - center, false))
        if (!apart(centers[k] + shift - center, moved(surfaces[k], shift), x)) return false;
    for (const Vec3& shift : images(Vec3::Zero(), true))
      if (!apart(shift, moved(x, shift), x)) return false;
    return true;
  }

 private:
  static Coefficients moved(Coefficients x, const Vec3& shift) {
    x.values.row(0) += std::sqrt(4 * pi) * shift.transpose();
    return x;
  }
  double near() const { return 2 * extent.reach + gap; }
  bool apart(const Vec3& from_centre_to_centre, const Coefficients& first, const Coefficients& second) {
    const double distance = from_centre_to_centre.norm();
    if (distance > near()) return true;
    if (distance < 2 * extent.core) return false;
    const Gap g = smallest_gap(plans, std::vector{first, second});
    return !g.crossing && g.distance >= gap;
  }
  /// Of the images of what lies so far away, the shifts of those that may be near; of the place itself, all but itself.
  std::vector<Vec3> images(const Vec3& away, bool own) const {
    if (!cell) return own ? std::vector<Vec3>{} : std::vector<Vec3>{Vec3::Zero()};
    const Vec3 number = -(away.array() / cell->array()).round();
    const Eigen::Vector3i most = (near() / cell->array()).ceil().matrix().cast<int>();
    std::vector<Vec3> all;
    for (int a = -most[0]; a <= most[0]; ++a)
      for (int b = -most[1]; b <= most[1]; ++b)
        for (int c = -most[2]; c <= most[2]; ++c) {
          const Vec3 shift = (number + Vec3(a, b, c)).cwiseProduct(*cell);
          if ((away + shift).norm() <= near() && !(own && a == 0 && b == 0 && c == 0)) all.push_back(shift);
        }
    return all;
  }
};

/// The volume fraction: of a cell that is to be filled, that of its own volume.
double fraction_of(const PlacementParameters& p, const Extent& e, const std::optional<Vec3>& cell) {
  return cell ? p.count * e.volume / cell->prod() : p.volume_fraction;
}

/// Share of a room (the region of the centres, and what reaches beyond it) that all fill with half the gap about each.
double filled_share(const PlacementParameters& p, const Extent& e, double room) {
  const double equivalent = std::cbrt(3 * e.volume / (4 * pi));
  return p.count * 4 * pi / 3 * std::pow(equivalent + gap_of(p, e) / 2, 3) / room;
}

// Random insertion jams at shares of 0.38 (spheres) to 0.45 (ellipsoids), and is slow from some 0.32 on. What is moved
// apart jams at 0.64 (spheres) to 0.71 (ellipsoids).
constexpr double fullest_inserted = 0.5, easily_inserted = 0.32, fullest_packed = 0.7;

void require_room(const PlacementParameters& p, const Extent& e, double room, double fullest,
                  const std::optional<Vec3>& cell) {
  const double gap = gap_of(p, e), filled = filled_share(p, e, room);
  if (p.count > 1 && filled > fullest)
    throw std::invalid_argument(fmt::format(
        "{} vesicles of radius {:.3g} with gaps of {:.3g} cannot be placed at random at a volume fraction of {:.3g}: "
        "with half the gap about each they would fill {:.0f} % of the room; give a smaller {} or gap",
        p.count, e.radius, gap, fraction_of(p, e, cell), 100 * filled, cell ? "count" : "volume_fraction"));
}

/// Copies at random points of a region, one after another, each free of those before.
std::vector<VesicleParameters> insert_at_random(const PlacementParameters& p, const VesicleParameters& original,
                                                const Extent& size, const Room& room,
                                                const std::function<Vec3(std::mt19937_64&)>& point) {
  std::mt19937_64 random(std::uint64_t(p.seed));
  const double gap = gap_of(p, size);
  Occupied occupied{gap, size, room.cell, {}, {}, {}};
  std::vector<VesicleParameters> all;
  constexpr int tries = 2000;
  while (int(all.size()) < p.count) {
    bool found = false;
    for (int attempt = 0; attempt < tries && !found; ++attempt) {
      if (room.stop && room.stop())
        throw std::system_error(std::make_error_code(std::errc::interrupted), "while vesicles were being placed");
      VesicleParameters v = original;
      v.center = p.center + point(random);
      if (p.orientation == "random") v.axis = random_direction(random);
      const Coefficients x = initial_position(v);
      found = occupied.free(v.center, x);
      if (!found) continue;
      occupied.centers.push_back(v.center);
      occupied.surfaces.push_back(x);
      all.push_back(std::move(v));
    }
    if (!found)
      throw std::invalid_argument(
          fmt::format("only {} of {} vesicles could be placed at a volume fraction of {:.3g} with gaps of {:.3g}",
                      all.size(), p.count, fraction_of(p, size, room.cell), gap));
  }
  return all;
}

/// Numbers of places along the sides of a cell that leave each vesicle the most room for its size.
Eigen::Vector3i places_in(const Vec3& cell, const Vec3& size, int count) {
  Eigen::Vector3i best(count, 1, 1);
  double most = 0;
  for (int x = 1; x <= count; ++x)
    for (int y = 1; y <= (count + x - 1) / x; ++y) {
      const Eigen::Vector3i n(x, y, (count + x * y - 1) / (x * y));
      const double room = (cell.array() / n.cast<double>().array() / size.array()).minCoeff();
      if (room > most) {
        most = room;
        best = n;
      }
    }
  return best;
}

std::vector<VesicleParameters> lattice(const PlacementParameters& p, const VesicleParameters& original,
                                       const Room& room) {
  const int side = int(std::ceil(std::cbrt(double(p.count)) - 1e-9));
  Eigen::Vector3i places = Eigen::Vector3i::Constant(side);
  Vec3 spacing;
  if (room.cell) {
    const Extent e = extent(original);
    places = places_in(*room.cell, p.orientation == "random" ? Vec3(Vec3::Constant(e.reach)) : e.size, p.count);
    spacing = room.cell->cwiseQuotient(places.cast<double>());
  } else {
    spacing.setConstant(std::cbrt(extent(original).volume / p.volume_fraction));
  }
  std::mt19937_64 random(std::uint64_t(p.seed));
  std::vector<VesicleParameters> all;
  for (int k = 0; k < p.count; ++k) {
    VesicleParameters v = original;
    const Eigen::Vector3i cell(k % places[0], k / places[0] % places[1], k / (places[0] * places[1]));
    const Vec3 shift = Vec3(uniform(random), uniform(random), uniform(random)) - Vec3::Constant(0.5);
    const Vec3 middle = (places.cast<double>() - Vec3::Ones()) / 2;
    v.center = p.center + spacing.cwiseProduct(cell.cast<double>() - middle + 2 * p.jitter * shift);
    if (p.orientation == "random") v.axis = random_direction(random);
    all.push_back(std::move(v));
  }
  return all;
}

/// Copies at random places that overlap, moved and turned apart. Sides: of the cell, or of the cube of the centres.
std::vector<VesicleParameters> packed(const PlacementParameters& p, const VesicleParameters& original, const Extent& e,
                                      const Room& room, const Vec3& sides) {
  std::mt19937_64 random(std::uint64_t(p.seed));
  VesicleParameters upright = original;
  upright.center.setZero();
  upright.axis = Vec3::UnitZ();
  const Coefficients along_z = initial_position(upright);
  const bool turns = (p.orientation == "random" || original.axis) && is_round(along_z);
  std::vector<VesicleParameters> all(std::size_t(p.count), original);
  std::vector<PackedBody> bodies(all.size());
  std::vector<SupportShape> shapes;
  if (turns) shapes.push_back(SupportShape::round(along_z));
  for (std::size_t k = 0; k < all.size(); ++k) {
    bodies[k].centre =
        sides.cwiseProduct(Vec3(uniform(random), uniform(random), uniform(random)) - Vec3::Constant(0.5));
    if (p.orientation == "random") all[k].axis = random_direction(random);
    if (turns) {
      bodies[k].axis = all[k].axis->normalized();
      continue;
    }
    VesicleParameters centred = all[k];
    centred.center.setZero();
    if (k == 0 || p.orientation == "random") shapes.push_back(SupportShape::fixed(initial_position(centred)));
    bodies[k].shape = int(shapes.size()) - 1;
  }
  // What can be moved apart takes some hundred rounds. More are of use near jamming, as far as they take a minute or
  // so.
  const int rounds = std::clamp(200000 / p.count, 600, 4000);
  const PackingRoom where{gap_of(p, e), e.radius, room.cell, sides / 2, p.orientation == "random", room.stop};
  if (const double missing = move_apart(bodies, shapes, where, rounds); missing > 0)
    throw std::invalid_argument(fmt::format(
        "{} vesicles could not be placed at random at a volume fraction of {:.3g} with gaps of {:.3g}: after {} rounds "
        "of moving them apart two are nearer by {:.2g}; give a smaller {} or gap",
        p.count, fraction_of(p, e, room.cell), where.gap, rounds, missing, room.cell ? "count" : "volume_fraction"));
  for (std::size_t k = 0; k < all.size(); ++k) {
    Vec3 centre = bodies[k].centre;
    if (room.cell) centre -= room.cell->cwiseProduct(Vec3((centre.array() / room.cell->array()).round()));
    all[k].center = p.center + centre;
    if (turns && where.turning) all[k].axis = bodies[k].axis;
  }
  return all;
}

std::vector<VesicleParameters> box(const PlacementParameters& p, const VesicleParameters& original, const Room& room) {
  const Extent e = extent(original);
  const double side = std::cbrt(p.count * e.volume / p.volume_fraction);
  // Without a cell, vesicles reach out of the box that holds their centres.
  const double space = room.cell ? room.cell->prod() : std::pow(side + 2 * e.reach + gap_of(p, e), 3);
  require_room(p, e, space, fullest_packed, room.cell);
  const Vec3 sides = room.cell.value_or(Vec3::Constant(side));
  if (filled_share(p, e, space) > easily_inserted) return packed(p, original, e, room, sides);
  return insert_at_random(p, original, e, room, [sides](std::mt19937_64& random) {
    return Vec3(sides.cwiseProduct(Vec3(uniform(random), uniform(random), uniform(random)) - Vec3::Constant(0.5)));
  });
}

std::vector<VesicleParameters> tube(const PlacementParameters& p, const VesicleParameters& original, const Room& room) {
  const Extent e = extent(original);
  const double radius = p.radius.value_or(default_tube_radius * e.radius);
  if (radius <= e.reach)
    throw std::invalid_argument(fmt::format(
        "a tube of radius {:.3g} is narrower than a vesicle, which reaches {:.3g} from its centre", radius, e.reach));
  const double length = p.count * e.volume / p.volume_fraction / (pi * radius * radius);
  require_room(p, e, pi * std::pow(radius + gap_of(p, e) / 2, 2) * (length + 2 * e.reach + gap_of(p, e)),
               fullest_inserted, {});
  return insert_at_random(p, original, e, room, [&, length](std::mt19937_64& random) {
    const double r = (radius - e.reach) * std::sqrt(uniform(random)), f = 2 * pi * uniform(random);
    return Vec3(length * (uniform(random) - 0.5), r * std::cos(f), r * std::sin(f));
  });
}

std::vector<VesicleParameters> from_file(const PlacementParameters& p, const VesicleParameters& original, const Room&) {
  std::string why;
  std::ifstream in = open_input(p.file, why);
  if (!in) throw std::invalid_argument(fmt::format("cannot read the table of centres '{}': {}", p.file, why));
  skip_byte_order_mark(in);
  std::vector<VesicleParameters> all;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<double> row;
    for (double x; words >> x;) row.push_back(x);
    words.clear();
    std::string rest;
    if (words >> rest) throw std::invalid_argument(fmt::format("{}:{}: '{}' is not a number", p.file, number, rest));
    if (row.empty()) continue;
    if (row.size() != 3 && row.size() != 6)
      throw std::invalid_argument(
          fmt::format("{}:{}: expected x y z or x y z and an axis, got {} numbers", p.file, number, row.size()));
    VesicleParameters v = original;
    v.center = p.center + Vec3(row[0], row[1], row[2]);
    if (row.size() == 6) v.axis = Vec3(row[3], row[4], row[5]);
    if (v.axis && !(v.axis->norm() > 0))
      throw std::invalid_argument(fmt::format("{}:{}: the axis has no direction", p.file, number));
    all.push_back(std::move(v));
  }
  if (all.empty()) throw std::invalid_argument(fmt::format("{}: no centres in it", p.file));
  return all;
}

}  // namespace

const std::vector<CatalogueRow<PlacementFunction>>& placement_catalogue() {
  static const std::vector<CatalogueRow<PlacementFunction>> table{
      {"lattice",
       "cubic lattice, or one that fills the cell, centres shifted at random by jitter",
       {"volume_fraction", "jitter", "count", "orientation", "seed"},
       lattice},
      {"box",
       "at random without overlap in a cube, or in the cell",
       {"volume_fraction", "gap", "count", "orientation", "seed"},
       box},
      {"tube",
       "at random without overlap in a tube along x",
       {"volume_fraction", "radius", "gap", "count", "orientation", "seed"},
       tube},
      {"file", "centres from a text table", {"file"}, from_file},
  };
  return table;
}

Scene placed(Scene scene, const StopQuestion& stop) {
  for (const PlacementParameters& p : scene.placements) {
    if (scene.vesicles.empty()) throw std::invalid_argument("a placement needs a vesicle to copy");
    const VesicleParameters original = scene.vesicles.back();
    scene.vesicles.pop_back();
    const auto* row = find_row(placement_catalogue(), p.kind);
    if (!row) throw std::invalid_argument("unknown placement '" + p.kind + "'");
    for (VesicleParameters& v : row->function(p, original, {scene.cell.size, stop}))
      scene.vesicles.push_back(std::move(v));
  }
  scene.placements.clear();
  return scene;
}

}  // namespace sim
