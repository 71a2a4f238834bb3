// Other processes of this program that draw shards of the frames: software OpenGL draws one picture at a time in a process.
#pragma once

#include "options.h"

#include <cstdint>
#include <optional>

namespace app {

/// Starts `render` once for each of options.jobs shards and waits for all. Throws std::runtime_error when one fails, with its
/// own sentence already on standard error. Returns how many frames they drew; nothing after an interruption, which is passed
/// on. No process is left in either case, nor when this one is killed.
std::optional<std::int64_t> draw_in_processes(const Options&, const std::filesystem::path& folder);

}  // namespace app
