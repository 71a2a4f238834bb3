#include "sim/surface/shapes.h"

#include "sim/core/input_file.h"
#include "sim/surface/geometry.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace sim {

namespace {

using std::numbers::pi;

/// x = (a1 sin t cos f, a2 sin t sin f, a3 cos t), exact in degree 1.
Coefficients ellipsoid(int order, const Vec3& axes) {
  Coefficients c{order, Matrix::Zero(coefficient_count(order), 3)};
  const double k = std::sqrt(4 * pi / 3);
  c.values(coefficient_index(1, 1), 0) = k * axes[0];
  c.values(coefficient_index(1, -1), 1) = k * axes[1];
  c.values(coefficient_index(1, 0), 2) = k * axes[2];
  return c;
}

double spheroid_area(double a, double b) {  // a along the symmetry axis
  if (std::abs(a - b) < 1e-9 * b) return 4 * pi * b * b;
  if (a > b) {
    const double e = std::sqrt(1 - b * b / (a * a));
    return 2 * pi * b * b * (1 + a / (b * e) * std::asin(e));
  }
  const double e = std::sqrt(1 - a * a / (b * b));
  return 2 * pi * b * b * (1 + (1 - e * e) / e * std::atanh(e));
}

/// Root of an increasing or decreasing function between two arguments of opposite sign.
double bisect(const std::function<double(double)>& f, double low, double high) {
  const double sign = f(low) < 0 ? 1 : -1;
  for (int i = 0; i < 200 && high - low > 1e-16 * std::abs(high); ++i) {
    const double middle = 0.5 * (low + high);
    (sign * f(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double required_volume(const VesicleParameters& v) {
  if (!v.reduced_volume) throw std::invalid_argument(fmt::format("shape '{}' needs reduced_volume", v.shape));
  return *v.reduced_volume;
}

/// Projects a surface given as a function of (theta, phi) on degree p.
Coefficients project(int order, int degree, const std::function<Vec3(double, double)>& surface) {
  const Basis basis(order, std::max(order, degree));
  Matrix samples(basis.points(), 3);
  for (int j = 0; j < basis.longitudes(); ++j)
    for (int i = 0; i < basis.latitudes(); ++i)
      samples.row(i + basis.latitudes() * j) = surface(basis.theta()[i], basis.phi()[j]).transpose();
  return basis.analyze(samples);
}

/// Evans-Fung disc (1, 1, s (...)) of design height s; band-limited at degree 5.
Coefficients disc(int order, double s) {
  return project(order, order + 6, [s](double t, double f) -> Vec3 {
    const double si = std::sin(t), s2 = si * si;
    return {si * std::cos(f), si * std::sin(f), 0.5 * s * std::cos(t) * (0.207 + 2.003 * s2 - 1.123 * s2 * s2)};
  });
}

double volume_ratio(const Coefficients& c) {
  const Basis basis(c.order, 4 * c.order + 32);
  const AreaVolume av = area_volume(basis, c);
  return reduced_volume(av.area, av.volume);
}

Coefficients biconcave(const VesicleParameters& v) {
  const double nu = required_volume(v);
  const auto excess = [&](double s) { return volume_ratio(disc(5, s)) - nu; };
  constexpr double thinnest = 0.2, thickest = 2.0;  // the dimple closes below, the rim stands above the middle beyond
  if (excess(thinnest) > 0 || excess(thickest) < 0)
    throw std::invalid_argument(fmt::format("shape 'biconcave' has reduced volumes from {:.3f} to {:.3f}, not {}",
                                            excess(thinnest) + nu, excess(thickest) + nu, nu));
  return disc(v.order, bisect(excess, thinnest, thickest));
}

/// rho = 1 + sum of value Y_nm times the unit direction.
Coefficients harmonics(const VesicleParameters& v) {
  int degree = 0;
  for (const auto& [n, m, value] : v.coefficients) {
    if (n != std::floor(n) || m != std::floor(m) || n < 0 || std::abs(m) > n || n > 128)
      throw std::invalid_argument(
          fmt::format("coefficients [{}, {}, {}]: n must be an integer in 0..128 and |m| at most n", n, m, value));
    degree = std::max(degree, int(n));
  }
  if (v.coefficients.empty())
    throw std::invalid_argument("shape 'harmonics' needs coefficients = [[n, m, value], ...]");
  Coefficients rho{degree, Matrix::Zero(coefficient_count(degree), 1)};
  rho.values(0, 0) = std::sqrt(4 * pi);
  for (const auto& [n, m, value] : v.coefficients) rho.values(coefficient_index(int(n), int(m)), 0) += value;
  const Basis basis(std::max(v.order, degree), v.order + degree + 2);
  const Matrix r = basis.synthesize(rho).values;
  if (r.minCoeff() <= 0) throw std::invalid_argument("shape 'harmonics': the radius is not positive everywhere");
  Matrix samples(basis.points(), 3);
  for (int j = 0; j < basis.longitudes(); ++j)
    for (int i = 0; i < basis.latitudes(); ++i) {
      const int k = i + basis.latitudes() * j;
      const double t = basis.theta()[i], f = basis.phi()[j];
      samples.row(k) = r(k, 0) * Vec3(std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t)).transpose();
    }
  return resized(basis.analyze(samples), v.order);
}

/// Text table: "coefficients" and rows n m x y z, or "grid q" and (q+1)(2q+2) rows x y z, latitude fastest.
Coefficients from_file(const VesicleParameters& v) {
  std::string why;
  std::ifstream in = open_input(v.file, why);
  if (!in) throw std::invalid_argument(fmt::format("cannot read shape file '{}': {}", v.file, why));
  skip_byte_order_mark(in);
  std::string line, kind;
  int number = 0, grid_order = 0;
  std::vector<std::array<double, 5>> rows;
  while (std::getline(in, line)) {
    ++number;
    line = line.substr(0, line.find('#'));
    std::istringstream words(line);
    std::string word;
    if (!(words >> word)) continue;
    if (kind.empty()) {
      kind = word;
      if (kind == "grid" ? !(words >> grid_order) || grid_order < 1 || grid_order > 512 : kind != "coefficients")
        throw std::invalid_argument(fmt::format(
            "{}:{}: expected 'coefficients' or 'grid q' (q from 1 to 512), got '{}'", v.file, number, line));
      continue;
    }
    words.clear();
    words.seekg(0);
    std::array<double, 5> row{};
    const int columns = kind == "grid" ? 3 : 5;
    for (int c = 0; c < columns; ++c)
      if (!(words >> row[c]) || !std::isfinite(row[c]))
        throw std::invalid_argument(fmt::format("{}:{}: expected {} finite numbers", v.file, number, columns));
    if (words >> word) throw std::invalid_argument(fmt::format("{}:{}: more than {} columns", v.file, number, columns));
    if (columns == 5 && (row[0] != std::floor(row[0]) || row[1] != std::floor(row[1]) || row[0] < 0 || row[0] > 128 ||
                         std::abs(row[1]) > row[0]))
      throw std::invalid_argument(
          fmt::format("{}:{}: n must be an integer in 0..128 and |m| at most n", v.file, number));
    rows.push_back(row);
  }
  if (rows.empty()) throw std::invalid_argument(fmt::format("{}: no table in it", v.file));
  if (kind == "coefficients") {
    int degree = 0;
    for (const auto& row : rows) degree = std::max(degree, int(row[0]));
    Coefficients c{degree, Matrix::Zero(coefficient_count(degree), 3)};
    for (const auto& row : rows) c.values.row(coefficient_index(int(row[0]), int(row[1]))) << row[2], row[3], row[4];
    return resized(c, v.order);
  }
  // Before anything of that size is computed.
  if (const std::size_t expected = std::size_t(grid_order + 1) * std::size_t(2 * grid_order + 2);
      rows.size() != expected)
    throw std::invalid_argument(
        fmt::format("{}: a grid of order {} has {} rows, the file {}", v.file, grid_order, expected, rows.size()));
  const Basis basis(std::min(v.order, grid_order), grid_order);
  Matrix samples(basis.points(), 3);
  for (int k = 0; k < basis.points(); ++k) samples.row(k) << rows[k][0], rows[k][1], rows[k][2];
  return resized(basis.analyze(samples), v.order);
}

Coefficients spheroid(const VesicleParameters& v, bool prolate) {
  const Vec3 axes = spheroid_axes(required_volume(v), prolate);
  return ellipsoid(v.order, {axes[1], axes[2], axes[0]});
}

}  // namespace

Vec3 spheroid_axes(double nu, bool prolate) {
  if (!(nu > 0 && nu <= 1)) throw std::invalid_argument(fmt::format("reduced volume {} is not in (0, 1]", nu));
  const auto excess = [&](double r) {  // a = r, b = 1
    return reduced_volume(spheroid_area(r, 1), 4 * pi / 3 * r) - nu;
  };
  const double r = nu == 1 ? 1 : prolate ? bisect(excess, 1, 1e6) : bisect(excess, 1e-6, 1);
  const double scale = std::sqrt(4 * pi / spheroid_area(r, 1));
  return {r * scale, scale, scale};
}

const std::vector<CatalogueRow<ShapeFunction>>& shape_catalogue() {
  static const std::vector<CatalogueRow<ShapeFunction>> table{
      {"sphere", "sphere", {}, [](const VesicleParameters& v) { return ellipsoid(v.order, Vec3::Ones()); }},
      {"prolate",
       "prolate spheroid of a given reduced volume",
       {"reduced_volume"},
       [](const VesicleParameters& v) { return spheroid(v, true); }},
      {"oblate",
       "oblate spheroid of a given reduced volume",
       {"reduced_volume"},
       [](const VesicleParameters& v) { return spheroid(v, false); }},
      {"biconcave", "biconcave disc of a given reduced volume", {"reduced_volume"}, biconcave},
      {"ellipsoid",
       "ellipsoid of given semi-axes",
       {"axes"},
       [](const VesicleParameters& v) {
         if (!v.axes) throw std::invalid_argument("shape 'ellipsoid' needs axes = [a, b, c]");
         return ellipsoid(v.order, {(*v.axes)[2], (*v.axes)[1], (*v.axes)[0]});
       }},
      {"harmonics", "sphere with radius 1 + sum of value Y_nm", {"coefficients"}, harmonics},
      {"file", "grid or coefficient table from a text file", {"file"}, from_file},
  };
  return table;
}

namespace {

/// The least even order from 4 on that leaves so little of a shape.
int order_of_shape(const Coefficients& c) {
  constexpr int least = 4;
  constexpr double negligible = 1e-4;
  const auto degrees_from = [&](int n) {
    return c.values.bottomRows(c.values.rows() - coefficient_count(n - 1)).norm();
  };
  int order = least;
  while (order < c.order && degrees_from(order + 1) > negligible * degrees_from(1)) order += 2;
  return order;
}

}  // namespace

Coefficients upright_shape(const VesicleParameters& v) {
  if (v.order == 0) {
    VesicleParameters ordered = v;
    constexpr int enough = 32;
    ordered.order = enough;
    ordered.order = order_of_shape(upright_shape(ordered));
    return upright_shape(ordered);
  }
  const auto* row = find_row(shape_catalogue(), v.shape);
  if (!row)
    throw std::invalid_argument("unknown shape '" + v.shape + "'" + suggestion(v.shape, row_names(shape_catalogue())));
  Coefficients c = row->function(v);
  const Basis fine(c.order, 4 * c.order + 32);
  const AreaVolume size = area_volume(fine, c);
  if (!(size.area > 0) || !(size.volume > 0))
    throw std::invalid_argument(
        fmt::format("shape '{}' encloses no volume (is its table turned inside out?)", v.shape));
  const bool own_size = v.shape == "ellipsoid" || v.shape == "file";
  if (v.area || v.radius || !own_size) {
    const double area = v.area ? *v.area : v.radius ? 4 * pi * *v.radius * *v.radius : default_area;
    c.values *= std::sqrt(area / size.area);
  }
  return c;
}

Eigen::Matrix3d local_frame(const VesicleParameters& v) {
  const Vec3 z = v.axis ? v.axis->normalized() : v.shape == "file" ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitX());
  Vec3 y = Vec3::UnitY() - z * z[1];
  if (y.norm() < 1e-8) y = Vec3::UnitZ();
  y.normalize();
  Eigen::Matrix3d frame;
  frame << y.cross(z), y, z;
  return frame;
}

Coefficients laid(const VesicleParameters& v, Coefficients c) {
  c.values = (c.values * local_frame(v).transpose()).eval();
  c.values.row(0) += std::sqrt(4 * pi) * v.center.transpose();
  return c;
}

Coefficients initial_position(const VesicleParameters& v) { return laid(v, upright_shape(v)); }

}  // namespace sim
