#include "app/tables/text_table.h"

#include "render/figures/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

/// Columns on a terminal, not bytes: continuation bytes of UTF-8 do not count.
std::size_t shown_width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width) {
  std::string result = text;
  return result.append(width - std::min(width, shown_width(text)), ' ');
}

std::string without_trailing_spaces(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

template <class Cell>
std::string joined(const std::vector<std::string>& cells, const std::string& separator, Cell&& cell) {
  std::string line;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (k > 0) line += separator;
    line += cell(cells[k], k);
  }
  return line;
}

std::vector<std::size_t> widths_of(const TextTable& table) {
  std::vector<std::size_t> widths;
  for (const std::string& column : table.columns) widths.push_back(shown_width(column));
  for (const auto& row : table.rows)
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], shown_width(row[k]));
  return widths;
}

}  // namespace

std::string scientific(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  if (value == 0) return "0";
  const std::string text = fmt::format("{:.{}e}", value, digits - 1);
  const std::size_t e = text.find('e');
  return fmt::format("{}e{}", text.substr(0, e), std::stoi(text.substr(e + 1)));
}

std::string plain_text(const TextTable& table) {
  const std::vector<std::size_t> widths = widths_of(table);
  const auto line = [&](const std::vector<std::string>& row) {
    const auto cell = [&](const std::string& c, std::size_t k) { return padded(c, widths[k]); };
    const std::string cells = joined(row, "  ", cell);
    return fmt::format("  {}\n", without_trailing_spaces(cells));
  };
  std::string text = table.caption.empty() ? "" : table.caption + "\n";
  text += line(table.columns);
  for (const auto& row : table.rows) text += line(row);
  return text;
}

std::string markdown_text(const TextTable& table) {
  const auto line = [](const std::vector<std::string>& row) {
    const auto cell = [](const std::string& c, std::size_t) { return replaced(c, "|", "\\|"); };
    return fmt::format("| {} |\n", joined(row, " | ", cell));
  };
  std::string text = table.caption.empty() ? "" : table.caption + "\n\n";
  text += line(table.columns);
  text += "|";
  for (std::size_t k = 0; k < table.columns.size(); ++k) text += "---|";
  text += "\n";
  for (const auto& row : table.rows) text += line(row);
  return text;
}

std::string csv_text(const TextTable& table) {
  const auto line = [](const std::vector<std::string>& row) {
    return fmt::format("{}\n", joined(row, ",", [](const std::string& c, std::size_t) { return render::csv_cell(c); }));
  };
  std::string text = line(table.columns);
  for (const auto& row : table.rows) text += line(row);
  return text;
}

}  // namespace app
