// Sentences to standard error.
#pragma once

#include <string_view>

namespace app {

/// One line, "tanktread: SENTENCE", printable whatever names and texts of files are in it. A standard error that is closed or full is no reason to stop what is under way.
void tell(std::string_view sentence) noexcept;
/// As it is, for a line that is drawn over.
void tell_raw(std::string_view text) noexcept;

}  // namespace app
