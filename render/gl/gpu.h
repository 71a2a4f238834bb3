// OpenGL objects: programs, vertex arrays, the framebuffer. Each frees itself; the context that made them must be
// current and alive.
#pragma once

#include "render/gl/gl.h"
#include "render/image/image.h"

#include <glm/glm.hpp>

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace render {

/// A compiled pair of shaders.
class Program {
 public:
  /// Throws std::runtime_error with `name` and the compiler's message.
  Program(const Gl& gl, std::string_view name, const std::string& vertex, const std::string& fragment);
  ~Program();
  Program(const Program&) = delete;

  void use() const;
  // Uniforms of the program in use; names missing in the shader are ignored, since variants drop some.
  void set(const char* name, float v) const;
  void set(const char* name, int v) const;
  void set(const char* name, const glm::vec2& v) const;
  void set(const char* name, const glm::vec3& v) const;
  void set(const char* name, const glm::mat4& v) const;
  void set(const char* name, std::span<const glm::vec4> v) const;

 private:
  const Gl* gl_;
  GLuint id_ = 0;
};

/// Vertex array with one buffer per float attribute, refilled for every body.
class VertexArray {
 public:
  explicit VertexArray(const Gl& gl);
  ~VertexArray();
  VertexArray(const VertexArray&) = delete;

  void bind() const;
  /// Attribute `location` takes one element of `data` per vertex; divisor 1: one per instance.
  void attribute(GLuint location, std::span<const float> data, GLuint divisor = 0);
  void attribute(GLuint location, std::span<const glm::vec2> data, GLuint divisor = 0);
  void attribute(GLuint location, std::span<const glm::vec3> data, GLuint divisor = 0);
  void attribute(GLuint location, std::span<const glm::vec4> data, GLuint divisor = 0);
  void indices(std::span<const std::uint32_t> data);

 private:
  void upload(GLuint location, int components, std::span<const std::byte> data, GLuint divisor);
  static constexpr std::size_t attributes = 12;
  const Gl* gl_;
  GLuint id_ = 0, index_buffer_ = 0;
  std::array<GLuint, attributes> buffers_{};
};

/// One row of RGB texels, read by texelFetch from texture unit 0.
class Palette {
 public:
  explicit Palette(const Gl& gl);
  ~Palette();
  Palette(const Palette&) = delete;

  void fill(std::span<const std::array<std::uint8_t, 3>> colours);
  void bind() const;

 private:
  const Gl* gl_;
  GLuint id_ = 0;
};

/// RGBA8 + depth. The shaders encode sRGB; an sRGB target would give results that depend on the processor.
class Framebuffer {
 public:
  /// Throws std::runtime_error when the driver cannot make one that large.
  Framebuffer(const Gl& gl, int width, int height);
  ~Framebuffer();
  Framebuffer(const Framebuffer&) = delete;

  void bind() const;
  int width() const { return width_; }
  int height() const { return height_; }
  /// RGBA, bottom row first.
  void read(Image& into) const;

 private:
  const Gl* gl_;
  int width_, height_;
  GLuint id_ = 0, colour_ = 0, depth_ = 0;
};

}  // namespace render
