#include "render/gl/context.h"

#include "render/gl/context_back_ends.h"

#include <dlfcn.h>
#include <sys/mman.h>

#include <charconv>
#include <stdexcept>

namespace render {
namespace {

GlContext::BackEnd open_first_of_both(EglDevices devices) {
  try {
    return open_osmesa();
  } catch (const GlUnavailable&) {
    // OSMesa is the one that few systems still have: what EGL lacks is what can be mended.
    try {
      return open_egl(devices, -1);
    } catch (const GlUnavailable& egl) {
      throw GlUnavailable("no OpenGL without a window: " + egl.sentence);
    }
  }
}

GlContext::BackEnd open(const GlChoice& choice) {
  if (choice.kind == "auto") return open_first_of_both(EglDevices::any);
  if (choice.kind == "osmesa") return open_osmesa();
  if (choice.kind == "egl")
    return choice.device < 0 ? open_egl(EglDevices::any, -1) : open_egl(EglDevices::one, choice.device);
  if (choice.kind == "software") return open_first_of_both(EglDevices::software);
  throw std::invalid_argument("unknown --gl " + choice.kind);
}

std::string text_of(const Gl& gl, GLenum name) {
  const GLubyte* text = gl.GetString(name);
  return text ? reinterpret_cast<const char*>(text) : "";
}

}  // namespace

void* open_library(const LibraryNames& names) {
  for (const char* name : names)
    if (void* handle = ::dlopen(name, RTLD_NOW | RTLD_LOCAL)) return handle;
  return nullptr;
}

const std::vector<GlChoiceRow>& gl_choices() {
  static const std::vector<GlChoiceRow> rows{
      {"auto", "OSMesa, or EGL where OSMesa is not installed"},
      {"osmesa", "Mesa's off-screen library, draws on the processor"},
      {"egl", "the first EGL device that works, graphics cards before the processor"},
      {"egl:N", "EGL device N, counted from 0"},
      {"software", "drawing on the processor, by OSMesa or EGL: the same pixels on every machine"},
  };
  return rows;
}

GlChoice parse_gl_choice(std::string_view word) {
  if (word == "auto" || word == "osmesa" || word == "egl" || word == "software") return {std::string(word), -1};
  if (word.starts_with("egl:")) {
    const std::string_view digits = word.substr(4);
    int device = -1;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), device);
    if (error == std::errc{} && end == digits.data() + digits.size() && device >= 0) return {"egl", device};
  }
  std::string known;
  for (const GlChoiceRow& row : gl_choices()) known += (known.empty() ? "" : ", ") + std::string(row.name);
  throw std::invalid_argument("unknown OpenGL back end '" + std::string(word) + "' (known: " + known + ")");
}

void require_memory(std::size_t bytes) {
  // Address space alone: it is given back at once, and pages are never touched.
  void* probe = ::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (probe == MAP_FAILED)
    throw std::runtime_error("there is not enough memory to draw: about " + std::to_string(bytes >> 20) +
                             " MiB more are needed");
  ::munmap(probe, bytes);
}

GlContext::GlContext(const GlChoice& choice) {
  constexpr std::size_t driver = std::size_t{560} << 20;  // its libraries, its compiler and the stacks of its threads
  require_memory(driver);
  try {
    back_end_ = open(choice);
  } catch (const GlUnavailable& e) {
    throw std::runtime_error(e.sentence);
  }
  gl_ = load_gl(back_end_.look_up);
  information_.back_end = back_end_.name;
  information_.renderer = text_of(gl_, GL_RENDERER);
  information_.version = text_of(gl_, GL_VERSION);
  for (const char* rasteriser : {"llvmpipe", "softpipe", "swrast"})
    information_.software = information_.software || information_.renderer.find(rasteriser) != std::string::npos;
  if (choice.kind == "software" && !information_.software)
    throw std::runtime_error("--gl software found only " + information_.renderer + ": " + egl_packages);
}

GlContext::~GlContext() = default;
GlContext::GlContext(GlContext&&) noexcept = default;

void GlContext::make_current() const {
  if (!back_end_.make_current(back_end_.object.get()))
    throw std::runtime_error(back_end_.name + ": the OpenGL context cannot be made current");
}

}  // namespace render
