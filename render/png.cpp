#include "image.h"

#include "file.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace render {
namespace {

// libpng reports errors by longjmp, which must not cross a C++ destructor: everything that lives between setjmp and
// the calls into libpng is plain data owned by the caller.
struct Failure {
  char text[256] = "";
};

void on_error(png_structp png, png_const_charp message) {
  auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
  std::snprintf(failure->text, sizeof failure->text, "%s", message);
  png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}

bool is_ascii(const std::string& s) {
  for (const char c : s)
    if (static_cast<unsigned char>(c) > 126) return false;
  return true;
}

std::vector<png_text> chunks_of(const PngText& text) {
  std::vector<png_text> chunks;
  for (const auto& [key, value] : text) {
    png_text chunk{};
    chunk.compression = is_ascii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    chunk.key = const_cast<char*>(key.c_str());  // libpng copies, its interface is older than const
    chunk.text = const_cast<char*>(value.c_str());
    chunks.push_back(chunk);
  }
  return chunks;
}

bool write_stream(std::FILE* file, const Image& image, std::vector<png_text>& chunks, int compression, double dots_per_inch,
                  Failure& failure) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, on_error, on_warning);
  if (!png) return false;
  png_infop info = png_create_info_struct(png);
  if (setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               image.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  const auto dots_per_metre = static_cast<png_uint_32>(std::lround(dots_per_inch / 0.0254));
  if (dots_per_metre > 0) png_set_pHYs(png, info, dots_per_metre, dots_per_metre, PNG_RESOLUTION_METER);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
  png_set_compression_level(png, compression);
  if (!chunks.empty()) png_set_text(png, info, chunks.data(), static_cast<int>(chunks.size()));
  png_write_info(png, info);
  for (int y = 0; y < image.height; ++y) png_write_row(png, image.at(0, y));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw std::runtime_error(path.string() + ": " + reason);
}

// The steps of reading that need C++ objects between them; libpng runs only inside the functions below.
struct Reader {
  std::FILE* file;
  png_structp png = nullptr;
  png_infop info = nullptr;
  Failure failure;
  std::uint64_t packed_rows = 0;  ///< bytes that the compressed part must give
  explicit Reader(std::FILE* f) : file(f) {}
  Reader(const Reader&) = delete;
  ~Reader() {
    if (png) png_destroy_read_struct(&png, &info, nullptr);
  }
};

constexpr png_uint_32 largest_side = 32768;
constexpr std::uint64_t largest_picture = std::uint64_t{1} << 30;  // bytes in memory
constexpr std::uint64_t largest_ratio = 1032;                      // deflate cannot pack more tightly
constexpr png_alloc_size_t largest_chunk = 8 << 20;
constexpr png_uint_32 most_chunks = 1000;

bool read_header(Reader& r) {
  if (setjmp(png_jmpbuf(r.png))) return false;
  png_init_io(r.png, r.file);
  png_set_sig_bytes(r.png, 8);
  // A damaged header must not ask for gigabytes.
  png_set_user_limits(r.png, largest_side, largest_side);
  png_set_chunk_malloc_max(r.png, largest_chunk);
  png_set_chunk_cache_max(r.png, most_chunks);
  png_read_info(r.png, r.info);
  r.packed_rows = std::uint64_t{png_get_rowbytes(r.png, r.info)} * png_get_image_height(r.png, r.info);
  png_set_expand(r.png);
  png_set_strip_16(r.png);
  png_set_gray_to_rgb(r.png);
  png_set_interlace_handling(r.png);
  png_read_update_info(r.png, r.info);
  return true;
}

bool read_rows(Reader& r, png_bytep* rows) {
  if (setjmp(png_jmpbuf(r.png))) return false;
  png_read_image(r.png, rows);
  png_read_end(r.png, r.info);
  return true;
}

}  // namespace

std::string png_bytes(const Image& image, const PngText& text, int compression, double dots_per_inch) {
  char* bytes = nullptr;
  std::size_t size = 0;
  std::FILE* stream = ::open_memstream(&bytes, &size);
  if (!stream) throw std::bad_alloc();
  std::vector<png_text> chunks = chunks_of(text);
  Failure failure;
  const bool written = write_stream(stream, image, chunks, compression, dots_per_inch, failure);
  const bool closed = std::fclose(stream) == 0;
  const std::string result(bytes ? bytes : "", bytes ? size : 0);
  std::free(bytes);
  if (!written || !closed) throw std::runtime_error(std::string("the picture cannot be encoded: ") + failure.text);
  return result;
}

void write_png(const std::filesystem::path& path, const Image& image, const PngText& text, int compression,
               double dots_per_inch) {
  std::string bytes;
  try {
    bytes = png_bytes(image, text, compression, dots_per_inch);
  } catch (const std::runtime_error& error) {
    fail(path, std::string("cannot be written: ") + error.what());
  }
  write_file(path, bytes);
}

PngFile read_png(std::FILE* file, const std::filesystem::path& path) {
  Reader r(file);
  png_byte signature[8] = {};
  const std::size_t got = std::fread(signature, 1, 8, file);
  if (std::ferror(file)) fail(path, std::string("cannot be read: ") + std::strerror(errno));
  if (got == 0) fail(path, "is empty, not a PNG file");
  if (got < 8 || png_sig_cmp(signature, 0, 8) != 0) fail(path, "is not a PNG file");
  if (std::fseek(file, 0, SEEK_END) != 0) fail(path, "cannot be read: it is not a file");
  const auto file_bytes = static_cast<std::uint64_t>(std::max(std::ftell(file), 0L));
  std::fseek(file, 8, SEEK_SET);
  r.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &r.failure, on_error, on_warning);
  r.info = r.png ? png_create_info_struct(r.png) : nullptr;
  if (!r.info) throw std::bad_alloc();
  if (!read_header(r)) fail(path, std::string("is damaged: ") + r.failure.text);
  const png_uint_32 width = png_get_image_width(r.png, r.info), height = png_get_image_height(r.png, r.info);
  const int channels = png_get_channels(r.png, r.info);
  if (r.packed_rows / largest_ratio > file_bytes)
    fail(path, fmt::format("is damaged: {} bytes cannot hold {} x {} pixels", file_bytes, width, height));
  if (std::uint64_t{width} * height * static_cast<unsigned>(channels) > largest_picture)
    fail(path, fmt::format("is too large: {} x {} pixels take more than 1 GiB", width, height));
  PngFile result;
  result.image = Image(static_cast<int>(width), static_cast<int>(height), channels);
  std::vector<png_bytep> rows;
  for (int y = 0; y < result.image.height; ++y) rows.push_back(result.image.at(0, y));
  if (!read_rows(r, rows.data())) fail(path, std::string("is damaged: ") + r.failure.text);
  png_textp text = nullptr;
  int count = 0;
  png_get_text(r.png, r.info, &text, &count);
  for (int i = 0; i < count; ++i) result.text.emplace_back(text[i].key, text[i].text ? text[i].text : "");
  return result;
}

PngFile read_png(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) fail(path, std::string("cannot be read: ") + std::strerror(errno));
  return read_png(file.get(), path);
}

PngText read_png_text(const std::filesystem::path& path) { return read_png(path).text; }

}  // namespace render
