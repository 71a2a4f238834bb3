// Styles: how a membrane is painted. One row a style; each becomes a variant of the shader body.frag.
#pragma once

#include "palette.h"
#include "parameters.h"

#include "sim/catalogue.h"

namespace render {

struct StyleRow {
  std::string_view name;
  std::string_view meaning;
  std::string_view defines;  ///< words that body.frag knows, separated by spaces
  bool grid;                 ///< lines on the membrane
  bool tracers;              ///< dots, when the view wants them
  bool own_colour;           ///< the vesicle's colour; otherwise the ground's
  bool see_through = false;  ///< drawn in order of depth, back faces too
  bool field = false;        ///< painted by Mesh::scalar on Frame::legend
  bool cut = false;          ///< opened by Body::cut
};
const std::vector<StyleRow>& styles();
/// Throws std::invalid_argument that names the nearest known style.
const StyleRow& find_style(std::string_view name);

/// The #define lines of body.frag for this view; `tracers` dots.
std::string body_defines(const StyleRow& style, const ViewParameters& view, std::size_t tracers);

}  // namespace render
