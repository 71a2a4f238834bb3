// Trajectory files: header and layout as HDF5 tells them, then every row. Checksums of the metadata are made to fit after
// each mutation, or hardly any would get beyond them.
#include "sim/trajectory.h"
#include "support.h"

#include <cstring>
#include <vector>

namespace {

/// Bob Jenkins' lookup3, with which HDF5 guards its metadata.
std::uint32_t metadata_checksum(const std::uint8_t* k, std::size_t length) {
  std::uint32_t a = 0xdeadbeef + static_cast<std::uint32_t>(length), b = a, c = a;
  const auto turn = [](std::uint32_t x, int by) { return x << by | x >> (32 - by); };
  const auto word = [&](std::size_t at) {
    std::uint32_t w = 0;
    for (std::size_t i = 0; i < 4 && at + i < length; ++i) w |= std::uint32_t{k[i + at]} << (8 * i);
    return w;
  };
  std::size_t at = 0;
  for (; length - at > 12; at += 12) {
    a += word(at), b += word(at + 4), c += word(at + 8);
    a -= c, a ^= turn(c, 4), c += b;
    b -= a, b ^= turn(a, 6), a += c;
    c -= b, c ^= turn(b, 8), b += a;
    a -= c, a ^= turn(c, 16), c += b;
    b -= a, b ^= turn(a, 19), a += c;
    c -= b, c ^= turn(b, 4), b += a;
  }
  if (at == length) return c;
  a += word(at), b += word(at + 4), c += word(at + 8);
  c ^= b, c -= turn(b, 14), a ^= c, a -= turn(c, 11), b ^= a, b -= turn(a, 25), c ^= b, c -= turn(b, 16);
  a ^= c, a -= turn(c, 4), b ^= a, b -= turn(a, 14), c ^= b, c -= turn(b, 24);
  return c;
}

void seal(std::vector<std::uint8_t>& file, std::size_t from, std::size_t length) {
  if (from + length + 4 > file.size() || length == 0) return;
  const std::uint32_t sum = metadata_checksum(file.data() + from, length);
  for (std::size_t i = 0; i < 4; ++i) file[from + length + i] = static_cast<std::uint8_t>(sum >> (8 * i));
}

/// Superblock 2 and first chunks of object headers of version 2.
void seal_metadata(std::vector<std::uint8_t>& file) {
  seal(file, 0, 44);
  for (std::size_t at = 48; at + 16 < file.size() && at < (1U << 17); ++at) {
    if (std::memcmp(file.data() + at, "OHDR", 4) != 0) continue;
    const std::uint8_t flags = file[at + 5];
    const std::size_t start = 6 + (flags & 0x20 ? 16U : 0U) + (flags & 0x10 ? 4U : 0U), width = std::size_t{1} << (flags & 3);
    std::uint64_t size = 0;
    for (std::size_t i = 0; i < width && at + start + i < file.size(); ++i)
      size |= std::uint64_t{file[at + start + i]} << (8 * i);
    if (size < file.size()) seal(file, at, start + width + size);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  std::vector<std::uint8_t> input(bytes, bytes + size);
  if (size > 48) seal_metadata(input);
  const fuzz::MemoryFile file(input.data(), input.size());
  fuzz::accepted([&] {
    const sim::TrajectoryReader reader(file.path());
    const auto damaged = reader.damaged();
    for (std::int64_t k = 0; k < reader.count(); ++k) fuzz::accepted([&] { reader.state(k); });
    fuzz::accepted([&] { reader.steps(); });
    reader.notes();
    reader.resume_payload();
  });
  return 0;
}
