#include "sim/suspension/placements.h"

#include "sim/core/input_file.h"
#include "sim/surface/shapes.h"
#include "sim/suspension/copies.h"
#include "sim/suspension/gap.h"
#include "sim/suspension/packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace sim {

namespace {

using std::numbers::pi;

/// A copy as it lies.
struct Lying {
  Vec3 center;
  double size;
  Eigen::Matrix3d frame;
};

/// Copies that have been placed, and whether another one keeps its distance from all of them and from all images.
struct Occupied {
  const Copies& copies;
  std::optional<Vec3> cell;
  Coefficients upright;  ///< of size 1
  std::vector<Lying> lying = {};
  Plans plans = {};
  Sources grid = make_sources(plans.basis(upright.order, upright.order + 4), upright);

  bool free(const Lying& place) {
    for (const Lying& other : lying)
      for (const Vec3& shift : images(other.center - place.center, other.size + place.size, false))
        if (!apart({other.center + shift, other.size, other.frame}, place)) return false;
    for (const Vec3& shift : images(Vec3::Zero(), 2 * place.size, true))
      if (!apart({place.center + shift, place.size, place.frame}, place)) return false;
    return true;
  }

 private:
  Coefficients surface(const Lying& copy) const {
    Coefficients x{upright.order, copy.size * upright.values * copy.frame.transpose()};
    x.values.row(0) += std::sqrt(4 * pi) * copy.center.transpose();
    return x;
  }
  double near(double both) const { return both * copies.extent.reach + copies.gap(); }
  bool apart(const Lying& first, const Lying& second) {
    const double distance = (first.center - second.center).norm(), both = first.size + second.size;
    if (distance > near(both)) return true;
    if (distance < both * copies.extent.core) return false;
    if (reaches_into(first, second) || reaches_into(second, first)) return false;
    const Gap g = gap_of_two(plans, surface(first), surface(second));
    return !g.crossing && g.distance >= copies.gap();
  }
  /// Whether that point of a copy which is nearest to the centre of another lies deep in it: a look at one point saves
  /// the search for the gap of most pairs that overlap.
  bool reaches_into(const Lying& copy, const Lying& other) const {
    const Eigen::Matrix3d turn = other.frame.transpose() * copy.frame * (copy.size / other.size);
    const Vec3 away = other.frame.transpose() * (copy.center - other.center) / other.size;
    Eigen::Index nearest = 0;
    const Matrix points = (grid.points * turn.transpose()).rowwise() + away.transpose();
    points.rowwise().squaredNorm().minCoeff(&nearest);
    constexpr double deep = 0.9;
    return winding(grid, points.row(nearest).transpose()) > deep;
  }
  /// Of the images of what lies so far away, the shifts of those that may be near; of the place itself, all but itself.
  /// `both`: the sizes of the two.
  std::vector<Vec3> images(const Vec3& away, double both, bool own) const {
    if (!cell) return own ? std::vector<Vec3>{} : std::vector<Vec3>{Vec3::Zero()};
    const Vec3 number = -(away.array() / cell->array()).round();
    if (!own && (away + number.cwiseProduct(*cell)).norm() > near(both)) return {};  // that of the nearest
    const Eigen::Vector3i most = (near(both) / cell->array()).ceil().matrix().cast<int>();
    std::vector<Vec3> all;
    for (int a = -most[0]; a <= most[0]; ++a)
      for (int b = -most[1]; b <= most[1]; ++b)
        for (int c = -most[2]; c <= most[2]; ++c) {
          const Vec3 shift = (number + Vec3(a, b, c)).cwiseProduct(*cell);
          if ((away + shift).norm() <= near(both) && !(own && a == 0 && b == 0 && c == 0)) all.push_back(shift);
        }
    return all;
  }
};

// Random insertion of equal bodies jams at shares of 0.38 (spheres) to 0.45 (ellipsoids), and is slow from some 0.32
// on. What is moved apart jams at 0.64 (spheres) to 0.71 (ellipsoids). Small ones find room between large ones.
constexpr double fullest_inserted = 0.5, easily_inserted = 0.32, fullest_packed = 0.7, more_by_spread = 0.1;

/// "vesicles of radius 1", "vesicles of mean radius 1 (0.7 to 1.6)".
std::string vesicles_of(const Copies& c) {
  const auto [least, most] = std::minmax_element(c.sizes.begin(), c.sizes.end());
  if (c.p.size_spread == 0) return fmt::format("vesicles of radius {:.3g}", c.extent.radius);
  return fmt::format("vesicles of mean radius {:.3g} ({:.3g} to {:.3g})", c.extent.radius, *least * c.extent.radius,
                     *most * c.extent.radius);
}

/// Where copies are placed, in words, and the keys of which a smaller value gives them more room.
struct Place {
  std::string at, keys;
};

Place place_of(const Copies& c, const std::optional<Vec3>& cell) {
  return {fmt::format("at a volume fraction of {:.3g}", c.fraction(cell)), cell ? "count" : "volume_fraction"};
}

void require_room(const Copies& c, double room, double fullest, const Place& place) {
  const double filled = c.filled_share(room);
  if (c.count() > 1 && filled > fullest + (c.p.size_spread > 0 ? more_by_spread : 0))
    throw std::invalid_argument(
        fmt::format("{} {} with gaps of {:.3g} cannot be placed at random {}: "
                    "with half the gap about each they would fill {:.0f} % of the room; give a smaller {} or gap",
                    c.count(), vesicles_of(c), c.gap(), place.at, 100 * filled, place.keys));
}

/// Numbers of the copies, the largest first: between small ones there is no room for it later.
std::vector<std::size_t> by_size(const std::vector<double>& sizes) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  return order;
}

/// Copies at random points of a region, one after another, each free of those before. `point`: for a copy of that size.
std::vector<VesicleParameters> insert_at_random(const Copies& c, const Room& room, const Place& place,
                                                const std::function<Vec3(std::mt19937_64&, double size)>& point) {
  std::mt19937_64 random(std::uint64_t(c.p.seed));
  Occupied occupied{c, room.cell, upright_shape(c.original)};
  std::vector<VesicleParameters> all(c.sizes.size());
  constexpr int tries = 2000;
  for (const std::size_t k : by_size(c.sizes)) {
    bool found = false;
    for (int attempt = 0; attempt < tries && !found; ++attempt) {
      if (room.stop && room.stop())
        throw std::system_error(std::make_error_code(std::errc::interrupted), "while vesicles were being placed");
      VesicleParameters v = c.copy(k);
      v.center = c.p.center + point(random, c.sizes[k]);
      if (c.p.orientation == "random") v.axis = random_direction(random);
      const Lying here{v.center, c.sizes[k], local_frame(v)};
      found = occupied.free(here);
      if (!found) continue;
      occupied.lying.push_back(here);
      all[k] = std::move(v);
    }
    if (!found)
      throw std::invalid_argument(
          fmt::format("only {} of {} {} could be placed at random {} with gaps of {:.3g}; give a smaller {} or gap",
                      occupied.lying.size(), c.count(), vesicles_of(c), place.at, c.gap(), place.keys));
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

/// A lattice asks for no distance, but its copies must not overlap.
void require_apart(const Copies& c, const std::vector<VesicleParameters>& all, double spacing, const Room& room) {
  const auto refuse = [&](const std::string& what) {
    std::string keys = place_of(c, room.cell).keys;
    if (c.p.size_spread > 0) keys += " or size_spread";
    if (c.p.jitter > 0) keys += " or jitter";
    throw std::invalid_argument(fmt::format("{} {} on a lattice {} overlap: {}; give a smaller {}", c.count(),
                                            vesicles_of(c), place_of(c, room.cell).at, what, keys));
  };
  const double widest = 2 * c.extent.reach * c.largest(), thinnest = 2 * c.extent.core * c.largest();
  if (spacing * (1 - 2 * c.p.jitter) > widest) return;
  if (c.fraction(room.cell) > 1 || (room.cell && room.cell->minCoeff() < thinnest))  // images without number
    return refuse("they are thicker than the room");
  const Coefficients upright = upright_shape(c.original);
  std::vector<Coefficients> x;
  for (std::size_t k = 0; k < all.size(); ++k) x.push_back(laid(all[k], {upright.order, c.sizes[k] * upright.values}));
  Plans plans;
  const CellSides sides = room.cell ? CellSides(Eigen::Matrix3d(room.cell->asDiagonal())) : CellSides();
  if (const Gap gap = smallest_gap(plans, x, sides); gap.crossing) refuse(pair_name(gap) + " of them do");
}

std::vector<VesicleParameters> lattice(const PlacementParameters& p, const VesicleParameters& original,
                                       const Room& room) {
  const Copies copies = copies_of(p, original);
  const int side = int(std::ceil(std::cbrt(double(p.count)) - 1e-9));
  Eigen::Vector3i places = Eigen::Vector3i::Constant(side);
  Vec3 spacing;
  if (room.cell) {
    const Extent& e = copies.extent;
    places = places_in(*room.cell, p.orientation == "random" ? Vec3(Vec3::Constant(e.reach)) : e.size, p.count);
    spacing = room.cell->cwiseQuotient(places.cast<double>());
  } else {
    spacing.setConstant(std::cbrt(copies.volume() / p.count / p.volume_fraction));
  }
  std::mt19937_64 random(std::uint64_t(p.seed));
  std::vector<VesicleParameters> all;
  for (int k = 0; k < p.count; ++k) {
    VesicleParameters v = copies.copy(std::size_t(k));
    const Eigen::Vector3i cell(k % places[0], k / places[0] % places[1], k / (places[0] * places[1]));
    const Vec3 shift = Vec3(uniform(random), uniform(random), uniform(random)) - Vec3::Constant(0.5);
    const Vec3 middle = (places.cast<double>() - Vec3::Ones()) / 2;
    v.center = p.center + spacing.cwiseProduct(cell.cast<double>() - middle + 2 * p.jitter * shift);
    if (p.orientation == "random") v.axis = random_direction(random);
    all.push_back(std::move(v));
  }
  require_apart(copies, all, spacing.minCoeff(), room);
  return all;
}

/// Copies at random places that overlap, moved and turned apart. Sides: of the cell, or of the cube of the centres.
std::vector<VesicleParameters> packed(const Copies& c, const Room& room, const Vec3& sides) {
  const bool at_random = c.p.orientation == "random";
  std::mt19937_64 random(std::uint64_t(c.p.seed));
  VesicleParameters upright = c.original;
  upright.center.setZero();
  upright.axis = Vec3::UnitZ();
  const Coefficients along_z = initial_position(upright);
  const bool turns = (at_random || c.original.axis) && is_round(along_z);
  std::vector<VesicleParameters> all;
  std::vector<PackedBody> bodies(c.sizes.size());
  std::vector<SupportShape> shapes;
  if (turns) shapes.push_back(SupportShape::round(along_z));
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    all.push_back(c.copy(k));
    bodies[k].size = c.sizes[k];
    bodies[k].centre =
        sides.cwiseProduct(Vec3(uniform(random), uniform(random), uniform(random)) - Vec3::Constant(0.5));
    if (at_random) all[k].axis = random_direction(random);
    if (turns) {
      bodies[k].axis = all[k].axis->normalized();
      continue;
    }
    VesicleParameters centred = c.original;
    centred.axis = all[k].axis;
    centred.center.setZero();
    if (k == 0 || at_random) shapes.push_back(SupportShape::fixed(initial_position(centred)));
    bodies[k].shape = int(shapes.size()) - 1;
  }
  // What can be moved apart takes some hundred rounds. More are of use near jamming, as far as they take a minute or
  // so.
  const int rounds = std::clamp(200000 / c.count(), 600, 4000);
  const PackingRoom where{c.gap(), c.extent.radius, room.cell, sides / 2, at_random, room.stop};
  if (const double missing = move_apart(bodies, shapes, where, rounds); missing > 0)
    throw std::invalid_argument(fmt::format(
        "{} vesicles could not be placed at random at a volume fraction of {:.3g} with gaps of {:.3g}: after {} rounds "
        "of moving them apart two are nearer by {:.2g}; give a smaller {} or gap",
        c.count(), c.fraction(room.cell), where.gap, rounds, missing, room.cell ? "count" : "volume_fraction"));
  for (std::size_t k = 0; k < all.size(); ++k) {
    Vec3 centre = bodies[k].centre;
    if (room.cell) centre -= room.cell->cwiseProduct(Vec3((centre.array() / room.cell->array()).round()));
    all[k].center = c.p.center + centre;
    if (turns && where.turning) all[k].axis = bodies[k].axis;
  }
  return all;
}

std::vector<VesicleParameters> box(const PlacementParameters& p, const VesicleParameters& original, const Room& room) {
  const Copies c = copies_of(p, original);
  const double side = std::cbrt(c.volume() / p.volume_fraction);
  // Without a cell, vesicles reach out of the box that holds their centres.
  const double beyond = 2 * c.extent.reach * c.mean([](double size) { return size; }) + c.gap();
  const double space = room.cell ? room.cell->prod() : std::pow(side + beyond, 3);
  const Place place = place_of(c, room.cell);
  require_room(c, space, fullest_packed, place);
  const Vec3 sides = room.cell.value_or(Vec3::Constant(side));
  if (p.size_spread > 0 || c.filled_share(space) > easily_inserted) return packed(c, room, sides);
  return insert_at_random(c, room, place, [sides](std::mt19937_64& random, double) {
    return Vec3(sides.cwiseProduct(Vec3(uniform(random), uniform(random), uniform(random)) - Vec3::Constant(0.5)));
  });
}

std::vector<VesicleParameters> tube(const PlacementParameters& p, const VesicleParameters& original, const Room& room) {
  const Copies c = copies_of(p, original);
  const double radius = p.radius.value_or(default_tube_radius * c.extent.radius);
  const double reach = c.extent.reach * c.largest();
  if (radius <= reach)
    throw std::invalid_argument(
        fmt::format("a tube of radius {:.3g} is narrower than {} vesicle, which reaches {:.3g} from its centre", radius,
                    p.size_spread > 0 ? "the largest" : "a", reach));
  const double length = c.volume() / p.volume_fraction / (pi * radius * radius);
  const double wide = radius + c.gap() / 2, across = pi * wide * wide, along = length + 2 * reach + c.gap();
  double space = across * along;
  Place place{fmt::format("at a volume fraction of {:.3g} in a tube of radius {:.3g} and length {:.3g}",
                          p.volume_fraction, radius, length),
              "volume_fraction"};
  if (room.cell) {  // a tube that is longer or wider than the cell overlaps its own images
    const Vec3& cell = *room.cell;
    space = std::min(along, cell[0]) * std::min(across, std::min(2 * wide, cell[1]) * std::min(2 * wide, cell[2]));
    place.at += fmt::format(" in a cell of {:.3g} x {:.3g} x {:.3g}", cell[0], cell[1], cell[2]);
    if (along > cell[0]) place.keys = "count";
  }
  require_room(c, space, fullest_inserted, place);
  return insert_at_random(c, room, place, [&, length](std::mt19937_64& random, double size) {
    const double r = (radius - c.extent.reach * size) * std::sqrt(uniform(random)), f = 2 * pi * uniform(random);
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
       {"volume_fraction", "jitter", "count", "size_spread", "orientation", "seed"},
       lattice},
      {"box",
       "at random without overlap in a cube, or in the cell",
       {"volume_fraction", "gap", "count", "size_spread", "orientation", "seed"},
       box},
      {"tube",
       "at random without overlap in a tube along x",
       {"volume_fraction", "radius", "gap", "count", "size_spread", "orientation", "seed"},
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
