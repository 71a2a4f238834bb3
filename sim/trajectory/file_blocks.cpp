#include "sim/trajectory/file_blocks.h"

#include <algorithm>
#include <cstring>

namespace sim::file {

std::uint32_t metadata_checksum(std::string_view bytes) {
  std::uint32_t a = 0xdeadbeef + static_cast<std::uint32_t>(bytes.size()), b = a, c = a;
  const auto turn = [](std::uint32_t x, int by) { return x << by | x >> (32 - by); };
  const auto word = [&](std::size_t at) {
    std::uint32_t w = 0;
    for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
      w |= std::uint32_t{static_cast<unsigned char>(bytes[i + at])} << (8 * i);
    return w;
  };
  std::size_t at = 0;
  for (; bytes.size() - at > 12; at += 12) {
    a += word(at), b += word(at + 4), c += word(at + 8);
    a -= c, a ^= turn(c, 4), c += b;
    b -= a, b ^= turn(a, 6), a += c;
    c -= b, c ^= turn(b, 8), b += a;
    a -= c, a ^= turn(c, 16), c += b;
    b -= a, b ^= turn(a, 19), a += c;
    c -= b, c ^= turn(b, 4), b += a;
  }
  if (at == bytes.size()) return c;
  a += word(at), b += word(at + 4), c += word(at + 8);
  c ^= b, c -= turn(b, 14), a ^= c, a -= turn(c, 11), b ^= a, b -= turn(a, 25), c ^= b, c -= turn(b, 16);
  a ^= c, a -= turn(c, 4), b ^= a, b -= turn(a, 14), c ^= b, c -= turn(b, 24);
  return c;
}

void require_checksum([[maybe_unused]] std::string_view bytes, [[maybe_unused]] std::uint64_t sum) {
#ifndef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION  // hardly a mutation would get beyond it
  if (metadata_checksum(bytes) != sum) throw Refused("a part of its index");
#endif
}

std::string_view Cursor::bytes(std::uint64_t count) {
  if (count > rest_.size()) throw Refused("a part of its index");
  const std::string_view taken = rest_.substr(0, count);
  rest_.remove_prefix(count);
  return taken;
}

std::uint64_t Cursor::number(std::uint64_t count) {
  if (count > sizeof(std::uint64_t)) throw Refused("a part of its index");
  std::uint64_t value = 0;
  std::memcpy(&value, bytes(count).data(), count);
  return value;
}

std::string Blocks::at(std::uint64_t address, std::uint64_t bytes) {
  const std::uint64_t cost = std::max<std::uint64_t>(bytes, 4096);  // blocks of a circle are small
  if (cost > rest_ || address > file_bytes_ || bytes > file_bytes_ - address) throw Refused("a part of its index");
  rest_ -= cost;
  std::string block(bytes, '\0');
  file_.read(address, block.data(), bytes);
  return block;
}

std::string Blocks::sealed(std::uint64_t address, std::uint64_t bytes) {
  if (bytes > file_bytes_) throw Refused("a part of its index");
  std::string block = at(address, bytes + 4);
  const std::uint64_t sum = Cursor(std::string_view(block).substr(bytes)).number(4);
  block.resize(bytes);
  require_checksum(block, sum);
  return block;
}

}  // namespace sim::file
