// The layout of figures: no text crosses another text, a curve, a frame or the edge of the page, at any width.
#include "render/figures/figure.h"

#include "diagrams.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <regex>

using surfaces::turn;

namespace {

const std::array<std::string, 5> titles{
    "Tank-treading in shear flow", "Tumbling in shear flow",
    "A nearly spherical vesicle that tank-treads at a viscosity contrast of four, computed with the default scheme",
    "Tumbling of a nearly spherical vesicle in simple shear flow at high viscosity contrast (run of November)",
    "viscosity_contrast=12.5,reduced_volume=0.9283746,bending_modulus=0.0123456,/home/somebody/trajectories/t5.h5"};

/// Panels as figures of trajectories have them: curves from corner to corner, noise, one and three curves a group.
std::vector<render::Series> series_of(std::size_t groups) {
  std::vector<render::Series> all;
  const auto add = [&](const char* axis, const std::string& part, std::size_t g, render::Scale scale, auto value) {
    render::Series s;
    s.axis = axis;
    s.part = part;
    s.group = groups > 1 ? titles[g] : "";
    s.scale = scale;
    for (int k = 0; k <= 60; ++k) {
      s.times.push_back(20.0 * k / 60);
      s.values.push_back(value(k / 60.0));
    }
    all.push_back(std::move(s));
  };
  for (std::size_t g = 0; g < groups; ++g) {
    const double shift = 0.1 * static_cast<double>(g);
    add("inclination θ (°)", "", g, render::Scale::degrees, [&](double t) { return 25 - (300 + 60 * shift) * t; });
    for (const char* part : {"a_{1}", "a_{2}", "a_{3}"})
      add("axes / R_{0}", part, g, render::Scale::linear, [&](double t) { return 1 + shift + 0.4 * std::sin(9 * t); });
    add("⟨(u·n)^{2}⟩^{1/2} / γ̇R_{0}", "", g, render::Scale::linear, [&](double t) { return 1331 + 0.02 * t + shift; });
    for (const char* part : {"area", "volume"})
      add("relative error", part, g, render::Scale::logarithmic,
          [&](double t) { return std::pow(10, -16 + 3 * std::abs(std::sin(100 * t + shift))); });
  }
  return all;
}

std::vector<render::Plot> plots_of(std::size_t groups) {
  std::vector<render::Plot> plots(2);
  for (std::size_t k = 0; k < plots.size(); ++k) {
    plots[k].x = {.label = "reduced volume ν", .grid = true};
    plots[k].y = {.label = k == 0 ? "inclination θ / π" : "E_{n} of the mean curvature",
                  .scale = k == 0 ? render::Scale::linear : render::Scale::logarithmic,
                  .grid = true};
    for (std::size_t g = 0; g < groups; ++g) {
      render::Curve curve;
      curve.name = titles[g];
      curve.colour = g;
      curve.marker = render::group_marker(g);
      curve.directed = true;
      for (int i = 0; i <= 8; ++i) {
        curve.x.push_back(i);
        curve.y.push_back(std::pow(10, -i * (1 + 0.2 * static_cast<double>(g))));
        curve.error.push_back(0.02);
      }
      plots[k].curves.push_back(std::move(curve));
    }
  }
  return plots;
}

render::FigureInput input_of(const render::FigureRow& row, const std::string& page, std::size_t groups) {
  render::FigureInput in;
  if (page == "slides")
    in.parameters.theme = "slides";
  else
    in.parameters.size = {std::stod(page)};
  in.time_symbol = "γ̇t";
  if (groups > 1 && row.needs == render::FigureNeeds::instants)
    in.labels = {titles.begin(), titles.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(groups, 2))};
  for (std::size_t k = 0; k < 2 + 2 * groups; ++k) {
    sim::State state = surfaces::state_of(
        {surfaces::ellipsoid({1.5, 0.8, 0.8}, turn(-12.0 * static_cast<double>(k), {0, 1, 0}), {-1.6, 0, 0.1}),
         surfaces::disc(turn(8.0 * static_cast<double>(k), {0, 1, 0}), {1.6, 0, -0.1})});
    state.time = 2.55 * static_cast<double>(k);
    in.states.push_back(state);
  }
  in.series = series_of(groups);
  if (row.name == "inclination")
    std::erase_if(in.series, [](const render::Series& s) { return s.scale != render::Scale::degrees; });
  in.plots = plots_of(groups);
  if (row.needs == render::FigureNeeds::diagram) in.diagram = surfaces::diagram(groups + 1);
  if (row.name == "phase") in.plots.resize(1);
  if (row.needs == render::FigureNeeds::stills) {
    in.shows_field = groups > 1;
    if (in.shows_field) {
      in.field.emplace();
      in.field->label = "tension σR_{0}^{2}/κ_{b}";
      in.field->low = -1200;
      in.field->high = 34.5;
      in.field->below = in.field->above = true;
    }
    in.stills.assign(in.states.size(), render::Image(8, 6, 3));
    for (render::Image& still : in.stills) still.pixels.assign(still.pixels.size(), 255);
  }
  in.flow.x = {-4, 4};
  in.flow.y = {-2.0 / static_cast<double>(groups), 2};
  in.flow.lines = {{(sim::Matrix(3, 2) << -3, -1, 0, 1, 3, -1).finished(), sim::Vector::Ones(3), false}};
  in.flow.speed = sim::Vector::LinSpaced(20, 0, 1.3) * sim::Vector::LinSpaced(40, 1, 0).transpose();
  in.flow.speed_window = {in.flow.x, in.flow.y};
  in.flow.speed_label = "in-plane |u − U| / γ̇R_{0}";
  return in;
}

/// The page without its text, a pixel a point.
render::Image without_text(const render::Drawing& drawing) {
  render::Image image(static_cast<int>(std::ceil(drawing.width)), static_cast<int>(std::ceil(drawing.height)), 3);
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height);
  cairo_t* cairo = cairo_create(surface);
  cairo_set_source_rgb(cairo, 1, 1, 1);
  cairo_paint(cairo);
  drawing.paint(cairo, render::Font(render::Font::Use::kept, drawing.family, true));
  cairo_destroy(cairo);
  cairo_surface_flush(surface);
  const unsigned char* data = cairo_image_surface_get_data(surface);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = data[y * cairo_image_surface_get_stride(surface) + 4 * x + c];
  cairo_surface_destroy(surface);
  return image;
}

bool crosses(const render::TextBox& a, const render::TextBox& b) {
  constexpr double touch = 0.3;  // pt: rounding of the boxes of turned texts
  return a.left + touch < b.right && b.left + touch < a.right && a.top + touch < b.bottom && b.top + touch < a.bottom;
}

/// What is wrong with the page: one sentence for each crossing.
std::string crossings(const render::Drawing& drawing) {
  std::string found;
  const std::vector<render::PlacedText> texts = render::texts_of(drawing);
  const render::Image image = without_text(drawing);
  constexpr int ink = 255 - 60;  // grids are lighter, everything else is darker
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const render::TextBox& b = texts[i].box;
    if (b.left < 0 || b.top < 0 || b.right > drawing.width || b.bottom > drawing.height)
      found += "'" + texts[i].text.text + "' leaves the page; ";
    for (std::size_t k = 0; k < i; ++k)
      if (crosses(b, texts[k].box)) found += "'" + texts[i].text.text + "' crosses '" + texts[k].text.text + "'; ";
    bool crossed = false;
    for (int y = std::max(0, static_cast<int>(std::ceil(b.top)));
         y < std::min<int>(image.height, static_cast<int>(b.bottom)); ++y)
      for (int x = std::max(0, static_cast<int>(std::ceil(b.left)));
           x < std::min<int>(image.width, static_cast<int>(b.right)); ++x)
        crossed = crossed || std::min({image.at(x, y)[0], image.at(x, y)[1], image.at(x, y)[2]}) < ink;
    if (crossed) found += "a line crosses '" + texts[i].text.text + "'; ";
  }
  return found;
}

struct Word {
  double left, top, right, bottom;
  std::string text;
};
std::vector<Word> words_of_pdf(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(
      ::popen(("pdftotext -bbox '" + path.string() + "' - 2>/dev/null").c_str(), "r"), ::pclose);
  std::string page;
  std::array<char, 4096> part{};
  while (pipe && std::fgets(part.data(), part.size(), pipe.get())) page += part.data();
  const std::regex word(
      "<word xMin=\"([-0-9.]+)\" yMin=\"([-0-9.]+)\" xMax=\"([-0-9.]+)\" yMax=\"([-0-9.]+)\">([^<]*)<");
  std::vector<Word> words;
  for (std::sregex_iterator at(page.begin(), page.end(), word), end; at != end; ++at)
    words.push_back(
        {std::stod(at->str(1)), std::stod(at->str(2)), std::stod(at->str(3)), std::stod(at->str(4)), at->str(5)});
  return words;
}

const char* const pages[] = {"85", "120", "180", "slides"};

}  // namespace

TEST_CASE("in no figure a text crosses a text, a curve or the edge of the page") {
  for (const render::FigureRow& row : render::figures())
    for (const char* page : pages)
      for (const std::size_t groups : {1, 2, 5}) {
        INFO(row.name << ", page " << page << ", trajectories " << groups);
        CHECK(crossings(row.draw(input_of(row, page, groups)).drawing) == "");
      }
}

TEST_CASE("the bar of a sheet has the dots of negative values where its pictures have them, and nothing else changes") {
  for (const render::FigureRow& row : render::figures()) {
    if (row.needs != render::FigureNeeds::stills) continue;
    render::FigureInput in = input_of(row, "85", 2);
    const render::Image without = without_text(row.draw(in).drawing);
    in.field->mirrored = true;
    const render::Image with = without_text(row.draw(in).drawing);
    REQUIRE(with.width == without.width);
    int changed = 0, top = with.height, bottom = 0, right = 0;
    for (int y = 0; y < with.height; ++y)
      for (int x = 0; x < with.width; ++x)
        if (std::abs(with.at(x, y)[1] - without.at(x, y)[1]) > 8) {
          ++changed;
          top = std::min(top, y);
          bottom = std::max(bottom, y);
          right = std::max(right, x);
        }
    INFO(row.name);
    CHECK(changed > 30);
    CHECK(bottom - top < 9);  // two rows in a bar of 0.8 x 9 pt
    // the upper half of the bar, at the right edge of the page, has none
    CHECK(right < 0.8 * with.width);
  }
}

TEST_CASE("in no serif figure on a tiny page a text crosses another") {
  for (const render::FigureRow& row : render::figures()) {
    if (row.needs != render::FigureNeeds::series && row.needs != render::FigureNeeds::plots) continue;
    for (const std::vector<double>& size : {std::vector<double>{40}, std::vector<double>{60, 50}}) {
      render::FigureInput in = input_of(row, "85", 5);
      in.parameters.size = size;
      in.parameters.font = "serif";
      INFO(row.name << " on a page " << size.front() << " mm wide");
      CHECK(crossings(row.draw(in).drawing) == "");
    }
  }
}

TEST_CASE("words of a PDF are found where the layout put them, and none lies on another") {
  const support::TemporaryFolder folder;
  if (words_of_pdf("/dev/null").empty() && std::system("pdftotext -v >/dev/null 2>&1") != 0) {
    WARN("without pdftotext (poppler-utils) the text of PDF files is not read");
    return;
  }
  for (const render::FigureRow& row : render::figures())
    for (const char* page : pages)
      for (const std::size_t groups : {1, 2, 5}) {
        INFO(row.name << ", page " << page << ", trajectories " << groups);
        const render::Drawing drawing = row.draw(input_of(row, page, groups)).drawing;
        render::write_drawing_pdf(folder / "f.pdf", drawing);
        const std::vector<Word> words = words_of_pdf(folder / "f.pdf");
        const std::vector<render::PlacedText> texts = render::texts_of(drawing);
        CHECK(words.size() >= texts.size());
        std::vector<std::size_t> owner;
        for (const Word& w : words) {
          const double x = (w.left + w.right) / 2, y = (w.top + w.bottom) / 2;
          // The middle of each word lies in the box of a text, but for its height: that of the font.
          double nearest = 1e300;
          std::size_t own = 0;
          for (std::size_t t = 0; t < texts.size(); ++t) {
            const render::TextBox& box = texts[t].box;
            const double aside =
                std::max({box.left - x, x - box.right, box.top - y, y - box.bottom}) / texts[t].text.size;
            if (aside < nearest) own = t;
            nearest = std::min(nearest, aside);
          }
          owner.push_back(own);
          INFO(w.text);
          CHECK(nearest < 0.5);
          // likewise a quarter of the height of the font, which of turned text lies across
          const double empty = std::min(w.right - w.left, w.bottom - w.top) / 4;
          CHECK(w.left > -empty);
          CHECK(w.right < drawing.width + empty);
        }
        for (std::size_t i = 0; i < words.size(); ++i)
          for (std::size_t k = 0; k < i; ++k) {
            if (owner[i] == owner[k]) continue;
            // Of the height of the font, a quarter above and below has no letters.
            const Word &a = words[i], &b = words[k];
            const double down_a = (a.bottom - a.top) / 4, down_b = (b.bottom - b.top) / 4;
            const bool across = a.left < b.right && b.left < a.right;
            const bool down = a.top + down_a < b.bottom - down_b && b.top + down_b < a.bottom - down_a;
            INFO(a.text << ", " << b.text);
            CHECK_FALSE((across && down));
          }
      }
}
