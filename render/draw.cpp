#include "draw.h"

#include "arrow_shape.h"
#include "assets.h"
#include "style.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace render {
namespace {

constexpr double tracer_radius = 0.088;                          // area radii
constexpr double longest_arrow = 0.21, arrow_thickness = 0.009;  // half heights of the picture
constexpr double weakest_arrow = 0.06;                           // of the longest; shorter ones are left out

glm::vec3 vector_of(const Colour& c) { return {c.r, c.g, c.b}; }

glm::vec3 linear(const Colour& c) {
  const auto decode = [](double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); };
  return {decode(c.r), decode(c.g), decode(c.b)};
}

// px at a height of 1080 in samples of this picture, at least `least` px wide however small it is.
float samples(const ViewParameters& view, double px, double least) {
  return static_cast<float>(view.supersampling * std::max(px * view.size[1] / 1080.0, std::min(px, least)));
}

// 0 under the captions, 1 elsewhere, smooth between: a passing arrow shrinks away instead of vanishing at once.
// place: scene coordinates.
double clear_of_captions(const Camera& camera, const glm::vec3& place) {
  const glm::vec4 clip = camera.projection * (camera.view * glm::vec4(place, 1));
  const double x = clip.x / clip.w, y = clip.y / clip.w;  // -1..1
  constexpr double ramp = 0.12;
  const double outside = std::max((x + 0.60) / ramp, std::min((0.72 - y) / ramp, (y + 0.78) / 0.06));
  const double t = std::clamp(outside, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

void check(const ViewParameters& view) {
  if (view.size.size() != 2 || view.size[0] < 1 || view.size[1] < 1)
    throw std::invalid_argument("view.size needs a width and a height of at least 1 px");
  if (view.supersampling < 1) throw std::invalid_argument("view.supersampling must be at least 1");
}

void set_camera(const Program& program, const Camera& camera) {
  program.set("u_view", camera.view);
  program.set("u_projection", camera.projection);
  program.set("u_perspective", camera.perspective ? 1 : 0);
}

}  // namespace

Renderer::Renderer(const GlChoice& choice, std::filesystem::path shader_dir)
    : context_(choice),
      shader_dir_(std::move(shader_dir)),
      nothing_(context_.gl()),
      bodies_(context_.gl()),
      arrows_(context_.gl()) {
  const ArrowShape shape = arrow_shape();
  arrows_.attribute(0, shape.position);
  arrows_.attribute(1, shape.normal);
}

// Programs and buffers are about to be freed, and must be freed in their own context.
Renderer::~Renderer() {
  try {
    context_.make_current();
  } catch (const std::runtime_error&) {
    return;  // the driver is gone, and its objects with it
  }
}

PngText Renderer::metadata() const {
  return {{"back_end", information().back_end},
          {"GL_RENDERER", information().renderer},
          {"GL_VERSION", information().version}};
}

const Program& Renderer::program(const std::string& name, const std::string& defines) {
  const std::string key = name + "\n" + defines;
  if (const auto found = programs_.find(key); found != programs_.end()) return found->second;
  const std::string head = "#version 330 core\n" + defines;
  std::string library;
  if (name == "body" || name == "arrow") library += shader_text("light.glsl", shader_dir_);
  if (name == "body") library += shader_text("lines.glsl", shader_dir_);
  return programs_
      .try_emplace(key, context_.gl(), name, head + shader_text(name + ".vert", shader_dir_),
                   head + library + shader_text(name + ".frag", shader_dir_))
      .first->second;
}

void Renderer::begin(const Frame& frame) {
  context_.make_current();
  const Gl& gl = context_.gl();
  const int width = frame.view.size[0] * frame.view.supersampling,
            height = frame.view.size[1] * frame.view.supersampling;
  if (!framebuffer_ || framebuffer_->width() != width || framebuffer_->height() != height) {
    framebuffer_.reset();
    framebuffer_.emplace(gl, width, height);
  }
  framebuffer_->bind();
  gl.ClearColor(1, 1, 1, 1);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.Enable(GL_CULL_FACE);
  gl.FrontFace(GL_CCW);
  gl.CullFace(GL_BACK);
}

void Renderer::draw_ground(const Frame& frame) {
  if (frame.view.background == "white") return;
  const Gl& gl = context_.gl();
  const Program& p = program("ground", "");
  p.use();
  p.set("u_top", vector_of(ground_top));
  p.set("u_bottom", vector_of(ground_bottom));
  nothing_.bind();
  gl.Disable(GL_DEPTH_TEST);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.Enable(GL_DEPTH_TEST);
}

void Renderer::draw_arrows(const Frame& frame) {
  const FlowArrows& flow = frame.arrows;
  if (!frame.view.flow_arrows || flow.points.rows() == 0) return;
  double fastest = flow.reference_speed;
  if (fastest <= 0) fastest = flow.velocities.rowwise().norm().maxCoeff();
  if (!(fastest > 0) || !std::isfinite(fastest)) return;
  std::vector<glm::vec3> starts, vectors;
  for (Eigen::Index i = 0; i < flow.points.rows(); ++i) {
    const glm::dvec3 v = to_glm(flow.velocities.row(i)) / fastest;
    if (!(glm::length(v) >= weakest_arrow)) continue;
    const glm::vec3 start = to_glm(flow.points.row(i));
    const double size = longest_arrow * frame.camera.half_height * clear_of_captions(frame.camera, start);
    if (size <= 0) continue;
    starts.push_back(start);
    vectors.emplace_back(v * size);
  }
  if (starts.empty()) return;
  const Gl& gl = context_.gl();
  const Program& p = program("arrow", "");
  p.use();
  set_camera(p, frame.camera);
  p.set("u_colour", linear(arrow_colour));
  p.set("u_thickness", static_cast<float>(arrow_thickness * frame.camera.half_height));
  arrows_.attribute(2, starts, 1);
  arrows_.attribute(3, vectors, 1);
  gl.DrawArraysInstanced(GL_TRIANGLES, 0, arrow_shape_vertices, static_cast<GLsizei>(starts.size()));
}

void Renderer::draw_body(const Frame& frame, const Body& body) {
  const Gl& gl = context_.gl();
  const StyleRow& style = find_style(frame.view.style);
  const std::vector<Mesh::Tracer>& tracers = body.mesh.tracers;
  const Program& p = program("body", body_defines(style, frame.view, tracers.size()));
  p.use();
  set_camera(p, frame.camera);
  const glm::vec3 colour = linear(style.own_colour ? body.colour : white);
  p.set("u_colour", colour);
  p.set("u_line_colour", 0.10F * colour + glm::vec3(0.012F, 0.015F, 0.022F));
  p.set("u_half_width", samples(frame.view, frame.view.line_width / 2, 0.42));
  if (style.tracers && frame.view.tracers && !tracers.empty()) {
    std::vector<glm::vec4> places;
    for (const Mesh::Tracer& t : tracers)
      places.emplace_back(glm::vec3(frame.camera.view * glm::vec4(t.position, 1)), t.bright ? 1.0F : 0.0F);
    p.set("u_tracer", places);
    p.set("u_tracer_bright", linear(tracer_bright));
    p.set("u_tracer_dark", linear(tracer_dark));
    bodies_.attribute(3, nearest_tracers(body.mesh));
    p.set("u_tracer_radius", static_cast<float>(tracer_radius * body.mesh.area_radius));
  }
  bodies_.attribute(0, body.mesh.position);
  bodies_.attribute(1, body.mesh.normal);
  bodies_.attribute(2, frame.view.lines == "grid" ? body.mesh.plan->parameters() : body.mesh.label);
  if (uploaded_plan_ != body.mesh.plan) {
    bodies_.indices(body.mesh.plan->indices());
    uploaded_plan_ = body.mesh.plan;
  }
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(body.mesh.plan->indices().size()), GL_UNSIGNED_INT, nullptr);
}

// Follows draw_body() of the same body, whose vertices it draws again.
void Renderer::draw_outline(const Frame& frame, const Body& body) {
  if (frame.view.outline_width <= 0) return;
  const Gl& gl = context_.gl();
  const Program& p = program("outline", "");
  p.use();
  set_camera(p, frame.camera);
  const float width = samples(frame.view, frame.view.outline_width, 1.0);
  p.set("u_push", glm::vec2(2 * width / static_cast<float>(framebuffer_->width()),
                                  2 * width / static_cast<float>(framebuffer_->height())));
  const Colour dark{0.10 + 0.08 * body.colour.r, 0.11 + 0.08 * body.colour.g, 0.14 + 0.08 * body.colour.b};
  p.set("u_colour", vector_of(dark));
  gl.CullFace(GL_FRONT);
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(body.mesh.plan->indices().size()), GL_UNSIGNED_INT, nullptr);
  gl.CullFace(GL_BACK);
}

Image Renderer::finish(const Frame& frame) {
  framebuffer_->read(samples_);
  if (const GLenum error = context_.gl().GetError(); error != GL_NO_ERROR)
    throw std::runtime_error("OpenGL reports error " + std::to_string(error) + " (" + information().renderer + ")");
  return downsample(samples_, frame.view.supersampling, RowOrder::bottom_first);
}

Image draw_frame(Renderer& renderer, const Frame& frame) {
  check(frame.view);
  renderer.begin(frame);
  renderer.draw_ground(frame);
  renderer.draw_arrows(frame);
  for (const Body& body : frame.bodies) {
    renderer.draw_body(frame, body);
    renderer.draw_outline(frame, body);
  }
  Image image = renderer.finish(frame);
  draw_captions(image, renderer.font_, frame);
  return image;
}

}  // namespace render
