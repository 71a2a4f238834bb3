// All catalogues of the program: what `tanktread list` prints, and the words that the scene reader accepts.
#pragma once

#include "sim/core/catalogue.h"

namespace app {

struct Catalogue {
  std::string_view name;                     ///< as in `tanktread list NAME` and Parameter::catalogue
  std::string_view meaning;                  ///< one line, no full stop
  std::vector<sim::CatalogueRow<int>> rows;  ///< name, meaning and keys of each kind, without its function
};

const std::vector<Catalogue>& catalogues();

}  // namespace app
