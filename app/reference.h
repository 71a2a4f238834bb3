// docs/reference.md: every parameter, kind and column, generated from where each is declared.
#pragma once

#include <string>

namespace app {

/// `tanktread list parameters --markdown`, the whole page.
std::string reference_page();
/// `tanktread list parameters`: the same for a terminal, parameters only.
std::string parameter_list();

}  // namespace app
