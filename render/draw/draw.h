// Draws a frame in passes: ground, arrows or streamlines, bodies with outlines, captions.
#pragma once

#include "render/draw/batch.h"
#include "render/gl/context.h"
#include "render/gl/gpu.h"
#include "render/overlay/overlay.h"
#include "render/scene/frame.h"

#include <filesystem>
#include <map>
#include <optional>

namespace render {

/// Everything that outlives a frame: context, compiled variants, buffers. One per thread at most; several contexts in
/// several threads are not faster (software rasterisers share one lock), so use processes.
class Renderer {
 public:
  /// shader_dir: read shaders from there instead of the embedded ones. Throws like GlContext.
  explicit Renderer(const GlChoice& choice = {}, std::filesystem::path shader_dir = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;

  const GlInformation& information() const { return context_.information(); }
  /// "back_end", "GL_RENDERER", "GL_VERSION" for the text chunks of pictures.
  PngText metadata() const;

 private:
  friend Image draw_frame(Renderer&, const Frame&);
  const Program& program(const std::string& name, const std::string& defines);
  void begin(const Frame&);
  void draw_ground(const Frame&);
  void draw_arrows(const Frame&);
  void draw_bodies(const Frame&);
  void draw_ghosts(const Frame&);
  void draw_cut_edges(const Frame&);
  void draw_flow_lines(const Frame&);
  /// Edges of frame.faces and sections of bodies by them: of the faces in front of all bodies, or of those behind.
  void draw_faces(const Frame&, bool in_front);
  /// An arrow of the flow along the line of sight.
  struct EndOn {
    glm::dvec3 place;
    double radius;  ///< lengths of the scene
    bool toward;    ///< the viewer
    float shown;    ///< 0 faded into the ground .. 1
  };
  void draw_end_on(const Frame&, const std::vector<EndOn>&);
  /// A strip along the points in the picture, `reach` samples to both sides, moved towards the eye by `nearer`.
  /// shown: 0 faded .. 1, one a point; empty: 1.
  void draw_ribbon(const Camera&, std::span<const glm::dvec3> points, bool closed, float reach, double nearer,
                   std::span<const float> shown = {});
  void start_blending();
  /// A program for membranes, in use, with the camera and what fades them set.
  const Program& use_for_bodies(const std::string& name, const Frame&, const std::string& defines);
  void upload(const Batch&);
  void draw_batch(const Frame&, const Batch&, const Variant&);
  void draw_solids(const Frame&);
  /// A core that hides what is behind it, and two translucent hulls that fade out in thirds of a sample.
  void draw_outlines(const Frame&);
  Image finish(const Frame&);

  GlContext context_;
  std::filesystem::path shader_dir_;
  std::map<std::string, Program> programs_;  ///< by name and defines
  VertexArray nothing_, bodies_, hulls_, sections_, ribbons_, arrows_, beads_;
  Palette palette_;
  std::optional<Framebuffer> framebuffer_;
  Image samples_;
  Font font_ = caption_font();
};

/// RGB picture of frame.view.size, or RGBA where the ground is transparent. The same frame gives the same bytes with
/// every software driver of one Mesa version. Throws std::runtime_error when the driver fails, std::invalid_argument
/// for an unknown style or a bad size.
Image draw_frame(Renderer& renderer, const Frame& frame);

}  // namespace render
