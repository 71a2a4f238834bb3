// FNV-1a of bytes, by which a file or a saved state is known again. No protection from those who mean harm.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace sim {

class Checksum {
 public:
  void add(std::string_view bytes) {
    for (const char c : bytes) h_ = (h_ ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  }
  std::string text() const { return fmt::format("{:016x}", h_); }

 private:
  std::uint64_t h_ = 14695981039346656037ull;
};

}  // namespace sim
