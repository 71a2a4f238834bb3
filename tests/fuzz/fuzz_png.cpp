// The PNG reader: a picture of the promised size, or a sentence.
#include "render/image.h"
#include "support.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  std::FILE* file = fmemopen(const_cast<std::uint8_t*>(bytes), size, "rb");
  if (!file) return 0;
  fuzz::accepted([&] {
    const render::Image image = render::read_png(file, "input").image;
    const auto expected = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                          static_cast<std::size_t>(image.channels);
    if (image.pixels.size() != expected || (image.channels != 3 && image.channels != 4))
      fuzz::broken("a picture has width x height x 3 or 4 bytes");
  });
  std::fclose(file);
  return 0;
}
