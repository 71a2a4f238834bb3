#include "dynamics.h"

#include <stdexcept>

namespace sim {

namespace {

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
  ar(v.relabelled), ar(v.labels_laid), ar(v.labels_laid_time);
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

struct Reader {
  std::span<const double> numbers;
  std::size_t at = 0;
  double next() {
    if (at >= numbers.size()) throw std::runtime_error("the resume state is cut short");
    return numbers[at++];
  }
  std::size_t length(double largest) {
    const double n = next();
    if (!(n >= 0 && n <= largest)) throw std::runtime_error("the resume state is not one");
    return std::size_t(n);
  }
  template <class T>
    requires std::is_arithmetic_v<T>
  void operator()(T& value) { value = T(next()); }
  void operator()(Matrix& m) {
    const std::size_t rows = length(1e6), columns = length(1e3);
    if (at + rows * columns > numbers.size()) throw std::runtime_error("the resume state is cut short");
    m = Eigen::Map<const Matrix>(numbers.data() + at, Eigen::Index(rows), Eigen::Index(columns));
    at += rows * columns;
  }
  void operator()(Coefficients& c) { (*this)(c.order), (*this)(c.values); }
  void size(std::vector<VesicleDynamics>& v) { v.resize(length(1e6)); }
};

}  // namespace

std::vector<double> serialised(const Dynamics& d) {
  Writer writer;
  transfer(writer, d);
  return std::move(writer.numbers);
}

Dynamics deserialised(std::span<const double> numbers) {
  Reader reader{numbers};
  Dynamics d;
  transfer(reader, d);
  return d;
}

}  // namespace sim
