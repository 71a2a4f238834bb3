// The resolved scene: every parameter with the value it has, as a scene file that gives the same scene again.
#pragma once

#include "settings.h"

namespace app {

std::string write_scene(const Settings&);
/// Only the tables of the physics.
std::string write_scene(const sim::Scene&);

/// 16 hexadecimal digits of what the simulation, or a picture, depends on; the number of threads is not of that.
std::string physics_hash(const sim::Scene&);
std::string picture_hash(const Settings&);

/// One key whose value is not the same in two scenes; "none" stands for a value that is not there.
struct SceneDifference {
  std::string key, first, second;
};
/// Those of the physics; empty when physics_hash() is the same.
std::vector<SceneDifference> physics_differences(const sim::Scene& first, const sim::Scene& second);
/// May a simulation of the one go on as the other: do they differ in time.end and time.save_every only?
bool continuable(const std::vector<SceneDifference>&);
/// "time.step is 0.1 there and 0.2 here; ...", some of them.
std::string text_of(const std::vector<SceneDifference>&);
/// Names for a legend, one a scene: its title. Scenes of one title are told apart by the keys of their physics that differ,
/// "viscosity_contrast = 3", and where that does not do, or takes more than three keys, by their files. A title that all share
/// is left out.
std::vector<std::string> distinct_names(const std::vector<sim::Scene>&, const std::vector<std::string>& files);

/// A value in TOML, shortest digits that give the same number.
std::string toml_value(bool), toml_value(int), toml_value(double), toml_value(const std::string&);
std::string toml_value(const sim::Vec3&), toml_value(const std::array<double, 3>&);
template <class T> std::string toml_value(const std::vector<T>& list) {
  std::string text;
  for (const T& item : list) text += (text.empty() ? "" : ", ") + toml_value(item);
  return "[" + text + "]";
}

}  // namespace app
