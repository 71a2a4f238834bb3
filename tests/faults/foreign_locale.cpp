// Preloaded: some library has set the user's locale before the program starts.
#include <clocale>

namespace {

[[gnu::constructor]] void set_locale() { std::setlocale(LC_ALL, ""); }

}  // namespace
