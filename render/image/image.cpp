#include "render/image/image.h"

#include "render/core/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace render {
namespace {

constexpr int linear_steps = 4096;  // the steepest part of the sRGB curve needs 0.8 codes a step, so codes survive

struct Tables {
  std::array<std::uint32_t, 256> linear;  // 0..65535
  std::array<std::uint8_t, linear_steps> encoded;
};

const Tables& tables() {
  static const Tables made = [] {
    Tables t{};
    for (std::size_t i = 0; i < t.linear.size(); ++i)
      t.linear[i] = static_cast<std::uint32_t>(std::lround(65535 * linear_of(static_cast<double>(i) / 255)));
    for (std::size_t i = 0; i < t.encoded.size(); ++i)
      t.encoded[i] = static_cast<std::uint8_t>(std::lround(255 * srgb_of(static_cast<double>(i) / (linear_steps - 1))));
    return t;
  }();
  return made;
}

// Sums of one row of blocks: row-wise accumulation keeps memory access sequential.
template <int Channels>
void add_row(const std::uint8_t* source, int blocks, int factor, const std::array<std::uint32_t, 256>& linear,
             std::uint32_t* sum) {
  for (int x = 0; x < blocks; ++x, sum += 3)
    for (int k = 0; k < factor; ++k, source += Channels) {
      sum[0] += linear[source[0]];
      sum[1] += linear[source[1]];
      sum[2] += linear[source[2]];
    }
}

// 2 x 2 samples of four bytes, the case of every movie. Most blocks are of one colour, which needs no sums.
void halve_row(const std::uint8_t* upper, const std::uint8_t* lower, int blocks, std::uint64_t scale,
               const Tables& table, std::uint8_t* out) {
  for (int x = 0; x < blocks; ++x, upper += 8, lower += 8, out += 3) {
    std::uint64_t a = 0, b = 0;
    std::memcpy(&a, upper, 8);
    std::memcpy(&b, lower, 8);
    if (a == b && a >> 32 == (a & 0xffffffffU)) {
      std::memcpy(out, upper, 3);
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t sum =
          table.linear[upper[c]] + table.linear[upper[4 + c]] + table.linear[lower[c]] + table.linear[lower[4 + c]];
      out[c] = table.encoded[(sum * scale + (std::uint64_t{1} << 31)) >> 32];
    }
  }
}

}  // namespace

Image downsample(const Image& source, int factor, RowOrder rows) {
  if (factor < 1 || source.width % factor != 0 || source.height % factor != 0)
    throw std::invalid_argument("a " + std::to_string(source.width) + "x" + std::to_string(source.height) +
                                " picture cannot be reduced by " + std::to_string(factor));
  const Tables& table = tables();
  Image result(source.width / factor, source.height / factor, 3);
  // 65535 n^2 -> 4095, rounded; 64-bit fixed point with 32 fractional bits keeps the division out of the loop
  const auto scale =
      static_cast<std::uint64_t>(std::llround(std::ldexp((linear_steps - 1) / (65535.0 * factor * factor), 32)));
  const std::uint64_t half = std::uint64_t{1} << 31;
  std::vector<std::uint32_t> sums(static_cast<std::size_t>(result.width) * 3);
  for (int y = 0; y < result.height; ++y) {
    std::uint8_t* out = result.at(0, y);
    const auto source_row = [&](int k) {
      const int row = y * factor + k;
      return source.at(0, rows == RowOrder::top_first ? row : source.height - 1 - row);
    };
    if (factor == 1) {
      const std::uint8_t* in = source_row(0);
      for (int x = 0; x < result.width; ++x)
        for (int c = 0; c < 3; ++c) out[3 * x + c] = in[source.channels * x + c];
      continue;
    }
    if (factor == 2 && source.channels == 4) {
      halve_row(source_row(0), source_row(1), result.width, scale, table, out);
      continue;
    }
    sums.assign(sums.size(), 0);
    for (int k = 0; k < factor; ++k)
      source.channels == 4 ? add_row<4>(source_row(k), result.width, factor, table.linear, sums.data())
                           : add_row<3>(source_row(k), result.width, factor, table.linear, sums.data());
    for (std::size_t i = 0; i < sums.size(); ++i) out[i] = table.encoded[(sums[i] * scale + half) >> 32];
  }
  return result;
}

Image downsample_transparent(const Image& source, int factor, RowOrder rows) {
  if (factor < 1 || source.channels != 4 || source.width % factor != 0 || source.height % factor != 0)
    throw std::invalid_argument("a " + std::to_string(source.width) + "x" + std::to_string(source.height) +
                                " picture cannot be reduced by " + std::to_string(factor));
  const Tables& table = tables();
  Image result(source.width / factor, source.height / factor, 4);
  const auto samples = static_cast<std::uint64_t>(factor) * static_cast<std::uint64_t>(factor);
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) {
      std::uint64_t alpha = 0;
      std::array<std::uint64_t, 3> sum{};
      for (int k = 0; k < factor; ++k) {
        const int row = y * factor + k;
        const std::uint8_t* p = source.at(x * factor, rows == RowOrder::top_first ? row : source.height - 1 - row);
        for (int i = 0; i < factor; ++i, p += 4) {
          const std::uint32_t a = p[3];
          if (a == 0) continue;
          alpha += a;
          for (std::size_t c = 0; c < 3; ++c) sum[c] += a * table.linear[std::min((p[c] * 255U + a / 2) / a, 255U)];
        }
      }
      if (alpha == 0) continue;
      std::uint8_t* out = result.at(x, y);
      // alpha of at least 1: what has colour is not lost
      out[3] = static_cast<std::uint8_t>(std::max<std::uint64_t>((alpha + samples / 2) / samples, 1));
      for (std::size_t c = 0; c < 3; ++c)
        out[c] = table.encoded[(sum[c] * (linear_steps - 1) + alpha * 65535 / 2) / (alpha * 65535)];
    }
  return result;
}

}  // namespace render
