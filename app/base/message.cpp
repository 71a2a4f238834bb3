#include "app/base/message.h"

#include "app/base/printable.h"

#include <cstdio>
#include <new>

namespace app {

void tell(std::string_view sentence) noexcept {
  try {
    std::fprintf(stderr, "tanktread: %s\n", printable(sentence).c_str());
  } catch (const std::bad_alloc&) {
    std::fputs("tanktread: there is not enough memory\n", stderr);
  }
}

void tell_raw(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace app
