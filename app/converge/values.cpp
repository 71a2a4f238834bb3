#include "app/converge/values.h"

#include "app/base/interrupt.h"
#include "app/tables/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>

namespace app {

namespace {

std::vector<std::string_view> measure_names() {
  std::vector<std::string_view> names;
  visit(sim::VesicleMeasures{}, [&](const char* name, const char*, double) { names.emplace_back(name); });
  return names;
}
bool is_measure(std::string_view name) {
  const std::vector<std::string_view> names = measure_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

[[noreturn]] void refuse(std::string_view word, const std::string& why) {
  throw std::runtime_error(fmt::format("--quantities {}: {}", word, why));
}

AskedResult read_result(std::string_view word, const sim::Scene& scene) {
  AskedResult asked;
  std::string_view rest = word;
  constexpr std::string_view prefix = "vesicle.";
  if (rest.starts_with(prefix)) {
    rest.remove_prefix(prefix.size());
    const std::string_view digits = rest.substr(0, rest.find('.'));
    int number = -1;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    const bool read = error == std::errc() && end == digits.data() + digits.size() && digits.size() < rest.size();
    if (!read) refuse(word, "write it as vesicle.0.NAME");
    if (number < 0 || number >= static_cast<int>(scene.vesicles.size()))
      refuse(word,
             fmt::format("there is no vesicle {}; they are numbered from 0 to {}", digits, scene.vesicles.size() - 1));
    asked.vesicle = number;
    rest.remove_prefix(digits.size() + 1);
  }
  const std::size_t colon = rest.find(':');
  asked.name = rest.substr(0, colon);
  const std::vector<std::string_view> names = result_names();
  if (std::find(names.begin(), names.end(), asked.name) == names.end() && !is_measure(asked.name)) {
    std::vector<std::string_view> all = names, columns = measure_names();
    all.insert(all.end(), columns.begin(), columns.end());
    refuse(word, fmt::format("there is no result '{}'{}", asked.name, sim::suggestion(asked.name, all)));
  }
  const bool whole = sim::find_row(results(), asked.name) != nullptr;
  if (colon != std::string_view::npos) {
    asked.reduction = rest.substr(colon + 1);
    if (whole) refuse(word, fmt::format("'{}' is a number already, which has no '{}'", asked.name, asked.reduction));
    if (!sim::find_row(reductions(), asked.reduction))
      refuse(word, fmt::format("'{}' is not a reduction{}", asked.reduction,
                               sim::suggestion(asked.reduction, sim::row_names(reductions()))));
  }
  if (const QuantityRow* row = sim::find_row(quantities(), asked.name); row && !row->per_vesicle && asked.vesicle)
    refuse(word, fmt::format("'{}' belongs to no vesicle", asked.name));
  return asked;
}

/// Histories of one run, as they are needed.
struct Histories {
  const FigureSource& source;
  const SharedScales& scales;
  std::map<std::string, std::vector<render::Series>, std::less<>> quantities = {};  ///< by name: vesicle, curve
  std::map<std::string, std::vector<History>, std::less<>> columns = {};            ///< by name: vesicle
};

void take_quantities(Histories& h, const std::vector<const QuantityRow*>& rows) {
  const std::vector<render::Series> all = series_of(h.source, h.scales, rows, false);
  std::size_t at = 0;
  for (const QuantityRow* row : rows) {
    const std::size_t vesicles = row->per_vesicle ? static_cast<std::size_t>(h.source.trajectory.layout().vesicles) : 1;
    const std::size_t count = vesicles * curve_names(*row).size();
    h.quantities[std::string(row->name)].assign(all.begin() + static_cast<std::ptrdiff_t>(at),
                                                all.begin() + static_cast<std::ptrdiff_t>(at + count));
    at += count;
  }
}

void take_columns(Histories& h, double time_factor) {
  sim::Plans plans;
  std::vector<sim::VesicleMeasures> initial;
  for (std::int64_t k = 0; k < h.source.trajectory.count(); ++k) {
    const sim::State state = h.source.trajectory.state(k);
    for (std::size_t v = 0; v < state.vesicles.size(); ++v) {
      if (k == 0) initial.push_back(sim::measure(plans, state.vesicles[v], 1, 1));
      visit(sim::measure(plans, state.vesicles[v], initial[v].area, initial[v].volume),
            [&](const char* name, const char*, double value) {
              std::vector<History>& of_all = h.columns[name];
              of_all.resize(state.vesicles.size());
              of_all[v].times.push_back(time_factor * state.time);
              of_all[v].values.push_back(value);
            });
    }
  }
}

/// What the label of an axis divides by, or has in brackets.
std::string unit_in(std::string_view label) {
  constexpr std::string_view over = " / ";
  if (const std::size_t at = label.rfind(over); at != std::string_view::npos)
    return std::string(label.substr(at + over.size()));
  const std::size_t open = label.rfind('(');
  return label.ends_with(')') && open != std::string_view::npos
             ? std::string(label.substr(open + 1, label.size() - open - 2))
             : std::string();
}

double reduced(const AskedResult& asked, const History& history) {
  return sim::find_row(reductions(), asked.reduction)->reduce(history);
}
History history_of(const render::Series& series) { return {series.times, series.values}; }

/// "vesicle.1.energy:largest".
std::string name_of(const AskedResult& asked, std::optional<int> vesicle) {
  return fmt::format("{}{}{}", vesicle ? fmt::format("vesicle.{}.", *vesicle) : std::string(), asked.name,
                     asked.reduction == "final" ? std::string() : ":" + asked.reduction);
}

struct Collector {
  const std::vector<FigureSource>& runs;
  const SharedScales& scales;
  std::vector<Histories>& histories;
  std::vector<ResultValues> all = {};

  int vesicles() const { return runs.front().trajectory.layout().vesicles; }
  template <class F>
  void for_vesicles(const AskedResult& asked, F&& f) const {
    for (int v = 0; v < vesicles(); ++v)
      if (!asked.vesicle || *asked.vesicle == v) f(v);
  }
  std::optional<int> shown(int v) const { return vesicles() > 1 ? std::optional(v) : std::nullopt; }

  void quantity(const AskedResult& asked, const QuantityRow& row) {
    const std::vector<const char*> curves = curve_names(row);
    const auto add = [&](std::optional<int> v) {
      for (std::size_t c = 0; c < curves.size(); ++c) {
        ResultValues values;
        values.name = name_of(asked, row.per_vesicle ? shown(v.value_or(0)) : std::nullopt);
        if (curves.size() > 1) values.name += fmt::format(" {}", curves[c]);
        for (const Histories& h : histories) {
          const render::Series& series =
              h.quantities.find(row.name)->second[static_cast<std::size_t>(v.value_or(0)) * curves.size() + c];
          values.label = series.axis;
          values.values.push_back(reduced(asked, history_of(series)));
        }
        values.unit = unit_in(values.label);
        if (asked.reduction != "final") values.label = fmt::format("{} {}", asked.reduction, values.label);
        values.usual = asked.usual;
        all.push_back(std::move(values));
      }
    };
    if (row.per_vesicle)
      for_vesicles(asked, [&](int v) { add(v); });
    else
      add(std::nullopt);
  }

  void column(const AskedResult& asked) {
    for_vesicles(asked, [&](int v) {
      ResultValues values{.name = name_of(asked, shown(v)), .label = asked.name, .unit = "", .values = {}};
      for (const Histories& h : histories)
        values.values.push_back(reduced(asked, h.columns.find(asked.name)->second[static_cast<std::size_t>(v)]));
      values.scaled = false;
      values.usual = asked.usual;
      all.push_back(std::move(values));
    });
  }

  void result(const AskedResult& asked, const OfQuantity& source) {
    for_vesicles(asked, [&](int v) {
      ResultValues values{.name = name_of(asked, shown(v)), .label = asked.name, .unit = "", .values = {}};
      for (const Histories& h : histories) {
        const render::Series& series = h.quantities.find(source.quantity)->second[static_cast<std::size_t>(v)];
        values.unit = source.is_time ? scales.time.symbol : unit_in(series.axis);
        values.values.push_back(source.reduce(history_of(series)));
      }
      values.label += fmt::format(" ({})", values.unit);
      values.usual = asked.usual;
      all.push_back(std::move(values));
    });
  }

  void result(const AskedResult& asked, const OfMembranes& source) {
    const auto last_of = [](const FigureSource& run) { return run.trajectory.state(run.trajectory.count() - 1); };
    const double length = length_of(runs.back().trajectory);
    const sim::State reference = last_of(runs.back());
    for_vesicles(asked, [&](int v) {
      const auto at = static_cast<std::size_t>(v);
      ResultValues values{.name = name_of(asked, shown(v)),
                          .label = fmt::format("{} / R_{{0}}", source.subject),
                          .unit = "R_{0}",
                          .values = {}};
      for (std::size_t k = 0; k + 1 < runs.size(); ++k)
        values.values.push_back(source.distance(last_of(runs[k]).vesicles[at], reference.vesicles[at], length));
      values.values.push_back(0);
      values.from_last_run = true;
      values.usual = asked.usual;
      all.push_back(std::move(values));
    });
  }
};

}  // namespace

std::vector<std::string_view> result_names() {
  std::vector<std::string_view> names = sim::row_names(results());
  for (const QuantityRow& row : quantities()) names.push_back(row.name);
  return names;
}

std::vector<AskedResult> read_results(std::string_view list, const sim::Scene& scene) {
  std::vector<AskedResult> all;
  for (std::string_view rest = list;;) {
    const std::size_t comma = rest.find(',');
    std::string_view word = rest.substr(0, comma);
    while (word.starts_with(' ')) word.remove_prefix(1);
    while (word.ends_with(' ')) word.remove_suffix(1);
    all.push_back(read_result(word, scene));
    if (comma == std::string_view::npos) return all;
    rest.remove_prefix(comma + 1);
  }
}

std::vector<AskedResult> usual_results(const sim::Scene& scene) {
  constexpr std::size_t most = 4;  // vesicles of which each is shown
  const std::optional<int> vesicle = scene.vesicles.size() > most ? std::optional(0) : std::nullopt;
  std::vector<AskedResult> all;
  for (const char* name : {"half-turn", "inclination", "deformation", "energy", "position", "shape-distance"})
    all.push_back({.name = name, .vesicle = vesicle, .usual = true});
  if (scene.vesicles.size() > 1) all.push_back({.name = "gap", .reduction = "least", .vesicle = {}, .usual = true});
  return all;
}

std::vector<ResultValues> values_of(const std::vector<FigureSource>& runs, const std::vector<AskedResult>& asked) {
  const SharedScales scales = shared_scales(runs);
  std::vector<const QuantityRow*> rows;
  const auto need = [&](std::string_view name) {
    const QuantityRow* row = sim::find_row(quantities(), name);
    if (row && std::find(rows.begin(), rows.end(), row) == rows.end()) rows.push_back(row);
    return row != nullptr;
  };
  bool columns = false;
  for (const AskedResult& one : asked) {
    const ResultRow* result = sim::find_row(results(), one.name);
    if (result) {
      if (const auto* of = std::get_if<OfQuantity>(&result->source)) need(of->quantity);
    } else if (!need(one.name)) {
      columns = true;
    }
  }
  std::vector<Histories> histories;
  for (const FigureSource& run : runs) {
    stop_if_interrupted();
    Histories& h = histories.emplace_back(Histories{run, scales});
    if (!rows.empty()) take_quantities(h, rows);
    if (columns) take_columns(h, scales.time.factor);
  }
  Collector collector{runs, scales, histories};
  for (const AskedResult& one : asked) {
    if (const ResultRow* result = sim::find_row(results(), one.name))
      std::visit([&](const auto& source) { collector.result(one, source); }, result->source);
    else if (const QuantityRow* row = sim::find_row(quantities(), one.name))
      collector.quantity(one, *row);
    else
      collector.column(one);
  }
  return std::move(collector.all);
}

double shape_distance_of(const FigureSource& run, const FigureSource& last) {
  const auto& source = std::get<OfMembranes>(sim::find_row(results(), "shape-distance")->source);
  const double length = length_of(last.trajectory);
  const sim::State a = run.trajectory.state(run.trajectory.count() - 1),
                   b = last.trajectory.state(last.trajectory.count() - 1);
  double most = 0;
  for (std::size_t v = 0; v < a.vesicles.size(); ++v)
    most = std::max(most, source.distance(a.vesicles[v], b.vesicles[v], length));
  return most;
}

std::string without_braces(std::string_view text) {
  std::string plain;
  for (const char c : text)
    if (c != '{' && c != '}') plain += c;
  return plain;
}

}  // namespace app
