// Files of results: whole or absent, whatever happens while they are written.
#pragma once

#include <filesystem>
#include <string_view>

namespace render {

/// Writes to a new file beside `path`, waits until the disk has it, then renames: the name never shows an incomplete file, and
/// no file or link of somebody else is written through. Where `path` is a link, what it points to is replaced; a pipe or a
/// device is written to as it is. Throws std::runtime_error with path and reason; nothing is left then.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace render
