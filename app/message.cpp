#include "message.h"

#include <cstdio>

namespace app {

void tell(std::string_view sentence) noexcept {
  std::fprintf(stderr, "tanktread: %.*s\n", static_cast<int>(sentence.size()), sentence.data());
}

void tell_raw(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace app
