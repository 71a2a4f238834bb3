// Many membranes as the arrays of one draw: what differs from one to the next comes with the vertices.
#pragma once

#include "render/core/ground.h"
#include "render/core/style.h"
#include "render/scene/detail.h"
#include "render/scene/frame.h"

#include <cstdint>
#include <tuple>
#include <vector>

namespace render {

/// One element per vertex; arrays that the variant does not need are empty.
struct Batch {
  std::vector<glm::vec3> position, normal, label;  ///< places of the camera
  std::vector<glm::vec4> dot, next_dot;            ///< nearest tracers: eye space, w: 1 bright, 0 dark, -1 none
  std::vector<glm::vec4> paint;                    ///< linear colour; share of the contour's width
  std::vector<glm::vec4> detail;                   ///< weights of all and of few lines; radius and weight of tracers
  std::vector<float> scalar;                       ///< share of the colour bar
  std::vector<glm::vec4> cut;                      ///< half space that is taken away
  std::vector<float> from_contour;                 ///< samples
  std::vector<glm::vec3> contour;                  ///< sRGB
  std::vector<glm::vec2> light;                    ///< shares of sky and key light
  std::vector<std::uint32_t> indices;              ///< three a triangle
};

/// How the bodies of a batch are painted: one variant of the shader each.
struct Variant {
  bool grid = true;     ///< lines
  bool sparse = false;  ///< lines that fade to a few
  bool tracers = true;
  bool sign_dots = false;
  bool occluded = false;
  bool boxed = false;  ///< ends at the faces of Frame::faces
  /// An order for maps.
  friend bool operator<(const Variant& a, const Variant& b) {
    return std::tie(a.grid, a.sparse, a.tracers, a.sign_dots, a.occluded, a.boxed) <
           std::tie(b.grid, b.sparse, b.tracers, b.sign_dots, b.occluded, b.boxed);
  }
};
Variant variant_of(const Frame& frame, const Body& body, const Detail& detail);

/// Detail of a body as the frame shows it.
Detail detail_in(const Frame& frame, const Body& body);

/// Of its outline, sRGB: dark, on dark ground light, with a share of the membrane's own colour.
Colour outline_colour(const Frame& frame, const Body& body);

/// Appends a body; `with_triangles`: of its mesh. samples_high: height of the picture in samples. Throws
/// std::invalid_argument when the style is "field" and the body has none.
void append(Batch& batch, const Frame& frame, const Body& body, const Detail& detail, const Variant& variant,
            int samples_high, bool with_triangles);

}  // namespace render
