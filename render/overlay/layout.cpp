#include "render/overlay/layout.h"

#include "render/overlay/colour_bar.h"

#include <cairo.h>

#include <algorithm>
#include <cmath>

namespace render {
namespace {

/// Widths of text do not depend on where it is drawn.
class Ruler {
 public:
  explicit Ruler(const Font& font) : font_(font) {}
  Ruler(const Ruler&) = delete;
  ~Ruler() {
    cairo_destroy(cairo_);
    cairo_surface_destroy(surface_);
  }
  double width(double size, std::string_view text) const { return text_width(cairo_, font_, size, text); }
  /// As much of the text as has room, whole letters, with an ellipsis for the rest.
  std::string shortened(double size, std::string text, double room) const {
    if (width(size, text) <= room) return text;
    while (!text.empty()) {
      do text.pop_back();
      while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U);
      if (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0xC0U) text.pop_back();
      if (std::string whole = text + "…"; width(size, whole) <= room) return whole;
    }
    return {};
  }

 private:
  const Font& font_;
  cairo_surface_t* surface_ = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  cairo_t* cairo_ = cairo_create(surface_);
};

/// The words of a caption are "Ca = 100" and so on, three spaces apart: as many in a line as have room.
std::vector<std::string> lines_of(const Ruler& ruler, double size, const std::string& text, double room) {
  constexpr std::string_view between = "   ";
  std::vector<std::string> lines;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(between, at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!lines.empty() && ruler.width(size, lines.back() + std::string(between) + word) <= room)
      lines.back() += std::string(between) + word;
    else
      lines.push_back(word);
    at = end + between.size();
  }
  for (std::string& line : lines) line = ruler.shortened(size, line, room);
  return lines;
}

/// A layout under way: the picture, and how far what stands so far reaches.
struct Page {
  const Frame& frame;
  const Ruler ruler;
  OverlayLayout layout = {};
  double width = frame.view.size[0], height = frame.view.size[1];
  OverlaySizes s = overlay_sizes(frame.view.size[1]);
  double gap = 0.6 * s.small;
  double corner_bottom = 0;  ///< of the texts in the upper left corner
  double margin = std::min(s.margin, width / 12);

  Page(const Frame& f, const Font& font) : frame(f), ruler(font) {}
};

using Role = TextPlace::Role;

/// A line that would meet what stands already is left out: that happens in the smallest pictures only.
void add_line(Page& p, Role role, const std::string& text, double size, double left, double top) {
  if (text.empty()) return;
  const Box box{left, top, left + p.ruler.width(size, text), top + size};
  const std::vector<Box> others = p.layout.boxes();
  if (box.bottom > p.height ||
      !std::all_of(others.begin(), others.end(), [&](const Box& other) { return apart(box, other); }))
    return;
  p.layout.texts.push_back({role, text, size, box});
}

void place_inset(Page& p) {
  if (!p.frame.inset || !p.frame.view.inset) return;
  constexpr double widest = 0.38;  // of a narrow picture
  const double inner = p.margin / 2, width = std::min(inset_aspect * inset_height * p.height, widest * p.width);
  p.layout.inset = Box{p.width - inner - width, inner, p.width - inner, inner + width / inset_aspect};
}

void place_triad(Page& p) {
  if (!p.frame.view.triad) return;
  constexpr double largest = 0.17;  // of the picture
  const double room = std::min(62 * p.s.unit + 1.6 * p.s.small, largest * std::min(p.width, p.height));
  p.layout.triad =
      Box{p.width - p.margin - 2 * room, p.height - p.margin - 2 * room, p.width - p.margin, p.height - p.margin};
  p.layout.triad_length = std::max(room - 1.6 * p.s.small, 0.3 * room);
}

/// Title, time, parameters, errors, note; the title beside the others where it has room, above them otherwise.
void place_texts(Page& p) {
  const ViewParameters& view = p.frame.view;
  const Captions& captions = p.frame.captions;
  const double end = p.layout.inset ? p.layout.inset->left - p.gap : p.width - p.margin;
  const double room = end - p.margin;
  const std::string time = view.time_stamp ? captions.time : "";
  const double time_size = std::min(p.s.large, p.s.large * room / std::max(p.ruler.width(p.s.large, time), 1e-9));
  const std::vector<std::string> parameters = view.caption && !captions.parameters.empty()
                                                  ? lines_of(p.ruler, p.s.small, captions.parameters, room)
                                                  : std::vector<std::string>{};
  double top = p.margin;
  if (!captions.title.empty()) {
    double aside = time.empty() ? 0 : p.ruler.width(time_size, time);
    for (const std::string& line : parameters) aside = std::max(aside, p.ruler.width(p.s.small, line));
    if (view.caption && !captions.widest_parameters.empty())
      for (const std::string& line : lines_of(p.ruler, p.s.small, captions.widest_parameters, room))
        aside = std::max(aside, p.ruler.width(p.s.small, line));
    const double middle = p.width / 2, left = p.margin + aside + (aside > 0 ? p.s.large : 0);
    const double beside = 2 * std::min(middle - left, end - middle);
    const auto widest = [&](double size) {
      return std::max(p.ruler.width(size, captions.title), p.ruler.width(size, captions.widest_title));
    };
    const double full = widest(p.s.large);
    const double size = std::clamp(p.s.large * beside / full, p.s.small, p.s.large);
    if (widest(size) <= beside) {
      add_line(p, Role::title, captions.title, size, middle - p.ruler.width(size, captions.title) / 2,
               top + 0.76 * (p.s.large - size));
    } else {
      const double own = std::clamp(p.s.large * room / full, p.s.small, p.s.large);
      const std::string text = p.ruler.shortened(own, captions.title, room);
      const double width = p.ruler.width(own, text);
      add_line(p, Role::title, text, own, std::clamp(middle - width / 2, p.margin, end - width), top);
      top += own + 0.6 * p.s.small;
    }
  }
  if (!time.empty()) {
    add_line(p, Role::time, time, time_size, p.margin, top);
    top += 1.11 * p.s.large + 0.24 * p.s.small;
  }
  const double step = 1.7 * p.s.small;
  for (const std::string& line : parameters) {
    add_line(p, Role::parameters, line, p.s.small, p.margin, top);
    top += step;
  }
  for (const auto& [role, text] :
       {std::pair{Role::errors, view.errors ? captions.errors : std::string()}, std::pair{Role::note, captions.note}}) {
    if (text.empty()) continue;
    add_line(p, role, p.ruler.shortened(p.s.small, text, room), p.s.small, p.margin, top);
    top += step;
  }
  for (const TextPlace& text : p.layout.texts)
    if (text.role != Role::panel) p.corner_bottom = std::max(p.corner_bottom, text.box.bottom);
}

/// In the lower left corner; none that is too short to be seen or too long for the picture.
void place_scale_bar(Page& p) {
  const Captions& captions = p.frame.captions;
  if (!p.frame.view.scale_bar || !(captions.scale_length > 0)) return;
  const double length = captions.scale_length / p.frame.camera.half_width * p.width / 2;
  const double thickness = std::max(4 * p.s.unit, 1.5), text = p.ruler.width(p.s.small, captions.scale);
  if (!(length > 2 * thickness && length < 0.6 * p.width)) return;
  // A name that is wider than its bar may reach into the margin, half of it at most.
  const double half = std::max(length, text) / 2, middle = std::max(p.margin + length / 2, p.margin / 2 + half);
  // above the triad where it is too long to stand beside it
  const bool above = p.layout.triad && middle + half > p.layout.triad->left - p.gap;
  const double bottom = above ? p.layout.triad->top - p.gap : p.height - p.margin;
  p.layout.scale_length = length;
  p.layout.scale_bar = Box{middle - half, bottom - thickness - 1.5 * p.s.small, middle + half, bottom};
}

/// In the middle of the lower edge, as far as the scale bar and the triad allow.
void place_panel_name(Page& p) {
  const std::string& name = p.frame.captions.panel;
  if (name.empty()) return;
  const double bottom = p.height - p.margin;
  const bool beside_bar = p.layout.scale_bar && p.layout.scale_bar->bottom > bottom - 2 * p.s.small;
  const double left = beside_bar ? p.layout.scale_bar->right + p.s.small : p.margin;
  const double right = p.layout.triad ? p.layout.triad->left - p.s.small : p.width - p.margin;
  const std::string text = p.ruler.shortened(p.s.small, name, right - left);
  const double width = p.ruler.width(p.s.small, text);
  add_line(p, Role::panel, text, p.s.small, std::clamp((p.width - width) / 2, left, std::max(left, right - width)),
           p.height - p.margin - 0.76 * p.s.small);
}

void place_colour_bar(Page& p) {
  if (!p.frame.legend || !p.frame.view.colour_bar) return;
  const Legend& legend = *p.frame.legend;
  double numbers = 0;
  for (const std::string& text : number_texts(bar_ticks(legend.low, legend.high)))
    numbers = std::max(numbers, p.ruler.width(p.s.small, text));
  const BarSizes sizes = bar_sizes(p.frame.view.size[1]);
  const double label = p.ruler.width(1.1 * p.s.small, legend.label);
  const double aside = sizes.gap + sizes.tick + numbers, right = p.width - p.margin;
  Box bar;
  bar.right = std::round(right - aside);
  bar.left = bar.right - sizes.width;
  const double left = std::min({bar.left, (bar.left + bar.right - label) / 2, right - label});
  double low = p.layout.inset ? p.layout.inset->bottom + p.gap : p.margin, high = p.height - p.margin;
  for (const TextPlace& text : p.layout.texts)
    if (text.box.right > left - p.gap) {
      if (text.role == Role::panel)
        high = std::min(high, text.box.top - p.gap);
      else
        low = std::max(low, text.box.bottom + p.gap);
    }
  if (p.layout.triad) high = std::min(high, p.layout.triad->top - p.gap);
  if (p.layout.scale_bar && p.layout.scale_bar->right > left - p.gap)
    high = std::min(high, p.layout.scale_bar->top - p.gap);
  // above the colours: the end, if values lie beyond it, and the label; below: the other end, or half a number
  const double point = 0.9 * sizes.width, above = (legend.above ? point : 0) + 0.8 * p.s.small + 1.1 * p.s.small;
  const double below = std::max(legend.below ? point : 0, 0.5 * p.s.small);
  bar.top = std::round(std::max(colour_bar_top * p.height, low + above));
  bar.bottom = bar.top + std::round(std::min(colour_bar_height * p.height, high - below - bar.top));
  if (bar.height() < 3 * p.s.small || bar.left < p.width / 2) return;
  p.layout.bar = bar;
  p.layout.colour_bar = Box{left, bar.top - above, right, bar.bottom + below};
}

/// At the left edge, between the captions and the scale bar, about the middle of the picture.
void place_profile(Page& p) {
  if (!p.frame.profile || !p.frame.view.flow_profile) return;
  const double name = 1.7 * p.s.small, middle = p.height / 2;
  const double low = std::max(p.corner_bottom + p.gap, p.margin) + name;
  const double high = p.layout.scale_bar ? p.layout.scale_bar->top - p.gap : p.height - p.margin;
  const double reach = std::min({profile_reach, 1 - low / middle, high / middle - 1});
  if (reach < 0.2) return;
  p.layout.profile_reach = reach;
  const double wide = std::max(profile_width * p.width, p.ruler.width(p.s.small, "u_{∞}") / 2);
  p.layout.profile = Box{0.4 * p.margin, middle * (1 - reach) - name, p.margin + wide + 0.6 * p.margin,
                         middle * (1 + reach) + 0.3 * p.s.small};
}

}  // namespace

std::vector<Box> OverlayLayout::boxes() const {
  std::vector<Box> all;
  for (const TextPlace& text : texts) all.push_back(text.box);
  for (const std::optional<Box>& box : {scale_bar, colour_bar, inset, profile, triad})
    if (box) all.push_back(*box);
  return all;
}

OverlayLayout lay_out(const Frame& frame, const Font& font) {
  Page p(frame, font);
  place_inset(p);
  place_triad(p);
  place_scale_bar(p);
  place_panel_name(p);
  place_texts(p);
  place_colour_bar(p);
  place_profile(p);
  return p.layout;
}

double clear_of(const std::vector<Box>& boxes, const glm::dvec2& place, const std::vector<int>& size) {
  constexpr double room = 0.02, ramp = 0.10;  // half heights
  const double half = size[1] / 2.0;
  const glm::dvec2 at((1 + place.x) * size[0] / 2, (1 - place.y) * half);
  double clear = 1;
  for (const Box& box : boxes) {
    const double aside = std::max({box.left - at.x, at.x - box.right, box.top - at.y, at.y - box.bottom});
    clear = std::min(clear, glm::smoothstep(room, room + ramp, aside / half));
  }
  return clear;
}

}  // namespace render
