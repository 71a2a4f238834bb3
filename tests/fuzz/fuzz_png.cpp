// The PNG reader: a picture of the promised size, or a sentence. Checksums of the chunks are made to fit after each
// mutation, or hardly any would get beyond them.
#include "render/image/image.h"
#include "support.h"

#include <zlib.h>

#include <vector>

namespace {

/// Length, type, data, and the crc32 of type and data.
void seal_chunks(std::vector<std::uint8_t>& file) {
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::size_t length = std::size_t{file[at]} << 24 | std::size_t{file[at + 1]} << 16 |
                               std::size_t{file[at + 2]} << 8 | std::size_t{file[at + 3]};
    if (length > file.size() - at - 12) return;
    const uLong sum = crc32_z(0, file.data() + at + 4, length + 4);
    for (std::size_t i = 0; i < 4; ++i) file[at + 8 + length + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    at += length + 12;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  std::vector<std::uint8_t> input(bytes, bytes + size);
  seal_chunks(input);
  std::FILE* file = fmemopen(input.data(), input.size(), "rb");
  if (!file) return 0;
  fuzz::accepted([&] {
    const render::PngFile read = render::read_png(file, "input");
    const render::Image& image = read.image;
    const auto expected = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                          static_cast<std::size_t>(image.channels);
    if (image.pixels.size() != expected || (image.channels != 3 && image.channels != 4))
      fuzz::broken("a picture has width x height x 3 or 4 bytes");
    if (!read.lower_bytes.empty() && read.lower_bytes.size() != expected)
      fuzz::broken("each sample has a lower byte, or none has");
  });
  std::fclose(file);
  return 0;
}
