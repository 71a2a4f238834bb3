// docs/reference.md and related lists: every parameter, kind and column, generated from its declaration.
#pragma once

#include <string>
#include <vector>

namespace app {

/// `tanktread list parameters --markdown`, the whole page.
std::string reference_page();
/// `tanktread list parameters`: the same for a terminal, parameters only.
std::string parameter_list();

/// A parameter of a scene file, in words.
struct ReferenceKey {
  std::string section, section_meaning, name, meaning, unit, fallback, allowed;
  bool list = false;  ///< the section is written [[section]]
};
/// All of them, in the order of the reference.
std::vector<ReferenceKey> reference_keys();

}  // namespace app
