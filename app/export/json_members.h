// JSON as text, for the data of a page.
#pragma once

#include "app/base/markup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <string_view>
#include <vector>

namespace app {

/// A JSON object under construction.
class Members {
 public:
  void raw(std::string_view name, std::string_view json) {
    text_ += fmt::format("{}{}:{}", text_.empty() ? "" : ",", json_text(name), json);
  }
  void text(std::string_view name, std::string_view value) { raw(name, json_text(value)); }
  void number(std::string_view name, double value) { raw(name, fmt::format("{:.9g}", value)); }
  void flag(std::string_view name, bool value) { raw(name, value ? "true" : "false"); }
  template <class V>  // of GLM or Eigen
  void vector(std::string_view name, const V& v) {
    raw(name, fmt::format("[{:.9g},{:.9g},{:.9g}]", v[0], v[1], v[2]));
  }
  std::string whole() const { return '{' + text_ + '}'; }

 private:
  std::string text_;
};

inline std::string list_of(const std::vector<std::string>& items) { return fmt::format("[{}]", fmt::join(items, ",")); }

inline std::string texts_of(const std::vector<std::string>& texts) {
  std::vector<std::string> items;
  for (const std::string& text : texts) items.push_back(json_text(text));
  return list_of(items);
}

}  // namespace app
