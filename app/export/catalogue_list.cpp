#include "app/export/catalogue_list.h"

#include "app/validate/validations.h"

namespace app {

const std::vector<Catalogue>& listed_catalogues() {
  static const std::vector<Catalogue> all = [] {
    std::vector<Catalogue> list = catalogues();
    Catalogue& added = list.emplace_back(Catalogue{"validations", "runs whose results are known, for validate", {}});
    for (const ValidationRow& row : validations()) added.rows.push_back({row.name, row.meaning, {}});
    return list;
  }();
  return all;
}

}  // namespace app
