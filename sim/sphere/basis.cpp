#include "sim/sphere/basis.h"

#include "sim/core/fftw_planner.h"
#include "sim/sphere/grid_transform.h"

#include <fftw3.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace sim {

namespace {

using std::numbers::pi;

/// Up to this degree a dense Fourier product beats FFTW's real transforms (docs/performance.md has the measurement).
constexpr int dense_fourier_limit = 40;

}  // namespace

struct Basis::Plan {
  int p = 0, q = 0, nlat = 0, nlon = 0;
  Vector theta, phi, weights, sin_theta;
  std::optional<GridTransform> transform;
  fftw_plan backward = nullptr, forward = nullptr;  ///< one field: nlat transforms of length nlon

  Plan(int order, int grid_order);
  ~Plan();
  Plan(const Plan&) = delete;
  bool dense() const { return p <= dense_fourier_limit; }

  void synthesize(const Coefficients& c, const Wanted& wanted) const;
  void fast_synthesis(const Lane* spectrum, int fields, TableRange made, const Wanted& wanted) const;
  void fast_analysis(const double* samples, int fields, Lane* spectrum) const;
  Coefficients analyze(const double* samples, int fields) const;
  SecondDerivatives second(const Coefficients&, bool with_value) const;
  /// To be filled: points x fields.
  double* sized(Matrix& m, const Coefficients& c) const {
    m.resize(nlat * nlon, c.values.cols());
    return m.data();
  }
};

Basis::Plan::Plan(int order, int grid_order) : p(order), q(grid_order), nlat(grid_order + 1), nlon(2 * grid_order + 2) {
  if (order < 0 || grid_order < order) throw std::invalid_argument("Basis: the grid order must be at least the degree");
  const GaussLegendre rule = gauss_legendre(nlat);
  theta = rule.theta;
  phi = Vector::LinSpaced(nlon, 0, 2 * pi * (nlon - 1) / nlon);
  weights.resize(nlat * nlon);
  sin_theta.resize(nlat * nlon);
  for (int j = 0; j < nlon; ++j)
    for (int i = 0; i < nlat; ++i) {
      weights[i + nlat * j] = rule.weight[i] * 2 * pi / nlon;
      sin_theta[i + nlat * j] = std::sin(theta[i]);
    }
  transform.emplace(p, rule, nlon, dense());
  if (!dense()) {
    Matrix in(nlat, nlon), out(nlat, nlon);
    const fftw_iodim dimension{nlon, nlat, nlat}, many{nlat, 1, 1};
    const fftw_r2r_kind to_points = FFTW_HC2R, to_spectrum = FFTW_R2HC;
    const unsigned flags = FFTW_ESTIMATE | FFTW_UNALIGNED;  // ESTIMATE: the same plan in every run
    const std::lock_guard lock(planner_mutex());
    backward = fftw_plan_guru_r2r(1, &dimension, 1, &many, in.data(), out.data(), &to_points, flags);
    forward = fftw_plan_guru_r2r(1, &dimension, 1, &many, in.data(), out.data(), &to_spectrum, flags);
  }
}

Basis::Plan::~Plan() {
  const std::lock_guard lock(planner_mutex());
  if (backward) fftw_destroy_plan(backward);
  if (forward) fftw_destroy_plan(forward);
}

void Basis::Plan::synthesize(const Coefficients& c, const Wanted& wanted) const {
  if (c.order > p) throw std::invalid_argument("Basis: coefficients of a higher degree than the plan's");
  const int fields = int(c.values.cols());
  TableRange made{3, 0};
  for (const TableRange& range : wanted.tables)
    if (range.count() > 0) made = {std::min(made.first, range.first), std::max(made.last, range.last)};
  const LaneScratch spectrum(std::size_t(transform->spectrum_size(made.count() * fields)));
  transform->along_latitudes(c.values.data(), c.order, fields, made, spectrum.get());
  if (dense()) {
    transform->around(spectrum.get(), c.order, fields, made, wanted);
    return;
  }
  const std::size_t row = std::size_t(made.count()) * fields * transform->latitude_lanes();
  for (int m = c.order + 1; m <= p; ++m)
    for (const int at : {m, p + m}) std::fill_n(spectrum.get() + at * row, row, Lane{});
  fast_synthesis(spectrum.get(), fields, made, wanted);
}

/// The Fourier half by FFTW.
void Basis::Plan::fast_synthesis(const Lane* spectrum, int fields, TableRange made, const Wanted& wanted) const {
  const int depth = transform->latitude_lanes(), columns = made.count() * fields;
  Matrix scratch(nlat, nlon);  // half-complex order: real parts 0.., imaginary part of m at nlon - m
  for (int d = 0; d < 3; ++d)
    for (int t = wanted.tables[d].first; t < wanted.tables[d].last; ++t)
      for (int f = 0; f < fields; ++f) {
        const auto row = [&](int at) {
          return transform->latitudes_of(spectrum +
                                         (std::ptrdiff_t(at) * columns + (t - made.first) * fields + f) * depth);
        };
        scratch.setZero();
        if (d == 0) scratch.col(0) = row(0) * longitude_norm(0);
        for (int m = 1; m <= p; ++m) {
          const double k = 0.5 * longitude_norm(m) * std::pow(m, d);
          const Vector c = row(m), s = row(p + m);
          if (d == 0) scratch.col(m) = k * c, scratch.col(nlon - m) = -k * s;
          if (d == 1) scratch.col(m) = k * s, scratch.col(nlon - m) = k * c;
          if (d == 2) scratch.col(m) = -k * c, scratch.col(nlon - m) = k * s;
        }
        fftw_execute_r2r(backward, scratch.data(), wanted.out[d][t] + std::ptrdiff_t(f) * nlat * nlon);
      }
}

void Basis::Plan::fast_analysis(const double* samples, int fields, Lane* spectrum) const {
  const int depth = transform->latitude_lanes();
  Matrix in(nlat, nlon), out(nlat, nlon);
  for (int f = 0; f < fields; ++f) {
    in = Eigen::Map<const Matrix>(samples + std::ptrdiff_t(f) * nlat * nlon, nlat, nlon);
    fftw_execute_r2r(forward, in.data(), out.data());
    const auto set_row = [&](int at, const Vector& values) {
      transform->set_latitudes(values, spectrum + (std::ptrdiff_t(at) * fields + f) * depth);
    };
    for (int m = 0; m <= p; ++m) {
      set_row(m, longitude_norm(m) * out.col(m));
      if (m > 0) set_row(p + m, -longitude_norm(m) * out.col(nlon - m));
    }
  }
}

Coefficients Basis::Plan::analyze(const double* samples, int fields) const {
  Coefficients c{p, Matrix(coefficient_count(p), fields)};
  const LaneScratch spectrum(std::size_t(transform->spectrum_size(fields)));
  if (dense())
    transform->spectrum_of(samples, fields, spectrum.get());
  else
    fast_analysis(samples, fields, spectrum.get());
  transform->project(spectrum.get(), fields, c.values.data());
  return c;
}

Basis::Basis(int order, int grid_order) : plan_(std::make_unique<Plan>(order, grid_order)) {}
Basis::~Basis() = default;
Basis::Basis(Basis&&) noexcept = default;

int Basis::order() const { return plan_->p; }
int Basis::grid_order() const { return plan_->q; }
int Basis::latitudes() const { return plan_->nlat; }
int Basis::longitudes() const { return plan_->nlon; }
int Basis::points() const { return plan_->nlat * plan_->nlon; }
const Vector& Basis::theta() const { return plan_->theta; }
const Vector& Basis::phi() const { return plan_->phi; }
const Vector& Basis::weights() const { return plan_->weights; }
const Vector& Basis::sin_theta() const { return plan_->sin_theta; }

SecondDerivatives Basis::Plan::second(const Coefficients& c, bool with_value) const {
  SecondDerivatives d;
  Wanted wanted{{{with_value ? 0 : 1, 3}, {0, 2}, {0, 1}}, {}};
  if (with_value) wanted.out[0][0] = sized(d.value, c);
  wanted.out[0][1] = sized(d.t, c);
  wanted.out[0][2] = sized(d.tt, c);
  wanted.out[1][0] = sized(d.f, c);
  wanted.out[1][1] = sized(d.tf, c);
  wanted.out[2][0] = sized(d.ff, c);
  synthesize(c, wanted);
  return d;
}

GridValues Basis::synthesize(const Coefficients& c) const {
  GridValues g{plan_->q, {}};
  Wanted wanted{{{0, 1}, {}, {}}, {}};
  wanted.out[0][0] = plan_->sized(g.values, c);
  plan_->synthesize(c, wanted);
  return g;
}

FirstDerivatives Basis::first(const Coefficients& c) const {
  FirstDerivatives d;
  Wanted wanted{{{0, 2}, {0, 1}, {}}, {}};
  wanted.out[0][0] = plan_->sized(d.value, c);
  wanted.out[0][1] = plan_->sized(d.t, c);
  wanted.out[1][0] = plan_->sized(d.f, c);
  plan_->synthesize(c, wanted);
  return d;
}

SecondDerivatives Basis::second(const Coefficients& c) const { return plan_->second(c, true); }

SecondDerivatives Basis::derivatives(const Coefficients& c) const { return plan_->second(c, false); }

FirstDerivatives Basis::slopes(const Coefficients& c) const {
  FirstDerivatives d;
  Wanted wanted{{{1, 2}, {0, 1}, {}}, {}};
  wanted.out[0][1] = plan_->sized(d.t, c);
  wanted.out[1][0] = plan_->sized(d.f, c);
  plan_->synthesize(c, wanted);
  return d;
}

SecondDerivatives Basis::curvatures(const Coefficients& c) const {
  SecondDerivatives d;
  Wanted wanted{{{2, 3}, {1, 2}, {0, 1}}, {}};
  wanted.out[0][2] = plan_->sized(d.tt, c);
  wanted.out[1][1] = plan_->sized(d.tf, c);
  wanted.out[2][0] = plan_->sized(d.ff, c);
  plan_->synthesize(c, wanted);
  return d;
}

Coefficients Basis::analyze(const GridValues& g) const { return analyze(g.values); }
Coefficients Basis::analyze(const Eigen::Ref<const Matrix>& samples) const {
  if (samples.rows() != points()) throw std::invalid_argument("Basis: samples are not on this grid");
  if (samples.outerStride() != samples.rows() && samples.cols() > 1) return analyze(Matrix(samples));
  return plan_->analyze(samples.data(), int(samples.cols()));
}

Vec3 unit_vector(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

Vec3 grid_direction(const Basis& basis, Eigen::Index point) {
  return unit_vector(basis.theta()[point % basis.latitudes()], basis.phi()[point / basis.latitudes()]);
}

Matrix grid_directions(const Basis& basis) {
  Matrix s(basis.points(), 3);
  for (Eigen::Index k = 0; k < basis.points(); ++k) s.row(k) = grid_direction(basis, k).transpose();
  return s;
}

SphereFrame sphere_frame(const Vec3& s) {
  const double rho = std::max(std::hypot(s[0], s[1]), 1e-150);
  const double c = s[0] / rho, d = s[1] / rho;
  return {Vec3(s[2] * c, s[2] * d, -rho), Vec3(-d, c, 0), rho};
}

Coefficients resized(const Coefficients& c, int order) {
  Coefficients r{order, Matrix::Zero(coefficient_count(order), c.values.cols())};
  const int rows = coefficient_count(std::min(order, c.order));
  r.values.topRows(rows) = c.values.topRows(rows);
  return r;
}

FirstDerivatives sample_grid(const Coefficients& c, const Vector& theta, const Vector& phi) {
  const int p = c.order, fields = int(c.values.cols()), nlat = int(theta.size()), nlon = int(phi.size());
  const LegendreTable table = legendre_table(p, theta, 1);
  FirstDerivatives d{Matrix::Zero(nlat * nlon, fields), Matrix::Zero(nlat * nlon, fields),
                     Matrix::Zero(nlat * nlon, fields)};
  Matrix fourier(2 * p + 1, nlon), derivative(2 * p + 1, nlon);
  for (int j = 0; j < nlon; ++j)
    for (int m = 0; m <= p; ++m) {
      const double k = longitude_norm(m), co = k * std::cos(m * phi[j]), si = k * std::sin(m * phi[j]);
      fourier(p + m, j) = co, derivative(p + m, j) = -m * si;
      if (m > 0) fourier(p - m, j) = si, derivative(p - m, j) = m * co;
    }
  Matrix value(nlat, 2 * p + 1), slope(nlat, 2 * p + 1);
  for (int f = 0; f < fields; ++f) {
    for (int m = -p; m <= p; ++m) {
      const int a = std::abs(m), first = legendre_index(p, a, a), count = p - a + 1;
      Vector column(count);
      for (int n = a; n <= p; ++n) column[n - a] = c.values(coefficient_index(n, m), f);
      value.col(p + m).noalias() = table.value.middleCols(first, count) * column;
      slope.col(p + m).noalias() = table.d1.middleCols(first, count) * column;
    }
    Eigen::Map<Matrix>(d.value.col(f).data(), nlat, nlon).noalias() = value * fourier;
    Eigen::Map<Matrix>(d.t.col(f).data(), nlat, nlon).noalias() = slope * fourier;
    Eigen::Map<Matrix>(d.f.col(f).data(), nlat, nlon).noalias() = value * derivative;
  }
  return d;
}

namespace {

struct BasisFunctions {
  Matrix value, t, f;  ///< count x (p+1)^2; derivatives where asked for
};

BasisFunctions basis_functions(int p, const Matrix& directions, bool derivatives) {
  const Eigen::Index count = directions.rows();
  Vector theta(count);
  for (Eigen::Index k = 0; k < count; ++k)
    theta[k] = std::atan2(std::hypot(directions(k, 0), directions(k, 1)), directions(k, 2));
  const LegendreTable table = legendre_table(p, theta, derivatives ? 1 : 0);
  BasisFunctions b;
  b.value.resize(count, coefficient_count(p));
  if (derivatives) b.t = b.f = Matrix::Zero(count, coefficient_count(p));
  Eigen::ArrayXd phi(count);
  for (Eigen::Index k = 0; k < count; ++k) phi[k] = std::atan2(directions(k, 1), directions(k, 0));
  for (int m = 0; m <= p; ++m) {
    const Eigen::ArrayXd co = longitude_norm(m) * (m * phi).cos(), si = longitude_norm(m) * (m * phi).sin();
    for (int n = m; n <= p; ++n) {
      const int column = legendre_index(p, n, m), c = coefficient_index(n, m), s = coefficient_index(n, -m);
      const auto value = table.value.col(column).array();
      b.value.col(c) = co * value;
      if (m > 0) b.value.col(s) = si * value;
      if (!derivatives) continue;
      const auto slope = table.d1.col(column).array();
      b.t.col(c) = co * slope;
      b.f.col(c) = -m * si * value;
      if (m > 0) b.t.col(s) = si * slope;
      if (m > 0) b.f.col(s) = m * co * value;
    }
  }
  return b;
}

constexpr Eigen::Index point_batch = 256;  ///< keeps the tables of a batch in cache

}  // namespace

Matrix basis_functions(int p, const Matrix& directions) { return basis_functions(p, directions, false).value; }

FirstDerivatives sample_points_first(const Coefficients& c, const Matrix& directions) {
  const Eigen::Index count = directions.rows(), fields = c.values.cols();
  FirstDerivatives d{Matrix(count, fields), Matrix(count, fields), Matrix(count, fields)};
  for (Eigen::Index start = 0; start < count; start += point_batch) {
    const Eigen::Index size = std::min(point_batch, count - start);
    const BasisFunctions b = basis_functions(c.order, directions.middleRows(start, size), true);
    d.value.middleRows(start, size).noalias() = b.value * c.values;
    d.t.middleRows(start, size).noalias() = b.t * c.values;
    d.f.middleRows(start, size).noalias() = b.f * c.values;
  }
  return d;
}

Matrix sample_points(const Coefficients& c, const Matrix& directions) {
  Matrix value(directions.rows(), c.values.cols());
  for (Eigen::Index start = 0; start < directions.rows(); start += point_batch) {
    const Eigen::Index size = std::min(point_batch, directions.rows() - start);
    value.middleRows(start, size).noalias() = basis_functions(c.order, directions.middleRows(start, size)) * c.values;
  }
  return value;
}

}  // namespace sim
