// Messages to standard error.
#pragma once

#include <string_view>

namespace app {

/// One line, "tanktread: SENTENCE", printable whatever file names and texts it contains. A closed or full standard
/// error does not stop the program.
void tell(std::string_view sentence) noexcept;
/// Unchanged, for a line that will be overwritten.
void tell_raw(std::string_view text) noexcept;

}  // namespace app
