#include "render/overlay/overlay.h"

#include "render/overlay/annotation.h"
#include "render/overlay/colour_bar.h"
#include "render/core/places.h"
#include "render/image/picture_canvas.h"

#include <algorithm>
#include <cmath>

namespace render {

void draw_captions(Image& image, const Font& font, const Frame& frame) {
  const ViewParameters& view = frame.view;
  if (frame.legend && view.colour_bar) draw_colour_bar(image, font, *frame.legend, frame.legend->mirrored && view.sign_dots);
  if (frame.profile && view.flow_profile) draw_flow_profile(image, font, *frame.profile);
  if (frame.inset && view.inset) draw_inset(image, font, *frame.inset);
  if (view.triad) draw_triad(image, font, frame.camera);
  const Captions& captions = frame.captions;
  const bool time = view.time_stamp && !captions.time.empty();
  const bool parameters = view.caption && !captions.parameters.empty();
  const OverlaySizes sizes = overlay_sizes(image.height);
  const double unit = sizes.unit, margin = sizes.margin, large = sizes.large, small = sizes.small;
  if (time || parameters || !captions.note.empty()) {
    const double height = margin + 1.2 * large + 3.4 * small;
    draw_on(image, {0, 0, image.width, static_cast<int>(std::ceil(height))}, [&](cairo_t* cairo) {
      double y = margin + 0.76 * large;
      if (time) {
        set_colour(cairo, ink);
        draw_text_on_picture(cairo, font, large, margin, y, captions.time);
        y += 0.35 * large + small;
      }
      if (parameters) {
        set_colour(cairo, soft_ink);
        draw_text_on_picture(cairo, font, small, margin, y, captions.parameters);
        y += 1.7 * small;
      }
      if (!captions.note.empty()) {
        set_colour(cairo, note_ink);
        draw_text_on_picture(cairo, font, small, margin, std::max(y, margin + 0.76 * large), captions.note);
      }
    });
  }
  if (!captions.title.empty() || !captions.panel.empty()) {
    const double top = margin + 0.76 * large;
    draw_on(image, {0, 0, image.width, static_cast<int>(std::ceil(top + large))}, [&](cairo_t* cairo) {
      set_colour(cairo, ink);
      if (!captions.title.empty()) {
        // as large as fits beside the time and the parameters
        const double aside = std::max(text_width(cairo, font, large, captions.time) * time,
                                      text_width(cairo, font, small, captions.parameters) * parameters);
        const double room = image.width - 2 * (margin + aside + large), width = text_width(cairo, font, large, captions.title);
        const double size = width > room && room > 0 ? std::max(large * room / width, small) : large;
        draw_text_on_picture(cairo, font, size, image.width / 2.0, top, captions.title, Align::centre);
      }
    });
    if (!captions.panel.empty())
      draw_on(image, {0, static_cast<int>(image.height - margin - 2 * small), image.width, static_cast<int>(margin + 2 * small)},
              [&](cairo_t* cairo) {
                set_colour(cairo, soft_ink);
                draw_text_on_picture(cairo, font, small, image.width / 2.0, image.height - margin, captions.panel, Align::centre);
              });
  }
  if (view.scale_bar && captions.scale_length > 0) {
    const double length = captions.scale_length / frame.camera.half_width * image.width / 2;
    const double thickness = std::max(4 * unit, 1.5);
    const double baseline = image.height - margin;
    if (length > 2 * thickness && length < 0.6 * image.width)
      draw_on(image,
              {0, static_cast<int>(baseline - 2.2 * small), image.width, static_cast<int>(std::ceil(2.2 * small + margin))},
              [&](cairo_t* cairo) {
                set_colour(cairo, ink);
                cairo_rectangle(cairo, margin, baseline - thickness, length, thickness);
                cairo_fill(cairo);
                draw_text_on_picture(cairo, font, small, margin + length / 2, baseline - thickness - 0.5 * small, captions.scale,
                          Align::centre);
              });
  }
}

}  // namespace render
