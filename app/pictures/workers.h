// Child processes that draw shards of the frames: software OpenGL draws only one picture at a time per process.
#pragma once

#include "app/base/options.h"

#include <cstdint>
#include <optional>

namespace app {

/// Starts `render` once for each of options.jobs shards and waits for all. Throws std::runtime_error when one fails,
/// after its own message on standard error. Returns how many frames they drew; empty after an interruption, which is
/// passed on. No process survives in any case, even when this one is killed.
std::optional<std::int64_t> draw_in_processes(const Options&, const std::filesystem::path& folder);

}  // namespace app
