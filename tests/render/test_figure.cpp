// Figures and their files.
#include "render/figures/figure.h"
#include "render/figures/plot_legend.h"
#include "render/image/image.h"

#include "diagrams.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

using sim::Vec3;
using surfaces::turn;

namespace {

render::FigureInput input() {
  render::FigureInput in;
  in.labels = {"λ = 1", "λ = 4"};
  for (int k = 0; k < 5; ++k) {
    sim::State state =
        surfaces::state_of({surfaces::ellipsoid({1.5, 0.8, 0.8}, turn(-12.0 * k, {0, 1, 0}), {-1.6, 0, 0.1}),
                            surfaces::disc(turn(8.0 * k, {0, 1, 0}), {1.6, 0, -0.1})});
    state.time = 2.5 * k;
    in.states.push_back(state);
  }
  in.series.resize(3);
  for (std::size_t k = 0; k < 3; ++k) in.series[k].times = {0, 1, 2};
  in.series[0].name = "a";
  in.series[1].name = "b";
  in.series[0].axis = in.series[1].axis = "energy";
  in.series[0].values = {3, 1, 2};
  in.series[1].values = {1, 1, 1};
  in.series[2].axis = "error";
  in.series[2].values = {0, 1e-9, 3e-4};
  in.series[2].scale = render::Scale::logarithmic;
  render::Plot plot;
  plot.x = {.label = "ν", .grid = true};
  plot.y = {.label = "ω / γ̇", .grid = true};
  render::Curve curve;
  curve.name = "published";
  curve.x = {0.7, 0.8, 0.95};
  curve.y = {0.25, 0.33, 0.454};
  curve.error = {0.02, 0.02, 0.009};
  curve.marker = render::Marker::diamond;
  plot.curves = {curve};
  in.plots = {plot, plot};
  in.diagram = surfaces::diagram(3);
  for (const render::SheetPanel& p : render::sheet_layout(in).panels)
    in.stills.emplace_back(static_cast<int>(p.width), static_cast<int>(p.height), 3);
  in.flow.x = {-4, 4};
  in.flow.y = {-2, 2};
  in.flow.lines = {{(sim::Matrix(3, 2) << -3, -1, 0, 1, 3, -1).finished(), sim::Vector::Ones(3), false}};
  in.flow.speed = sim::Vector::LinSpaced(20, 0, 1.3) * sim::Vector::LinSpaced(40, 1, 0).transpose();
  in.flow.speed_window = {in.flow.x, in.flow.y};
  return in;
}

std::vector<std::vector<std::string>> table(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

}  // namespace

TEST_CASE("panels of a sheet of a periodic cell hold its box, wherever vesicles have drifted to") {
  render::FigureInput in = input();
  in.camera = "flow-gradient";
  in.box = render::FaceBox{{-3, -2, -2}, {3, 2, 2}};
  const render::Sheet near = render::sheet_layout(in);
  for (sim::VesicleState& v : in.states.back().vesicles) v.position.values.row(0) += sim::Vec3(900, 0, 40).transpose();
  const render::Sheet far = render::sheet_layout(in);
  for (const render::Sheet* sheet : {&near, &far})
    for (const render::SheetPanel& p : sheet->panels) {
      CHECK(p.target.norm() < 1e-12);
      CHECK(p.half_height > 2);
      CHECK(p.half_height < 3);
      CHECK(p.width == near.panels.front().width);
      CHECK(p.width > 6 * near.scale);
    }
  in.box.reset();
  CHECK(render::sheet_layout(in).panels.back().target.norm() > 100);
}

TEST_CASE("every figure of the catalogue is written as PNG, SVG, PDF and CSV, twice with the same bytes") {
  const support::TemporaryFolder folder;
  for (const render::FigureRow& row : render::figures()) {
    INFO(row.name);
    const auto first = render::write_figure(row.draw(input()), folder / (std::string(row.name) + "1"));
    const auto second = render::write_figure(row.draw(input()), folder / (std::string(row.name) + "2"));
    REQUIRE(first.size() == 4);
    for (std::size_t k = 0; k < first.size(); ++k) {
      const std::string a = support::read_file(first[k]), b = support::read_file(second[k]);
      CHECK(a.size() > 50);
      CHECK((a == b));
    }
    CHECK(support::read_file(first[1]).find("<svg") != std::string::npos);
    CHECK(support::read_file(first[2]).substr(0, 5) == "%PDF-");
    const render::Image image = render::read_png(first[0]).image;
    std::int64_t ink = 0;
    for (const std::uint8_t v : image.pixels) ink += v < 128;
    CHECK(ink > 3000);
  }
}

TEST_CASE("each name in an SVG is defined once, counted from 0 in its kind, and each reference finds one") {
  const support::TemporaryFolder folder;
  std::size_t pictures = 0;
  for (const render::FigureRow& row : render::figures()) {
    INFO(row.name);
    const std::string svg =
        support::read_file(render::write_figure(row.draw(input()), folder / std::string(row.name))[1]);
    std::map<std::string, int> next;
    std::set<std::string> names;
    const std::regex definition(" id=\"([A-Za-z-]*)([0-9]*)\"");
    for (std::sregex_iterator at(svg.begin(), svg.end(), definition), end; at != end; ++at) {
      CHECK(at->str(2) == std::to_string(next[at->str(1)]++));
      CHECK(names.insert(at->str(1) + at->str(2)).second);
      pictures += at->str(1).find("image") != std::string::npos || at->str(1).find("source") != std::string::npos;
    }
    const std::regex reference("(?:href=\"|url\\()#([\\w-]+)");
    for (std::sregex_iterator at(svg.begin(), svg.end(), reference), end; at != end; ++at)
      CHECK(names.contains(at->str(1)));
  }
  CHECK(pictures > 0);  // what Cairo counts through the process
}

TEST_CASE("the CSV of cross-sections holds points of the sections") {
  const auto rows = table(render::find_figure("cross-sections").draw(input()).csv);
  CHECK(rows.front() == std::vector<std::string>{"time", "vesicle", "curve", "x", "z"});
  REQUIRE(rows.size() > 1000);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i][1] != "0") continue;
    const Vec3 p = turn(12.0 * std::stod(rows[i][0]) / 2.5, {0, 1, 0}) *
                   Vec3(std::stod(rows[i][3]) + 1.6, 0, std::stod(rows[i][4]) - 0.1);
    CHECK(std::pow(p.x() / 1.5, 2) + std::pow(p.z() / 0.8, 2) == Approx(1).epsilon(1e-7));
  }
}

TEST_CASE("instants of a figure are spread evenly over the saved states, or those that were asked for") {
  const std::vector<double> times{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  render::FigureParameters p;
  p.panels = 3;
  CHECK(render::chosen_times(times, p) == std::vector<double>{0, 5, 10});
  p.panels = 1;
  CHECK(render::chosen_times(times, p) == std::vector<double>{0});
  p.panels = 40;
  CHECK(render::chosen_times(times, p).size() == 11);
  p.times = {2.2, 9.8};
  CHECK(render::chosen_times(times, p) == p.times);
  p.times = {2.2, 99};
  CHECK_THROWS_WITH(render::chosen_times(times, p), Catch::Contains("there is no t = 99"));
  CHECK(render::chosen_times({}, p).empty());
}

TEST_CASE("ticks are round numbers inside the range") {
  CHECK(render::tick_values({0, 1}, 5) == std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1});
  CHECK(render::tick_values({-90, 90}, 4, render::Scale::degrees) == std::vector<double>{-90, -45, 0, 45, 90});
  CHECK(render::tick_values({-6.2, -0.5}, 3, render::Scale::logarithmic) == std::vector<double>{-6, -4, -2});
  CHECK(render::tick_values({1, 1}, 5).empty());
}

TEST_CASE("the numbers of one axis have equally many digits after the point") {
  CHECK(render::tick_texts({1.35, 1.4, 1.45}) == std::vector<std::string>{"1.35", "1.40", "1.45"});
  CHECK(render::tick_texts({-2, 0, 2}) == std::vector<std::string>{"−2", "0", "2"});
  CHECK(render::tick_texts({0, 2e-13}) == std::vector<std::string>{"0", "2·10^{−13}"});
  CHECK(render::tick_texts({-3, 0}, render::Scale::logarithmic) == std::vector<std::string>{"10^{−3}", "10^{0}"});
}

TEST_CASE("numbers of an axis never touch, at any length and size of text") {
  const render::Ruler ruler;
  for (const render::Theme& row : render::themes())
    for (const double font : {6.0, 9.0, 14.0, 24.0})
      for (const double length : {60.0, 100.0, 180.0, 400.0, 900.0})
        for (const render::Range range :
             {render::Range{0, 1}, render::Range{-3.7, 12}, render::Range{1.331, 1.352}, render::Range{-1e-9, 4e-9}}) {
          const render::Theme theme = render::find_theme(row.name, font);
          const render::Ticks ticks = render::ticks_of(ruler, theme, {}, range, length, true);
          INFO(row.name << ", text " << font << ", length " << length << ", from " << range.low << " to "
                        << range.high);
          REQUIRE(ticks.values.size() >= 1);
          if (length >= 180 && font <= 14) CHECK(ticks.values.size() >= 2);
          for (std::size_t k = 1; k < ticks.values.size(); ++k) {
            const double apart = (ticks.values[k] - ticks.values[k - 1]) / range.size() * length;
            CHECK(apart > 0.5 * (ruler.width(font, ticks.texts[k]) + ruler.width(font, ticks.texts[k - 1])));
          }
        }
}

TEST_CASE("a circle stays a circle on every page") {
  render::FigureInput in;
  in.states = {surfaces::state_of({surfaces::sphere()})};
  const std::vector<std::vector<double>> pages{{}, {90}, {180, 120}, {60, 200}, {240, 60}};
  for (const char* kind : {"cross-sections", "overlay"})
    for (const std::vector<double>& page : pages)
      for (const char* theme : {"paper", "slides"}) {
        in.parameters.size = page;
        in.parameters.theme = theme;
        in.parameters.panels = 1;
        const render::Figure figure = render::find_figure(kind).draw(in);
        const support::TemporaryFolder folder;
        render::write_drawing_png(folder / "f.png", figure.drawing);
        const render::Image image = render::read_png(folder / "f.png").image;
        INFO(kind << " on a page of " << page.size() << " numbers, " << image.width << "x" << image.height << ", theme "
                  << theme);
        if (page.size() == 2) {
          CHECK(image.width == std::lround(page[0] / 25.4 * 300));
          CHECK(image.height == std::lround(page[1] / 25.4 * 300));
        }
        // The outline is the only colour: its extent in both directions.
        int low[2] = {image.width, image.height}, high[2] = {0, 0};
        for (int y = 0; y < image.height; ++y)
          for (int x = 0; x < image.width; ++x) {
            const std::uint8_t* p = image.at(x, y);
            if (std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}) < 110) continue;
            const int at[2] = {x, y};
            for (int d = 0; d < 2; ++d) low[d] = std::min(low[d], at[d]), high[d] = std::max(high[d], at[d]);
          }
        if (std::string(kind) == "overlay") continue;  // its legend has the same colour; below it only has to fit
        REQUIRE(high[0] > low[0] + 20);
        CHECK(std::abs((high[0] - low[0]) - (high[1] - low[1])) <= 2);
      }
}

TEST_CASE("pixels as the unit of size give exactly so many") {
  const support::TemporaryFolder folder;
  render::FigureInput in = input();
  in.parameters.unit = "px";
  in.parameters.size = {800, 450};
  for (const render::FigureRow& row : render::figures()) {
    INFO(row.name);
    if (row.needs == render::FigureNeeds::stills) {
      in.stills.clear();
      for (std::size_t k = 0; k < render::sheet_layout(in).panels.size(); ++k) in.stills.emplace_back(40, 30, 3);
    }
    render::write_drawing_png(folder / "f.png", row.draw(in).drawing);
    const render::Image image = render::read_png(folder / "f.png").image;
    CHECK(image.width == 800);
    CHECK(image.height == 450);
  }
}

TEST_CASE("the panels of a sheet lie on the page, side by side, and show their states whole at one scale") {
  render::FigureInput in = input();
  for (const std::vector<double>& page : std::vector<std::vector<double>>{{}, {120}, {254, 143}}) {
    in.parameters.size = page;
    const render::Sheet sheet = render::sheet_layout(in);
    REQUIRE(sheet.panels.size() == in.states.size());
    for (std::size_t k = 0; k < sheet.panels.size(); ++k) {
      const render::SheetPanel& p = sheet.panels[k];
      CHECK(p.left > -1e-9);
      CHECK(p.left + p.width < sheet.width + 1e-6);
      CHECK(p.top + p.height < sheet.height + 1e-6);
      CHECK(p.height == Approx(2 * p.half_height * sheet.scale));
      CHECK(p.width > 5.5 * sheet.scale);  // both vesicles, at -1.6 and 1.6
      if (k > 0 && sheet.panels[k - 1].top == p.top)
        CHECK(p.left > sheet.panels[k - 1].left + sheet.panels[k - 1].width);
    }
  }
}

TEST_CASE("a figure's plane has axes along x and z where it can, and says which") {
  render::FigureParameters p;
  const auto axes = [&](const Vec3& normal) {
    p.plane_normal = normal;
    const render::CutPlane plane = render::plane_of(p, {1, 2, 3});
    CHECK(plane.origin == Vec3(1, 2, 3));
    CHECK(std::abs(plane.right.dot(plane.normal)) + std::abs(plane.up.dot(plane.normal)) +
              std::abs(plane.right.dot(plane.up)) <
          1e-12);
    return render::axis_names(plane);
  };
  CHECK(axes({0, 2, 0}) == std::pair<std::string, std::string>("x", "z"));
  CHECK(axes({0, 0, -1}) == std::pair<std::string, std::string>("x", "y"));
  CHECK(axes({1, 0, 0}) == std::pair<std::string, std::string>("y", "z"));
  CHECK(axes({1, 1, 0}).first == "ξ");
  p.plane_normal = {0, 0, 0};
  CHECK_THROWS_AS(render::plane_of(p, {0, 0, 0}), std::invalid_argument);
}

TEST_CASE("numbers on axes are written as readers expect") {
  CHECK(render::number_text(0) == "0");
  CHECK(render::number_text(-0.5) == "−0.5");
  CHECK(render::number_text(1e-9) == "10^{−9}");
  CHECK(render::number_text(2.5e6) == "2.5·10^{6}");
}

TEST_CASE("a figure that cannot be written names its path") {
  const support::TemporaryFolder folder;
  CHECK_THAT(support::message_of([&] {
               render::write_figure(render::find_figure("overlay").draw(input()), folder / "no/such/figure");
             }),
             Catch::Contains("no/such/figure.png"));
  CHECK_THROWS_AS(render::find_figure("cross-sections").draw({}), std::invalid_argument);
  CHECK_THAT(support::message_of([] { render::find_figure("cross-section"); }),
             Catch::Contains("did you mean 'cross-sections'"));
}

TEST_CASE("numbers of an axis differ from each other, whatever their size and offset") {
  using Texts = std::vector<std::string>;
  CHECK(render::number_texts({1e6, 1000000.2, 1000000.4}) == Texts{"1000000.0", "1000000.2", "1000000.4"});
  CHECK(render::number_texts({99999998, 1e8, 100000002}) == Texts{"99999998", "100000000", "100000002"});
  CHECK(render::number_texts({0, 5e6, 1e7}) == Texts{"0", "0.5·10^{7}", "1.0·10^{7}"});
  CHECK(render::number_texts({-2e-7, 0, 2e-7}) == Texts{"−2·10^{−7}", "0", "2·10^{−7}"});
  CHECK(render::number_texts({2e7, 3e7}) == Texts{"2·10^{7}", "3·10^{7}"});
  CHECK(render::number_text(9.99999e7) == "10^{8}");  // not 10·10^7
  for (const double offset : {0.0, 1.0, 1e3, 1e8, -1e10})
    for (const double step : {1e-4, 0.25, 3.0, 1e6}) {
      std::vector<double> values;
      for (int k = 0; k < 6; ++k) values.push_back(offset + k * step);
      Texts texts = render::number_texts(values);
      INFO(offset << " by " << step << ": " << texts[0] << ", " << texts[1]);
      std::sort(texts.begin(), texts.end());
      CHECK(std::unique(texts.begin(), texts.end()) == texts.end());
    }
}

TEST_CASE("instants beyond the trajectory are refused, not moved") {
  render::FigureParameters p;
  p.times = {0.5, 2.5};
  CHECK_THROWS_WITH(render::chosen_times({0, 1, 2}, p),
                    Catch::Contains("goes from t = 0 to t = 2") && Catch::Contains("2.5"));
  p.times = {std::nan("")};
  CHECK_THROWS(render::chosen_times({0, 1, 2}, p));
  p.times = {2};
  CHECK(render::chosen_times({0, 1, 2}, p) == std::vector<double>{2});
}

TEST_CASE("text of a figure is text in PDF and SVG, and the PNG says its dots per inch") {
  const support::TemporaryFolder folder;
  render::Drawing drawing{200, 60, nullptr, render::white, 300};
  drawing.paint = [](cairo_t* cairo, const render::Font& font) {
    cairo_set_source_rgb(cairo, 0, 0, 0.5);
    render::draw_text(cairo, font, 12, 100, 30, "R_{0} < \x01 2", render::Align::centre);
  };
  const auto bytes = [](const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  render::write_drawing_svg(folder / "a.svg", drawing);
  const std::string svg = bytes(folder / "a.svg");
  CHECK_THAT(svg, Catch::Contains("<text") && Catch::Contains("font-family=\"'DejaVu Sans'") &&
                      Catch::Contains(">0</tspan>") && Catch::Contains("text-anchor=\"middle\"") &&
                      Catch::Contains("#000080") && Catch::Contains(" &lt;   2"));
  CHECK(svg.find("</svg>") > svg.find("</text>"));
  CHECK(svg.find("<path") == std::string::npos);  // no letter is an outline
  render::write_drawing_pdf(folder / "a.pdf", drawing);
  const std::string pdf = bytes(folder / "a.pdf");
  CHECK_THAT(pdf, Catch::Contains("DejaVuSans") && Catch::Contains("FontFile2"));
  render::write_drawing_pdf(folder / "b.pdf", drawing);
  CHECK(pdf == bytes(folder / "b.pdf"));
  render::write_drawing_png(folder / "a.png", drawing);
  const std::string png = bytes(folder / "a.png");
  const std::size_t at = png.find("pHYs");
  REQUIRE(at != std::string::npos);
  const auto number = [&](std::size_t from) {
    unsigned value = 0;
    for (std::size_t k = from; k < from + 4; ++k) value = value << 8 | static_cast<unsigned char>(png[k]);
    return value;
  };
  CHECK(number(at + 4) == 11811);  // 300 / 0.0254 m
  CHECK(number(at + 8) == 11811);
  CHECK(png[at + 12] == 1);
}

TEST_CASE("variables are in italics, words, numbers, units and names of operators are not") {
  const auto italics = [](const char* text) {
    std::string found;
    for (const render::TextRun& run : render::text_runs(text))
      if (run.italic) found += (found.empty() ? "" : " ") + run.text;
    return found;
  };
  CHECK(italics("γ̇t = 2.5") == "γ̇t");
  CHECK(italics("inclination θ (°)") == "θ");
  CHECK(italics("tolerance 1e-4") == "");
  CHECK(italics("κ_{b} = 0.01, 1e-3") == "κ");
  CHECK(italics("E / 8πκ") == "E κ");
  CHECK(italics("σR_{0}^{2}/κ_{b}") == "σR κ");
  CHECK(italics("(dθ/dt) / γ̇") == "θ t γ̇");
  CHECK(italics("γ̇Δt") == "γ̇ t");
  CHECK(italics("E_{n} of the mean curvature") == "E n");
  CHECK(italics("D = (L − B) / (L + B)") == "D L B L B");
  CHECK(italics("(a)  a panel of a figure, 5 m wide, e.g. run B") == "");
  CHECK(italics("Αριστοτέλης, a vesicle's λ") == "λ");
}

TEST_CASE("text as paths leaves no text in SVG and no font in PDF, and looks the same") {
  const support::TemporaryFolder folder;
  render::FigureInput in = input();
  const render::Figure text = render::find_figure("overlay").draw(in);
  in.parameters.text = "paths";
  const render::Figure paths = render::find_figure("overlay").draw(in);
  const auto written = render::write_figure(paths, folder / "paths"),
             usual = render::write_figure(text, folder / "text");
  CHECK(support::read_file(usual[1]).find("<text") != std::string::npos);
  CHECK(support::read_file(written[1]).find("<text") == std::string::npos);
  CHECK(support::read_file(written[2]).find("FontFile") == std::string::npos);
  CHECK((support::read_file(written[0]) == support::read_file(usual[0])));
}

/// The bytes of a PDF file, and after them all of its streams that can be inflated: newer versions of Cairo pack
/// titles.
std::string opened_pdf(const std::filesystem::path& path) {
  const std::string raw = support::read_file(path);
  std::string all = raw;
  const std::string begin = "stream\n";
  for (std::size_t at = raw.find(begin); at != std::string::npos; at = raw.find(begin, at + 1)) {
    const std::size_t from = at + begin.size(), end = std::min(raw.find("endstream", from), raw.size());
    std::string bytes(std::size_t{1} << 20, '\0');
    uLongf size = bytes.size();
    if (uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(raw.data() + from),
                   end - from) == Z_OK)
      all.append(bytes, 0, size);
  }
  return all;
}

TEST_CASE("title and scene of a figure are in all of its pictures") {
  const support::TemporaryFolder folder;
  render::Figure figure = render::find_figure("overlay").draw(input());
  figure.drawing.title = "overlay: shear & <more>";
  figure.drawing.subject = "[flow]\nrate = 1";
  const auto files = render::write_figure(figure, folder / "f");
  const auto text = render::read_png_text(files[0]);
  const auto holds = [&](const char* key, const std::string& value) {
    return std::find(text.begin(), text.end(), std::pair<std::string, std::string>(key, value)) != text.end();
  };
  CHECK(holds("Title", figure.drawing.title));
  CHECK(holds("Description", figure.drawing.subject));
  CHECK_THAT(support::read_file(files[1]), Catch::Contains("<title>overlay: shear &amp; &lt;more&gt;</title>"));
  const std::string pdf = opened_pdf(files[2]);
  CHECK(pdf.find("/Title (overlay: shear & <more>)") != std::string::npos);
  CHECK(pdf.find("<FEFF005B0066006C006F0077005D000A") != std::string::npos);  // UTF-16: "[flow]" and a new line
}

TEST_CASE("a page without ground is transparent, another ground is where nothing is drawn, and ink is seen on it") {
  const support::TemporaryFolder folder;
  render::FigureInput in = input();
  in.parameters.ground = "transparent";
  render::write_drawing_png(folder / "f.png", render::find_figure("time-series").draw(in).drawing);
  const render::Image clear = render::read_png(folder / "f.png").image;
  REQUIRE(clear.channels == 4);
  CHECK(clear.at(0, 0)[3] == 0);
  int solid = 0;
  for (int y = 0; y < clear.height; ++y)
    for (int x = 0; x < clear.width; ++x) solid += clear.at(x, y)[3] == 255;
  CHECK(solid > 1000);
  for (const char* ground : {"white", "dark", "#204080", "#e0f0e0"}) {
    INFO(ground);
    const render::Theme theme = render::on_ground_named(render::find_theme("paper"), ground);
    CHECK(std::abs(theme.ink.g - theme.ground.g) > 0.6);
    in.parameters.ground = ground;
    render::write_drawing_png(folder / "g.png", render::find_figure("time-series").draw(in).drawing);
    const render::Image image = render::read_png(folder / "g.png").image;
    CHECK(std::abs(image.at(0, 0)[1] - 255 * theme.ground.g) < 1.01);
  }
  CHECK_THAT(support::message_of([] { render::on_ground_named(render::find_theme("paper"), "drak"); }),
             Catch::Contains("did you mean 'dark'"));
}

TEST_CASE("a picture in a phase diagram is as large as was asked for, and PDF and SVG keep what is transparent in it") {
  // A red disc on nothing.
  render::FigureInput input;
  input.parameters.kind = "phase-diagram";
  input.parameters.size = {80};
  input.diagram = surfaces::diagram(1);
  render::DiagramPoint& point = input.diagram.points.front();
  point.reach = 2;
  const render::DiagramPicture place = render::diagram_picture(input);
  CHECK(place.reach >= 2);
  CHECK(place.side < 80 / 25.4 * 72 / 2);
  render::Image disc(64, 64, 4);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      if (std::hypot(x - 31.5, y - 31.5) < 20) {
        disc.at(x, y)[0] = 255;
        disc.at(x, y)[3] = 255;
      }
  point.picture = disc;
  const render::Figure figure = render::find_figure("phase-diagram").draw(input);
  const support::TemporaryFolder folder;
  render::write_figure(figure, folder / "d");
  const render::Image page = render::read_png(folder / "d.png").image;
  double red = 0;
  for (int y = 0; y < page.height; ++y)
    for (int x = 0; x < page.width; ++x)
      if (const std::uint8_t* p = page.at(x, y); p[0] > 250 && p[1] < 128 && p[2] < 128) ++red;
  const double pixels = 300.0 / 72;
  const double disc_area = std::numbers::pi * std::pow(20.0 / 64 * place.side * pixels, 2);
  CHECK(red == Approx(disc_area).epsilon(0.1));  // less the mark that lies on it
  CHECK(support::read_file(folder / "d.pdf").find("/SMask") != std::string::npos);
  CHECK(support::read_file(folder / "d.svg").find("data:image/png;base64") != std::string::npos);
}

TEST_CASE("letters that no font has are told") {
  render::Drawing drawing{200, 60, nullptr, render::white, 300};
  drawing.paint = [](cairo_t* cairo, const render::Font& font) {
    render::draw_text(cairo, font, 12, 10, 30, "λ = 1, \U0010fffd\U0010fffd");  // private use
  };
  CHECK(render::missing_letters(drawing) == "\U0010fffd");
}

TEST_CASE("heads of arrows follow a curve, point where it goes, and stay away from marks and each other") {
  render::Panel panel;  // 100 x 100 pt, y downward on the page
  panel.x = panel.y = {-1.1, 1.1};
  constexpr double size = 6, turns = 3;
  for (const double way : {1.0, -1.0}) {
    std::vector<double> x, y;
    for (int k = 0; k <= 600; ++k) {
      x.push_back(std::cos(way * turns * 2 * std::numbers::pi * k / 600));
      y.push_back(std::sin(way * turns * 2 * std::numbers::pi * k / 600));
    }
    const double radius = panel.page_x(1) - panel.page_x(0);
    const Eigen::Vector2d middle(panel.page_x(0), panel.page_y(0));
    std::vector<Eigen::Vector2d> taken;
    for (const double degrees : {0.0, 100.0, 200.0, 300.0})
      taken.emplace_back(middle + radius * Eigen::Vector2d(std::cos(degrees / 57.3), std::sin(degrees / 57.3)));
    const std::vector<render::ArrowHead> heads = render::arrow_heads(panel, x, y, size, taken);
    REQUIRE(heads.size() == 2);  // a long curve, however often it goes round
    for (const render::ArrowHead& head : heads) {
      const Eigen::Vector2d at = head.tip - size / 2 * head.along - middle;
      CHECK(at.norm() == Approx(radius).epsilon(0.001));
      // counter-clockwise in data is clockwise on a page whose y points downward
      const Eigen::Vector2d tangent = way * Eigen::Vector2d(at.y(), -at.x()) / at.norm();
      CHECK(head.along.dot(tangent) > 0.999);
      for (const Eigen::Vector2d& mark : taken) CHECK((at + middle - mark).norm() > size);
    }
    CHECK((heads[0].tip - heads[1].tip).norm() > 2 * size);
  }
  const std::vector<double> none{0.1, 0.1}, gap{0, std::nan("")};
  CHECK(render::arrow_heads(panel, none, none, size, {}).empty());
  CHECK(render::arrow_heads(panel, gap, gap, size, {}).empty());
}

TEST_CASE("a legend within a panel lies where no curve runs, or nowhere") {
  render::Panel panel;
  panel.x = panel.y = {0, 1};
  using Curves = std::vector<std::pair<std::vector<double>, std::vector<double>>>;
  const Curves diagonal{{{0, 1}, {0, 1}}},
      cross{{{0, 1}, {0, 1}}, {{0, 1}, {1, 0}}, {{0.5, 0.5}, {0, 1}}, {{0, 1}, {0.5, 0.5}}};
  const auto place = render::free_place(panel, {40, 20}, diagonal, 2);
  REQUIRE(place.has_value());
  // A line from the lower left to the upper right: the nearest corner of the rectangle is farther from it than 2 pt.
  const double apart =
      std::min(std::abs(place->x() + 40 - (100 - (place->y() + 20))), std::abs(place->x() - (100 - place->y())));
  CHECK(apart / std::sqrt(2.0) >= 2);
  CHECK_FALSE(render::free_place(panel, {60, 40}, cross, 2).has_value());
  CHECK_FALSE(render::free_place(panel, {101, 5}, {}, 0).has_value());
}
