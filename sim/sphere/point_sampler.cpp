#include "sim/sphere/point_sampler.h"

#include "sim/sphere/legendre.h"

#include <array>
#include <cmath>

namespace sim {

namespace {

using Half = Eigen::Array4d;
using Both = Eigen::Array<double, 8, 1>;

/// Room for tables of all P_nm: on the stack up to degree 24, which serves most runs.
class Tables {
 public:
  Tables(int count, int number)
      : count_(count), many_(count * number > int(few_.size()) ? std::size_t(count) * number : 0) {}
  double* operator[](int k) { return (many_.empty() ? few_.data() : many_.data()) + std::ptrdiff_t(k) * count_; }

 private:
  int count_;
  std::array<double, 3 * legendre_count(24)> few_;  // written before it is read
  std::vector<double> many_;
};

/// cos and sin of a longitude and its multiples, one after the other.
struct Turn {
  double c1, s1, c = 1, s = 0;
  void next() {
    const double turned = c * c1 - s * s1;
    s = s * c1 + c * s1;
    c = turned;
  }
};
Turn turn_of(const Vec3& s, double rho) { return rho > 0 ? Turn{s[0] / rho, s[1] / rho} : Turn{1, 0}; }

}  // namespace

Vec3 beside_the_pole(const Vec3& s) {
  return std::hypot(s[0], s[1]) < 1e-9 ? Vec3(s[0] + 1e-6, s[1], s[2]).normalized() : s;
}

PointSampler::PointSampler(const Coefficients& position)
    : order_(position.order), recurrence_(legendre_count(position.order)), halves_(8, legendre_count(position.order)) {
  const int p = order_;
  for (int m = 0; m <= p; ++m)
    for (int n = m; n <= p; ++n) {
      const int k = legendre_index(p, n, m);
      const double nn = double(n) * n, mm = double(m) * m;
      Recurrence& r = recurrence_[k];
      r.next = n > m ? std::sqrt((4 * nn - 1) / (nn - mm)) : m > 0 ? std::sqrt((2.0 * m + 1) / (2.0 * m)) : 0;
      r.before = n > m + 1 ? std::sqrt((2.0 * n + 1) * (n - m - 1.0) * (n + m - 1.0) / ((2.0 * n - 3) * (nn - mm))) : 0;
      r.down = 0.5 * std::sqrt(double(n + m) * (n - m + 1));
      r.up = 0.5 * std::sqrt(double(n - m) * (n + m + 1));
      halves_.col(k).setZero();
      halves_.col(k).head<3>() = longitude_norm(m) * position.values.row(coefficient_index(n, m)).transpose();
      if (m > 0)
        halves_.col(k).segment<3>(4) = longitude_norm(m) * position.values.row(coefficient_index(n, -m)).transpose();
    }
}

void PointSampler::legendre(double cosine, double sine, double* value) const {
  double diagonal = std::sqrt(0.5);
  for (int m = 0, k = 0; m <= order_; ++m) {
    if (m > 0) diagonal *= recurrence_[k].next * sine;
    value[k++] = diagonal;
    double before = 0, now = diagonal;
    for (int n = m + 1; n <= order_; ++n, ++k) {
      const double next = recurrence_[k].next * cosine * now - recurrence_[k].before * before;
      value[k] = next;
      before = now;
      now = next;
    }
  }
}

void PointSampler::ladder(const double* table, double* derivative) const {
  const int p = order_;
  derivative[0] = 0;
  for (int n = 1; n <= p; ++n)  // P_n,-1 = -P_n,1 without the Condon-Shortley sign
    derivative[n] = -(recurrence_[n].down + recurrence_[n].up) * table[legendre_index(p, n, 1)];
  for (int m = 1; m <= p; ++m) {
    const int row = legendre_index(p, m, m);
    const double* lower = table + legendre_index(p, m, m - 1);
    derivative[row] = recurrence_[row].down * lower[0];
    for (int k = 1; k <= p - m; ++k) {
      const Recurrence& r = recurrence_[row + k];
      derivative[row + k] = r.down * lower[k] - r.up * table[row + p - m + k];
    }
  }
}

Vec3 PointSampler::position(const Vec3& s) const {
  const double rho = std::hypot(s[0], s[1]), size = s.norm();
  Tables tables(legendre_count(order_), 1);
  const double* value = tables[0];
  legendre(s[2] / size, rho / size, tables[0]);
  Turn turn = turn_of(s, rho);
  Half x = Half::Zero();
  for (int m = 0, k = 0; m <= order_; ++m, turn.next()) {
    Both sum = Both::Zero();
    for (int n = m; n <= order_; ++n, ++k) sum += value[k] * halves_.col(k).array();
    x += turn.c * sum.head<4>() + turn.s * sum.tail<4>();
  }
  return x.head<3>().matrix();
}

PointTangents PointSampler::tangents(const Vec3& given) const {
  const Vec3 s = beside_the_pole(given.normalized());
  const double rho = std::hypot(s[0], s[1]);
  Tables tables(legendre_count(order_), 3);
  const double *p0 = tables[0], *p1 = tables[1], *p2 = tables[2];
  legendre(s[2], rho, tables[0]);
  ladder(p0, tables[1]);
  ladder(p1, tables[2]);
  Turn turn = turn_of(s, rho);
  Half x = Half::Zero(), t = x, f = x, tt = x, tf = x, ff = x;
  for (int m = 0, k = 0; m <= order_; ++m, turn.next()) {
    Both sum0 = Both::Zero(), sum1 = sum0, sum2 = sum0;
    for (int n = m; n <= order_; ++n, ++k) {
      const Both half = halves_.col(k).array();
      sum0 += p0[k] * half;
      sum1 += p1[k] * half;
      sum2 += p2[k] * half;
    }
    const double c = turn.c, w = turn.s, mc = m * c, mw = m * w;
    x += c * sum0.head<4>() + w * sum0.tail<4>();
    t += c * sum1.head<4>() + w * sum1.tail<4>();
    tt += c * sum2.head<4>() + w * sum2.tail<4>();
    f += mc * sum0.tail<4>() - mw * sum0.head<4>();
    tf += mc * sum1.tail<4>() - mw * sum1.head<4>();
    ff -= m * (mc * sum0.head<4>() + mw * sum0.tail<4>());
  }
  const auto vector = [](const Half& h) { return Vec3(h.head<3>().matrix()); };
  PointTangents at;
  at.pole = rho;
  at.e1 = Vec3(turn.c1 * s[2], turn.s1 * s[2], -rho);
  at.e2 = Vec3(-turn.s1, turn.c1, 0);
  at.x = vector(x);
  at.a = vector(t);
  at.b = vector(f) / rho;
  at.aa = vector(tt);
  // Along great circles: circles of latitude turn against them by cot(theta).
  at.ab = (vector(tf) - s[2] * at.b) / rho;
  at.bb = (vector(ff) / rho + s[2] * at.a) / rho;
  return at;
}

}  // namespace sim
