#include "app/reproduce/reproduce_report.h"

#include "app/base/version.h"

#include "render/figures/figure.h"

#include <fmt/format.h>

namespace app {

namespace fs = std::filesystem;

std::string plain_text(const Report& report) {
  std::string text = report.title + "\n";
  for (const std::string& line : report.setting) text += fmt::format("  {}\n", line);
  for (const TextTable& table : report.tables) text += fmt::format("\n{}", plain_text(table));
  if (!report.findings.empty()) text += "\n";
  for (const std::string& line : report.findings) text += line + "\n";
  return text;
}

std::string markdown_text(const Report& report, const std::string& item, const std::string& command) {
  std::string text = fmt::format("### {}\n\n`{}` (tanktread {})\n\n", report.title, command, version());
  for (const std::string& line : report.setting) text += fmt::format("- {}\n", line);
  for (const TextTable& table : report.tables) text += fmt::format("\n{}", markdown_text(table));
  if (report.figure) text += fmt::format("\n![{0}]({1}.png)\n\n{2}\n", report.title, item, report.picture_text);
  if (!report.findings.empty()) text += "\n";
  for (const std::string& line : report.findings) text += line + "\n";
  return text;
}

std::vector<fs::path> write_report(const Report& report, const fs::path& folder, const std::string& item,
                                   const std::string& command, const sim::FileWriter& write) {
  std::vector<fs::path> files;
  if (report.figure) {
    std::string tables;  // a page that shows the picture beside other numbers is found out
    for (const TextTable& table : report.tables) tables += markdown_text(table);
    files = render::write_figure(
        *report.figure, folder / item,
        {{"Title", report.title}, {"Software", "tanktread " + version()}, {"tanktread:tables", tables}}, write);
  }
  for (std::size_t k = 0; k < report.tables.size(); ++k) {
    const bool first = k == 0 && !report.figure;
    const fs::path path = folder / (first ? fmt::format("{}.csv", item) : fmt::format("{}-{}.csv", item, k + 1));
    write(path, csv_text(report.tables[k]));
    files.push_back(path);
  }
  files.push_back(folder / (item + ".md"));
  write(files.back(), markdown_text(report, item, command));
  return files;
}

}  // namespace app
