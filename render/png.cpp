#include "image.h"

#include <fmt/format.h>
#include <png.h>
#include <unistd.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <functional>
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

bool write_stream(std::FILE* file, const Image& image, std::vector<png_text>& chunks, int compression, Failure& failure) {
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
  png_structp png = nullptr;
  png_infop info = nullptr;
  Failure failure;
  std::FILE* file = nullptr;
  ~Reader() {
    if (png) png_destroy_read_struct(&png, &info, nullptr);
    if (file) std::fclose(file);
  }
};

bool read_header(Reader& r) {
  if (setjmp(png_jmpbuf(r.png))) return false;
  png_init_io(r.png, r.file);
  png_set_sig_bytes(r.png, 8);
  png_set_user_limits(r.png, 32768, 32768);  // a damaged header must not ask for gigabytes
  png_read_info(r.png, r.info);
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

void write_png(const std::filesystem::path& path, const Image& image, const PngText& text, int compression) {
  std::filesystem::path temporary = path;
  temporary.replace_filename(fmt::format(".{}.{}.tmp", path.filename().string(), ::getpid()));
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (!file) fail(path, std::string("cannot be written: ") + std::strerror(errno));
  std::vector<png_text> chunks = chunks_of(text);
  Failure failure;
  errno = 0;
  const bool written = write_stream(file, image, chunks, compression, failure);
  int error = written ? 0 : (errno ? errno : EIO);
  if (std::fclose(file) != 0 && !error) error = errno;
  std::string reason = error ? std::strerror(error) : "";
  if (!error && std::rename(temporary.c_str(), path.c_str()) != 0) {
    error = errno;
    reason = std::strerror(error);
  }
  if (error) {
    std::remove(temporary.c_str());
    // libpng's own words name bad input (a keyword too long); "Write Error" says less than errno
    const bool own_words = failure.text[0] != '\0' && std::strcmp(failure.text, "Write Error") != 0;
    fail(path, "cannot be written: " + (own_words ? std::string(failure.text) : reason));
  }
}

PngFile read_png(const std::filesystem::path& path) {
  Reader r;
  r.file = std::fopen(path.c_str(), "rb");
  if (!r.file) fail(path, std::string("cannot be read: ") + std::strerror(errno));
  png_byte signature[8] = {};
  const std::size_t got = std::fread(signature, 1, 8, r.file);
  if (std::ferror(r.file)) fail(path, std::string("cannot be read: ") + std::strerror(errno));
  if (got == 0) fail(path, "is empty, not a PNG file");
  if (got < 8 || png_sig_cmp(signature, 0, 8) != 0) fail(path, "is not a PNG file");
  r.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &r.failure, on_error, on_warning);
  r.info = r.png ? png_create_info_struct(r.png) : nullptr;
  if (!r.info) throw std::bad_alloc();
  if (!read_header(r)) fail(path, std::string("is damaged: ") + r.failure.text);
  PngFile result;
  result.image = Image(static_cast<int>(png_get_image_width(r.png, r.info)),
                       static_cast<int>(png_get_image_height(r.png, r.info)), png_get_channels(r.png, r.info));
  std::vector<png_bytep> rows;
  for (int y = 0; y < result.image.height; ++y) rows.push_back(result.image.at(0, y));
  if (!read_rows(r, rows.data())) fail(path, std::string("is damaged: ") + r.failure.text);
  png_textp text = nullptr;
  int count = 0;
  png_get_text(r.png, r.info, &text, &count);
  for (int i = 0; i < count; ++i) result.text.emplace_back(text[i].key, text[i].text ? text[i].text : "");
  return result;
}

PngText read_png_text(const std::filesystem::path& path) { return read_png(path).text; }

}  // namespace render
