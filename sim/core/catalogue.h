// Catalogues: tables with one row per kind. The command line, the scene reader, error messages, the reference page
// and the tests walk the table, so a new kind takes only a new row.
#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// A row of a catalogue; a table is a function that returns a const std::vector<CatalogueRow<...>>&.
template <class Function>
struct CatalogueRow {
  std::string_view name;
  std::string_view meaning;            ///< one line, no full stop
  std::vector<std::string_view> keys;  ///< scene keys of this kind, besides those common to all kinds
  Function function{};
};

/// The row of that name, or nullptr.
template <class Row>
const Row* find_row(const std::vector<Row>& table, std::string_view name) {
  const auto row = std::find_if(table.begin(), table.end(), [&](const Row& r) { return r.name == name; });
  return row == table.end() ? nullptr : &*row;
}

template <class Row>
std::vector<std::string_view> row_names(const std::vector<Row>& table) {
  std::vector<std::string_view> names;
  for (const Row& row : table) names.push_back(row.name);
  return names;
}

/// Number of insertions, deletions, replacements and swaps of adjacent letters that turn a into b.
inline int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, now);
  }
  return last[b.size()];
}

/// The known word nearest to a misspelt one; empty when none is a plausible correction (over half the letters wrong).
inline std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known) {
  std::string_view best;
  int least = static_cast<int>(word.size()) / 2 + 1;
  for (const std::string_view candidate : known) {
    const int distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

/// " (did you mean 'prolate'?)" or, when no word is near, " (known: a, b, c)".
inline std::string suggestion(std::string_view word, std::span<const std::string_view> known) {
  if (const std::string_view best = nearest_word(word, known); !best.empty())
    return " (did you mean '" + std::string(best) + "'?)";
  std::string text;
  for (const std::string_view name : known) text += (text.empty() ? " (known: " : ", ") + std::string(name);
  return text.empty() ? text : text + ")";
}

}  // namespace sim
