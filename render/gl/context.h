// An OpenGL 3.3 core context without a window, by OSMesa or EGL, both opened at run time: the program starts and
// simulates on machines that have neither. Nothing is ever drawn to the context's own framebuffer.
#pragma once

#include "render/gl/gl.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace render {

/// The choice made by `--gl`.
struct GlChoice {
  std::string kind = "auto";  ///< a row of gl_choices()
  int device = -1;            ///< egl:N
};

struct GlChoiceRow {
  std::string_view name;
  std::string_view meaning;
};
/// auto, osmesa, egl, egl:N, software with their meanings.
const std::vector<GlChoiceRow>& gl_choices();
/// Throws std::invalid_argument that lists the choices.
GlChoice parse_gl_choice(std::string_view word);

/// For logs and for the text chunks of pictures.
struct GlInformation {
  std::string back_end;   ///< "OSMesa", "EGL device 0", "EGL surfaceless"
  std::string renderer;   ///< GL_RENDERER
  std::string version;    ///< GL_VERSION
  bool software = false;  ///< software rasteriser: pictures are the same on every machine
};

/// Throws std::runtime_error with one sentence when so much address space is not available. Drivers do not handle
/// this: they crash or print cryptic messages on standard error.
void require_memory(std::size_t bytes);

/// A context and its functions. Current on the thread that opened it; make_current() before drawing when there are
/// several.
class GlContext {
 public:
  /// Throws std::runtime_error: one sentence, with the Debian package when a library is missing.
  explicit GlContext(const GlChoice& choice = {});
  ~GlContext();
  GlContext(GlContext&&) noexcept;
  GlContext(const GlContext&) = delete;

  void make_current() const;
  const Gl& gl() const { return gl_; }
  const GlInformation& information() const { return information_; }

  /// What a back end supplies: its object and the functions on it.
  struct BackEnd {
    std::shared_ptr<void> object;  ///< destroys the context with the last reference
    bool (*make_current)(void*) = nullptr;
    GlFunction (*look_up)(const char*) = nullptr;
    std::string name;
  };

 private:
  BackEnd back_end_;
  Gl gl_;
  GlInformation information_;
};

}  // namespace render
