#include "render/core/ground.h"

#include "sim/core/catalogue.h"

#include <array>
#include <stdexcept>
#include <string>

namespace render {
namespace {

struct NamedGround {
  std::string_view name;
  Ground ground;
};
constexpr std::array<NamedGround, 4> grounds{{
    {"gradient", {ground_top, ground_bottom}},
    {"white", {white, white}},
    {"dark", {{0.115, 0.125, 0.150}, {0.055, 0.060, 0.075}}},
    {"transparent", {white, white, true}},
}};

double luma(const Colour& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

}  // namespace

bool Ground::dark() const { return luma(top) + luma(bottom) < 0.9; }

Ground ground_of(std::string_view background, std::vector<std::string_view> names) {
  for (const NamedGround& row : grounds) {
    if (row.name == background) return row.ground;
    names.push_back(row.name);
  }
  if (background.starts_with('#')) {
    const Colour colour = parse_colour(background);
    return {colour, colour};
  }
  throw std::invalid_argument("'" + std::string(background) + "' is no known ground" +
                              sim::suggestion(background, names) + ", and not #rrggbb");
}

Inks inks_on(const Ground& ground) {
  if (!ground.dark()) {
    Inks inks;
    inks.rimmed = ground.transparent;
    return inks;
  }
  return {.text = {0.93, 0.94, 0.96},
          .soft = {0.66, 0.70, 0.76},
          .note = {0.98, 0.70, 0.40},
          .rim = ground.bottom,
          .arrow = {0.36, 0.40, 0.47},
          .flow_line = {0.46, 0.51, 0.59},
          .paper = ground.top};
}

}  // namespace render
