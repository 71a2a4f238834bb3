// The sRGB transfer function between encoded values and linear light, both 0..1.
#pragma once

#include <cmath>

namespace render {

template <class Real>
Real linear_of(Real code) {
  return code <= Real(0.04045) ? code / Real(12.92) : std::pow((code + Real(0.055)) / Real(1.055), Real(2.4));
}

inline double srgb_of(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

}  // namespace render
