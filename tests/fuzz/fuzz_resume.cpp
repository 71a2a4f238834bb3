// Resume records whose checksum fits. The input is a list of changes to the numbers of a whole one, most of them to
// those that are counts and sizes. What is accepted is written again as it was, and a step can be taken from it or is
// refused.
#include "sim/stepping/dynamics.h"
#include "sim/stepping/stepper.h"
#include "support.h"

#include <cmath>
#include <cstring>
#include <vector>

namespace {

constexpr int order = 2, label_order = 4;

const sim::Scene& scene() {
  static const sim::Scene scene = [] {
    sim::Scene s;
    s.flows.push_back({});
    s.flows.back().kind = "shear";
    sim::VesicleParameters v;
    v.shape = "prolate";
    v.reduced_volume = 0.9;
    v.order = order;
    s.vesicles = {v};
    s.numerics.label_order = label_order;
    s.numerics.threads = 1;
    s.time.scheme = "adaptive";
    return s;
  }();
  return scene;
}

constexpr double step_length = 0.05;

sim::Model& model() {
  static sim::Plans plans;
  static sim::Model model = sim::make_model(scene(), plans);
  return model;
}

const std::vector<double>& whole() {
  static const std::vector<double> numbers = [] {
    sim::Dynamics d = sim::initial_dynamics(model());
    sim::mark_saved(d, sim::evaluate(model(), d).value());
    for (int k = 0; k < 2; ++k) d = sim::take_step(model(), d, step_length).value().dynamics;
    return sim::serialised(d);
  }();
  return numbers;
}

/// Where counts and sizes stand: numbers that are whole and not 0.
const std::vector<std::size_t>& counts() {
  static const std::vector<std::size_t> places = [] {
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < whole().size(); ++i)
      if (const double x = whole()[i]; x != 0 && x == std::floor(x)) all.push_back(i);
    return all;
  }();
  return places;
}

/// Changes of 4 bytes each: what is done, where (two bytes), and to what.
std::vector<double> changed(const std::uint8_t* bytes, std::size_t size) {
  constexpr double values[] = {0,      1,        -1,        2,   3,      4,     9,     25,     0.5,
                               1e3,    65536,    1e6,       1e9, 1e18,   1e150, 1e300, 0x1p31, 0x1p32,
                               0x1p53, INFINITY, -INFINITY, NAN, 1e-300, -0.0,  8,     1024};
  std::vector<double> numbers = whole();
  for (std::size_t at = 0; at + 4 <= size && !numbers.empty(); at += 4) {
    const std::size_t where = bytes[at + 1] + 256U * bytes[at + 2], kind = bytes[at];
    const std::size_t place =
        std::min((kind & 0x80) ? where % numbers.size() : counts()[where % counts().size()], numbers.size() - 1);
    const double value = values[bytes[at + 3] % std::size(values)];
    const auto here = numbers.begin() + static_cast<std::ptrdiff_t>(place);
    switch (kind % 8) {
      case 0:
        numbers.resize(place);
        break;
      case 1:
        numbers.erase(here);
        break;
      case 2:
        numbers.insert(here, value);
        break;
      case 3:
        *here += 1;
        break;
      case 4:
        *here *= double(bytes[at + 3]) - 128;
        break;
      default:
        *here = value;
    }
  }
  return numbers;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::vector<double> numbers = changed(bytes, size);
  sim::TrajectoryLayout layout;
  layout.order = order;
  layout.label_order = label_order;
  fuzz::accepted([&] {
    const sim::Dynamics d = sim::deserialised(numbers, layout);
    const std::vector<double> again = sim::serialised(d);
    if (again.size() != numbers.size() || !std::equal(again.begin(), again.end(), numbers.begin()))
      fuzz::broken("an accepted record is written as it was");
    const auto fits = [](const sim::Coefficients& c) {
      if (c.values.rows() != sim::coefficient_count(c.order)) fuzz::broken("an accepted record is of its orders");
    };
    for (const sim::VesicleDynamics& v : d.vesicles) {
      sim::visit(v, [&]<class Member>(sim::Part, const Member& member) {
        if constexpr (std::is_same_v<Member, sim::Coefficients>) fits(member);
      });
      for (const sim::PastLevel& level : v.history.levels)
        sim::visit_level(level, [&]<class Part>(const char*, const Part& part) {
          if constexpr (std::is_same_v<Part, sim::Coefficients>) fits(part);
        });
    }
    if (d.vesicles.front().position.order == order) sim::take_step(model(), d, step_length);
  });
  return 0;
}
