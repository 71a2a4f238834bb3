#include "render/gl/gl.h"

#include <stdexcept>
#include <string>

namespace render {

Gl load_gl(GlFunction (*look_up)(const char*)) {
  Gl gl;
#define RENDER_GL_LOAD(Type, Name)                       \
  gl.Name = reinterpret_cast<Type>(look_up("gl" #Name)); \
  if (!gl.Name) throw std::runtime_error("this OpenGL driver lacks gl" #Name);
  RENDER_GL_FUNCTIONS(RENDER_GL_LOAD)
#undef RENDER_GL_LOAD
  return gl;
}

}  // namespace render
