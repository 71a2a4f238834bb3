#include "sim/trajectory/trajectory_rows.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cmath>
#include <stdexcept>

namespace sim::rows {

namespace {

/// The columns of a state, declared once. An archive gets each in turn and describes, packs or unpacks it.
template <class Archive>
void walk_state(Archive& archive) {
  archive.integer("step", "number of the step that ended here", &State::step);
  archive.real("time", "time of the state", &State::time);
  archive.order("order", "p of the vesicle's fields", &VesicleState::position);
  archive.order("label_order", "degree of the vesicle's labels", &VesicleState::labels);
  archive.integer("relabelled", "how often the parametrisation has changed since t = 0", &VesicleState::relabelled);
  archive.integer("labels_laid", "how often the labels have been laid anew", &VesicleState::labels_laid);
  archive.real("labels_laid_time", "when that last happened", &VesicleState::labels_laid_time);
  archive.points("tracers", "tracer dots: their parameters as unit vectors", &VesicleState::tracers);
  archive.field("tension", "coefficients of sigma", 1, false, &VesicleState::tension);
  archive.field("labels", "coefficients of the material label, 3 components", 3, true, &VesicleState::labels);
  archive.field("position", "coefficients of x, y, z", 3, false, &VesicleState::position);
  archive.field("velocity", "coefficients of the membrane velocity", 3, false, &VesicleState::velocity);
  archive.field("position_before", "the previous saved position in this parametrisation", 3, false,
                &VesicleState::position_before);
  archive.field("velocity_before", "the velocity of its points, sliding included", 3, false,
                &VesicleState::velocity_before);
  if (archive.layout.format > 1)
    archive.field("sliding", "coefficients of the velocity of the points along the membrane, relative to it", 3, false,
                  &VesicleState::sliding);
}

struct Describe {
  const TrajectoryLayout& layout;
  std::vector<Column> columns = {};

  std::uint64_t vesicles() const { return static_cast<std::uint64_t>(layout.vesicles); }
  template <class T>
  void integer(const char* name, const char* meaning, std::int64_t T::*) {
    columns.push_back({name, meaning, true, shape<T>()});
  }
  template <class T>
  void real(const char* name, const char* meaning, double T::*) {
    columns.push_back({name, meaning, false, shape<T>()});
  }
  void order(const char* name, const char* meaning, Coefficients VesicleState::*) {
    columns.push_back({name, meaning, true, {vesicles()}});
  }
  void points(const char* name, const char* meaning, Matrix VesicleState::*) {
    columns.push_back({name, meaning, false, {vesicles(), static_cast<std::uint64_t>(layout.tracers), 3}});
  }
  void field(const char* name, const char* meaning, std::uint64_t fields, bool label, Coefficients VesicleState::*) {
    const auto rows = static_cast<std::uint64_t>(coefficient_count(label ? layout.label_order : layout.order));
    columns.push_back({name, meaning, false, {vesicles(), fields, rows}});
  }
  template <class T>
  std::vector<std::uint64_t> shape() const {
    if constexpr (std::is_same_v<T, State>)
      return {};
    else
      return {vesicles()};
  }
};

struct Pack {
  const State& state;
  const TrajectoryLayout& layout;
  Words words = {};

  void put(std::int64_t value) { words.push_back(static_cast<std::uint64_t>(value)); }
  void put(double value) { words.push_back(std::bit_cast<std::uint64_t>(value)); }
  template <class T, class M>
  void each(M T::*member) {
    if constexpr (std::is_same_v<T, State>)
      put(state.*member);
    else
      for (const VesicleState& v : state.vesicles) put(v.*member);
  }
  template <class T>
  void integer(const char*, const char*, std::int64_t T::*member) {
    each(member);
  }
  template <class T>
  void real(const char*, const char*, double T::*member) {
    each(member);
  }
  void order(const char*, const char*, Coefficients VesicleState::*member) {
    for (const VesicleState& v : state.vesicles) put(static_cast<std::int64_t>((v.*member).order));
  }
  void points(const char* name, const char*, Matrix VesicleState::*member) {
    for (const VesicleState& v : state.vesicles) {
      const Matrix& m = v.*member;
      if (m.rows() != layout.tracers || m.cols() != 3)
        throw std::runtime_error(
            fmt::format("a state has {} x {} {}, the trajectory {} x 3", m.rows(), m.cols(), name, layout.tracers));
      for (Eigen::Index i = 0; i < m.rows(); ++i)
        for (Eigen::Index j = 0; j < 3; ++j) put(m(i, j));
    }
  }
  void field(const char* name, const char*, int fields, bool label, Coefficients VesicleState::*member) {
    const int capacity = label ? layout.label_order : layout.order;
    for (const VesicleState& v : state.vesicles) {
      const Coefficients& c = v.*member;
      const int order = label ? v.labels.order : v.position.order;
      if (c.order != order || order > capacity || c.values.cols() != fields ||
          c.values.rows() != coefficient_count(order))
        throw std::runtime_error(
            fmt::format("the {} of a state are of order {} with {} x {} numbers; the trajectory has "
                        "room for order {} with {} fields",
                        name, c.order, c.values.rows(), c.values.cols(), capacity, fields));
      for (Eigen::Index f = 0; f < fields; ++f) {
        for (Eigen::Index i = 0; i < c.values.rows(); ++i) put(c.values(i, f));
        words.resize(words.size() + static_cast<std::size_t>(coefficient_count(capacity) - c.values.rows()), 0);
      }
    }
  }
};

constexpr double largest_number = 1e150;  // the square of every number is one, too

struct Unpack {
  const Words& words;
  const TrajectoryLayout& layout;
  State state = {};
  std::size_t next = 0;

  void get(std::int64_t& value) { value = static_cast<std::int64_t>(words.at(next++)); }
  void get(double& value) { value = std::bit_cast<double>(words.at(next++)); }
  template <class T, class M>
  void each(M T::*member) {
    if constexpr (std::is_same_v<T, State>)
      get(state.*member);
    else
      for (VesicleState& v : state.vesicles) get(v.*member);
  }
  void require(bool fits, const char* name, const auto& value) const {
    if (!fits) throw Unfit(fmt::format("{} is {}", name, value));
  }
  void real(const char* name, double& value) {
    get(value);
    require(std::abs(value) <= largest_number, name, value);
  }
  /// Counts and times are never negative.
  template <class T>
  void integer(const char* name, const char*, std::int64_t T::*member) {
    each(member);
    const auto check = [&](const T& t) { require(t.*member >= 0, name, t.*member); };
    if constexpr (std::is_same_v<T, State>)
      check(state);
    else
      for (const VesicleState& v : state.vesicles) check(v);
  }
  template <class T>
  void real(const char* name, const char*, double T::*member) {
    each(member);
    const auto check = [&](const T& t) { require(t.*member >= 0 && t.*member <= largest_number, name, t.*member); };
    if constexpr (std::is_same_v<T, State>)
      check(state);
    else
      for (const VesicleState& v : state.vesicles) check(v);
  }
  void order(const char* name, const char*, Coefficients VesicleState::*member) {
    const int largest = member == &VesicleState::labels ? layout.label_order : layout.order;
    for (VesicleState& v : state.vesicles) {
      std::int64_t order = 0;
      get(order);
      require(order >= 0 && order <= largest, name, order);
      (v.*member).order = static_cast<int>(order);
    }
  }
  void points(const char* name, const char*, Matrix VesicleState::*member) {
    for (VesicleState& v : state.vesicles) {
      Matrix& m = v.*member;
      m.resize(layout.tracers, 3);
      for (Eigen::Index i = 0; i < m.rows(); ++i)
        for (Eigen::Index j = 0; j < 3; ++j) real(name, m(i, j));
    }
  }
  void field(const char* name, const char*, int fields, bool label, Coefficients VesicleState::*member) {
    const int capacity = label ? layout.label_order : layout.order;
    for (VesicleState& v : state.vesicles) {
      Coefficients& c = v.*member;
      c.order = label ? v.labels.order : v.position.order;
      c.values.resize(coefficient_count(c.order), fields);
      for (Eigen::Index f = 0; f < fields; ++f) {
        for (Eigen::Index i = 0; i < c.values.rows(); ++i) real(name, c.values(i, f));
        next += static_cast<std::size_t>(coefficient_count(capacity) - c.values.rows());
      }
    }
  }
};

}  // namespace

std::uint64_t width(const Column& column) {
  std::uint64_t numbers = 1;
  for (const std::uint64_t extent : column.shape) numbers *= extent;
  return numbers;
}

std::vector<Column> state_columns(const TrajectoryLayout& layout) {
  Describe archive{layout};
  walk_state(archive);
  return std::move(archive.columns);
}

Words pack(const State& state, const TrajectoryLayout& layout) {
  if (static_cast<int>(state.vesicles.size()) != layout.vesicles)
    throw std::runtime_error(
        fmt::format("a state has {} vesicles, the trajectory {}", state.vesicles.size(), layout.vesicles));
  Pack archive{state, layout};
  walk_state(archive);
  return std::move(archive.words);
}

State unpack_state(const Words& words, const TrajectoryLayout& layout) {
  Unpack archive{words, layout};
  archive.state.vesicles.resize(static_cast<std::size_t>(layout.vesicles));
  walk_state(archive);
  if (layout.format == 1)
    for (VesicleState& v : archive.state.vesicles)
      v.sliding = {v.position.order, Matrix::Zero(coefficient_count(v.position.order), 3)};
  return std::move(archive.state);
}

namespace {

/// Files of earlier formats know less of a step.
bool has_column(const TrajectoryLayout& layout, std::string_view name) {
  if (name == "order" || name == "error") return layout.format > 1;
  if (name == "degree" || name == "space_error") return layout.format > 2;
  return true;
}

}  // namespace

std::vector<Column> step_columns(const TrajectoryLayout& layout) {
  std::vector<Column> columns;
  const auto add = [&](const std::vector<std::uint64_t>& shape) {
    return [&columns, shape, &layout](const char* name, const char* meaning, const double&) {
      if (!has_column(layout, name)) return;
      columns.push_back({std::string("steps/") + name, meaning, false, shape});
    };
  };
  const StepRecord record;
  const VesicleStep vesicle;
  visit(record, add({}));
  visit(vesicle, add({static_cast<std::uint64_t>(layout.vesicles)}));
  return columns;
}

Words pack(const StepRecord& record, const TrajectoryLayout& layout) {
  if (static_cast<int>(record.vesicles.size()) != layout.vesicles)
    throw std::runtime_error(
        fmt::format("a step record has {} vesicles, the trajectory {}", record.vesicles.size(), layout.vesicles));
  Words words;
  visit(record, [&](const char*, const char*, double value) { words.push_back(std::bit_cast<std::uint64_t>(value)); });
  const std::size_t vesicles = record.vesicles.size();
  const std::size_t start = words.size();
  for (std::size_t v = 0; v < vesicles; ++v) {
    std::size_t column = 0;
    visit(record.vesicles[v], [&](const char*, const char*, double value) {
      const std::size_t place = start + column++ * vesicles + v;
      if (words.size() <= place) words.resize(place + 1);
      words[place] = std::bit_cast<std::uint64_t>(value);
    });
  }
  return words;
}

StepRecord unpack_step(const Words& words, const TrajectoryLayout& layout) {
  StepRecord record;
  record.vesicles.resize(static_cast<std::size_t>(layout.vesicles));
  std::size_t start = 0;
  visit(record, [&](const char* name, const char*, double& value) {
    if (has_column(layout, name)) value = std::bit_cast<double>(words.at(start++));
  });
  for (std::size_t v = 0; v < record.vesicles.size(); ++v) {
    std::size_t column = 0;
    visit(record.vesicles[v], [&](const char* name, const char*, double& value) {
      if (has_column(layout, name))
        value = std::bit_cast<double>(words.at(start + column++ * record.vesicles.size() + v));
    });
  }
  return record;
}

std::uint64_t checksum(std::uint64_t row, std::span<const std::byte> bytes) {
  uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(&row), sizeof row);
  crc = crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return (std::uint64_t{1} << 32) | static_cast<std::uint64_t>(crc & 0xffffffffu);
}

}  // namespace sim::rows
