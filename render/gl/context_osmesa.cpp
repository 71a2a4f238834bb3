#include "render/gl/context_back_ends.h"

#include <dlfcn.h>

#include <array>

namespace render {
namespace {

// GL/osmesa.h would bring GL/gl.h, whose prototypes clash with glcorearb.h: four types and seven numbers replace it.
using OsmesaContext = void*;
using CreateContext = OsmesaContext (*)(const int*, OsmesaContext);
using MakeCurrent = unsigned char (*)(OsmesaContext, void*, GLenum, GLsizei, GLsizei);
using DestroyContext = void (*)(OsmesaContext);
using GetProcAddress = GlFunction (*)(const char*);

constexpr int osmesa_format = 0x22, osmesa_depth_bits = 0x30, osmesa_profile = 0x33, osmesa_core_profile = 0x34,
              osmesa_major_version = 0x36, osmesa_minor_version = 0x37;
constexpr int rgba = GL_RGBA;
constexpr GLsizei side = 16;  // the buffer is written at every flush, so its size never changes

struct Library {
  CreateContext create = nullptr;
  MakeCurrent make_current = nullptr;
  DestroyContext destroy = nullptr;
  GetProcAddress look_up = nullptr;
};

Library load_osmesa(const LibraryNames& names) {
  void* handle = open_library(names);
  if (!handle)
    throw GlUnavailable("OSMesa is not installed, and newer systems do not offer it: --gl egl draws the same pixels");
  Library l;
  l.create = reinterpret_cast<CreateContext>(::dlsym(handle, "OSMesaCreateContextAttribs"));
  l.make_current = reinterpret_cast<MakeCurrent>(::dlsym(handle, "OSMesaMakeCurrent"));
  l.destroy = reinterpret_cast<DestroyContext>(::dlsym(handle, "OSMesaDestroyContext"));
  l.look_up = reinterpret_cast<GetProcAddress>(::dlsym(handle, "OSMesaGetProcAddress"));
  if (!l.create || !l.make_current || !l.destroy || !l.look_up)
    throw GlUnavailable("the installed OSMesa is too old; 12 or newer is needed, or --gl egl");
  return l;
}

struct OsmesaObject {
  Library functions;
  OsmesaContext context = nullptr;
  std::array<unsigned char, side * side * 4> buffer{};
  ~OsmesaObject() {
    if (context) functions.destroy(context);
  }
};

}  // namespace

GlContext::BackEnd open_osmesa(const LibraryNames& names) {
  auto object = std::make_shared<OsmesaObject>();
  object->functions = load_osmesa(names);
  const std::array<int, 13> wanted{osmesa_format,
                                   rgba,
                                   osmesa_depth_bits,
                                   0,
                                   osmesa_profile,
                                   osmesa_core_profile,
                                   osmesa_major_version,
                                   3,
                                   osmesa_minor_version,
                                   3,
                                   0,
                                   0,
                                   0};
  object->context = object->functions.create(wanted.data(), nullptr);
  if (!object->context) throw GlUnavailable("OSMesa cannot make an OpenGL 3.3 core context");
  const auto make_current = [](void* o) {
    auto* self = static_cast<OsmesaObject*>(o);
    return self->functions.make_current(self->context, self->buffer.data(), GL_UNSIGNED_BYTE, side, side) != 0;
  };
  if (!make_current(object.get())) throw GlUnavailable("OSMesa cannot make its context current");
  const GetProcAddress look_up = object->functions.look_up;
  return {std::move(object), make_current, look_up, "OSMesa"};
}

}  // namespace render
