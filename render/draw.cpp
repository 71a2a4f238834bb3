#include "draw.h"

#include "arrow_shape.h"
#include "assets.h"
#include "depth_order.h"
#include "style.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace render {
namespace {

constexpr double tracer_radius = 0.088;                          // area radii
constexpr double longest_arrow = 0.21, arrow_thickness = 0.009;  // half heights of the picture
constexpr double weakest_arrow = 0.10;                           // of the longest; shorter ones are left out

glm::vec3 vector_of(const Colour& c) { return {c.r, c.g, c.b}; }

glm::vec3 linear(const Colour& c) {
  const auto decode = [](double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); };
  return {decode(c.r), decode(c.g), decode(c.b)};
}

// px at a height of 1080 in samples of this picture, at least `least` px wide however small it is.
float samples(const ViewParameters& view, double px, double least) {
  return static_cast<float>(view.supersampling * std::max(px * view.size[1] / 1080.0, std::min(px, least)));
}

// The membranes as the picture shows them: points in half heights of the picture, dense enough for distances to them.
std::vector<glm::dvec2> shadows(const Frame& frame) {
  constexpr int stride = 2;  // of the mesh: 48 x 96 points
  std::vector<glm::dvec2> places;
  for (const Body& body : frame.bodies) {
    const int rings = body.mesh.plan->latitudes() - 1, columns = body.mesh.plan->longitudes();
    for (int j = 0; j < columns; j += stride)
      for (int i = 0; i < rings; i += stride) {
        const glm::dvec2 place = frame.camera.picture_place(body.mesh.position[static_cast<std::size_t>(j * rings + i)]);
        places.emplace_back(place.x * frame.camera.half_width / frame.camera.half_height, place.y);
      }
  }
  return places;
}

// 0 when the segment touches a membrane's shadow, 1 when it is well away: half an arrow beside a contour looks like
// something that belongs to the vesicle.
double clear_of_bodies(const std::vector<glm::dvec2>& shadows, const glm::dvec2& tail, const glm::dvec2& tip) {
  constexpr double near = 0.03, far = 0.055;  // half heights
  const glm::dvec2 along = tip - tail;
  const double length2 = std::max(glm::dot(along, along), 1e-12);
  double nearest2 = far * far;
  for (const glm::dvec2& p : shadows) {
    const glm::dvec2 away = p - tail - along * std::clamp(glm::dot(p - tail, along) / length2, 0.0, 1.0);
    nearest2 = std::min(nearest2, glm::dot(away, away));
  }
  return glm::smoothstep(near, far, std::sqrt(nearest2));
}

// 0 where the colour bar, axes, profile or inset stand, 1 elsewhere, smooth between; place as Camera::picture_place() gives it.
double clear_of_annotation(const Frame& frame, const glm::dvec2& place) {
  constexpr double ramp = 0.10;  // half heights, as all lengths here
  const double aspect = frame.camera.half_width / frame.camera.half_height;
  const double from_left = (1 + place.x) * aspect, from_right = (1 - place.x) * aspect;
  double clear = 1;
  const auto keep = [&](bool shown, double x, double low, double high) {  // x: how far beyond the annotation's inner edge
    if (!shown) return;
    const double outside = std::max({x, low - place.y, place.y - high}) / ramp;
    clear = std::min(clear, glm::smoothstep(0.0, 1.0, outside));
  };
  keep(frame.legend && frame.view.colour_bar, from_right - 0.42, -0.52, 0.68);
  keep(frame.view.triad, from_right - 0.45, -1, -0.62);
  keep(frame.inset && frame.view.inset, from_right - 0.72, 0.48, 1);
  keep(frame.profile && frame.view.flow_profile, from_left - 0.25 * aspect, -0.72, 0.78);
  const double from_middle = std::abs(place.x) * aspect;
  keep(!frame.captions.title.empty(), from_middle - 0.8, 0.80, 1);
  keep(!frame.captions.panel.empty(), from_middle - 0.35, -1, -0.80);
  return clear;
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

void set_ground(const Program& program, const Frame& frame) {
  const bool is_white = frame.view.background == "white";
  program.set("u_top", vector_of(is_white ? white : ground_top));
  program.set("u_bottom", vector_of(is_white ? white : ground_bottom));
}

Colour outline_colour(const Body& body) {
  return {0.10 + 0.08 * body.colour.r, 0.11 + 0.08 * body.colour.g, 0.14 + 0.08 * body.colour.b};
}

}  // namespace

Renderer::Renderer(const GlChoice& choice, std::filesystem::path shader_dir)
    : context_(choice),
      shader_dir_(std::move(shader_dir)),
      nothing_(context_.gl()),
      bodies_(context_.gl()),
      hulls_(context_.gl()),
      ghosts_(context_.gl()),
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
  return {
      {"back_end", information().back_end}, {"GL_RENDERER", information().renderer}, {"GL_VERSION", information().version}};
}

const Program& Renderer::program(const std::string& name, const std::string& defines) {
  const std::string key = name + "\n" + defines;
  if (const auto found = programs_.find(key); found != programs_.end()) return found->second;
  const std::string head = "#version 330 core\n" + defines;
  std::string library;
  if (name == "body" || name == "arrow") library += shader_text("light.glsl", shader_dir_);
  if (name == "ground" || name == "arrow") library += shader_text("ground.glsl", shader_dir_);
  if (name == "body") library += shader_text("lines.glsl", shader_dir_);
  return programs_
      .try_emplace(key, context_.gl(), name, head + shader_text(name + ".vert", shader_dir_),
                   head + library + shader_text(name + ".frag", shader_dir_))
      .first->second;
}

void Renderer::begin(const Frame& frame) {
  context_.make_current();
  const Gl& gl = context_.gl();
  const int width = frame.view.size[0] * frame.view.supersampling, height = frame.view.size[1] * frame.view.supersampling;
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
  const std::vector<glm::dvec2> bodies = shadows(frame);
  const auto place_of = [&](const glm::dvec3& point) {
    return camera.picture_place(point) * glm::dvec2(camera.half_width / camera.half_height, 1);
  };
  std::vector<glm::vec4> starts;
  std::vector<glm::vec3> vectors;
  for (Eigen::Index i = 0; i < flow.points.rows(); ++i) {
    const glm::dvec3 v = rests ? glm::dvec3(0) : to_glm(flow.velocities.row(i)) / fastest;
    const glm::dvec3 middle = to_glm(flow.points.row(i)), arrow = v * longest_arrow * camera.half_height;
    if (!rests && !(glm::length(v) >= weakest_arrow)) continue;
    const double shown = flow.shown * clear_of_captions(camera.picture_place(middle)) *
                         clear_of_annotation(frame, camera.picture_place(middle)) *
                         clear_of_bodies(bodies, place_of(middle - arrow / 2.0), place_of(middle + arrow / 2.0));
    if (shown <= 0) continue;
    starts.emplace_back(middle, shown);
    vectors.emplace_back(arrow);
  }
  if (starts.empty()) return;
  const Gl& gl = context_.gl();
  const Program& p = program("arrow", rests ? "#define BEAD\n" : "");
  p.use();
  set_camera(p, camera);
  set_ground(p, frame);
  p.set("u_colour", linear(arrow_colour));
  p.set("u_height", static_cast<float>(framebuffer_->height()));
  p.set("u_thickness", static_cast<float>(arrow_thickness * camera.half_height));
  VertexArray& shape = rests ? beads_ : arrows_;
  shape.attribute(2, starts, 1);
  if (!rests) shape.attribute(3, vectors, 1);
  shape.bind();
  gl.DrawArraysInstanced(GL_TRIANGLES, 0, rests ? bead_shape_vertices : arrow_shape_vertices,
                         static_cast<GLsizei>(starts.size()));
  gl.Clear(GL_DEPTH_BUFFER_BIT);  // arrows stand behind everything, though the plane they show goes through the vesicles
}

void Renderer::upload(const Body& body) {
  bodies_.attribute(0, body.mesh.position);
  bodies_.attribute(1, body.mesh.normal);
  if (uploaded_plan_ == body.mesh.plan) return;
  bodies_.indices(body.mesh.plan->indices());
  uploaded_plan_ = body.mesh.plan;
}

void Renderer::draw_body(const Frame& frame, const Body& body) {
  const Gl& gl = context_.gl();
  const StyleRow& style = find_style(frame.view.style);
  const std::vector<Mesh::Tracer>& tracers = body.mesh.tracers;
  const Program& p = program("body", body_defines(style, frame.view, tracers.size()));
  p.use();
  set_camera(p, frame.camera);
  if (style.field) {
    if (!frame.legend || body.mesh.scalar.size() != body.mesh.position.size())
      throw std::invalid_argument("the style 'field' needs a legend, and a scalar on every mesh");
    const double low = frame.legend->low, width = frame.legend->high - low;
    std::vector<float> shares;
    for (const float value : body.mesh.scalar) shares.push_back(static_cast<float>((value - low) / width));
    bodies_.attribute(6, shares);
    palette_.bind();
    p.set("u_map", 0);
  }
  if (style.cut) {
    const Cut cut = body.cut.value_or(Cut{{0, 0, 0}, 1, {}});  // of nothing
    p.set("u_cut", std::array{glm::vec4(cut.normal, -cut.height)});
    p.set("u_contour_width", samples(frame.view, frame.view.outline_width, 1.0));
  }
  const glm::vec3 colour = linear(style.own_colour ? body.colour : white);
  p.set("u_colour", colour);
  p.set("u_line_colour", 0.07F * colour + glm::vec3(0.010F, 0.012F, 0.018F));
  p.set("u_contour", vector_of(outline_colour(body)));
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
  upload(body);
  bodies_.attribute(2, frame.view.lines == "grid" ? body.mesh.plan->parameters() : body.mesh.label);
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(body.mesh.plan->indices().size()), GL_UNSIGNED_INT, nullptr);
}

void Renderer::draw_outline(const Frame& frame, const Body& body, OutlinePart part) {
  const Gl& gl = context_.gl();
  const Program& p = program("outline", "");
  const std::vector<std::uint32_t> rim = rim_triangles(body.mesh, frame.camera);
  p.use();
  set_camera(p, frame.camera);
  p.set("u_colour", vector_of(outline_colour(body)));
  hulls_.attribute(0, body.mesh.position);
  hulls_.attribute(1, body.mesh.normal);
  hulls_.indices(rim);
  gl.CullFace(GL_FRONT);
  const auto hull = [&](double more, double share) {
    const float width = samples(frame.view, frame.view.outline_width, 1.0) + static_cast<float>(more);
    p.set("u_push", glm::vec2(2 * width / static_cast<float>(framebuffer_->width()),
                              2 * width / static_cast<float>(framebuffer_->height())));
    p.set("u_alpha", static_cast<float>(share));
    gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(rim.size()), GL_UNSIGNED_INT, nullptr);
  };
  if (part == OutlinePart::core) hull(-1.0 / 3, 1);
  if (part == OutlinePart::edge) {
    hull(0, 1.0 / 2);
    hull(1.0 / 3, 1.0 / 3);
  }
  gl.CullFace(GL_BACK);
}

// All membranes in one draw, farthest triangle first.
void Renderer::draw_ghosts(const Frame& frame) {
  const Gl& gl = context_.gl();
  const StyleRow& style = find_style(frame.view.style);
  std::vector<glm::vec3> positions, normals, labels, colours;
  std::vector<glm::vec4> dots, next_dots;
  std::size_t tracers = 0;
  double radius = 0;
  for (const Body& body : frame.bodies) {
    const auto append = [](auto& all, const auto& some) { all.insert(all.end(), some.begin(), some.end()); };
    append(positions, body.mesh.position);
    append(normals, body.mesh.normal);
    append(labels, frame.view.lines == "grid" ? body.mesh.plan->parameters() : body.mesh.label);
    colours.resize(positions.size(), linear(style.own_colour ? body.colour : white));
    tracers = std::max(tracers, body.mesh.tracers.size());
    radius = std::max(radius, body.mesh.area_radius);
  }
  const bool dotted = style.tracers && frame.view.tracers && tracers > 0;
  if (dotted)
    for (const Body& body : frame.bodies) {
      const auto place = [&](float k) {
        if (k < 0) return glm::vec4(0, 0, 0, -1);
        const Mesh::Tracer& t = body.mesh.tracers[static_cast<std::size_t>(k)];
        return glm::vec4(glm::vec3(frame.camera.view * glm::vec4(t.position, 1)), t.bright ? 1 : 0);
      };
      for (const glm::vec2& nearest : nearest_tracers(body.mesh)) {
        dots.push_back(place(nearest.x));
        next_dots.push_back(place(nearest.y));
      }
    }
  const Program& p = program("body", body_defines(style, frame.view, tracers));
  p.use();
  set_camera(p, frame.camera);
  p.set("u_line_colour", glm::vec3(0.010F, 0.012F, 0.018F));
  p.set("u_contour", glm::vec3(0.10F, 0.11F, 0.14F));
  p.set("u_contour_width", samples(frame.view, frame.view.outline_width, 1.0));
  p.set("u_half_width", samples(frame.view, frame.view.line_width / 2, 0.42));
  p.set("u_opacity", static_cast<float>(frame.view.opacity));
  ghosts_.attribute(0, positions);
  ghosts_.attribute(1, normals);
  ghosts_.attribute(2, labels);
  ghosts_.attribute(5, colours);
  if (dotted) {
    ghosts_.attribute(3, dots);
    ghosts_.attribute(4, next_dots);
    p.set("u_tracer_bright", linear(tracer_bright));
    p.set("u_tracer_dark", linear(tracer_dark));
    p.set("u_tracer_radius", static_cast<float>(tracer_radius * radius));
  }
  const std::vector<std::uint32_t> triangles = back_to_front(frame.bodies, frame.camera);
  ghosts_.indices(triangles);
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(triangles.size()), GL_UNSIGNED_INT, nullptr);
  gl.Enable(GL_CULL_FACE);
  gl.Enable(GL_DEPTH_TEST);
  gl.Disable(GL_BLEND);
}

// The rims that the plane leaves: a bright core between two dark lines, like the membrane's thickness under a lens.
void Renderer::draw_cut_edges(const Frame& frame) {
  const Gl& gl = context_.gl();
  const Program& p = program("ribbon", "");
  const float line = samples(frame.view, std::max(frame.view.outline_width, 1.6), 1.0);
  const float core = 0.9F * line, half_width = core + 0.9F * line;
  const glm::dvec2 sample(2.0 / framebuffer_->width(), 2.0 / framebuffer_->height());  // clip units
  p.use();
  p.set("u_core", core);
  p.set("u_half_width", half_width);
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl.DepthMask(GL_FALSE);
  gl.Disable(GL_CULL_FACE);
  for (const Body& body : frame.bodies) {
    if (!body.cut) continue;
    p.set("u_colour", vector_of({0.5 + 0.5 * body.colour.r, 0.5 + 0.5 * body.colour.g, 0.5 + 0.5 * body.colour.b}));
    p.set("u_rim", vector_of(outline_colour(body)));
    for (const std::vector<glm::dvec3>& edge : body.cut->edges) {
      const std::size_t n = edge.size();
      if (n < 3) continue;
      std::vector<glm::dvec4> clips;
      for (const glm::dvec3& point : edge) {
        glm::dvec4 eye = glm::dmat4(frame.camera.view) * glm::dvec4(point, 1);
        eye.z += 0.004 * body.mesh.area_radius;  // in front of the membrane that it bounds
        clips.push_back(glm::dmat4(frame.camera.projection) * eye);
      }
      std::vector<glm::vec4> strip;
      std::vector<float> across;
      const float reach = half_width + 1;
      for (std::size_t k = 0; k <= n; ++k) {
        const glm::dvec4 &before = clips[(k + n - 1) % n], &here = clips[k % n], &after = clips[(k + 1) % n];
        const glm::dvec2 along = (glm::dvec2(after) / after.w - glm::dvec2(before) / before.w) / sample;
        const glm::dvec2 side = glm::dvec2(-along.y, along.x) / std::max(glm::length(along), 1e-9) * sample * here.w;
        for (const float sign : {-1.0F, 1.0F}) {
          strip.emplace_back(glm::dvec2(here) + static_cast<double>(sign * reach) * side, here.z, here.w);
          across.push_back(sign * reach);
        }
      }
      ribbons_.attribute(0, strip);
      ribbons_.attribute(1, across);
      gl.DrawArrays(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(strip.size()));
    }
  }
  gl.Enable(GL_CULL_FACE);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
}

void Renderer::draw_bodies(const Frame& frame) {
  const StyleRow& style = find_style(frame.view.style);
  if (style.see_through) return draw_ghosts(frame);
  if (style.field && frame.legend) palette_.fill(frame.legend->colours);
  if (style.cut) {
    const Gl& gl = context_.gl();
    gl.Enable(GL_CLIP_DISTANCE0);
    gl.Disable(GL_CULL_FACE);
    for (const Body& body : frame.bodies) draw_body(frame, body);
    gl.Disable(GL_CLIP_DISTANCE0);
    gl.Enable(GL_CULL_FACE);
    return draw_cut_edges(frame);
  }
  const bool outlined = frame.view.outline_width > 0;
  for (const Body& body : frame.bodies) {
    draw_body(frame, body);
    if (outlined) draw_outline(frame, body, OutlinePart::core);
  }
  if (!outlined) return;
  // Two hulls more make thirds of a sample at the outer edge. They let through what lies behind: all of that is there now.
  const Gl& gl = context_.gl();
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl.DepthMask(GL_FALSE);
  for (const Body& body : frame.bodies) draw_outline(frame, body, OutlinePart::edge);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
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
  renderer.draw_bodies(frame);
  Image image = renderer.finish(frame);
  draw_captions(image, renderer.font_, frame);
  return image;
}

}  // namespace render
