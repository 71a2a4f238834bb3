// The resolved scene: every parameter with its value, as a scene file that gives the same scene when read.
#pragma once

#include "app/scene/settings.h"

namespace app {

std::string write_scene(const Settings&);
/// Only the physics tables.
std::string write_scene(const sim::Scene&);

/// Hash, 16 hexadecimal digits, of everything that the simulation or a picture depends on; not the number of threads.
std::string physics_hash(const sim::Scene&);
std::string picture_hash(const Settings&);

/// One key whose value differs between two scenes; "none" stands for a missing value.
struct SceneDifference {
  std::string key, first, second;
};
/// Differences of the physics; empty when physics_hash() is the same.
std::vector<SceneDifference> physics_differences(const sim::Scene& first, const sim::Scene& second);
/// Whether a simulation of one can be continued as the other: they differ only in time.end and time.save_every.
bool continuable(const std::vector<SceneDifference>&);
/// "time.step is 0.1 there and 0.2 here; ...", some of them.
std::string text_of(const std::vector<SceneDifference>&);
/// "λ" for vesicle.viscosity_contrast; empty where there is none.
std::string symbol_of(const std::string& key);
/// Names for a legend, one per scene: its title. Scenes with the same title are distinguished by the physics keys
/// that differ, "λ = 3" or "order = 8", without those of times and numerics where the others are enough; where that
/// fails or needs more than three keys, by their files. A title shared by all is omitted.
std::vector<std::string> distinct_names(const std::vector<sim::Scene>&, const std::vector<std::string>& files);

/// A value in TOML, with the shortest digits that give the same number.
std::string toml_value(bool), toml_value(int), toml_value(double), toml_value(const std::string&);
std::string toml_value(const sim::Vec3&), toml_value(const std::array<double, 3>&);
std::string toml_value(const render::FieldRange&);
template <class T>
std::string toml_value(const std::vector<T>& list) {
  std::string text;
  for (const T& item : list) text += (text.empty() ? "" : ", ") + toml_value(item);
  return "[" + text + "]";
}

}  // namespace app
