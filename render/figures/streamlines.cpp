#include "render/figures/streamlines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <optional>

namespace render {
namespace {

using Vec2 = Eigen::Vector2d;

/// Points of the lines drawn so far, in square cells one spacing wide.
class Cells {
 public:
  Cells(const Range& x, const Range& y, double size)
      : x_(x.low),
        y_(y.low),
        size_(size),
        columns_(count(x)),
        rows_(count(y)),
        cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

  void add(const Vec2& p) { cells_[index(column(p), row(p))].push_back(p); }

  /// Is any point nearer than `distance`, at most one cell?
  bool crowded(const Vec2& p, double distance) const {
    for (int r = std::max(row(p) - 1, 0); r <= std::min(row(p) + 1, rows_ - 1); ++r)
      for (int c = std::max(column(p) - 1, 0); c <= std::min(column(p) + 1, columns_ - 1); ++c)
        for (const Vec2& q : cells_[index(c, r)])
          if ((p - q).squaredNorm() < distance * distance) return true;
    return false;
  }

 private:
  int count(const Range& r) const { return std::max(1, static_cast<int>(std::ceil(r.size() / size_))); }
  int column(const Vec2& p) const { return std::clamp(static_cast<int>((p.x() - x_) / size_), 0, columns_ - 1); }
  int row(const Vec2& p) const { return std::clamp(static_cast<int>((p.y() - y_) / size_), 0, rows_ - 1); }
  std::size_t index(int c, int r) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c);
  }

  double x_, y_, size_;
  int columns_, rows_;
  std::vector<std::vector<Vec2>> cells_;
};

/// A point of a line with the unit tangent there.
struct Place {
  Vec2 point, tangent;
};
struct Step {
  Place end;
  double error = 0;
};

class Tracer {
 public:
  Tracer(const PlaneFlow& flow, double sign, double least_speed) : flow_(flow), sign_(sign), least_(least_speed) {}

  /// Unit tangent; nothing at a point of rest.
  std::optional<Vec2> direction(const Vec2& p) const {
    const Vec2 v = flow_(p);
    const double speed = v.norm();
    if (!(speed > least_)) return {};
    return Vec2(sign_ / speed * v);
  }

  /// The pair of Dormand and Prince; nothing when it meets a point of rest.
  std::optional<Step> step(const Place& from, double h) const {
    constexpr double a[6][6] = {{1.0 / 5},
                                {3.0 / 40, 9.0 / 40},
                                {44.0 / 45, -56.0 / 15, 32.0 / 9},
                                {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    constexpr double difference[7] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                      -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    std::array<Vec2, 7> k;
    k[0] = from.tangent;
    Vec2 at = from.point;
    for (std::size_t s = 0; s < 6; ++s) {
      Vec2 sum = Vec2::Zero();
      for (std::size_t i = 0; i <= s; ++i) sum += a[s][i] * k[i];
      at = from.point + h * sum;
      const std::optional<Vec2> next = direction(at);
      if (!next) return {};
      k[s + 1] = *next;
    }
    Vec2 miss = Vec2::Zero();
    for (std::size_t i = 0; i < 7; ++i) miss += difference[i] * k[i];
    return Step{{at, k[6]}, h * miss.norm()};
  }

 private:
  const PlaneFlow& flow_;
  double sign_, least_;
};

/// Cubic between two places: t from 0 to 1.
Vec2 between(const Place& a, const Place& b, double h, double t) {
  const double u = 1 - t;
  return u * u * (1 + 2 * t) * a.point + t * t * (3 - 2 * t) * b.point + h * t * u * (u * a.tangent - t * b.tangent);
}

enum class End { left, crowded, rest, round, closed };  ///< round: past the seed, but beside it

/// Follows the flow from `seed` in one direction. `behind`: points of the other half.
End trace(const Tracer& tracer, const Vec2& seed, const Range& x, const Range& y, const Cells& others,
          const StreamlineOptions& o, const std::vector<Vec2>& behind, std::vector<Vec2>& points) {
  constexpr int pieces = 3;
  const double longest = 0.3 * o.spacing, least = o.spacing * 1e-3, near = o.nearest * o.spacing;
  const double allowed = o.tolerance * o.spacing;
  const double most = 60 * (x.size() + y.size());  // a line that winds for ever
  const std::optional<Vec2> start = tracer.direction(seed);
  if (!start) return End::rest;
  Place p{seed, *start};
  double h = longest / 2, travelled = 0;
  const auto inside = [&](const Vec2& q) {
    return q.x() >= x.low && q.x() <= x.high && q.y() >= y.low && q.y() <= y.high;
  };
  // Points of the line itself count as a neighbour but for its last stretch and the surroundings of the seed, where it
  // closes.
  const auto meets_itself = [&](const Vec2& q) {
    if ((q - seed).norm() < 0.6 * o.spacing) return false;
    double back = 0;
    for (std::size_t i = points.size(); i-- > 0;) {
      back += ((i + 1 < points.size() ? points[i + 1] : q) - points[i]).norm();
      if (back > 3 * o.spacing && (points[i] - q).squaredNorm() < near * near) return true;
    }
    for (const Vec2& r : behind)
      if (travelled > 3 * o.spacing && (r - q).squaredNorm() < near * near) return true;
    return false;
  };
  while (travelled < most) {
    const std::optional<Step> s = tracer.step(p, h);
    if (!s || (s->error > allowed && h > least)) {
      if (h <= least) return End::rest;
      h = std::max(least, s ? h * std::clamp(0.9 * std::pow(allowed / s->error, 0.2), 0.2, 0.9) : h / 4);
      continue;
    }
    for (int k = 1; k <= pieces; ++k) {
      const Vec2 q = k == pieces ? s->end.point : between(p, s->end, h, double(k) / pieces);
      const Vec2 before = points.empty() ? seed : points.back();
      if (!inside(q)) {
        points.push_back(q);  // the panel clips it
        return End::left;
      }
      if (others.crowded(q, near)) return End::crowded;
      if (travelled > 2 * o.spacing) {
        // Round once: passes the seed's normal in the seed's direction. Exactly there: closed. Beside it: a spiral.
        const double was = (before - seed).dot(*start), is = (q - seed).dot(*start);
        if ((q - seed).norm() < 0.5 * o.spacing && was < 0 && is >= 0) {
          const Vec2 crossing = before + (q - before) * (-was / (is - was));
          points.push_back(crossing);
          return (crossing - seed).norm() < o.closing * o.spacing ? End::closed : End::round;
        }
      }
      if (meets_itself(q)) return End::crowded;
      points.push_back(q);
    }
    travelled += h;
    p = s->end;
    h = std::min(longest, h * std::clamp(0.9 * std::pow(allowed / std::max(s->error, 1e-300), 0.2), 0.5, 2.0));
  }
  return End::crowded;
}

double length_of(const std::vector<Vec2>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

}  // namespace

std::vector<Streamline> streamlines(const PlaneFlow& flow, const Range& x, const Range& y, const StreamlineOptions& o,
                                    const std::vector<Vec2>& seeds) {
  std::vector<Streamline> lines;
  Cells cells(x, y, o.spacing);
  double fastest = 0;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; j <= 8; ++j)
      fastest = std::max(fastest, flow({x.low + x.size() * i / 8, y.low + y.size() * j / 8}).norm());
  if (!(fastest > o.rest)) return lines;
  const double least = o.stagnation * fastest;

  std::deque<Vec2> waiting(seeds.begin(), seeds.end());
  waiting.push_back({(x.low + x.high) / 2, (y.low + y.high) / 2});
  // A net of further seeds finds pockets that no line passes.
  const int columns = static_cast<int>(std::ceil(x.size() / o.spacing)),
            rows = static_cast<int>(std::ceil(y.size() / o.spacing));
  std::vector<Vec2> net;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      net.push_back({x.low + (c + 0.5) * x.size() / columns, y.low + (r + 0.5) * y.size() / rows});
  std::size_t next_of_net = 0;
  while (!waiting.empty() || next_of_net < net.size()) {
    Vec2 seed;
    if (!waiting.empty()) {
      seed = waiting.front();
      waiting.pop_front();
    } else {
      seed = net[next_of_net++];
    }
    if (seed.x() <= x.low || seed.x() >= x.high || seed.y() <= y.low || seed.y() >= y.high) continue;
    if (cells.crowded(seed, 0.98 * o.spacing)) continue;
    std::vector<Vec2> ahead, back;
    const End end = trace({flow, 1, least}, seed, x, y, cells, o, {}, ahead);
    if (end != End::closed && end != End::round) trace({flow, -1, least}, seed, x, y, cells, o, ahead, back);
    if (end == End::closed) {  // the little that is missing is spread over the whole loop
      const Vec2 miss = ahead.back() - seed;
      ahead.pop_back();
      for (std::size_t i = 0; i < ahead.size(); ++i)
        ahead[i] -= static_cast<double>(i + 1) / static_cast<double>(ahead.size() + 1) * miss;
    }
    std::vector<Vec2> all(back.rbegin(), back.rend());
    all.push_back(seed);
    all.insert(all.end(), ahead.begin(), ahead.end());
    if (length_of(all) < o.shortest * o.spacing) continue;
    Streamline line{sim::Matrix(static_cast<Eigen::Index>(all.size()), 2),
                    sim::Vector(static_cast<Eigen::Index>(all.size())), end == End::closed};
    double since = o.spacing;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      line.points.row(row) = all[i].transpose();
      const Vec2 v = flow(all[i]);
      line.speed[row] = v.norm();
      cells.add(all[i]);
      if (i > 0) since += (all[i] - all[i - 1]).norm();
      if (since < 0.5 * o.spacing || !(v.norm() > 0)) continue;
      since = 0;
      const Vec2 side = o.spacing * Vec2(-v.y(), v.x()) / v.norm();
      waiting.push_back(all[i] + side);
      waiting.push_back(all[i] - side);
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<Eigen::Index> arrow_places(const Streamline& line, double apart, double phase) {
  std::vector<double> along{0};
  for (Eigen::Index i = 1; i < line.points.rows(); ++i)
    along.push_back(along.back() + (line.points.row(i) - line.points.row(i - 1)).norm());
  const double total = along.back();
  const int count = static_cast<int>(std::lround(total / apart));
  std::vector<Eigen::Index> places;
  if (total < 0.35 * apart) return places;
  for (int k = 0; k < std::max(count, 1); ++k) {
    const double wanted = total * (k + phase) / std::max(count, 1);
    const auto at = std::lower_bound(along.begin(), along.end(), wanted);
    places.push_back(std::clamp<Eigen::Index>(at - along.begin(), 1, line.points.rows() - 2));
  }
  return places;
}

}  // namespace render
