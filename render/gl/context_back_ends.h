// The back ends of GlContext: each opens its library and makes a context current, or throws.
#pragma once

#include "render/gl/context.h"

namespace render {

/// A library or a device is missing: the next back end may be tried.
struct GlUnavailable : std::exception {
  std::string sentence;
  explicit GlUnavailable(std::string s) : sentence(std::move(s)) {}
  const char* what() const noexcept override { return sentence.c_str(); }
};

/// File names to try, in this order.
using LibraryNames = std::vector<const char*>;
/// How to install EGL on Debian or Ubuntu; every release has these packages.
constexpr const char* egl_packages =
    "install the packages libegl1 and libgl1-mesa-dri (apt install libegl1 libgl1-mesa-dri)";

inline const LibraryNames osmesa_libraries{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
inline const LibraryNames egl_libraries{"libEGL.so.1", "libEGL.so"};

GlContext::BackEnd open_osmesa(const LibraryNames& names = osmesa_libraries);

enum class EglDevices { any, one, software };
/// device: index among the EGL devices for EglDevices::one.
GlContext::BackEnd open_egl(EglDevices which, int device, const LibraryNames& names = egl_libraries);

/// dlopen of the first of the names that exists; nullptr when none does. Never closed: drivers crash on that.
void* open_library(const LibraryNames& names);

}  // namespace render
