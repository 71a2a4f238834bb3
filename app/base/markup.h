// Texts of any content inside JSON, XML and HTML.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace app {

/// A JSON string with its quotes. What is no text becomes a question mark.
std::string json_text(std::string_view text);
/// For XML and HTML, also inside quotes. Likewise; control characters become question marks, too.
std::string markup_text(std::string_view text);

/// The page with each {{name}} replaced by its text, in one pass: a text may well look like a place. Names without a
/// text stay.
std::string filled(std::string_view page, const std::vector<std::pair<std::string_view, std::string>>& texts);

}  // namespace app
