#include "render/gl/gpu.h"

#include <glm/gtc/type_ptr.hpp>

#include <stdexcept>
#include <vector>

namespace render {
namespace {

GLuint compile(const Gl& gl, GLenum kind, std::string_view name, const std::string& source) {
  const GLuint shader = gl.CreateShader(kind);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint good = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  std::vector<char> log(4096);
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteShader(shader);
  throw std::runtime_error("shader " + std::string(name) + (kind == GL_VERTEX_SHADER ? ".vert" : ".frag") +
                           " does not compile:\n" + log.data());
}

}  // namespace

Program::Program(const Gl& gl, std::string_view name, const std::string& vertex, const std::string& fragment)
    : gl_(&gl) {
  const GLuint v = compile(gl, GL_VERTEX_SHADER, name, vertex);
  GLuint f = 0;
  try {
    f = compile(gl, GL_FRAGMENT_SHADER, name, fragment);
  } catch (...) {
    gl.DeleteShader(v);
    throw;
  }
  id_ = gl.CreateProgram();
  gl.AttachShader(id_, v);
  gl.AttachShader(id_, f);
  gl.LinkProgram(id_);
  gl.DeleteShader(v);
  gl.DeleteShader(f);
  GLint good = 0;
  gl.GetProgramiv(id_, GL_LINK_STATUS, &good);
  if (good) return;
  std::vector<char> log(4096);
  gl.GetProgramInfoLog(id_, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteProgram(id_);
  throw std::runtime_error("shader " + std::string(name) + " does not link:\n" + log.data());
}

Program::~Program() { gl_->DeleteProgram(id_); }
void Program::use() const { gl_->UseProgram(id_); }
void Program::set(const char* name, float v) const { gl_->Uniform1f(gl_->GetUniformLocation(id_, name), v); }
void Program::set(const char* name, int v) const { gl_->Uniform1i(gl_->GetUniformLocation(id_, name), v); }
void Program::set(const char* name, const glm::vec2& v) const {
  gl_->Uniform2fv(gl_->GetUniformLocation(id_, name), 1, glm::value_ptr(v));
}
void Program::set(const char* name, const glm::vec3& v) const {
  gl_->Uniform3fv(gl_->GetUniformLocation(id_, name), 1, glm::value_ptr(v));
}
void Program::set(const char* name, const glm::mat4& v) const {
  gl_->UniformMatrix4fv(gl_->GetUniformLocation(id_, name), 1, GL_FALSE, glm::value_ptr(v));
}
void Program::set(const char* name, std::span<const glm::vec4> v) const {
  if (v.empty()) return;
  gl_->Uniform4fv(gl_->GetUniformLocation(id_, name), static_cast<GLsizei>(v.size()), glm::value_ptr(v[0]));
}

VertexArray::VertexArray(const Gl& gl) : gl_(&gl) {
  gl.GenVertexArrays(1, &id_);
  gl.GenBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  gl.GenBuffers(1, &index_buffer_);
}

VertexArray::~VertexArray() {
  gl_->DeleteBuffers(1, &index_buffer_);
  gl_->DeleteBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  gl_->DeleteVertexArrays(1, &id_);
}

void VertexArray::bind() const { gl_->BindVertexArray(id_); }

void VertexArray::attribute(GLuint location, std::span<const float> data, GLuint divisor) {
  upload(location, 1, std::as_bytes(data), divisor);
}
void VertexArray::attribute(GLuint location, std::span<const glm::vec2> data, GLuint divisor) {
  upload(location, 2, std::as_bytes(data), divisor);
}
void VertexArray::attribute(GLuint location, std::span<const glm::vec3> data, GLuint divisor) {
  upload(location, 3, std::as_bytes(data), divisor);
}
void VertexArray::attribute(GLuint location, std::span<const glm::vec4> data, GLuint divisor) {
  upload(location, 4, std::as_bytes(data), divisor);
}

void VertexArray::upload(GLuint location, int components, std::span<const std::byte> data, GLuint divisor) {
  bind();
  gl_->BindBuffer(GL_ARRAY_BUFFER, buffers_.at(location));
  gl_->BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size_bytes()), data.data(), GL_STREAM_DRAW);
  gl_->VertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl_->VertexAttribDivisor(location, divisor);
  gl_->EnableVertexAttribArray(location);
}

void VertexArray::indices(std::span<const std::uint32_t> data) {
  bind();
  gl_->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);
  gl_->BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size_bytes()), data.data(), GL_STATIC_DRAW);
}

Palette::Palette(const Gl& gl) : gl_(&gl) {
  gl.GenTextures(1, &id_);
  bind();
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
}

Palette::~Palette() { gl_->DeleteTextures(1, &id_); }
void Palette::bind() const { gl_->BindTexture(GL_TEXTURE_2D, id_); }

void Palette::fill(std::span<const std::array<std::uint8_t, 3>> colours) {
  bind();
  gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, static_cast<GLsizei>(colours.size()), 1, 0, GL_RGB, GL_UNSIGNED_BYTE,
                  colours.data());
}

Framebuffer::Framebuffer(const Gl& gl, int width, int height) : gl_(&gl), width_(width), height_(height) {
  GLint largest = 0;
  gl.GetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  if (width > largest || height > largest)
    throw std::runtime_error("the driver draws at most " + std::to_string(largest) + " samples a side, not " + size +
                             ": lower view.size or view.supersampling");
  gl.GenFramebuffers(1, &id_);
  gl.GenRenderbuffers(1, &colour_);
  gl.GenRenderbuffers(1, &depth_);
  gl.BindRenderbuffer(GL_RENDERBUFFER, colour_);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  gl.BindRenderbuffer(GL_RENDERBUFFER, depth_);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
  gl.BindFramebuffer(GL_FRAMEBUFFER, id_);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    gl.DeleteRenderbuffers(1, &depth_);
    gl.DeleteRenderbuffers(1, &colour_);
    gl.DeleteFramebuffers(1, &id_);
    throw std::runtime_error("the driver cannot make a framebuffer of " + size);
  }
}

Framebuffer::~Framebuffer() {
  gl_->DeleteRenderbuffers(1, &depth_);
  gl_->DeleteRenderbuffers(1, &colour_);
  gl_->DeleteFramebuffers(1, &id_);
}

void Framebuffer::bind() const {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, id_);
  gl_->Viewport(0, 0, width_, height_);
}

void Framebuffer::read(Image& into) const {
  if (into.width != width_ || into.height != height_ || into.channels != 4) into = Image(width_, height_, 4);
  gl_->PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_->ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, into.pixels.data());
}

}  // namespace render
