// One value of a scene file, checked against its parameter.
#pragma once

#include "app/scene/settings.h"

#include <toml++/toml.h>

namespace app {

/// toml::parse for untrusted text. Input that would crash the parser is refused first, as std::runtime_error: keys of
/// more than 200 parts, one recursion each, and non-ASCII letters outside strings and comments. Other errors are
/// toml::parse_error.
toml::table parse_toml(std::string_view text, const std::string& name);

/// Message for a value outside the range of its parameter, e.g. "'order' must be at least 2, at most 64, not 1"; else
/// empty.
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
void read_value(const sim::Parameter&, const toml::node&, render::FieldRange& value);

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
  if (!list)
    fail_at(node.source(),
            "'" + std::string(parameter.name) + "' must be a list, [..., ...]: " + std::string(parameter.meaning));
  value.clear();
  for (const toml::node& item : *list) {
    T read{};
    read_value(parameter, item, read);
    value.push_back(read);
  }
}

/// FNV-1a of bytes, 16 hexadecimal digits: detects that a file has changed, not tampering.
std::string checksum(std::string_view bytes);

}  // namespace app
