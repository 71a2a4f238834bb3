// Several processes, the ranks of MPI, that make one computation together. What is light, each of them has and computes
// whole; what is dear is divided by items, and everybody gets the results, in the order of the items: the same bytes
// come out for any number of ranks, as for any number of threads. With one rank nothing is copied or asked.
//
// All ranks come to the same collective calls in the same order. What decides how it goes on is therefore computed by
// everybody from the same numbers, or gathered.
#pragma once

#include "sim/core/types.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace sim {

/// This process among its like. The functions are set where there are several; all ranks call `gathered` or
/// `exchanged` at once.
struct Ranks {
  int rank = 0, count = 1;
  int neighbours = 1;  ///< ranks on this machine, itself included
  /// What each rank gives, by rank. May be of different lengths.
  std::function<std::vector<std::vector<double>>(std::span<const double>)> gathered;
  /// What each rank gives this one, by rank, of what each gives each, by rank.
  std::function<std::vector<std::vector<double>>(std::span<const std::vector<double>>)> exchanged;
  std::function<void(int status)> end_all;  ///< ends all processes at once, this one too
  std::shared_ptr<void> session;            ///< kept while the ranks talk
  bool first() const { return rank == 0; }
};
/// A process by itself.
inline const Ranks alone{};

/// Numbers on their way between ranks: the same calls write them and read them.
class Parcel {
 public:
  Parcel() = default;                                             ///< to be written
  explicit Parcel(std::span<const double> from) : from_(from) {}  ///< to be read

  template <class T>
  requires std::is_arithmetic_v<T>
  void operator()(T& value) {  // integers here stay below 2^53
    if (!from_) return numbers_.push_back(double(value));
    value = static_cast<T>(next());
  }
  void operator()(Vec3& v) {
    for (int d = 0; d < 3; ++d) (*this)(v[d]);
  }
  void operator()(Matrix& m) { numbers_of(m, m.rows(), m.cols()); }
  void operator()(Vector& v) { numbers_of(v, v.rows(), 1); }
  void operator()(Coefficients& c) { (*this)(c.order), (*this)(c.values); }
  void operator()(std::string& text) {
    std::size_t size = text.size();
    (*this)(size);
    text.resize(size);
    for (char& letter : text) (*this)(letter);
  }
  template <class T>
  void operator()(std::vector<T>& items) {
    std::size_t size = items.size();
    (*this)(size);
    items.resize(size);
    for (T& item : items) (*this)(item);
  }
  std::span<const double> numbers() const { return numbers_; }

 private:
  double next() {
    if (at_ >= from_->size()) throw std::logic_error("ranks do not agree on what they exchange");
    return (*from_)[at_++];
  }
  template <class M>
  void numbers_of(M& m, Eigen::Index rows, Eigen::Index columns) {
    (*this)(rows), (*this)(columns);
    if (!from_) {
      numbers_.insert(numbers_.end(), m.data(), m.data() + m.size());
      return;
    }
    m.resize(rows, columns);
    for (Eigen::Index k = 0; k < m.size(); ++k) m.data()[k] = next();
  }

  std::optional<std::span<const double>> from_;
  std::size_t at_ = 0;
  std::vector<double> numbers_;
};

/// The first rank's value for all. `transfer(parcel, value)`.
template <class T, class Transfer>
void from_first(const Ranks& ranks, T& value, Transfer&& transfer) {
  if (ranks.count == 1) return;
  Parcel mine;
  if (ranks.first()) transfer(mine, value);
  const auto all = ranks.gathered(mine.numbers());
  if (ranks.first()) return;
  Parcel theirs(all[0]);
  transfer(theirs, value);
}

/// Whether some rank says so.
inline bool any(const Ranks& ranks, bool here) {
  if (ranks.count == 1) return here;
  const double number = here ? 1 : 0;
  for (const auto& one : ranks.gathered({&number, 1})) here = here || one.at(0) != 0;
  return here;
}

/// Which rank does which of many items.
struct Division {
  const Ranks* ranks = &alone;
  std::vector<int> owner;  ///< by item; empty: one rank does all
  bool mine(int item) const { return owner.empty() || owner[std::size_t(item)] == ranks->rank; }
  bool whole() const { return owner.empty(); }
};
/// By place: ranks get boxes that hold about the same weight, cut across their longest side again and again.
Division divided(const Ranks&, std::span<const Vec3> places, std::span<const double> weights);
/// In stretches of as many items each.
Division divided(const Ranks&, int items);

}  // namespace sim
