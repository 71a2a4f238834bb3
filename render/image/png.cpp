#include "render/image/image.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <png.h>
#include <sys/stat.h>
#include <unistd.h>

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

bool write_stream(std::FILE* file, const Image& image, std::vector<png_text>& chunks, int compression,
                  double dots_per_inch, Failure& failure) {
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
  bool sixteen_bits = false;
  int passes = 1;  ///< over all rows, of an interlaced picture
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
  r.sixteen_bits = png_get_bit_depth(r.png, r.info) == 16;
  png_set_expand(r.png);
  png_set_gray_to_rgb(r.png);
  r.passes = png_set_interlace_handling(r.png);
  png_read_update_info(r.png, r.info);
  return true;
}

bool read_rows(Reader& r, png_bytep* rows, png_uint_32 count) {
  if (setjmp(png_jmpbuf(r.png))) return false;
  png_read_rows(r.png, rows, nullptr, count);
  return true;
}

bool read_end(Reader& r) {
  if (setjmp(png_jmpbuf(r.png))) return false;
  png_read_end(r.png, r.info);
  return true;
}

using Stream = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Without waiting for a pipe that nobody writes to.
Stream open_to_read(const std::filesystem::path& path) {
  const int number = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  return {number < 0 ? nullptr : ::fdopen(number, "rb"), &std::fclose};
}

/// What a file that is no PNG file starts with.
struct Kind {
  std::size_t at;
  std::string_view bytes, name;
};
constexpr Kind other_kinds[] = {
    {0, "\xff\xd8\xff", "a JPEG picture"},
    {0, "GIF8", "a GIF picture"},
    {8, "WEBP", "a WebP picture"},
    {4, "ftypavi", "an AVIF picture"},
    {4, "ftyphei", "a HEIC picture"},
    {4, "ftyp", "a movie"},
    {0, "BM", "a BMP picture"},
    {0, {"II*\0", 4}, "a TIFF picture"},
    {0, {"MM\0*", 4}, "a TIFF picture"},
    {0, "<svg", "an SVG picture"},
    {0, "<?xml", "an XML file"},
    {0, "%PDF", "a PDF file"},
    {0, "\x89HDF", "an HDF5 file"},
    {0, "\x1f\x8b", "a gzip file"},
    {0, "version https://git-lfs", "a pointer of Git LFS, whose picture 'git lfs pull' fetches"},
};

[[noreturn]] void fail_as_no_png(const std::filesystem::path& path, std::string_view start) {
  for (const Kind& kind : other_kinds)
    if (start.size() >= kind.at + kind.bytes.size() && start.substr(kind.at, kind.bytes.size()) == kind.bytes)
      fail(path, fmt::format("is not a PNG file but {}", kind.name));
  fail(path, "is not a PNG file");
}

std::uint32_t word_at(const unsigned char* p) {
  return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | std::uint32_t{p[3]};
}

/// FNV-1a, to tell contents apart.
void add_to_sum(std::uint64_t& sum, const unsigned char* bytes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) sum = (sum ^ bytes[i]) * 0x100000001b3U;
}

/// What the chunks say beside the samples. libpng does not know all of them, and mends what contradicts itself.
struct Declared {
  std::string cicp, profile, gamma, primaries;
  bool srgb = false;
  std::uint32_t frames = 0;                 ///< of an animation
  std::uint64_t sum = 0xcbf29ce484222325U;  ///< of its chunks

  /// The strongest of the declarations; empty: sRGB, which is also what no declaration means.
  std::string colours() const {
    if (!cicp.empty()) return cicp == "1/13/0/1" ? "" : "code points " + cicp;
    if (!profile.empty()) return profile;
    if (srgb) return {};
    return gamma + (gamma.empty() || primaries.empty() ? "" : ", ") + primaries;
  }
  std::string animation() const {
    return frames == 0 ? std::string() : fmt::format("{} frames ({:016x})", frames, sum);
  }
};

void note_chunk(Declared& declared, std::string_view type, const unsigned char* data, std::size_t size,
                std::uint32_t check) {
  if (type == "sRGB") declared.srgb = true;
  if (type == "cICP" && size == 4) declared.cicp = fmt::format("{}/{}/{}/{}", data[0], data[1], data[2], data[3]);
  if (type == "iCCP") {
    std::string name;
    for (std::size_t i = 0; i < size && i < 79 && data[i] != 0; ++i)
      name += data[i] >= 32 && data[i] < 127 ? static_cast<char>(data[i]) : '?';
    declared.profile = fmt::format("ICC profile '{}' ({:08x})", name, check);
  }
  if (type == "gAMA" && size == 4) {
    // 1/2.2, which stands for sRGB where there is no more.
    const std::uint32_t gamma = word_at(data);
    declared.gamma = gamma >= 45400 && gamma <= 45500 ? "" : fmt::format("gamma {:g}", gamma / 1e5);
  }
  if (type == "cHRM" && size == 32) {
    constexpr std::uint32_t srgb[] = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    std::string text;
    bool same = true;
    for (std::size_t i = 0; i < 8; ++i) {
      const std::uint32_t value = word_at(data + 4 * i);
      same = same && value + 10 >= srgb[i] && value <= srgb[i] + 10;  // writers round
      text += fmt::format("{}{:g}", i == 0 ? "" : " ", value / 1e5);
    }
    declared.primaries = same ? "" : "white point and primaries " + text;
  }
  if (type == "acTL" && size == 8) declared.frames = word_at(data);
  if (type == "acTL" || type == "fcTL" || type == "fdAT") {
    add_to_sum(declared.sum, reinterpret_cast<const unsigned char*>(type.data()), type.size());
    const unsigned char tail[8] = {static_cast<unsigned char>(size >> 24),  static_cast<unsigned char>(size >> 16),
                                   static_cast<unsigned char>(size >> 8),   static_cast<unsigned char>(size),
                                   static_cast<unsigned char>(check >> 24), static_cast<unsigned char>(check >> 16),
                                   static_cast<unsigned char>(check >> 8),  static_cast<unsigned char>(check)};
    add_to_sum(declared.sum, tail, sizeof tail);
  }
}

/// From one chunk's head to the next; the file is known to start with a PNG signature.
Declared read_declared(std::FILE* file) {
  constexpr std::size_t most = 128;  // of a chunk's data, more than is looked at
  Declared declared;
  for (long at = 8; std::fseek(file, at, SEEK_SET) == 0;) {
    unsigned char head[8], data[most], check[4];
    if (std::fread(head, 1, 8, file) != 8) break;
    const std::uint32_t length = word_at(head);
    if (length > 0x7fffffffU) break;
    const std::size_t looked_at = std::min<std::size_t>(length, most);
    if (std::fread(data, 1, looked_at, file) != looked_at) break;
    if (std::fseek(file, at + 8 + static_cast<long>(length), SEEK_SET) != 0 || std::fread(check, 1, 4, file) != 4)
      break;
    const std::string_view type(reinterpret_cast<const char*>(head) + 4, 4);
    if (type == "IEND") break;
    note_chunk(declared, type, data, length > most && type != "iCCP" ? length : looked_at, word_at(check));
    at += 12 + static_cast<long>(length);
  }
  return declared;
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
  std::string result(bytes ? bytes : "", bytes ? size : 0);
  std::free(bytes);
  if (!written || !closed) throw std::runtime_error(std::string("the picture cannot be encoded: ") + failure.text);
  return result;
}

void write_png(const std::filesystem::path& path, const Image& image, const PngText& text, int compression,
               double dots_per_inch, const sim::FileWriter& write) {
  std::string bytes;
  try {
    bytes = png_bytes(image, text, compression, dots_per_inch);
  } catch (const std::runtime_error& error) {
    fail(path, std::string("cannot be written: ") + error.what());
  }
  write(path, bytes);
}

PngFile read_png(std::FILE* file, const std::filesystem::path& path, const std::function<void()>& look) {
  Reader r(file);
  char start[64] = {};
  const std::size_t got = std::fread(start, 1, sizeof start, file);
  if (std::ferror(file)) fail(path, std::string("cannot be read: ") + std::strerror(errno));
  if (got == 0) fail(path, "is empty, not a PNG file");
  if (got < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(start), 0, 8) != 0) fail_as_no_png(path, {start, got});
  if (std::fseek(file, 0, SEEK_END) != 0) fail(path, "cannot be read: it is not a file");
  const auto file_bytes = static_cast<std::uint64_t>(std::max(std::ftell(file), 0L));
  const Declared declared = read_declared(file);
  std::fseek(file, 8, SEEK_SET);
  r.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &r.failure, on_error, on_warning);
  r.info = r.png ? png_create_info_struct(r.png) : nullptr;
  if (!r.info) throw std::bad_alloc();
  if (!read_header(r)) fail(path, std::string("is damaged: ") + r.failure.text);
  const png_uint_32 width = png_get_image_width(r.png, r.info), height = png_get_image_height(r.png, r.info);
  const int channels = png_get_channels(r.png, r.info);
  if (r.packed_rows / largest_ratio > file_bytes)
    fail(path, fmt::format("is damaged: {} bytes cannot hold {} x {} pixels", file_bytes, width, height));
  const std::uint64_t samples = std::uint64_t{width} * height * static_cast<unsigned>(channels);
  if (samples * (r.sixteen_bits ? 2 : 1) > largest_picture)
    fail(path, fmt::format("is too large: {} x {} pixels take more than 1 GiB", width, height));
  PngFile result;
  result.image = Image(static_cast<int>(width), static_cast<int>(height), channels);
  std::vector<std::uint8_t> wide(r.sixteen_bits ? 2 * samples : 0);  // upper byte first
  std::vector<png_bytep> rows;
  for (int y = 0; y < result.image.height; ++y)
    rows.push_back(r.sixteen_bits ? wide.data() + static_cast<std::size_t>(y) * 2 * (samples / height)
                                  : result.image.at(0, y));
  constexpr png_uint_32 at_a_time = 128;
  bool whole = true;
  for (int pass = 0; pass < r.passes && whole; ++pass)
    for (png_uint_32 y = 0; y < height && whole; y += at_a_time) {
      if (look) look();
      whole = read_rows(r, rows.data() + y, std::min(at_a_time, height - y));
    }
  if (!whole || !read_end(r)) fail(path, std::string("is damaged: ") + r.failure.text);
  if (r.sixteen_bits) {
    result.lower_bytes.resize(samples);
    for (std::size_t i = 0; i < samples; ++i) {
      result.image.pixels[i] = wide[2 * i];
      result.lower_bytes[i] = wide[2 * i + 1];
    }
  }
  result.colours = declared.colours();
  result.animation = declared.animation();
  png_textp text = nullptr;
  int count = 0;
  png_get_text(r.png, r.info, &text, &count);
  for (int i = 0; i < count; ++i) result.text.emplace_back(text[i].key, text[i].text ? text[i].text : "");
  return result;
}

PngFile read_png(const std::filesystem::path& path, const std::function<void()>& look) {
  const Stream file = open_to_read(path);
  if (!file) fail(path, std::string("cannot be read: ") + std::strerror(errno));
  struct stat status {};
  if (::fstat(::fileno(file.get()), &status) != 0) fail(path, std::string("cannot be read: ") + std::strerror(errno));
  if (S_ISDIR(status.st_mode)) fail(path, "is a folder, not a PNG file");
  if (!S_ISREG(status.st_mode)) fail(path, "is a pipe or a device, not a PNG file");
  return read_png(file.get(), path, look);
}

std::uint64_t png_memory(const std::filesystem::path& path) {
  const Stream file = open_to_read(path);
  unsigned char head[26];  // signature, length and type of the header, then width, height, bits and kind of samples
  if (!file || std::fread(head, 1, sizeof head, file.get()) != sizeof head || png_sig_cmp(head, 0, 8) != 0) return 0;
  const std::uint64_t pixels = std::uint64_t{word_at(head + 16)} * word_at(head + 20);
  return std::min(pixels, largest_picture) * 4 * (head[24] == 16 ? 3 : 1);
}

PngFile png_from(std::string_view bytes, const std::filesystem::path& name) {
  if (bytes.empty()) fail(name, "is empty, not a PNG file");
  const Stream file(::fmemopen(const_cast<char*>(bytes.data()), bytes.size(), "rb"), &std::fclose);  // reads only
  if (!file) throw std::bad_alloc();
  return read_png(file.get(), name);
}

PngText read_png_text(const std::filesystem::path& path) { return read_png(path).text; }

}  // namespace render
