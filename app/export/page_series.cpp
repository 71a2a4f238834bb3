#include "app/export/page_series.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace app {

namespace {

void append(std::string& to, std::int64_t residual) {
  std::uint64_t rest =
      residual >= 0 ? 2 * static_cast<std::uint64_t>(residual) : 2 * static_cast<std::uint64_t>(-(residual + 1)) + 1;
  for (; rest >= 128; rest >>= 7) to += static_cast<char>(128 + (rest & 127));
  to += static_cast<char>(rest);
}

}  // namespace

void PageSeries::add(std::span<const double> numbers) {
  constexpr double most = 281474976710656;  // 2^48: second differences still fit the 53 bits of a number in a page
  if (numbers.size() > rows_.size()) {
    Row silent;
    for (std::string& residuals : silent.residuals) residuals.assign(frames_, '\0');
    rows_.resize(numbers.size(), silent);
  }
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    Row& row = rows_[k];
    const double number = k < numbers.size() ? numbers[k] / quantum_ : 0;
    if (!(std::abs(number) <= most)) throw std::invalid_argument("a number of the trajectory is too large for a page");
    const auto now = static_cast<std::int64_t>(std::llround(number));
    append(row.residuals[0], now);
    append(row.residuals[1], now - row.last);
    append(row.residuals[2], now - 2 * row.last + row.before);
    row.before = row.last;
    row.last = now;
    row.used = row.used || now != 0;
  }
  ++frames_;
}

std::size_t PageSeries::rows() const {
  const auto last = std::find_if(rows_.rbegin(), rows_.rend(), [](const Row& row) { return row.used; });
  return static_cast<std::size_t>(rows_.rend() - last);
}

std::string PageSeries::bytes() const {
  std::string text;
  for (std::size_t k = 0, count = rows(); k < count; ++k) {
    const std::array<std::string, 3>& residuals = rows_[k].residuals;
    // The shortest; of equal ones that with the fewest bytes that are not 0, which the compression takes for nothing.
    const auto cost = [&](std::size_t d) {
      const std::string& r = residuals[d];
      return 4 * static_cast<std::ptrdiff_t>(r.size()) - std::count(r.begin(), r.end(), '\0');
    };
    std::size_t best = 0;
    for (std::size_t d = 1; d <= 2; ++d)
      if (cost(d) < cost(best)) best = d;
    text += static_cast<char>(best);
    text += residuals[best];
  }
  return text;
}

}  // namespace app
