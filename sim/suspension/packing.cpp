#include "sim/suspension/packing.h"

#include "sim/layers/near.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <system_error>

namespace sim {

namespace {

using std::numbers::pi;

/// Unit vectors spread evenly over the sphere, a row each.
Matrix spread_directions(int count) {
  Matrix all(count, 3);
  const double golden = pi * (3 - std::sqrt(5.0));
  for (int k = 0; k < count; ++k) {
    const double z = 1 - (2.0 * k + 1) / count, r = std::sqrt(1 - z * z);
    all.row(k) << r * std::cos(golden * k), r * std::sin(golden * k), z;
  }
  return all;
}

Matrix meridian(int count, double longitude) {
  Matrix all(count, 3);
  for (int k = 0; k < count; ++k) {
    const double theta = pi * k / (count - 1);
    all.row(k) << std::sin(theta) * std::cos(longitude), std::sin(theta) * std::sin(longitude), std::cos(theta);
  }
  return all;
}

/// Two bodies, or a body and an image, with the direction that tells them apart best so far.
struct Contact {
  int first, second;
  Vec3 shift;  ///< of the image of the second
  Vec3 n = Vec3::Zero();
  double apart = 0;                                        ///< lower bound of the distance
  Vec3 at_first = Vec3::Zero(), at_second = Vec3::Zero();  ///< points there, from the centres
};

struct Pack {
  const std::vector<SupportShape>& shapes;
  const PackingRoom& room;
  double slack;  ///< what chords of a body of size 1 may hide

  const SupportShape& shape(const PackedBody& b) const { return shapes[static_cast<std::size_t>(b.shape)]; }
  double reach(const PackedBody& b) const { return b.size * shape(b).reach(); }
  Vec3 farthest(const PackedBody& b, const Vec3& n) const { return b.size * shape(b).farthest(n, b.axis); }

  /// Improves n: a step along the part of the line between the points that is across n. Radii of curvature bound how
  /// fast that changes; the step is that of the largest likely ones, so that it climbs.
  void look(Contact& c, const PackedBody& a, const PackedBody& b, int steps) const {
    const Vec3 between = b.centre + c.shift - a.centre;
    if (c.n.isZero()) c.n = between.norm() > 1e-9 * room.radius ? Vec3(between.normalized()) : Vec3::UnitX();
    Vec3 n = c.n;
    double best = -1e300, share = 1;
    for (int k = 0; k < steps; ++k) {
      const Vec3 p = farthest(a, n), q = farthest(b, -n);
      const Vec3 line = between + q - p;
      const double apart = n.dot(line);
      if (apart > best) {
        best = apart;
        c.n = n;
        c.apart = apart;
        c.at_first = p;
        c.at_second = q;
      } else {
        share /= 2;
      }
      const Vec3 rest = between + c.at_second - c.at_first, across = rest - c.n.dot(rest) * c.n;
      if (across.norm() < 1e-4 * room.radius) break;
      n = (c.n + share * across / (reach(a) + reach(b) + std::max(0.0, c.apart))).normalized();
    }
    c.apart -= slack * (a.size + b.size);
  }

  std::vector<Contact> contacts(const std::vector<PackedBody>& bodies, double within) const {
    std::vector<Box> boxes;
    for (const PackedBody& b : bodies) {
      const Vec3 half = Vec3::Constant(reach(b));
      boxes.push_back({b.centre - half, b.centre + half});
    }
    const CellSides sides = room.cell ? CellSides(Eigen::Matrix3d(room.cell->asDiagonal())) : CellSides();
    std::vector<Contact> all;
    for (const ImagePair& p : near_images(boxes, within, sides)) {
      const auto first = static_cast<std::size_t>(p.first), second = static_cast<std::size_t>(p.second);
      const double far = reach(bodies[first]) + reach(bodies[second]) + within;
      const Vec3 shift = p.shift(sides);
      if (p.first == p.second && shift.isZero()) continue;
      if ((bodies[second].centre + shift - bodies[first].centre).norm() > far) continue;
      all.push_back({.first = p.first, .second = p.second, .shift = shift});
    }
    return all;
  }
};

}  // namespace

bool is_round(const Coefficients& surface) {
  constexpr int count = 33;
  const auto profile = [](const Matrix& points) {
    Matrix p(points.rows(), 2);
    p.col(0) = points.leftCols(2).rowwise().norm();
    p.col(1) = points.col(2);
    return p;
  };
  const Matrix first = profile(sample_points(surface, meridian(count, 0)));
  const double size = first.rowwise().norm().maxCoeff();
  for (const double longitude : {0.7, 1.9, 2.6, 4.4})
    if ((profile(sample_points(surface, meridian(count, longitude))) - first).cwiseAbs().maxCoeff() > 1e-6 * size)
      return false;
  return true;
}

SupportShape SupportShape::round(const Coefficients& surface) {
  constexpr int samples = 1441, angles = 721;
  const Matrix points = sample_points(surface, meridian(samples, 0));
  SupportShape s;
  s.reach_ = points.rowwise().norm().maxCoeff();
  // Chords of both tables span angles below 0.005 of curves whose radius is below some 10 reaches.
  s.error_ = 1e-4 * s.reach_;
  for (int k = 0; k < angles; ++k) {
    const double angle = pi * k / (angles - 1);
    Eigen::Vector2d best = Eigen::Vector2d::Zero();
    double most = -1e300;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const Eigen::Vector2d x(points.row(i).head<2>().norm(), points(i, 2));
      const double along = x[0] * std::sin(angle) + x[1] * std::cos(angle);
      if (along > most) most = along, best = x;
    }
    s.profile_.push_back(best);
  }
  return s;
}

SupportShape SupportShape::fixed(const Coefficients& surface) {
  constexpr int samples = 1600;
  const Matrix points = sample_points(surface, spread_directions(samples));
  SupportShape s;
  s.reach_ = points.rowwise().norm().maxCoeff();
  s.error_ = 4e-3 * s.reach_;  // points 0.09 apart on a unit sphere: 0.001, and more where a surface is stretched
  for (Eigen::Index k = 0; k < points.rows(); ++k) s.points_.emplace_back(points.row(k).transpose());
  return s;
}

Vec3 SupportShape::farthest(const Vec3& n, const Vec3& axis) const {
  if (can_turn()) {
    const double along = n.dot(axis);
    const Vec3 across = n - along * axis;
    const double sine = across.norm();
    const double place = std::atan2(sine, along) / pi * static_cast<double>(profile_.size() - 1);
    const auto k = std::min(static_cast<std::size_t>(place), profile_.size() - 2);
    const Eigen::Vector2d x = profile_[k] + (place - static_cast<double>(k)) * (profile_[k + 1] - profile_[k]);
    return x[1] * axis + (sine > 0 ? Vec3(x[0] / sine * across) : Vec3(Vec3::Zero()));
  }
  double most = -1e300;
  const Vec3* best = nullptr;
  for (const Vec3& p : points_)
    if (const double along = n.dot(p); along > most) most = along, best = &p;
  return *best;
}

double move_apart(std::vector<PackedBody>& bodies, const std::vector<SupportShape>& shapes, const PackingRoom& room,
                  int rounds) {
  double error = 0;
  for (const SupportShape& s : shapes) error = std::max(error, s.error());
  const Pack pack{shapes, room, error};
  // Heavy balls on springs that are a little longer than the gap, so that the gap is reached and not only approached.
  constexpr double pull = 0.15, memory = 0.8, longer = 0.03, most = 0.1, margin = 0.3;
  constexpr int kept = 8, first_steps = 12, steps = 2, sure_steps = 60;
  const double wanted = room.gap + longer * room.radius;
  std::vector<Vec3> speed(bodies.size(), Vec3::Zero()), spin = speed;
  std::vector<Contact> contacts;
  double missing = 0;
  for (int round = 0; round <= rounds; ++round) {
    if (room.stop && room.stop())
      throw std::system_error(std::make_error_code(std::errc::interrupted), "while vesicles were being placed");
    const bool fresh = round % kept == 0 || round == rounds;
    if (fresh) contacts = pack.contacts(bodies, wanted + margin * room.radius);
    std::vector<Vec3> force(bodies.size(), Vec3::Zero()), torque = force;
    missing = 0;
    for (Contact& c : contacts) {
      const auto i = static_cast<std::size_t>(c.first), j = static_cast<std::size_t>(c.second);
      pack.look(c, bodies[i], bodies[j], fresh ? first_steps : steps);
      if (fresh && c.apart < room.gap) pack.look(c, bodies[i], bodies[j], sure_steps);
      missing = std::max(missing, room.gap - c.apart);
      if (c.apart >= wanted) continue;
      const Vec3 push = (wanted - c.apart) * c.n;
      force[i] -= push;
      force[j] += push;
      torque[i] -= c.at_first.cross(push);
      torque[j] += c.at_second.cross(push);
    }
    if (fresh && missing <= 0) return 0;
    if (round == rounds) break;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      PackedBody& b = bodies[k];
      // A large body has as many more neighbours as it has surface.
      const double mass = std::max(1.0, b.size * b.size), arm = room.radius * b.size;
      speed[k] = memory * speed[k] + pull / mass * force[k];
      spin[k] = memory * spin[k] + pull / (mass * arm * arm) * torque[k];
      const double fast = speed[k].norm() / (most * room.radius), whirl = spin[k].norm() / most;
      if (fast > 1) speed[k] /= fast;
      if (whirl > 1) spin[k] /= whirl;
      b.centre += speed[k];
      if (!room.cell) b.centre = b.centre.cwiseMax(-room.half).cwiseMin(room.half);
      if (room.turning && pack.shape(b).can_turn()) b.axis = (b.axis + spin[k].cross(b.axis)).normalized();
    }
  }
  return missing;
}

}  // namespace sim
