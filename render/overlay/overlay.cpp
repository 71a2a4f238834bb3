#include "render/overlay/overlay.h"

#include "render/core/places.h"
#include "render/image/picture_canvas.h"
#include "render/overlay/annotation.h"
#include "render/overlay/colour_bar.h"
#include "render/overlay/layout.h"

#include <algorithm>
#include <cmath>

namespace render {

namespace {

Colour colour_of(TextPlace::Role role, const Inks& inks) {
  switch (role) {
    case TextPlace::Role::time:
    case TextPlace::Role::title:
      return inks.text;
    case TextPlace::Role::note:
      return inks.note;
    default:
      return inks.soft;
  }
}

void draw_line(Image& image, const Font& font, const Inks& inks, const TextPlace& line) {
  const Box& box = line.box;
  const double around = line.size;  // letters with a tail, and the rim of the text
  draw_on(image,
          {static_cast<int>(box.left - around), static_cast<int>(box.top - around),
           static_cast<int>(box.width() + 2 * around) + 1, static_cast<int>(box.height() + 2 * around) + 1},
          [&](cairo_t* cairo) {
            set_colour(cairo, colour_of(line.role, inks));
            draw_text_on_picture(cairo, font, inks.rim, line.size, box.left, box.bottom - 0.24 * line.size, line.text);
          });
}

// In the lower left corner.
void draw_scale_bar(Image& image, const Font& font, const Inks& inks, const Captions& captions,
                    const OverlayLayout& layout) {
  if (!layout.scale_bar) return;
  const OverlaySizes s = overlay_sizes(image.height);
  const Box& box = *layout.scale_bar;
  const double middle = (box.left + box.right) / 2, thickness = std::max(4 * s.unit, 1.5);
  const int top = static_cast<int>(box.bottom - 2.2 * s.small),
            height = static_cast<int>(std::ceil(2.2 * s.small + s.margin));
  draw_on(image, {0, top, image.width, height}, [&](cairo_t* cairo) {
    cairo_rectangle(cairo, middle - layout.scale_length / 2, box.bottom - thickness, layout.scale_length, thickness);
    if (inks.rimmed) {
      set_colour(cairo, inks.rim);
      cairo_set_line_width(cairo, thickness);
      cairo_stroke_preserve(cairo);
    }
    set_colour(cairo, inks.text);
    cairo_fill(cairo);
    draw_text_on_picture(cairo, font, inks.rim, s.small, middle, box.bottom - thickness - 0.5 * s.small, captions.scale,
                         Align::centre);
  });
}

}  // namespace

void draw_captions(Image& image, const Font& font, const Frame& frame) {
  const OverlayLayout layout = lay_out(frame, font);
  const Inks inks = inks_on(ground_of(frame.view.background));
  if (layout.colour_bar)
    draw_colour_bar(image, font, inks, *frame.legend, layout.bar, frame.legend->mirrored && frame.view.sign_dots);
  if (layout.profile) draw_flow_profile(image, font, inks, *frame.profile, layout.profile_reach);
  if (layout.inset) draw_inset(image, font, inks, *frame.inset, *layout.inset);
  if (layout.triad) draw_triad(image, font, inks, frame.camera, *layout.triad, layout.triad_length);
  for (const TextPlace& line : layout.texts) draw_line(image, font, inks, line);
  draw_scale_bar(image, font, inks, frame.captions, layout);
}

}  // namespace render
