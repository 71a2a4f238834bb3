#include "sim/measures/fields.h"

#include "sim/core/parallel.h"
#include "sim/membrane/forces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sim {

namespace {

Vector row_dot(const Matrix& a, const Matrix& b) { return a.cwiseProduct(b).rowwise().sum(); }

/// Of the membrane relative to its vesicle, which moves with the mean velocity of its membrane.
Matrix relative_velocity(const FieldSite& s) {
  Matrix u = s.basis.synthesize(s.state.vesicles[s.vesicle].velocity).values;
  const Vec3 mean = u.transpose() * s.geometry.dA / s.geometry.dA.sum();
  u.rowwise() -= mean.transpose();
  return u;
}

Vector tension(const FieldSite& s) { return s.basis.synthesize(s.state.vesicles[s.vesicle].tension).values.col(0); }
Vector mean_curvature(const FieldSite& s) { return -s.geometry.H; }
Vector gaussian_curvature(const FieldSite& s) { return s.geometry.K; }

Vector bending(const FieldSite& s) {
  const ForceBases bases{s.basis, s.full};
  return row_dot(bending_force(bases, s.geometry, s.bending_modulus), s.geometry.n);
}

Vector tension_density(const FieldSite& s) {
  const ForceBases bases{s.basis, s.full};
  return tension_force(bases, s.geometry, s.state.vesicles[s.vesicle].tension).rowwise().norm();
}

Vector normal_velocity(const FieldSite& s) { return row_dot(relative_velocity(s), s.geometry.n); }

Vector membrane_speed(const FieldSite& s) {
  const Matrix u = relative_velocity(s);
  const Vector across = row_dot(u, s.geometry.n);
  return (u - (s.geometry.n.array().colwise() * across.array()).matrix()).rowwise().norm();
}

}  // namespace

/// A vesicle as a net of points, dense enough to find the nearest part of it. Points near each other make a patch.
struct Surroundings::Net {
  PointSampler surface;
  Matrix points, normals, parameters;
  Vec3 centre;
  double reach;  ///< of its points from the centre
  double inner;  ///< least distance of its points from the centre
  struct Patch {
    Vec3 centre;
    double reach;
    std::vector<Eigen::Index> points;
  };
  std::vector<Patch> patches;
};

namespace {

using Net = Surroundings::Net;

Net net_of(const Coefficients& position) {
  constexpr Eigen::Index latitudes = 40, longitudes = 80, side = 5;  // of a patch
  const double step = std::numbers::pi / latitudes;
  const Vector theta = Vector::LinSpaced(latitudes, step / 2, std::numbers::pi - step / 2);
  const Vector phi = Vector::LinSpaced(longitudes + 1, 0, 2 * std::numbers::pi).head(longitudes);
  const FirstDerivatives x = sample_grid(position, theta, phi);
  Net net{PointSampler(position), {}, {}, {}, Vec3::Zero(), 0, 0, {}};
  net.points = x.value;
  net.normals.resize(x.value.rows(), 3);
  net.parameters.resize(x.value.rows(), 3);
  for (Eigen::Index k = 0; k < x.value.rows(); ++k) {
    const Vec3 t = x.t.row(k), f = x.f.row(k);
    net.normals.row(k) = t.cross(f).normalized().transpose();
    net.parameters.row(k) = unit_vector(theta[k % latitudes], phi[k / latitudes]).transpose();
  }
  net.centre = net.points.colwise().mean().transpose();
  const Vector away = (net.points.rowwise() - net.centre.transpose()).rowwise().norm();
  net.reach = away.maxCoeff();
  net.inner = away.minCoeff();
  for (Eigen::Index j = 0; j < longitudes; j += side)
    for (Eigen::Index i = 0; i < latitudes; i += side) {
      Net::Patch& patch = net.patches.emplace_back(Net::Patch{Vec3::Zero(), 0, {}});
      for (Eigen::Index b = j; b < j + side; ++b)
        for (Eigen::Index a = i; a < i + side; ++a) patch.points.push_back(a + b * latitudes);
      for (const Eigen::Index k : patch.points)
        patch.centre += net.points.row(k).transpose() / static_cast<double>(side * side);
      for (const Eigen::Index k : patch.points)
        patch.reach = std::max(patch.reach, (net.points.row(k).transpose() - patch.centre).norm());
    }
  return net;
}

/// Number and distance of the nearest point of a net: patches that cannot hold it are passed over.
std::pair<Eigen::Index, double> nearest_of(const Net& net, const Vec3& here) {
  std::vector<double> away;  // of the patches' centres
  away.reserve(net.patches.size());
  std::size_t first = 0;
  for (const Net::Patch& patch : net.patches) {
    away.push_back((patch.centre - here).norm());
    if (away.back() < away[first]) first = away.size() - 1;
  }
  Eigen::Index nearest = 0;
  double best2 = std::numeric_limits<double>::infinity();
  const auto look_into = [&](const Net::Patch& patch) {
    for (const Eigen::Index k : patch.points)
      if (const double d2 = (net.points.row(k).transpose() - here).squaredNorm(); d2 < best2) {
        best2 = d2;
        nearest = k;
      }
  };
  look_into(net.patches[first]);
  for (std::size_t k = 0; k < net.patches.size(); ++k)
    if (k != first && away[k] - net.patches[k].reach < std::sqrt(best2)) look_into(net.patches[k]);
  return {nearest, std::sqrt(best2)};
}

/// A vesicle, or an image of one so far from it.
struct Other {
  std::size_t vesicle;
  Vec3 shift;
};
/// Those that may be the nearest to some point of a vesicle: of all others, and of 27 images round the nearest, those
/// whose least possible distance is below what another one surely keeps.
std::vector<Other> others_of(const FieldSite& s) {
  const std::vector<Net>& nets = s.surroundings.nets(s.state);
  const CellSides& cell = s.surroundings.cell();
  std::vector<Other> all;
  for (std::size_t k = 0; k < nets.size(); ++k) {
    if (!cell) {
      if (k != s.vesicle) all.push_back({k, Vec3::Zero()});
      continue;
    }
    const Vec3 number = (cell->inverse() * (nets[s.vesicle].centre - nets[k].centre)).array().round();
    for (int a = -1; a <= 1; ++a)
      for (int b = -1; b <= 1; ++b)
        for (int c = -1; c <= 1; ++c)
          if (k != s.vesicle || a != 0 || b != 0 || c != 0) all.push_back({k, *cell * (number + Vec3(a, b, c))});
  }
  const auto between = [&](const Other& o) {
    return (nets[s.vesicle].centre - nets[o.vesicle].centre - o.shift).norm();
  };
  double sure = std::numeric_limits<double>::infinity();
  for (const Other& o : all) sure = std::min(sure, between(o) + nets[s.vesicle].reach + nets[o.vesicle].inner);
  std::erase_if(all, [&](const Other& o) { return between(o) - nets[s.vesicle].reach - nets[o.vesicle].reach > sure; });
  return all;
}

Vector neighbour_distance(const FieldSite& s) {
  const std::vector<Net>& nets = s.surroundings.nets(s.state);
  const double near = 0.3 * nets[s.vesicle].reach;  // below it the exact nearest point, above it that of the net
  const Matrix& x = s.geometry.x.value;
  Vector distance(x.rows());
  const std::vector<Other> others = others_of(s);
  parallel_for(static_cast<int>(x.rows()), [&](int i) {
    double best = std::numeric_limits<double>::infinity();
    std::vector<double> least(others.size());  // distances that they can have
    for (std::size_t k = 0; k < others.size(); ++k) {
      const Net& net = nets[others[k].vesicle];
      least[k] = (x.row(i).transpose() - others[k].shift - net.centre).norm() - net.reach;
    }
    // Those that may come nearest first: most of the others need no look.
    for (;;) {
      const std::size_t other = std::size_t(std::min_element(least.begin(), least.end()) - least.begin());
      if (least[other] >= best) break;
      least[other] = std::numeric_limits<double>::infinity();
      const std::size_t k = others[other].vesicle;
      const Vec3 here = x.row(i).transpose() - others[other].shift;
      const Net& net = nets[k];
      const auto [nearest, rough] = nearest_of(net, here);
      const double height = std::abs(net.normals.row(nearest).dot(here.transpose() - net.points.row(nearest)));
      // Above the tangent plane of a surface that curves like the net's own sphere.
      const double aside2 = std::max(rough * rough - height * height, 0.0),
                   curved = height + 0.5 * aside2 / (net.reach + height);
      best =
          std::min(best, rough > near ? std::min(rough, curved)
                                      : nearest_point(net.surface, here, Vec3(net.parameters.row(nearest))).distance);
    }
    distance[i] = best;
  });
  return distance;
}

}  // namespace

const std::vector<FieldRow>& field_catalogue() {
  static const std::vector<FieldRow> rows{
      {"tension", "membrane tension", "σ", FieldScale::tension, true, false, tension},
      {"mean-curvature", "mean curvature, 1 on the sphere of the same area", "H", FieldScale::curvature, true, false,
       mean_curvature},
      {"gaussian-curvature", "Gaussian curvature, 1 on the sphere of the same area, negative on saddles", "K",
       FieldScale::square_curvature, true, false, gaussian_curvature},
      {"bending-force", "bending force of the membrane on the fluid per area, along the outward normal", "f_{b}·n",
       FieldScale::force, true, false, bending},
      {"tension-force", "magnitude of the tension force of the membrane on the fluid per area", "|f_{σ}|",
       FieldScale::force, false, false, tension_density},
      {"normal-velocity",
       "velocity along the outward normal, relative to the vesicle: how fast the shape changes or turns", "u·n",
       FieldScale::velocity, true, false, normal_velocity},
      {"membrane-speed", "speed along the membrane, relative to the vesicle: tank-treading", "|u_{s}|",
       FieldScale::velocity, false, false, membrane_speed},
      {"neighbour-distance", "distance to the nearest point of any other vesicle", "h", FieldScale::length, false, true,
       neighbour_distance, 3},  // farther away a neighbour is hardly felt, and the map is for the near ones
  };
  return rows;
}

const FieldRow& find_field(std::string_view name) {
  if (const FieldRow* row = find_row(field_catalogue(), name)) return *row;
  throw std::invalid_argument("unknown field '" + std::string(name) + "'" +
                              suggestion(name, row_names(field_catalogue())));
}

Surroundings::Surroundings(const CellSides& cell) : cell_(cell) {}
Surroundings::~Surroundings() = default;

const std::vector<Surroundings::Net>& Surroundings::nets(const State& state) {
  if (nets_.empty())
    for (const VesicleState& v : state.vesicles) nets_.push_back(net_of(v.position));
  return nets_;
}

Coefficients membrane_field(Plans& plans, const FieldRow& field, const State& state, std::size_t vesicle,
                            double bending_modulus, Surroundings& surroundings) {
  if (field.needs_neighbours && state.vesicles.size() < 2 && !surroundings.cell())
    throw std::invalid_argument("the field '" + std::string(field.name) + "' needs two vesicles or more");
  const VesicleState& v = state.vesicles.at(vesicle);
  const int p = v.position.order;
  const int q = std::clamp(3 * p, 24, std::max(96, p));  // nonlinear in the surface: three times its degree
  const Basis &basis = plans.basis(p, q), &full = plans.basis(q, q);
  const FieldSite site{basis, full, geometry(basis, v.position), state, vesicle, bending_modulus, surroundings};
  return full.analyze(Matrix(field.function(site)));
}

}  // namespace sim
