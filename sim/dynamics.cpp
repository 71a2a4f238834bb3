#include "dynamics.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace sim {

namespace {

constexpr int most_upsampling = 8;  // that a scene may ask for, and Algorithm 1 chooses: a forged record makes no vast grid
constexpr double largest_number = 1e150;  // the square of every number is one, too

/// One list of members for both directions.
template <class Archive, class D>
void transfer_vesicle(Archive& ar, D& v) {
  for (auto* c : {&v.position, &v.displacement, &v.motion.velocity, &v.motion.tension, &v.labels, &v.saved_position,
                  &v.saved_velocity})
    ar(*c);
  ar(v.tracers);
  for (auto* frame : {&v.frame, &v.frame_before, &v.carrier})
    for (auto* x : {&frame->motion.translation, &frame->motion.rotation, &frame->motion.centre})
      for (int k = 0; k < 3; ++k) ar((*x)[k]);
  for (auto* frame : {&v.frame, &v.frame_before, &v.carrier})
    for (int k = 0; k < 9; ++k) ar(frame->drift(k));
  ar(v.area), ar(v.volume), ar(v.energy), ar(v.tail), ar(v.upsampling), ar(v.upsampling_due), ar(v.high_share);
  ar(v.relabelled), ar(v.labels_laid), ar(v.labels_laid_time), ar(v.warned);
}

template <class Archive, class D>
void transfer(Archive& ar, D& d) {
  ar(d.step), ar(d.saves), ar(d.time), ar(d.dt_before), ar(d.dt_limit), ar(d.calm), ar(d.history);
  ar.size(d.vesicles);
  for (auto& v : d.vesicles) transfer_vesicle(ar, v);
}

struct Writer {
  std::vector<double> numbers;
  template <class T>
    requires std::is_arithmetic_v<T>
  void operator()(const T& value) { numbers.push_back(double(value)); }  // integers here stay far below 2^53
  void operator()(const Matrix& m) {
    (*this)(m.rows()), (*this)(m.cols());
    numbers.insert(numbers.end(), m.data(), m.data() + m.size());
  }
  void operator()(const Coefficients& c) { (*this)(c.order), (*this)(c.values); }
  void size(const std::vector<VesicleDynamics>& v) { (*this)(v.size()); }
};

[[noreturn]] void refuse(const char* why) { throw std::runtime_error(why); }

/// Each number is checked for what its type can hold, each size before anything of that size is made.
struct Reader {
  std::span<const double> numbers;
  const TrajectoryLayout& layout;
  std::size_t at = 0;

  double next() {
    if (at >= numbers.size()) refuse("it is cut short");
    const double value = numbers[at++];
    if (!(std::abs(value) <= largest_number)) refuse("a number in it is impossible");
    return value;
  }
  double whole(double least, double largest) {
    const double value = next();
    if (!(value >= least && value <= largest && value == std::floor(value))) refuse("a count in it is impossible");
    return value;
  }
  void operator()(double& value) { value = next(); }
  void operator()(bool& value) { value = whole(0, 1) == 1; }
  void operator()(int& value) { value = int(whole(0, std::numeric_limits<int>::max())); }
  void operator()(std::int64_t& value) { value = std::int64_t(whole(0, 0x1p53)); }
  void operator()(Matrix& m) {
    const double rows = whole(0, double(numbers.size())), columns = whole(0, double(numbers.size()));
    if (rows * columns > double(numbers.size() - at)) refuse("it is cut short");  // behind the two
    m = Eigen::Map<const Matrix>(numbers.data() + at, Eigen::Index(rows), Eigen::Index(columns));
    if (!m.allFinite() || (m.array().abs() > largest_number).any()) refuse("a number in it is impossible");
    at += std::size_t(m.size());
  }
  void operator()(Coefficients& c) {
    c.order = int(whole(0, std::max(layout.order, layout.label_order)));
    (*this)(c.values);
    if (c.values.rows() != coefficient_count(c.order)) refuse("an order in it does not fit its numbers");
  }
  void size(std::vector<VesicleDynamics>& v) { v.resize(std::size_t(whole(layout.vesicles, layout.vesicles))); }
};

bool is_field(const Coefficients& c, int order, int columns) { return c.order == order && c.values.cols() == columns; }

void check(const VesicleDynamics& v, const TrajectoryLayout& layout) {
  const int p = v.position.order;
  for (const Coefficients* c : {&v.position, &v.displacement, &v.motion.velocity, &v.saved_position, &v.saved_velocity})
    if (p > layout.order || !is_field(*c, p, 3)) refuse("its fields are of different orders");
  if (!is_field(v.motion.tension, p, 1)) refuse("its fields are of different orders");
  if (!is_field(v.labels, v.labels.order, 3) || v.labels.order > layout.label_order) refuse("its labels do not fit");
  if (v.tracers.rows() != layout.tracers || v.tracers.cols() != 3) refuse("its tracers do not fit");
  if (!(v.area > 0) || v.upsampling < 1 || v.upsampling > most_upsampling) refuse("a vesicle in it is impossible");
}

}  // namespace

std::vector<double> serialised(const Dynamics& d) {
  Writer writer;
  transfer(writer, d);
  return std::move(writer.numbers);
}

Dynamics deserialised(std::span<const double> numbers, const TrajectoryLayout& layout) {
  Reader reader{numbers, layout};
  Dynamics d;
  transfer(reader, d);
  if (reader.at != numbers.size()) refuse("there is more in it");
  for (const VesicleDynamics& v : d.vesicles) check(v, layout);
  if (d.saves < 1 || d.time < 0 || !(d.dt_limit > 0) || (d.history && !(d.dt_before > 0))) refuse("a time in it is impossible");
  return d;
}

}  // namespace sim
