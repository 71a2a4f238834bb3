// What a scene takes from the trajectory in whose state it starts: which state that is, the strain of its cell, and
// the vesicles where the scene has none. With that it says everything by itself.
#pragma once

#include "sim/core/parameters.h"
#include "sim/stepping/saved_start.h"

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace app {

/// A sentence about a key of a scene, whose place in its file the reader of scenes knows.
struct WrongKey : std::runtime_error {
  std::string table, key;
  WrongKey(std::string in_table, std::string of_key, const std::string& why)
      : std::runtime_error(why), table(std::move(in_table)), key(std::move(of_key)) {}
};

/// The scene that stands in a trajectory, from its text; the path is for messages.
using SceneThere = std::function<sim::Scene(std::string_view text, const std::filesystem::path&)>;

/// Of a scene with start.from, whose path is absolute. Returns the state, which the vesicles must still be compared
/// with. Where `continued` is the trajectory of a run that started so before, all is taken from its scene, nothing is
/// returned, and the file of the start need not exist any more. Throws WrongKey.
std::optional<sim::State> take_start(sim::Scene&, bool own_vesicles, const std::filesystem::path& continued,
                                     const SceneThere&);

}  // namespace app
