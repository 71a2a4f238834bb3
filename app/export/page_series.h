// Numbers that change from frame to frame, packed small for a page: rounded to multiples of a quantum, as differences
// in time, as bytes.
//
// The bytes of a series are those of its rows, one row after the other. A row, the history of one number, is a byte d
// of 0, 1 or 2 and a residual for each frame, the d-th difference in time of the rounded number (what came before the
// first frame counts as 0). A residual r is written as 2r when r >= 0 and -2r - 1 otherwise, seven bits a byte from the
// lowest, with 128 added to all bytes but the last.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace app {

class PageSeries {
 public:
  explicit PageSeries(double quantum) : quantum_(quantum) {}
  /// The numbers of the next frame, of any count: those that are missing are 0. Throws std::invalid_argument for one
  /// that is not finite or beyond 2^48 quanta.
  void add(std::span<const double> numbers);

  double quantum() const { return quantum_; }
  /// Without those after the last that is not 0 all the time.
  std::size_t rows() const;
  std::string bytes() const;

 private:
  struct Row {
    std::int64_t last = 0, before = 0;
    std::array<std::string, 3> residuals;  ///< of each d
    bool used = false;
  };
  double quantum_;
  std::size_t frames_ = 0;
  std::vector<Row> rows_;
};

}  // namespace app
