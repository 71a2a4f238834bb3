#include "sim/stepping/dynamics.h"

#include "sim/core/divided.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

namespace sim {

namespace {

constexpr int most_upsampling =
    8;  // that a scene may ask for, and Algorithm 1 chooses: a forged record makes no vast grid
constexpr double largest_number = 1e150;  // the square of every number is one, too

/// One list of members for both directions: of all but the vesicles.
template <class Archive, class D>
void transfer_run(Archive& ar, D& d) {
  ar(d.step), ar(d.saves), ar(d.time), ar(d.dt_limit), ar(d.calm);
  ar(d.control.order), ar(d.control.at_order), ar(d.control.held), ar(d.control.resolution_due), ar(d.control.gap);
}
template <class Archive, class D>
void transfer(Archive& ar, D& d) {
  transfer_run(ar, d);
  ar.size(d.vesicles);
  for (auto& v : d.vesicles) visit(v, [&](Part, auto& member) { ar(member); });
  ar(d.learned);
}

template <class Archive, class F>
void transfer_frame(Archive& ar, F& frame) {
  for (auto* x : {&frame.motion.translation, &frame.motion.rotation, &frame.motion.centre})
    for (int k = 0; k < 3; ++k) ar((*x)[k]);
  for (int k = 0; k < 9; ++k) ar(frame.drift(k));
  for (int k = 0; k < 3; ++k) ar(frame.spin_up[k]);
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
  void operator()(const Frame& frame) { transfer_frame(*this, frame); }
  void operator()(const History& history) {
    (*this)(history.levels.size());
    for (const PastLevel& level : history.levels)
      visit_level(level, [this](const char*, const auto& part) { (*this)(part); });
  }
  /// Two numbers of single precision in the place of one.
  void operator()(const Eigen::MatrixXf& m) {
    (*this)(m.rows()), (*this)(m.cols());
    for (Eigen::Index k = 0; k < m.size(); k += 2)
      numbers.push_back(std::bit_cast<double>(std::array{m.data()[k], k + 1 < m.size() ? m.data()[k + 1] : 0.0F}));
  }
  void operator()(const Lessons& lessons) {
    (*this)(lessons.size());
    for (const auto& learned : lessons) {
      (*this)(bool(learned));
      if (learned) (*this)(learned->directions), (*this)(learned->images);
    }
  }
  void size(const std::vector<VesicleDynamics>& v) { (*this)(v.size()); }
};

/// Whether something was learned; then two sizes each of directions and images, and their numbers, two in the place of
/// one.
std::size_t numbers_learned(std::size_t size, std::size_t directions) {
  return 1 + 2 * (2 + (size * directions + 1) / 2);
}

/// How many numbers a Writer would write.
struct Counter {
  std::size_t numbers = 0;
  template <class T>
  requires std::is_arithmetic_v<T>
  void operator()(const T&) { ++numbers; }
  void operator()(const Matrix& m) { numbers += 2 + std::size_t(m.size()); }
  void operator()(const Coefficients& c) { (*this)(c.order), (*this)(c.values); }
  void operator()(const Frame& frame) { transfer_frame(*this, frame); }
  void operator()(const History& history) {
    (*this)(history.levels.size());
    for (const PastLevel& level : history.levels)
      visit_level(level, [this](const char*, const auto& part) { (*this)(part); });
  }
  void operator()(const Lessons& lessons) {
    ++numbers;
    for (const auto& learned : lessons)
      numbers +=
          learned ? numbers_learned(std::size_t(learned->images.rows()), std::size_t(learned->images.cols())) : 1;
  }
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
  void operator()(Frame& frame) { transfer_frame(*this, frame); }
  void operator()(History& history) {
    history.levels.resize(std::size_t(whole(0, most_past_levels)));
    for (PastLevel& level : history.levels) visit_level(level, [this](const char*, auto& part) { (*this)(part); });
  }
  void operator()(Eigen::MatrixXf& m) {
    const double rows = whole(0, double(numbers.size())), columns = whole(0, double(numbers.size()));
    if (rows * columns > 2 * double(numbers.size() - at)) refuse("it is cut short");
    m.resize(Eigen::Index(rows), Eigen::Index(columns));
    for (Eigen::Index k = 0; k < m.size(); k += 2) {
      const auto pair = std::bit_cast<std::array<float, 2>>(numbers[at++]);
      m.data()[k] = pair[0];
      if (k + 1 < m.size()) m.data()[k + 1] = pair[1];
    }
    if (!m.allFinite()) refuse("a number in it is impossible");
  }
  void operator()(Lessons& lessons) {
    lessons.resize(std::size_t(whole(0, layout.vesicles)));
    for (auto& learned : lessons) {
      bool known = false;
      (*this)(known);
      if (!known) continue;
      Learned read;
      (*this)(read.directions), (*this)(read.images);
      learned = std::make_shared<const Learned>(std::move(read));
    }
  }
  void size(std::vector<VesicleDynamics>& v) { v.resize(std::size_t(whole(layout.vesicles, layout.vesicles))); }
};

bool is_field(const Coefficients& c, int order, int columns) { return c.order == order && c.values.cols() == columns; }

void check(const VesicleDynamics& v, const TrajectoryLayout& layout) {
  const int p = v.position.order;
  if (p > layout.order) refuse("its fields are of different orders");
  const auto look = [&]<class Member>(Part part, const Member& member) {
    if constexpr (std::is_same_v<Member, Coefficients>) {
      if (part == Part::label) {
        if (!is_field(member, member.order, 3) || member.order > layout.label_order) refuse("its labels do not fit");
      } else if (!is_field(member, p, part == Part::scalar ? 1 : 3)) {
        refuse("its fields are of different orders");
      }
    } else if constexpr (std::is_same_v<Member, History>) {
      for (const PastLevel& level : member.levels) {
        if (!is_field(level.position, p, 3) || !is_field(level.motion.velocity, p, 3) ||
            !is_field(level.motion.tension, p, 1) || !is_field(level.sliding, p, 3))
          refuse("its fields are of different orders");
        if (!(level.dt > 0)) refuse("a time in it is impossible");
      }
    } else if constexpr (std::is_same_v<Member, Matrix>) {
      if (member.rows() != layout.tracers || member.cols() != 3) refuse("its tracers do not fit");
    }
  };
  visit(v, look);
  if (!(v.area > 0) || !(v.upsampling >= 1) || v.upsampling > most_upsampling) refuse("a vesicle in it is impossible");
}

void check_lessons(const Dynamics& d) {
  if (!d.learned.empty() && d.learned.size() != d.vesicles.size()) refuse("what it has learned is of other vesicles");
  for (std::size_t k = 0; k < d.learned.size(); ++k)
    if (const auto& known = d.learned[k]) {
      const Eigen::Index size = unknowns(d.vesicles[k].position.order), columns = known->images.cols();
      if (known->directions.rows() != size || known->images.rows() != size || known->directions.cols() != columns ||
          columns > directions_kept(d.vesicles.size()))
        refuse("what it has learned does not fit its vesicles");
    }
}

/// All vesicles have taken the same steps.
void check_histories(const Dynamics& d) {
  for (const VesicleDynamics& v : d.vesicles) {
    const auto& levels = v.history.levels;
    const auto& first = d.vesicles.front().history.levels;
    if (!std::equal(levels.begin(), levels.end(), first.begin(), first.end(),
                    [](const PastLevel& a, const PastLevel& b) { return a.dt == b.dt; }))
      refuse("its vesicles have different pasts");
  }
}

}  // namespace

void carry(Plans& plans, const Relabelling& r, VesicleDynamics& v) {
  const Coefficients before = v.position;
  visit(v, [&]<class Member>(Part part, Member& member) {
    if constexpr (std::is_same_v<Member, Coefficients>) {
      member = pulled_back(plans, r, member);
    } else if constexpr (std::is_same_v<Member, History>) {
      carry(plans, r, member);
    } else if constexpr (std::is_same_v<Member, Matrix>) {
      if (part == Part::points) member = carried_points(r, before, v.position, member);
    }
  });
}

namespace {

void transfer(Parcel& parcel, Eigen::MatrixXf& m) {
  Matrix numbers = m.cast<double>();
  parcel(numbers);
  m = numbers.cast<float>();
}

void transfer(Parcel& parcel, std::shared_ptr<const Learned>& learned) {
  bool known = bool(learned);
  parcel(known);
  if (!known) return;
  Learned copy = learned ? *learned : Learned{};
  transfer(parcel, copy.directions), transfer(parcel, copy.images);
  if (!learned) learned = std::make_shared<const Learned>(std::move(copy));
}

}  // namespace

Lessons delivered(const Lessons& learned, std::span<const int> keepers, const Division& division) {
  if (division.whole() || learned.empty()) return learned;
  const Ranks& ranks = *division.ranks;
  Lessons mine(learned.size());
  std::vector<Parcel> letters(std::size_t(ranks.count));
  for (std::size_t k = 0; k < learned.size(); ++k) {
    auto one = learned[k];
    if (division.mine(int(k)))
      mine[k] = std::move(one);
    else if (!keepers.empty() && keepers[k] == ranks.rank)
      transfer(letters[std::size_t(division.owner[k])], one);
  }
  if (keepers.empty()) return mine;
  std::vector<std::vector<double>> given;
  for (const Parcel& letter : letters) given.emplace_back(letter.numbers().begin(), letter.numbers().end());
  const auto got = ranks.exchanged(given);
  std::vector<Parcel> theirs;
  for (const auto& one : got) theirs.emplace_back(one);
  for (std::size_t k = 0; k < learned.size(); ++k)
    if (division.mine(int(k)) && keepers[k] != ranks.rank) transfer(theirs[std::size_t(keepers[k])], mine[k]);
  return mine;
}

std::vector<double> serialised(const Dynamics& d) {
  Writer writer;
  Counter counter;
  counter(resume_version);
  transfer(counter, d);
  writer.numbers.reserve(counter.numbers);
  writer(resume_version);
  transfer(writer, d);
  return std::move(writer.numbers);
}

void transfer(Parcel& parcel, VesicleDynamics& vesicle) {
  visit(vesicle, [&]<class Member>(Part, Member& member) {
    if constexpr (std::is_same_v<Member, Frame>) {
      transfer_frame(parcel, member);
    } else if constexpr (std::is_same_v<Member, History>) {
      std::size_t levels = member.levels.size();
      parcel(levels);
      member.levels.resize(levels);
      for (PastLevel& level : member.levels) visit_level(level, [&](const char*, auto& part) { parcel(part); });
    } else {
      parcel(member);
    }
  });
}

TrajectoryLayout layout_of(const Dynamics& d) {
  TrajectoryLayout layout;
  layout.vesicles = int(d.vesicles.size());
  layout.order = layout.label_order = 0;
  for (const VesicleDynamics& v : d.vesicles) {
    layout.order = std::max(layout.order, v.position.order);
    layout.label_order = std::max(layout.label_order, v.labels.order);
    layout.tracers = int(v.tracers.rows());
  }
  return layout;
}

void from_first(const Ranks& ranks, Dynamics& d) {
  if (ranks.count == 1) return;
  std::size_t count = d.vesicles.size(), lessons = d.learned.size();
  from_first(ranks, d, [&](Parcel& parcel, Dynamics& all) {
    transfer_run(parcel, all);
    parcel(count), parcel(lessons);
  });
  d.vesicles.resize(count);
  d.learned.resize(lessons);  // they stay with the first rank until a solve asks for them
  const Division of_first{&ranks, std::vector<int>(count, 0)};
  d.keepers = of_first.owner;
  divided_for(
      of_first, int(count), [](int) {}, [&](Parcel& parcel, int k) { transfer(parcel, d.vesicles[std::size_t(k)]); });
}

std::size_t resume_numbers(const Dynamics& d, int past_levels) {
  Counter counter, lessons;
  counter(resume_version);
  transfer(counter, d);
  lessons(d.learned);
  counter.numbers -= lessons.numbers - 1;  // instead of these as many as there may be
  for (const VesicleDynamics& v : d.vesicles) {
    const PastLevel level{v.position, v.motion, v.sliding, 1};
    for (int missing = past_levels - static_cast<int>(v.history.levels.size()); missing > 0; --missing)
      visit_level(level, [&](const char*, const auto& part) { counter(part); });
  }
  for (std::size_t k = 0; k < d.vesicles.size(); ++k)  // two to a number, of directions and images
    counter.numbers += numbers_learned(std::size_t(unknowns(d.vesicles[k].position.order)),
                                       std::size_t(directions_kept(d.vesicles.size())));
  return counter.numbers;
}

Dynamics deserialised(std::span<const double> numbers, const TrajectoryLayout& layout) {
  Reader reader{numbers, layout};
  if (reader.next() != resume_version) refuse("it is of another version");
  Dynamics d;
  transfer(reader, d);
  if (reader.at != numbers.size()) refuse("there is more in it");
  for (const VesicleDynamics& v : d.vesicles) check(v, layout);
  check_histories(d);
  check_lessons(d);
  if (d.control.order < 1 || d.control.order > highest_order) refuse("an order of time stepping in it is impossible");
  if (d.saves < 1 || d.time < 0 || !(d.dt_limit > 0)) refuse("a time in it is impossible");
  return d;
}

}  // namespace sim
