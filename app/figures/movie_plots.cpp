#include "app/figures/movie_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace app {

namespace {

/// The ground of the plots: that of the picture where it has one colour.
std::string ground_of(const std::string& background) {
  return background == "dark" || background.starts_with('#') ? background : "white";
}

/// Shares of the picture that plots take.
constexpr double row_share = 0.3, column_share = 0.36;

}  // namespace

std::optional<PlotStrip> movie_plots(const std::vector<FigureSource>& sources) {
  const render::ViewParameters& view = sources.front().settings.view;
  if (view.plots.empty()) return {};
  std::vector<const QuantityRow*> rows;
  for (const std::string& name : view.plots) rows.push_back(&find_quantity(name));
  const SharedScales scales = shared_scales(sources);
  std::vector<render::Series> series;
  for (const FigureSource& source : sources)
    for (render::Series& one : series_of(source, scales, rows, false)) series.push_back(std::move(one));
  const std::vector<render::Plot> plots = render::plots_against_time(series, scales.time.symbol);

  const int width = view.size[0], height = view.size[1];
  const bool below = view.plots_at == "below";
  // Side by side as long as they are not narrow.
  constexpr int most_columns = 3;
  const auto count = static_cast<int>(plots.size());
  const int columns = below ? std::min(count, most_columns) : 1, lines = (count + columns - 1) / columns;
  PlotStrip strip;
  strip.views_width = below ? width : width - static_cast<int>(std::lround(column_share * width));
  strip.views_height =
      below ? height - static_cast<int>(std::lround(std::min(0.62, row_share * lines) * height)) : height;
  strip.place = below ? render::Rectangle{0, strip.views_height, width, height - strip.views_height}
                      : render::Rectangle{strip.views_width, 0, width - strip.views_width, height};
  strip.time_factor = scales.time.factor;

  render::FigureParameters parameters;
  parameters.columns = columns;
  render::Page page;
  page.theme = render::on_ground_named(render::find_theme("paper"), ground_of(view.background));
  constexpr double text = 0.021;  // of the picture's height, as captions have it
  strip.pixels = std::max(text * std::min(height, width), 7.0) / page.theme.text;
  page.width = strip.place.width / strip.pixels;
  page.height = strip.place.height / strip.pixels;
  try {
    strip.placed = render::placed_plots(parameters, page, plots, true, false);
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(
        fmt::format("a picture of {} x {} has no room for the {} plots of view.plots", width, height, count));
  }
  // Marks along the curves would be taken for those of the time, which have their shapes.
  render::PlacedPlots unmarked = strip.placed;
  for (render::PlacedPlot& p : unmarked.plots)
    for (render::Curve& curve : p.plot.curves)
      if (curve.phase >= 0) curve.marker.reset();
  strip.ground = render::Image(strip.place.width, strip.place.height, 3);
  const render::Font font = render::caption_font();
  render::draw_on(strip.ground, {0, 0, strip.place.width, strip.place.height}, [&](cairo_t* cairo) {
    render::set_colour(cairo, page.theme.ground);
    cairo_paint(cairo);
    cairo_scale(cairo, strip.pixels, strip.pixels);
    render::draw_plots({cairo, font, strip.placed.theme}, unmarked);
  });
  return strip;
}

}  // namespace app
