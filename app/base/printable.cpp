#include "app/base/printable.h"

#include <algorithm>

namespace app {

namespace {

bool within(char32_t code, char32_t first, char32_t last) { return first <= code && code <= last; }

/// Unicode promises that these stand for no character; XML does not allow all of them.
bool is_noncharacter(char32_t code) { return (code & 0xfffe) == 0xfffe || within(code, 0xfdd0, 0xfdef); }

}  // namespace

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  const std::size_t length = lead < 0x80                ? 1
                             : within(lead, 0xc2, 0xdf) ? 2
                             : within(lead, 0xe0, 0xef) ? 3
                             : within(lead, 0xf0, 0xf4) ? 4
                                                        : 0;
  if (length == 0 || length > text.size()) return {};
  char32_t code = length == 1 ? lead : lead & (0xffU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3fU);
  }
  constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};  // what so many bytes are needed for
  if (code < least[length] || code > 0x10ffff || within(code, 0xd800, 0xdfff) || is_noncharacter(code)) return {};
  return {code, length};
}

bool is_control(char32_t code) {
  return code < 0x20 || within(code, 0x7f, 0x9f) || within(code, 0x2028, 0x2029) || within(code, 0x202a, 0x202e) ||
         within(code, 0x2066, 0x2069);
}

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const Character c = first_character(text);
    if (c.length == 0 || is_control(c.code))
      result += '?';
    else
      result += text.substr(0, c.length);
    text.remove_prefix(std::max<std::size_t>(c.length, 1));
  }
  return result;
}

}  // namespace app
