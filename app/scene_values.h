// One value of a scene file, checked against its parameter.
#pragma once

#include "settings.h"

#include <toml++/toml.h>

namespace app {

/// toml::parse for text that may be anything. What the parser cannot bear is refused first, as std::runtime_error: keys of
/// more than 200 parts, one recursion each, and letters beyond ASCII outside of texts and comments. Other errors are
/// toml::parse_error.
toml::table parse_toml(std::string_view text, const std::string& name);

/// A value that is not what its parameter allows, e.g. "'order' must be at least 2, at most 64, not 1"; else empty.
std::string range_error(const sim::Parameter&, double value);
/// The allowed range in words, e.g. "above 0, at most 1"; empty: any number.
std::string range_text(const sim::Parameter&);

/// Throws std::runtime_error("FILE:LINE:COLUMN: sentence"), or "--set KEY=VALUE: sentence" for an override.
[[noreturn]] void fail_at(const toml::source_region&, std::string_view sentence);

/// Reads `node` as the type of `value` or fails at its position.
void read_value(const sim::Parameter&, const toml::node&, bool& value);
void read_value(const sim::Parameter&, const toml::node&, int& value);
void read_value(const sim::Parameter&, const toml::node&, double& value);
void read_value(const sim::Parameter&, const toml::node&, std::string& value);
void read_value(const sim::Parameter&, const toml::node&, sim::Vec3& value);
void read_value(const sim::Parameter&, const toml::node&, std::array<double, 3>& value);

template <class T>
void read_value(const sim::Parameter& parameter, const toml::node& node, std::optional<T>& value) {
  if (!parameter.refused.empty())
    fail_at(node.source(), "'" + std::string(parameter.name) + "' is reserved: " + std::string(parameter.refused));
  T read{};
  read_value(parameter, node, read);
  value = read;
}

template <class T>
void read_value(const sim::Parameter& parameter, const toml::node& node, std::vector<T>& value) {
  const toml::array* list = node.as_array();
  if (!list) fail_at(node.source(), "'" + std::string(parameter.name) + "' must be a list, [..., ...]");
  value.clear();
  for (const toml::node& item : *list) {
    T read{};
    read_value(parameter, item, read);
    value.push_back(read);
  }
}

/// FNV-1a of bytes, 16 hexadecimal digits: tells that a file has changed, not who changed it.
std::string checksum(std::string_view bytes);

}  // namespace app
