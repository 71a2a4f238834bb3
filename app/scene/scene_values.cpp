#include "app/scene/scene_values.h"

#include "app/scene/catalogues.h"
#include "sim/core/checksum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

/// Where the text in quotes that begins at `at` ends: behind its last quote, or where it is broken off.
std::size_t end_of_quotes(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string three(3, quote);
  const bool long_text = text.substr(at, 3) == three;
  for (at += long_text ? 3 : 1; at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"')
      ++at;
    else if (!long_text && text[at] == '\n')
      return at;
    else if (!long_text && text[at] == quote)
      return at + 1;
    else if (long_text && text.substr(at, 3) == three) {
      at += 3;
      for (int more = 0; more < 2 && at < text.size() && text[at] == quote; ++more) ++at;  // they belong to the text
      return at;
    }
  }
  return text.size();
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& name) {
  constexpr int most_parts = 200;
  int dots = 0;
  const auto refuse = [&](std::size_t at, std::string_view sentence) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw std::runtime_error(fmt::format("{}:{}: {}", name, line, sentence));
  };
  for (std::size_t at = text.starts_with("\xef\xbb\xbf") ? 3 : 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = end_of_quotes(text, at);
      continue;
    }
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (static_cast<unsigned char>(c) >= 0x80) refuse(at, "a letter beyond ASCII outside of a text in quotes");
    if (c == '.' && ++dots == most_parts) refuse(at, fmt::format("a key of more than {} parts", most_parts));
    if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) dots = 0;
    ++at;
  }
  return toml::parse(text, name);
}

void fail_at(const toml::source_region& where, std::string_view sentence) {
  const std::string name = where.path ? *where.path : std::string("scene");
  if (name.starts_with("--set") || !where.begin) throw std::runtime_error(fmt::format("{}: {}", name, sentence));
  throw std::runtime_error(fmt::format("{}:{}:{}: {}", name, where.begin.line, where.begin.column, sentence));
}

std::string range_text(const sim::Parameter& p) {
  std::string text;
  if (p.minimum > -sim::unlimited) text = fmt::format("{} {}", p.exclusive_minimum ? "above" : "at least", p.minimum);
  if (p.maximum < sim::unlimited)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", p.exclusive_maximum ? "below" : "at most", p.maximum);
  return text;
}

namespace {

std::string instead_of(const sim::Parameter& p) { return p.instead.empty() ? "" : fmt::format("; {}", p.instead); }

}  // namespace

std::string range_error(const sim::Parameter& p, double value) {
  const bool low = p.exclusive_minimum ? !(value > p.minimum) : !(value >= p.minimum);
  const bool high = p.exclusive_maximum ? !(value < p.maximum) : !(value <= p.maximum);
  const bool unlimited = p.minimum == -sim::unlimited && p.maximum == sim::unlimited;
  if (std::isnan(value)) return fmt::format("'{}' must be a number, not nan", p.name);
  if (unlimited || !(low || high)) return {};
  return fmt::format("'{}' must be {}, not {}{}", p.name, range_text(p), value, instead_of(p));
}

namespace {

std::string as_written(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "the text \"" + node.as_string()->get() + "\"";
    case toml::node_type::integer:
      return "the number " + std::to_string(node.as_integer()->get());
    case toml::node_type::floating_point:
      return fmt::format("the number {}", node.as_floating_point()->get());
    case toml::node_type::boolean:
      return node.as_boolean()->get() ? "true" : "false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

[[noreturn]] void wrong_type(const sim::Parameter& p, const toml::node& node, std::string_view wanted) {
  fail_at(node.source(), fmt::format("'{}' must be {}, not {}{}", p.name, wanted, as_written(node), instead_of(p)));
}

void check_range(const sim::Parameter& p, const toml::node& node, double value) {
  if (const std::string error = range_error(p, value); !error.empty()) fail_at(node.source(), error);
}

}  // namespace

void read_value(const sim::Parameter& p, const toml::node& node, bool& value) {
  if (!node.is_boolean()) wrong_type(p, node, "true or false");
  value = node.as_boolean()->get();
}

void read_value(const sim::Parameter& p, const toml::node& node, int& value) {
  if (p.zero_is_auto && node.is_string() && node.as_string()->get() == "auto") {
    value = 0;
    return;
  }
  constexpr double largest = 9007199254740992;  // 2^53: whole numbers of type double have all their digits up to there
  std::int64_t number = 0;
  if (node.is_integer())
    number = node.as_integer()->get();
  else if (const double x = node.is_floating_point() ? node.as_floating_point()->get() : 0.5;
           std::floor(x) == x && std::abs(x) < largest)
    number = static_cast<std::int64_t>(x);  // 8.0
  else
    wrong_type(p, node, p.zero_is_auto ? "\"auto\" or a whole number" : "a whole number");
  if (!(p.zero_is_auto && number == 0)) check_range(p, node, static_cast<double>(number));
  if (number != static_cast<int>(number)) fail_at(node.source(), fmt::format("'{}' is too large: {}", p.name, number));
  value = static_cast<int>(number);
}

void read_value(const sim::Parameter& p, const toml::node& node, double& value) {
  if (node.is_integer())
    value = static_cast<double>(node.as_integer()->get());
  else if (node.is_floating_point())
    value = node.as_floating_point()->get();
  else
    wrong_type(p, node, "a number");
  check_range(p, node, value);
  if (std::isinf(value) && p.name != "until") fail_at(node.source(), fmt::format("'{}' must be finite", p.name));
}

void read_value(const sim::Parameter& p, const toml::node& node, std::string& value) {
  if (!node.is_string()) wrong_type(p, node, "a text in quotes");
  value = node.as_string()->get();
  std::vector<std::string_view> known(p.choices.begin(), p.choices.end());
  std::string list;
  for (const Catalogue& catalogue : catalogues())
    if (catalogue.name == p.catalogue) {
      known = sim::row_names(catalogue.rows);
      list = fmt::format("; 'tanktread list {}' shows all", catalogue.name);
    }
  if (known.empty() || std::find(known.begin(), known.end(), value) != known.end()) return;
  fail_at(node.source(), fmt::format("'{}' is no known {}{}{}", value, p.name, sim::suggestion(value, known), list));
}

void read_value(const sim::Parameter& p, const toml::node& node, std::array<double, 3>& value) {
  const toml::array* list = node.as_array();
  if (!list || list->size() != 3) wrong_type(p, node, "a list of three numbers, [.., .., ..]");
  for (std::size_t i = 0; i < 3; ++i) read_value(p, *list->get(i), value[i]);
}

void read_value(const sim::Parameter& p, const toml::node& node, sim::Vec3& value) {
  std::array<double, 3> three{};
  read_value(p, node, three);
  value = sim::Vec3(three[0], three[1], three[2]);
}

void read_value(const sim::Parameter& p, const toml::node& node, render::FieldRange& value) {
  value = {};
  if (node.is_string()) {
    std::string word;
    read_value(p, node, word);
    value.shared = true;
    return;
  }
  read_value(p, node, value.ends);
  if (value.given() && (value.ends.size() != 2 || !(value.ends[0] < value.ends[1])))
    fail_at(node.source(),
            fmt::format("'{}' must be two numbers, [lowest, highest], or [], or \"{}\"", p.name, p.choices[0]));
}

std::string checksum(std::string_view bytes) {
  sim::Checksum sum;
  sum.add(bytes);
  return sum.text();
}

}  // namespace app
