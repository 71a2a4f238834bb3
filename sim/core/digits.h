// Formats two numbers of one message so that they differ: "0.150003 is above 0.15".
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace sim {

/// With as many significant digits, at least `least`, as distinguish them; 17 distinguish any two.
inline std::pair<std::string, std::string> told_apart(double a, double b, int least = 3) {
  std::pair<std::string, std::string> texts;
  for (int digits = least; digits <= 17; ++digits) {
    texts = {fmt::format("{:.{}g}", a, digits), fmt::format("{:.{}g}", b, digits)};
    if (texts.first != texts.second) break;
  }
  return texts;
}

}  // namespace sim
