#include "app/scene/scene_overrides.h"

#include "app/scene/scene_values.h"

#include <fmt/format.h>

#include <charconv>

namespace app {

namespace {

/// ".5", "-.5" and "5." as TOML writes them, outside of quotes.
std::string with_all_digits(std::string_view value) {
  const auto digit = [&](std::size_t at) { return at < value.size() && value[at] >= '0' && value[at] <= '9'; };
  std::string text;
  char quote = 0;
  for (std::size_t at = 0; at < value.size(); ++at) {
    const char c = value[at];
    if (quote ? c == quote : c == '"' || c == '\'') quote = quote ? '\0' : c;
    const bool before = at > 0 && digit(at - 1), after = digit(at + 1);
    if (!quote && c == '.' && after && !before) text += '0';
    text += c;
    if (!quote && c == '.' && before && !after) text += '0';
  }
  return text;
}

/// The value, with the override as its source, so that a later complaint names it.
toml::table parse_value(const std::string& value, const std::string& source) {
  try {
    return parse_toml("value = " + value, source);
  } catch (const toml::parse_error& error) {
    if (const std::string digits = with_all_digits(value); digits != value) try {
        return parse_toml("value = " + digits, source);
      } catch (const toml::parse_error&) {
        // It is no number for other reasons.
      }
    // A colour, which would begin a comment.
    const bool is_colour = value.starts_with('#') && value.find_first_of(" \t", 1) == std::string::npos;
    if (value.find_first_of("\"'[]{}\n#=", is_colour ? 1 : 0) != std::string::npos)
      throw std::runtime_error(fmt::format("{}: {}", source, error.description()));
    return toml::parse("value = \"" + value + "\"", source);
  }
}

/// Moves keep a node's source, copies lose it.
void put(toml::table& table, const std::string& key, toml::node& value, const toml::source_region& where) {
  value.visit([&](auto& concrete) { table.insert_or_assign(toml::key(key, where), std::move(concrete)); });
}

}  // namespace

void apply_override(toml::table& scene, const std::string& text) {
  const std::string source = "--set " + text;
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw std::runtime_error(fmt::format("{}: write it as section.key=value, for example time.end=5", source));
  std::vector<std::string> path(1);
  for (const char c : text.substr(0, equals)) {
    if (c == '.')
      path.emplace_back();
    else if (c != ' ')
      path.back() += c;
  }
  const toml::source_region where{{}, {}, std::make_shared<const std::string>(source)};
  const std::string value = text.substr(equals + 1), key = path.back();
  const auto set_in = [&](toml::table& table) {
    toml::table parsed = parse_value(value, source);
    put(table, key, *parsed.get("value"), where);
  };
  if (path.size() == 1) return set_in(scene);
  if (path.size() > 3)
    throw std::runtime_error(fmt::format("{}: write it as section.key or section.number.key", source));

  const std::string& section = path[0];
  if (!scene.contains(section)) {
    toml::table empty = toml::parse("", source);
    scene.insert(toml::key(section, where), std::move(empty));
  }
  toml::node& node = *scene.get(section);
  if (path.size() == 2) {
    if (toml::table* table = node.as_table()) return set_in(*table);
    if (toml::array* list = node.as_array()) {
      for (toml::node& item : *list)
        if (toml::table* table = item.as_table()) set_in(*table);
      return;
    }
    throw std::runtime_error(fmt::format("{}: '{}' is not a table", source, section));
  }
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(path[1].data(), path[1].data() + path[1].size(), number);
  if (error != std::errc() || end != path[1].data() + path[1].size())
    throw std::runtime_error(fmt::format("{}: '{}' is not a number, counted from 0", source, path[1]));
  toml::array* list = node.as_array();
  const std::size_t count = list ? list->size() : 1;
  toml::table* table =
      list ? (number < count ? list->get(number)->as_table() : nullptr) : (number == 0 ? node.as_table() : nullptr);
  if (!table)
    throw std::runtime_error(
        fmt::format("{}: there is no {} {}; they are numbered from 0 to {}", source, section, number, count - 1));
  set_in(*table);
}

}  // namespace app
