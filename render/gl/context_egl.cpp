#include "render/gl/context_back_ends.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <array>
#include <cstring>

namespace render {
namespace {

#define RENDER_EGL_FUNCTIONS(X)               \
  X(PFNEGLBINDAPIPROC, BindAPI)               \
  X(PFNEGLCHOOSECONFIGPROC, ChooseConfig)     \
  X(PFNEGLCREATECONTEXTPROC, CreateContext)   \
  X(PFNEGLDESTROYCONTEXTPROC, DestroyContext) \
  X(PFNEGLGETPROCADDRESSPROC, GetProcAddress) \
  X(PFNEGLINITIALIZEPROC, Initialize)         \
  X(PFNEGLMAKECURRENTPROC, MakeCurrent)       \
  X(PFNEGLQUERYSTRINGPROC, QueryString)

// Displays are never terminated: EGLDisplay is one per process and device, and another context may live on it.
struct Egl {
#define RENDER_EGL_MEMBER(Type, Name) Type Name = nullptr;
  RENDER_EGL_FUNCTIONS(RENDER_EGL_MEMBER)
#undef RENDER_EGL_MEMBER
  PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplay = nullptr;
  PFNEGLQUERYDEVICESEXTPROC QueryDevices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC QueryDeviceString = nullptr;
};

Egl load_egl(const LibraryNames& names) {
  void* handle = open_library(names);
  if (!handle) throw GlUnavailable(std::string("EGL is not installed: ") + egl_packages);
  Egl egl;
#define RENDER_EGL_LOAD(Type, Name)                                \
  egl.Name = reinterpret_cast<Type>(::dlsym(handle, "egl" #Name)); \
  if (!egl.Name) throw GlUnavailable("the installed libEGL lacks egl" #Name);
  RENDER_EGL_FUNCTIONS(RENDER_EGL_LOAD)
#undef RENDER_EGL_LOAD
  egl.GetPlatformDisplay =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(egl.GetProcAddress("eglGetPlatformDisplayEXT"));
  egl.QueryDevices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.GetProcAddress("eglQueryDevicesEXT"));
  egl.QueryDeviceString =
      reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(egl.GetProcAddress("eglQueryDeviceStringEXT"));
  if (!egl.GetPlatformDisplay) throw GlUnavailable("the installed libEGL cannot work without a window system");
  return egl;
}

struct EglObject {
  Egl egl;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  ~EglObject() {
    if (context == EGL_NO_CONTEXT) return;
    egl.MakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl.DestroyContext(display, context);
  }
};

bool make_current(void* o) {
  const auto* self = static_cast<EglObject*>(o);
  self->egl.BindAPI(EGL_OPENGL_API);
  return self->egl.MakeCurrent(self->display, EGL_NO_SURFACE, EGL_NO_SURFACE, self->context) == EGL_TRUE;
}

/// Empty when the display does not give a context.
std::shared_ptr<EglObject> try_display(const Egl& egl, EGLDisplay display) {
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || !egl.Initialize(display, &major, &minor) || !egl.BindAPI(EGL_OPENGL_API)) return {};
  const std::array<EGLint, 5> config_wanted{EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                            EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!egl.ChooseConfig(display, config_wanted.data(), &config, 1, &count) || count == 0) config = EGL_NO_CONFIG_KHR;
  const std::array<EGLint, 7> wanted{
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  auto object = std::make_shared<EglObject>();
  object->egl = egl;
  object->display = display;
  object->context = egl.CreateContext(display, config, EGL_NO_CONTEXT, wanted.data());
  if (object->context == EGL_NO_CONTEXT || !make_current(object.get())) return {};
  return object;
}

GlContext::BackEnd back_end(std::shared_ptr<EglObject> object, std::string name) {
  const auto look_up = reinterpret_cast<GlFunction (*)(const char*)>(object->egl.GetProcAddress);
  return {std::move(object), make_current, look_up, std::move(name)};
}

}  // namespace

GlContext::BackEnd open_egl(EglDevices which, int device, const LibraryNames& names) {
  const Egl egl = load_egl(names);
  std::array<EGLDeviceEXT, 32> devices{};
  EGLint count = 0;
  if (egl.QueryDevices) egl.QueryDevices(static_cast<EGLint>(devices.size()), devices.data(), &count);
  if (which == EglDevices::one && (device < 0 || device >= count))
    throw GlUnavailable("there is no EGL device " + std::to_string(device) + "; this machine has " +
                        std::to_string(count) + (count > 0 ? ", counted from 0" : ""));
  for (EGLint i = 0; i < count; ++i) {
    if (which == EglDevices::one && i != device) continue;
    const EGLDeviceEXT d = devices[static_cast<std::size_t>(i)];
    const char* extensions = egl.QueryDeviceString ? egl.QueryDeviceString(d, EGL_EXTENSIONS) : nullptr;
    const bool software = extensions && std::strstr(extensions, "EGL_MESA_device_software");
    if (which == EglDevices::software && !software) continue;
    if (auto object = try_display(egl, egl.GetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, d, nullptr)))
      return back_end(std::move(object), "EGL device " + std::to_string(i));
  }
  if (which == EglDevices::one)
    throw GlUnavailable("EGL device " + std::to_string(device) + " gives no OpenGL 3.3 core context");
  if (auto object =
          try_display(egl, egl.GetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)))
    return back_end(std::move(object), "EGL surfaceless");
  throw GlUnavailable(std::string("EGL finds no device with OpenGL 3.3 core: ") + egl_packages);
}

}  // namespace render
