// Tables of texts: on a terminal, as Markdown and as CSV.
#pragma once

#include <string>
#include <vector>

namespace app {

struct TextTable {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};
std::string plain_text(const TextTable&);
std::string markdown_text(const TextTable&);
std::string csv_text(const TextTable&);

/// "8.1e-6": two significant digits, as in the paper; "0" for zero, "-" for not a number.
std::string scientific(double value, int digits = 2);

}  // namespace app
