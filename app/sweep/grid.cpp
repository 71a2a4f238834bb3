#include "app/sweep/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <stdexcept>

namespace app {

namespace {

constexpr std::size_t most_points = 10'000;

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

/// Parts between separators that are within neither brackets nor quotes.
std::vector<std::string> parts_of(std::string_view text, char separator) {
  std::vector<std::string> parts{""};
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    }
    if (c == separator && depth <= 0 && quote == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  for (std::string& part : parts) part = std::string(trimmed(part));
  return parts;
}

/// Twelve digits: 0.1 + 0.2 is 0.3.
std::string shown(double value) { return fmt::format("{:.12g}", value); }

/// Values of a range; nothing where the text is none. `told` begins complaints.
std::optional<std::vector<std::string>> range_of(const std::string& text, const std::string& told) {
  std::vector<std::string> ends = parts_of(text, ':');
  if (ends.size() < 2 || !number_of(ends[0])) return {};
  const bool by_factor = ends.size() == 3 && ends[2].starts_with('*');
  if (by_factor) ends[2].erase(0, 1);
  if (ends.size() != 3 || !number_of(ends[1]) || !number_of(ends[2]))
    throw std::runtime_error(fmt::format(
        "{}'{}' is no range; FIRST:LAST:STEP, such as 1:12:1, or FIRST:LAST:*FACTOR, such as 1:1000:*10", told, text));
  const double first = *number_of(ends[0]), last = *number_of(ends[1]), step = *number_of(ends[2]);
  if (by_factor && !(first * last > 0 && step > 0))
    throw std::runtime_error(
        fmt::format("{}'{}' passes zero, which no factor does; FIRST, LAST and FACTOR are above 0", told, text));
  const double steps = by_factor ? std::log(last / first) / std::log(step) : (last - first) / step;
  if (first != last && !(steps > 0 && std::isfinite(steps)))
    throw std::runtime_error(fmt::format("{}'{}' never gets from {} to {}", told, text, ends[0], ends[1]));
  constexpr double met = 1e-9;  // of a step: rounding
  const double count = first == last ? 1 : std::floor(steps + met) + 1;
  if (count > static_cast<double>(most_points))
    throw std::runtime_error(fmt::format("{}'{}' has {:.3g} values, more than {}", told, text, count, most_points));
  std::vector<std::string> values;
  for (int k = 0; k < static_cast<int>(count); ++k)
    values.push_back(shown(by_factor ? first * std::pow(step, k) : first + k * step));
  return values;
}

/// For names of folders: letters, digits, and what numbers need.
std::string plain(std::string_view value) {
  std::string text;
  for (const char c : value) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (letter || c == '.' || c == '-' || c == '+')
      text += c;
    else if (!text.empty() && text.back() != '_' && c != '"' && c != '\'')
      text += '_';
  }
  constexpr std::size_t longest = 40;
  if (text.size() > longest) text.resize(longest);
  while (text.ends_with('_') || text.ends_with('.')) text.pop_back();
  return text;
}

/// Eight digits that tell texts apart (FNV-1a).
std::string mark_of(std::string_view text) {
  std::uint32_t mark = 2166136261u;
  for (const char c : text) mark = (mark ^ static_cast<unsigned char>(c)) * 16777619u;
  return fmt::format("{:08x}", mark);
}

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

}  // namespace

SweepAxis read_axis(std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string key(trimmed(text.substr(0, equals)));
  if (equals == std::string_view::npos || key.empty())
    throw std::runtime_error(
        fmt::format("--vary {} is not KEY=VALUES, such as vesicle.viscosity_contrast=1:12:1 or vesicle.shape=prolate,"
                    "oblate",
                    text));
  SweepAxis axis{key, {}};
  const std::string told = fmt::format("--vary {}: ", text);
  for (const std::string& part : parts_of(text.substr(equals + 1), ',')) {
    if (part.empty()) throw std::runtime_error(told + "a value is missing");
    if (const auto range = range_of(part, told))
      axis.values.insert(axis.values.end(), range->begin(), range->end());
    else
      axis.values.push_back(part);
  }
  std::set<std::string> once;
  for (const std::string& value : axis.values)
    if (!once.insert(value).second) throw std::runtime_error(fmt::format("{}{} comes twice", told, value));
  return axis;
}

std::string short_name(const std::vector<SweepAxis>& axes, std::size_t axis) {
  const std::string last = last_part(axes[axis].key);
  const auto same =
      std::count_if(axes.begin(), axes.end(), [&](const SweepAxis& a) { return last_part(a.key) == last; });
  return same == 1 ? last : axes[axis].key;
}

std::vector<SweepPoint> points_of(const std::vector<SweepAxis>& axes) {
  std::size_t count = 1;
  std::set<std::string> keys;
  for (const SweepAxis& axis : axes) {
    if (!keys.insert(axis.key).second) throw std::runtime_error(fmt::format("--vary {} is there twice", axis.key));
    count *= axis.values.size();
    if (count > most_points) throw std::runtime_error(fmt::format("a sweep has at most {} runs", most_points));
  }
  std::vector<SweepPoint> points(count);
  std::set<std::string> names;
  for (std::size_t k = 0; k < count; ++k) {
    SweepPoint& point = points[k];
    std::size_t rest = k;
    point.values.resize(axes.size());
    for (std::size_t a = axes.size(); a-- > 0; rest /= axes[a].values.size())
      point.values[a] = axes[a].values[rest % axes[a].values.size()];
    for (std::size_t a = 0; a < axes.size(); ++a)
      point.name += fmt::format("{}{}-{}", a > 0 ? "_" : "", plain(short_name(axes, a)), plain(point.values[a]));
    constexpr std::size_t longest = 200;  // of names that file systems take
    std::string exact;
    for (const std::string& change : changes_at(axes, point)) exact += change + "\n";
    if (point.name.size() > longest) point.name = fmt::format("{}_{}", point.name.substr(0, longest), mark_of(exact));
    const auto plainly = [](const std::string& value) { return plain(value) == value; };
    if (!std::all_of(point.values.begin(), point.values.end(), plainly))
      point.name += fmt::format("_{}", mark_of(exact));
    if (!names.insert(point.name).second)
      throw std::runtime_error(fmt::format("two runs would have the folder '{}'", point.name));
  }
  return points;
}

std::vector<double> numbers_of(const SweepAxis& axis) {
  std::vector<double> numbers;
  for (const std::string& value : axis.values) {
    const std::optional<double> number = number_of(value);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

std::vector<std::string> changes_at(const std::vector<SweepAxis>& axes, const SweepPoint& point) {
  std::vector<std::string> changes;
  for (std::size_t a = 0; a < axes.size(); ++a) changes.push_back(axes[a].key + "=" + point.values[a]);
  return changes;
}

}  // namespace app
