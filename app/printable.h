// Texts from elsewhere (names of files, titles, text chunks) on their way to a terminal, a comment or a report.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace app {

/// The character that starts a text, which is not empty.
struct Character {
  char32_t code = 0;       ///< 0 where the bytes are no character
  std::size_t length = 0;  ///< bytes; 0: no UTF-8, a surrogate, beyond U+10FFFF, written longer than need be, or a noncharacter
};
Character first_character(std::string_view text);

/// Does it act on a terminal, end a line or turn the direction of writing? C0, DEL, C1, U+2028, U+2029, and the embeddings,
/// overrides and isolates of writing direction.
bool is_control(char32_t);

/// The same text on one line, harmless wherever it is shown: a question mark for each control character and for each byte
/// that belongs to no character. The result is valid UTF-8.
std::string printable(std::string_view text);

}  // namespace app
