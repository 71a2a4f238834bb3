// Untrusted text (file names, titles, text chunks) made safe for a terminal, a comment or a report.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace app {

/// The first character of a non-empty text.
struct Character {
  char32_t code = 0;       ///< 0 where the bytes are not a character
  std::size_t length = 0;  ///< bytes; 0: invalid UTF-8, a surrogate, beyond U+10FFFF, overlong, or a noncharacter
};
Character first_character(std::string_view text);

/// Whether it controls a terminal, ends a line or changes the direction of writing: C0, DEL, C1, U+2028, U+2029, and
/// the bidirectional embeddings, overrides and isolates.
bool is_control(char32_t);

/// The same text on one line, safe to display: a question mark for each control character and for each byte of
/// invalid UTF-8. The result is valid UTF-8.
std::string printable(std::string_view text);

}  // namespace app
