#include "render/draw/draw.h"

#include "render/core/assets.h"
#include "render/core/paint.h"
#include "render/core/places.h"
#include "render/core/style.h"
#include "render/draw/arrow_shape.h"
#include "render/draw/clearance.h"
#include "render/draw/draw_values.h"
#include "render/overlay/layout.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace render {
namespace {

void check(const ViewParameters& view) {
  if (view.size.size() != 2 || view.size[0] < 1 || view.size[1] < 1)
    throw std::invalid_argument("view.size needs a width and a height of at least 1 px");
  if (view.supersampling < 1) throw std::invalid_argument("view.supersampling must be at least 1");
}

}  // namespace

Renderer::Renderer(const GlChoice& choice, std::filesystem::path shader_dir)
    : context_(choice),
      shader_dir_(std::move(shader_dir)),
      nothing_(context_.gl()),
      bodies_(context_.gl()),
      hulls_(context_.gl()),
      sections_(context_.gl()),
      ribbons_(context_.gl()),
      arrows_(context_.gl()),
      beads_(context_.gl()),
      palette_(context_.gl()) {
  for (const auto& [array, shape] : {std::pair{&arrows_, arrow_shape()}, std::pair{&beads_, bead_shape()}}) {
    array->attribute(0, shape.position);
    array->attribute(1, shape.normal);
  }
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
  const auto text = [&](const std::string& file) {
    std::string whole = "#version 330 core\n" + light_defines() + defines;
    for (const std::string& library : shader_libraries(file)) whole += shader_text(library, shader_dir_);
    return whole + shader_text(file, shader_dir_);
  };
  return programs_.try_emplace(key, context_.gl(), name, text(name + ".vert"), text(name + ".frag")).first->second;
}

void Renderer::begin(const Frame& frame) {
  context_.make_current();
  const Gl& gl = context_.gl();
  const int width = frame.view.size[0] * frame.view.supersampling,
            height = frame.view.size[1] * frame.view.supersampling;
  if (!framebuffer_ || framebuffer_->width() != width || framebuffer_->height() != height) {
    framebuffer_.reset();
    constexpr std::size_t of_sample =
        16;  // bytes: colour and depth, the copy that is read back, and as much again for the driver
    require_memory(of_sample * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    framebuffer_.emplace(gl, width, height);
  }
  framebuffer_->bind();
  gl.ClearColor(0, 0, 0, 0);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.Enable(GL_CULL_FACE);
  gl.FrontFace(GL_CCW);
  gl.CullFace(GL_BACK);
}

// Premultiplied over a transparent ground: the alphas add up as coverages do.
void Renderer::start_blending() {
  context_.gl().Enable(GL_BLEND);
  context_.gl().BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

void Renderer::draw_ground(const Frame& frame) {
  if (ground_of(frame.view.background).transparent) return;
  const Gl& gl = context_.gl();
  const Program& p = program("ground", "");
  p.use();
  set_ground(p, frame);
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
  if (!std::isfinite(fastest)) return;
  const bool rests = fastest <= 0;
  if (rests && !frame.camera.follows) return;

  const Camera& camera = frame.camera;
  const std::vector<Shadow> bodies = shadows(frame);
  const auto place_of = [&](const glm::dvec3& point) {
    return camera.picture_place(point) * glm::dvec2(camera.half_width / camera.half_height, 1);
  };
  const std::vector<Box> overlays = lay_out(frame, font_).boxes();
  std::vector<glm::vec4> starts;
  std::vector<glm::vec3> vectors;
  std::vector<EndOn> end_on;
  for (Eigen::Index i = 0; i < flow.points.rows(); ++i) {
    const glm::dvec3 v = rests ? glm::dvec3(0) : to_glm(flow.velocities.row(i)) / fastest;
    const glm::dvec3 middle = to_glm(flow.points.row(i)), arrow = v * longest_arrow * camera.half_height;
    if (!rests && !(glm::length(v) >= weakest_arrow)) continue;
    // Both ends and the middle: a long arrow reaches over a narrow overlay.
    double beside = 1;
    for (const double share : {-0.5, 0.0, 0.5})
      beside = std::min(beside, clear_of(overlays, camera.picture_place(middle + share * arrow), frame.view.size));
    if (!camera.follows) beside = beside > 0.6;  // arrows at rest are there or not: a faint one looks like a flaw
    const double shown =
        flow.shown * beside * clear_of_bodies(bodies, place_of(middle - arrow / 2.0), place_of(middle + arrow / 2.0));
    if (shown <= 0) continue;
    if (!rests) {
      const glm::dvec3 sight = camera.perspective ? camera.eye - middle : camera.eye - camera.target;
      const double along = glm::dot(arrow, sight) / (glm::length(arrow) * glm::length(sight));
      const double as_ring = glm::smoothstep(0.94, 0.96, std::abs(along));
      if (as_ring > 0)
        end_on.push_back({middle, end_on_radius * glm::length(arrow), along > 0, static_cast<float>(shown * as_ring)});
      if (as_ring >= 1) continue;
      starts.emplace_back(glm::vec3(camera.place(middle)), shown * (1 - as_ring));
      vectors.emplace_back(arrow / camera.half_height);
      continue;
    }
    starts.emplace_back(glm::vec3(camera.place(middle)), shown);
    vectors.emplace_back(arrow / camera.half_height);
  }
  if (starts.empty()) return draw_end_on(frame, end_on);
  const Gl& gl = context_.gl();
  const Program& p = program("arrow", rests ? "#define BEAD\n" : "");
  p.use();
  set_camera(p, camera);
  set_ground(p, frame);
  p.set("u_colour", linear(inks_on(ground_of(frame.view.background)).arrow));
  p.set("u_height", static_cast<float>(framebuffer_->height()));
  p.set("u_thickness", static_cast<float>(arrow_thickness));
  VertexArray& shape = rests ? beads_ : arrows_;
  shape.attribute(2, starts, 1);
  if (!rests) shape.attribute(3, vectors, 1);
  shape.bind();
  gl.DrawArraysInstanced(GL_TRIANGLES, 0, rests ? bead_shape_vertices : arrow_shape_vertices,
                         static_cast<GLsizei>(starts.size()));
  gl.Clear(
      GL_DEPTH_BUFFER_BIT);  // arrows stand behind everything, though the plane they show goes through the vesicles
  draw_end_on(frame, end_on);
}

Image Renderer::finish(const Frame& frame) {
  framebuffer_->read(samples_);
  if (const GLenum error = context_.gl().GetError(); error != GL_NO_ERROR)
    throw std::runtime_error("OpenGL reports error " + std::to_string(error) + " (" + information().renderer + ")");
  return ground_of(frame.view.background).transparent
             ? downsample_transparent(samples_, frame.view.supersampling, RowOrder::bottom_first)
             : downsample(samples_, frame.view.supersampling, RowOrder::bottom_first);
}

Image draw_frame(Renderer& renderer, const Frame& frame) {
  check(frame.view);
  renderer.begin(frame);
  renderer.draw_ground(frame);
  renderer.draw_arrows(frame);
  if (!find_style(frame.view.style).cut) renderer.draw_flow_lines(frame);
  renderer.draw_faces(frame, false);
  renderer.draw_bodies(frame);
  renderer.draw_faces(frame, true);
  Image image = renderer.finish(frame);
  draw_captions(image, renderer.font_, frame);
  return image;
}

}  // namespace render
