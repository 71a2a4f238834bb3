#include "app/base/markup.h"

#include "app/base/printable.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace {

/// Names of files may be any bytes: what is no text becomes a question mark, the rest is escaped by `special`, which
/// answers nothing for characters that stay as they are.
template <class F>
std::string escaped(std::string_view text, F&& special) {
  std::string result;
  while (!text.empty()) {
    const Character c = first_character(text);
    const std::string replaced = c.length == 0 ? std::string("?") : special(c.code);
    result += replaced.empty() ? std::string(text.substr(0, c.length)) : replaced;
    text.remove_prefix(std::max<std::size_t>(c.length, 1));
  }
  return result;
}

}  // namespace

std::string json_text(std::string_view text) {
  return '"' +
         escaped(text,
                 [](char32_t c) -> std::string {
                   if (c == '"' || c == '\\') return std::string("\\") + static_cast<char>(c);
                   return is_control(c) ? fmt::format("\\u{:04x}", static_cast<std::uint32_t>(c)) : std::string();
                 }) +
         '"';
}

std::string markup_text(std::string_view text) {
  return escaped(text, [](char32_t c) -> std::string {
    switch (c) {
      case '&':
        return "&amp;";
      case '<':
        return "&lt;";
      case '>':
        return "&gt;";
      case '"':
        return "&quot;";
      case '\'':
        return "&#39;";
      default:
        return is_control(c) ? "?" : std::string();
    }
  });
}

std::string filled(std::string_view page, const std::vector<std::pair<std::string_view, std::string>>& texts) {
  std::string result;
  while (!page.empty()) {
    const std::size_t at = std::min(page.find("{{"), page.size());
    result += page.substr(0, at);
    page.remove_prefix(at);
    const auto text = std::find_if(texts.begin(), texts.end(), [&](const auto& entry) {
      return page.starts_with(fmt::format("{{{{{}}}}}", entry.first));
    });
    const bool known = text != texts.end();
    result += known ? text->second : std::string(page.substr(0, 1));
    page.remove_prefix(std::min(page.size(), known ? text->first.size() + 4 : 1));
  }
  return result;
}

}  // namespace app
