// The report on one reproduced item of the paper: setting, tables with our numbers beside the paper's, findings, and
// for a figure its drawing; printing and writing.
#pragma once

#include "app/tables/text_table.h"

#include "render/figures/figure.h"
#include "render/image/image.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace app {

struct Report {
  std::string title;
  std::vector<std::string> setting;  ///< shapes and parameters needed to repeat it
  std::vector<TextTable> tables;
  std::vector<std::string> findings;
  std::optional<render::Figure> figure;
  std::string picture_text;  ///< caption of the figure
};

/// For the terminal: setting, tables, findings.
std::string plain_text(const Report&);
/// ITEM.md; `command` reproduces it.
std::string markdown_text(const Report&, const std::string& item, const std::string& command);
/// Writes ITEM.md, the figure's files, and ITEM.csv, ITEM-2.csv... of the tables that the figure's CSV does not
/// replace.
std::vector<std::filesystem::path> write_report(const Report&, const std::filesystem::path& folder,
                                                const std::string& item, const std::string& command,
                                                const sim::FileWriter& write);

}  // namespace app
