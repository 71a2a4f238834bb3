// Loops over independent items that ranks, and the threads of each, divide.
#pragma once

#include "sim/core/parallel.h"
#include "sim/core/ranks.h"

#include <algorithm>

namespace sim {

/// body(k) for the items of this rank; then `transfer(parcel, k)` carries what has become of item k from its rank to
/// the others. std::domain_error, by which a shape is refused, is thrown by all ranks where one throws it, that of the
/// smallest k; any other exception is one of this rank.
template <class Body, class Transfer>
void divided_for(const Division& division, int n, Body&& body, Transfer&& transfer) {
  if (division.whole()) return parallel_for(n, body);
  const Ranks& ranks = *division.ranks;
  std::vector<int> items;
  for (int k = 0; k < n; ++k)
    if (division.mine(k)) items.push_back(k);
  std::vector<std::optional<std::string>> objections(std::size_t(n), std::nullopt);
  const auto attempt = [&](int k) {
    try {
      body(k);
    } catch (const std::domain_error& error) {
      objections[std::size_t(k)] = error.what();
    }
  };
  if (items.size() == 1)
    attempt(items[0]);  // its own loops get the threads
  else
    parallel_for(int(items.size()), [&](int i) { attempt(items[std::size_t(i)]); });
  const auto carry = [&](Parcel& parcel, int k) {
    auto& objection = objections[std::size_t(k)];
    bool refused = objection.has_value();
    parcel(refused);
    if (!refused) return transfer(parcel, k);
    if (!objection) objection.emplace();
    parcel(*objection);
  };
  // Some items at a time, so that nobody has the messages of all at once.
  constexpr double numbers_at_once = 1 << 19;  // 4 MB
  int at_once = 64;
  for (int first = 0, end = 0; first < n; first = end) {
    end = first + std::min(n - first, at_once);
    Parcel mine;
    for (int k = first; k < end; ++k)
      if (division.mine(k)) carry(mine, k);
    const auto all = ranks.gathered(mine.numbers());
    std::vector<Parcel> theirs;
    double numbers = 1;
    for (const auto& one : all) {
      theirs.emplace_back(one);
      numbers += double(one.size());
    }
    for (int k = first; k < end; ++k)
      if (!division.mine(k)) carry(theirs[std::size_t(division.owner[std::size_t(k)])], k);
    at_once = int(std::clamp(numbers_at_once / numbers * (end - first), 1.0, double(n)));
  }
  for (const auto& objection : objections)
    if (objection) throw std::domain_error(*objection);
}
/// Where each rank keeps what has become of its own items.
template <class Body>
void divided_for(const Division& division, int n, Body&& body) {
  divided_for(division, n, body, [](Parcel&, int) {});
}

/// Each rank's numbers, of its own items, for all: one an item, or as many, side by side.
inline void share(const Division& division, std::vector<double>& by_item, std::size_t of_each = 1) {
  if (division.whole()) return;
  std::vector<double> mine;
  for (std::size_t k = 0; k < by_item.size(); ++k)
    if (division.mine(int(k / of_each))) mine.push_back(by_item[k]);
  const auto all = division.ranks->gathered(mine);
  std::vector<std::size_t> next(all.size());
  for (std::size_t k = 0; k < by_item.size(); ++k) {
    const auto owner = std::size_t(division.owner[k / of_each]);
    by_item[k] = all[owner].at(next[owner]++);
  }
}

}  // namespace sim
