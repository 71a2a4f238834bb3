#include "render/overlay/overlay.h"

#include "render/core/places.h"
#include "render/image/picture_canvas.h"
#include "render/overlay/annotation.h"
#include "render/overlay/colour_bar.h"

#include <algorithm>
#include <cmath>

namespace render {

namespace {

// What of the captions in the upper left corner is shown.
struct Shown {
  bool time, parameters, errors;
};
Shown shown_captions(const Frame& frame) {
  return {.time = frame.view.time_stamp && !frame.captions.time.empty(),
          .parameters = frame.view.caption && !frame.captions.parameters.empty(),
          .errors = frame.view.errors && !frame.captions.errors.empty()};
}

// Time, parameters, errors and note, below each other.
void draw_corner(Image& image, const Font& font, const Inks& inks, const Frame& frame) {
  const Captions& captions = frame.captions;
  const Shown shown = shown_captions(frame);
  if (!shown.time && !shown.parameters && !shown.errors && captions.note.empty()) return;
  const OverlaySizes s = overlay_sizes(image.height);
  const double line = 1.7 * s.small, height = s.margin + 1.2 * s.large + (shown.errors ? 3 : 2) * line;
  draw_on(image, {0, 0, image.width, static_cast<int>(std::ceil(height))}, [&](cairo_t* cairo) {
    double y = s.margin + 0.76 * s.large;
    if (shown.time) {
      set_colour(cairo, inks.text);
      draw_text_on_picture(cairo, font, inks.rim, s.large, s.margin, y, captions.time);
      y += 0.35 * s.large + s.small;
    }
    if (shown.parameters) {
      set_colour(cairo, inks.soft);
      draw_text_on_picture(cairo, font, inks.rim, s.small, s.margin, y, captions.parameters);
      y += line;
    }
    if (shown.errors) {
      set_colour(cairo, inks.soft);
      draw_text_on_picture(cairo, font, inks.rim, s.small, s.margin, y, captions.errors);
      y += line;
    }
    if (!captions.note.empty()) {
      set_colour(cairo, inks.note);
      draw_text_on_picture(cairo, font, inks.rim, s.small, s.margin, std::max(y, s.margin + 0.76 * s.large),
                           captions.note);
    }
  });
}

// In the middle of the upper edge, as large as fits beside the time and the parameters.
void draw_title(Image& image, const Font& font, const Inks& inks, const Frame& frame) {
  const Captions& captions = frame.captions;
  if (captions.title.empty()) return;
  const Shown shown = shown_captions(frame);
  const OverlaySizes s = overlay_sizes(image.height);
  const double top = s.margin + 0.76 * s.large;
  draw_on(image, {0, 0, image.width, static_cast<int>(std::ceil(top + s.large))}, [&](cairo_t* cairo) {
    set_colour(cairo, inks.text);
    const double aside = std::max(text_width(cairo, font, s.large, captions.time) * shown.time,
                                  text_width(cairo, font, s.small, captions.parameters) * shown.parameters);
    const double room = image.width - 2 * (s.margin + aside + s.large);
    const double width = text_width(cairo, font, s.large, captions.title);
    const double size = width > room && room > 0 ? std::max(s.large * room / width, s.small) : s.large;
    draw_text_on_picture(cairo, font, inks.rim, size, image.width / 2.0, top, captions.title, Align::centre);
  });
}

// The name of the panel, in the middle of the lower edge.
void draw_panel_name(Image& image, const Font& font, const Inks& inks, const std::string& name) {
  if (name.empty()) return;
  const OverlaySizes s = overlay_sizes(image.height);
  const int top = static_cast<int>(image.height - s.margin - 2 * s.small),
            height = static_cast<int>(s.margin + 2 * s.small);
  draw_on(image, {0, top, image.width, height}, [&](cairo_t* cairo) {
    set_colour(cairo, inks.soft);
    draw_text_on_picture(cairo, font, inks.rim, s.small, image.width / 2.0, image.height - s.margin, name,
                         Align::centre);
  });
}

// In the lower left corner; none that is too short to be seen or too long for the picture.
void draw_scale_bar(Image& image, const Font& font, const Inks& inks, const Captions& captions, const Camera& camera) {
  if (!(captions.scale_length > 0)) return;
  const OverlaySizes s = overlay_sizes(image.height);
  const double length = captions.scale_length / camera.half_width * image.width / 2;
  const double thickness = std::max(4 * s.unit, 1.5), baseline = image.height - s.margin;
  if (!(length > 2 * thickness && length < 0.6 * image.width)) return;
  const int top = static_cast<int>(baseline - 2.2 * s.small),
            height = static_cast<int>(std::ceil(2.2 * s.small + s.margin));
  draw_on(image, {0, top, image.width, height}, [&](cairo_t* cairo) {
    set_colour(cairo, inks.text);
    cairo_rectangle(cairo, s.margin, baseline - thickness, length, thickness);
    cairo_fill(cairo);
    draw_text_on_picture(cairo, font, inks.rim, s.small, s.margin + length / 2, baseline - thickness - 0.5 * s.small,
                         captions.scale, Align::centre);
  });
}

}  // namespace

void draw_captions(Image& image, const Font& font, const Frame& frame) {
  const ViewParameters& view = frame.view;
  const Inks inks = inks_on(ground_of(view.background));
  if (frame.legend && view.colour_bar)
    draw_colour_bar(image, font, inks, *frame.legend, frame.legend->mirrored && view.sign_dots);
  if (frame.profile && view.flow_profile) draw_flow_profile(image, font, inks, *frame.profile);
  if (frame.inset && view.inset) draw_inset(image, font, inks, *frame.inset);
  if (view.triad) draw_triad(image, font, inks, frame.camera);
  draw_corner(image, font, inks, frame);
  draw_title(image, font, inks, frame);
  draw_panel_name(image, font, inks, frame.captions.panel);
  if (view.scale_bar) draw_scale_bar(image, font, inks, frame.captions, frame.camera);
}

}  // namespace render
