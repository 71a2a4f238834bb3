// Figures and their files.
#include "render/figure.h"
#include "render/image.h"
#include "render/plot.h"

#include "surfaces.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <sstream>

using sim::Vec3;
using surfaces::turn;

namespace {

render::FigureInput input() {
  render::FigureInput in;
  in.labels = {"λ = 1", "λ = 4"};
  for (int k = 0; k < 5; ++k) {
    sim::State state = surfaces::state_of({surfaces::ellipsoid({1.5, 0.8, 0.8}, turn(-12.0 * k, {0, 1, 0}), {-1.6, 0, 0.1}),
                                           surfaces::disc(turn(8.0 * k, {0, 1, 0}), {1.6, 0, -0.1})});
    state.time = 2.5 * k;
    in.states.push_back(state);
  }
  in.series = {{"a", "energy", {0, 1, 2}, {3, 1, 2}}, {"b", "energy", {0, 1, 2}, {1, 1, 1}}, {"", "gap", {0, 2}, {0, 1e-9}}};
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

TEST_CASE("every figure of the catalogue is written as PNG, SVG, PDF and CSV, twice with the same bytes") {
  const support::TemporaryFolder folder;
  for (const render::FigureRow& row : render::figures()) {
    INFO(row.name);
    const auto first = render::write_figure(row.draw(input()), folder / (std::string(row.name) + "1"));
    const auto second = render::write_figure(row.draw(input()), folder / (std::string(row.name) + "2"));
    REQUIRE(first.size() == 4);
    for (std::size_t k = 0; k < first.size(); ++k) {
      const std::string a = support::read_file(first[k]), b = support::read_file(second[k]);
      CHECK(a.size() > 60);
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

TEST_CASE("the inclination of a turned ellipsoid is the angle it was turned by") {
  const auto rows = table(render::find_figure("inclination").draw(input()).csv);
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (rows[i][0] == "λ = 1") CHECK(std::stod(rows[i][3]) == Approx(12.0 * std::stod(rows[i][2]) / 2.5).margin(1e-7));
}

TEST_CASE("chosen states are spread evenly or lie nearest to the wanted times") {
  const std::vector<double> times{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  render::FigureParameters p;
  p.panels = 3;
  CHECK(render::chosen_states(times, p) == std::vector<std::size_t>{0, 5, 10});
  p.panels = 1;
  CHECK(render::chosen_states(times, p) == std::vector<std::size_t>{0});
  p.panels = 40;
  CHECK(render::chosen_states(times, p).size() == 11);
  p.times = {2.2, 99};
  CHECK(render::chosen_states(times, p) == std::vector<std::size_t>{2, 10});
  CHECK(render::chosen_states({}, p).empty());
}

TEST_CASE("ticks are round numbers inside the range") {
  CHECK(render::tick_values({0, 1}, 5) == std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1});
  CHECK(render::tick_values({-90, 90}, 4, true) == std::vector<double>{-90, -45, 0, 45, 90});
  CHECK(render::tick_values({1, 1}, 5).empty());
}

TEST_CASE("numbers on axes are written as readers expect") {
  CHECK(render::number_text(0) == "0");
  CHECK(render::number_text(-0.5) == "−0.5");
  CHECK(render::number_text(1e-9) == "10^{−9}");
  CHECK(render::number_text(2.5e6) == "2.5·10^{6}");
}

TEST_CASE("a figure that cannot be written names its path") {
  const support::TemporaryFolder folder;
  CHECK_THAT(support::message_of(
                 [&] { render::write_figure(render::find_figure("overlay").draw(input()), folder / "no/such/figure"); }),
             Catch::Contains("no/such/figure.png"));
  CHECK_THROWS_AS(render::find_figure("cross-sections").draw({}), std::invalid_argument);
  CHECK_THAT(support::message_of([] { render::find_figure("cross-section"); }),
             Catch::Contains("did you mean 'cross-sections'"));
}
