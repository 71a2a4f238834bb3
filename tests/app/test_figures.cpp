// Figures from the command line: every kind from a real trajectory, sizes, themes, and what is refused.
#include "app/tables/quantities.h"
#include "render/figures/figure.h"
#include "render/image/image.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// A short run of one small vesicle in shear flow.
struct Bench {
  support::TemporaryFolder folder;
  std::string trajectory = (folder / "t.h5").string();
  explicit Bench(const std::vector<std::string>& changes = {}) {
    std::vector<std::string> words{
        TANKTREAD_PROGRAM, "simulate", std::string(TANKTREAD_SCENES) + "/tank-treading.toml", "-q", "-o", trajectory};
    for (const char* change : {"vesicle.order=4", "time.end=0.3", "time.save_every=0.1"})
      words.insert(words.end(), {"--set", change});
    for (const std::string& change : changes) words.insert(words.end(), {"--set", change});
    REQUIRE(support::run(folder, words).status == 0);
  }
  support::Outcome figure(const std::string& kind, std::vector<std::string> more) const {
    std::vector<std::string> words{TANKTREAD_PROGRAM, "figure", kind, trajectory, "-o", (folder / kind).string()};
    words.insert(words.end(), more.begin(), more.end());
    return support::run(folder, words);
  }
};

/// Two vesicles in a periodic cell.
const std::vector<std::string> in_a_cell{"cell.size=[6, 5, 4.8]", "placement={kind=\"lattice\", count=2}"};

}  // namespace

TEST_CASE("every kind of figure is drawn from a trajectory, at the size that is asked for", "[figure]") {
  const Bench single, other({"vesicle.viscosity_contrast=3", "vesicle.reduced_volume=0.8"}), cell(in_a_cell);
  for (const render::FigureRow& row : render::figures()) {
    INFO(row.name);
    const std::string name(row.name);
    const Bench& bench = name == "pair-distribution" ? cell : single;
    std::vector<std::string> words{"--size", "320x240px",          "--theme", "slides",
                                   "--set",  "figure.spacing=0.6", "--set",   "figure.panels=2"};
    if (row.needs == render::FigureNeeds::diagram) words.insert(words.begin(), other.trajectory);
    const support::Outcome drawn = bench.figure(name, words);
    INFO(drawn.err);
    REQUIRE(drawn.status == 0);
    for (const char* ending : {".svg", ".pdf", ".csv"}) CHECK(fs::file_size(bench.folder / (name + ending)) > 30);
    const render::Image image = render::read_png(bench.folder / (name + ".png")).image;
    CHECK(image.width == 320);
    CHECK(image.height == 240);
  }
}

TEST_CASE("every quantity can be drawn against time", "[figure]") {
  const Bench bench;
  std::string all;
  for (const app::QuantityRow& row : app::quantities())
    all += fmt::format("{}\"{}\"", all.empty() ? "" : ",", row.name);
  const support::Outcome drawn = bench.figure("time-series", {"--set", "figure.quantities=[" + all + "]"});
  INFO(drawn.err);
  REQUIRE(drawn.status == 0);
  const std::string csv = support::read_file(bench.folder / "time-series.csv");
  for (const app::QuantityRow& row : app::quantities()) CHECK_THAT(csv, Contains(row.axis));
}

TEST_CASE("a quantity whose unit the scene does not have is shown as it is, and its axis says so", "[figure]") {
  const Bench bench({"flow={kind=\"uniform\", velocity=[3, 0, 0]}", "vesicle.bending_modulus=0"});
  const support::Outcome drawn =
      bench.figure("time-series", {"--set", "figure.quantities=[\"step\", \"normal-velocity\", \"tension\"]"});
  INFO(drawn.err);
  REQUIRE(drawn.status == 0);
  const std::string csv = support::read_file(bench.folder / "time-series.csv");
  CHECK_THAT(csv, !Contains("γ̇") && !Contains("κ") && Contains("Δt") && Contains("σ"));
  // A vesicle without stiffness is carried along as it is: no normal velocity relative to its centre.
  std::istringstream lines(csv);
  int found = 0;
  for (std::string line; std::getline(lines, line);)
    if (line.find("u·n") != std::string::npos) {
      ++found;
      CHECK(std::abs(std::stod(line.substr(line.rfind(',') + 1))) < 1e-9);
    }
  CHECK(found == 4);
}

TEST_CASE("a figure that cannot be says why in one sentence", "[figure]") {
  const Bench bench;
  const auto complaint = [&](const std::string& kind, std::vector<std::string> more) {
    const support::Outcome outcome = bench.figure(kind, std::move(more));
    CHECK(outcome.status != 0);
    return outcome.err;
  };
  CHECK_THAT(complaint("streamline", {}), Contains("did you mean 'streamlines'"));
  CHECK_THAT(complaint("phase", {"--set", "figure.abscissa=enrgy"}), Contains("did you mean 'energy'"));
  CHECK_THAT(complaint("overlay", {"--theme", "papr"}), Contains("did you mean 'paper'"));
  CHECK_THAT(complaint("overlay", {"--size", "12cm"}), Contains("180mm"));
  CHECK_THAT(complaint("overlay", {"--set", "figure.plane_point=[0,9,0]"}), Contains("cuts no vesicle"));
  CHECK_THAT(complaint("streamlines", {"--set", "figure.plane_point=[0,9,0]"}), Contains("cuts no vesicle"));
  CHECK_THAT(complaint("overlay", {"--set", "figure.plane_normal=[0,0,0]"}), Contains("plane_normal"));
  CHECK_THAT(complaint("overlay", {"--set", "figure.times=[0.30000002]"}),
             Contains("to t = 0.3; there is no t = 0.30000002 for figure.times"));
}

TEST_CASE("a figure of pair distributions counts pairs in a cell from a time on, and says what it lacks elsewhere",
          "[figure]") {
  const Bench bench(in_a_cell), alone({"cell.size=[6, 4, 4]"}), free;
  const support::Outcome drawn = bench.figure("pair-distribution", {bench.trajectory});
  INFO(drawn.err);
  REQUIRE(drawn.status == 0);
  // Two vesicles 2.5 apart along y, and their images no nearer: up to half of a side, 2.4, there is no pair.
  std::istringstream lines(support::read_file(bench.folder / "pair-distribution.csv"));
  int none = 0, one = 0;
  for (std::string line; std::getline(lines, line);) {
    none += line.find(",0,0") != std::string::npos;
    one += line.find("points at random") != std::string::npos;
  }
  CHECK(none == 48);  // two curves of 24 bins
  CHECK(one == 2);
  CHECK_THAT(bench.figure("pair-distribution", {"--set", "figure.from=0.4"}).err,
             Contains("ends at t = 0.3: no state is left from figure.from = 0.4 on"));
  CHECK_THAT(alone.figure("pair-distribution", {}).err, Contains("a single vesicle, which makes no pair"));
  const support::Outcome refused = free.figure("pair-distribution", {});
  CHECK(refused.status == 1);
  CHECK_THAT(refused.err, Contains("t.h5' has no periodic [cell]"));
}

TEST_CASE("streamlines of a cell go on through its faces, round the images of its vesicles", "[figure]") {
  const Bench cell({"cell.size=[3.4, 4, 4.5]"}), free;
  const auto ink = [](const Bench& bench) {
    const support::Outcome drawn = bench.figure(
        "streamlines", {"--size", "480x360px", "--set", "figure.spacing=0.6", "--set", "figure.margin=3.4"});
    INFO(drawn.err);
    REQUIRE(drawn.status == 0);
    const render::Image image = render::read_png(bench.folder / "streamlines.png").image;
    int count = 0;  // of the colour of sections
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* pixel = image.at(x, y);
        count += pixel[0] > pixel[2] + 80;
      }
    return count;
  };
  // A window three cells wide has a vesicle and its two images, and parts of those above and below.
  CHECK(ink(cell) > 2.5 * ink(free));
  std::istringstream lines(support::read_file(cell.folder / "streamlines.csv"));
  double last = 1e9;
  int through = 0;
  for (std::string line; std::getline(lines, line);) {
    int number = 0, closed = 0;
    double x = 0;
    if (std::sscanf(line.c_str(), "%d,%d,%lf", &number, &closed, &x) != 3) continue;
    through += std::abs(x - last) < 0.1 && (x - 1.7) * (last - 1.7) <= 0;
    last = x;
  }
  CHECK(through > 3);
}

TEST_CASE("a figure of tank-treading refuses a vesicle that tumbles and says what a short run leaves open",
          "[figure]") {
  const Bench rests;
  const support::Outcome shown = rests.figure("tank-treading", {});
  CHECK(shown.status == 0);
  CHECK_THAT(shown.err, Contains("too short a run to tell"));
  const std::string csv = support::read_file(rests.folder / "tank-treading.csv");
  CHECK_THAT(csv, Contains("\"Keller, Skalak 1982, λ = 1\"") && Contains("\"Kraus et al. 1996, λ = 1\"") &&
                      Contains("\"Tanktread, not settled, λ = 1\""));
  const Bench turns({"vesicle.viscosity_contrast=20", "time.end=16", "time.step=0.1", "time.save_every=0.5"});
  const support::Outcome refused = turns.figure("tank-treading", {});
  CHECK(refused.status == 1);
  CHECK_THAT(refused.err, Contains("t.h5', vesicle 0: it tumbles"));
  CHECK_FALSE(fs::exists(turns.folder / "tank-treading.csv"));
  // Its angle goes on beyond a right angle, in both figures that show it.
  REQUIRE(turns.figure("inclination", {}).status == 0);
  REQUIRE(turns.figure("time-series", {"--set", "figure.quantities=[\"inclination\"]"}).status == 0);
  const std::string angles = support::read_file(turns.folder / "inclination.csv");
  CHECK(angles == support::read_file(turns.folder / "time-series.csv"));
  CHECK(std::stod(angles.substr(angles.rfind(',') + 1)) < -120);
}

TEST_CASE("curves of scenes of one title are told apart by what differs between them", "[figure]") {
  const Bench first({"vesicle.viscosity_contrast=3"}), second({"vesicle.viscosity_contrast=5"});
  for (const char* kind : {"time-series", "phase"}) {
    REQUIRE(first.figure(kind, {second.trajectory}).status == 0);
    const std::string csv = support::read_file(first.folder / (std::string(kind) + ".csv"));
    CHECK_THAT(csv, Contains("λ = 3,") && Contains("λ = 5,"));
  }
  CHECK_THAT(first.figure("phase-diagram", {second.trajectory}).err,
             Contains("differ in two numbers; these differ in vesicle.viscosity_contrast only"));
  REQUIRE(first.figure("phase", {first.trajectory}).status == 0);  // nothing differs
  CHECK_THAT(support::read_file(first.folder / "phase.csv"), Contains("t.h5"));
}

TEST_CASE("an instant between saved states is interpolated in figures as in stills", "[figure]") {
  const Bench bench;
  REQUIRE(bench.figure("overlay", {"--set", "figure.times=[0.1, 0.15, 0.2]"}).status == 0);
  std::map<double, std::vector<double>> heights;  // of the points of each section, in the order of the curve
  std::istringstream lines(support::read_file(bench.folder / "overlay.csv"));
  std::string line;
  for (std::getline(lines, line); std::getline(lines, line);)
    heights[std::stod(line)].push_back(std::stod(line.substr(line.rfind(',') + 1)));
  REQUIRE(heights.size() == 3);
  const auto top = [&](double time) { return *std::max_element(heights.at(time).begin(), heights.at(time).end()); };
  // Between both, and nearer to their middle than to either.
  const double whole = top(0.2) - top(0.1);
  CHECK(std::abs(whole) > 1e-4);
  CHECK((top(0.15) - top(0.1)) / whole == Approx(0.5).margin(0.2));
}

TEST_CASE("a phase portrait goes through the saved states, and between them where the trajectory goes", "[figure]") {
  // The same steps, saved at each and at every fourth.
  const std::vector<std::string> steps{"time.step=0.1", "time.end=1.6"};
  std::vector<std::string> coarse = steps, dense = steps;
  coarse.emplace_back("time.save_every=0.4");
  dense.emplace_back("time.save_every=0.1");
  const auto points_of = [](const Bench& bench) {
    REQUIRE(bench.figure("phase", {}).status == 0);
    std::vector<std::pair<double, double>> points;  // inclination, deformation
    std::istringstream lines(support::read_file(bench.folder / "phase.csv"));
    std::string line;
    for (std::getline(lines, line); std::getline(lines, line);) {
      const std::size_t y = line.rfind(',', line.size() - 2), x = line.rfind(',', y - 1);
      points.emplace_back(std::stod(line.substr(x + 1)), std::stod(line.substr(y + 1)));
    }
    points.pop_back();  // the mark of the start
    return points;
  };
  const auto few = points_of(Bench(coarse)), many = points_of(Bench(dense));
  // 4 intervals into 20 pieces each, and 16 into 20.
  REQUIRE(few.size() == 81);
  REQUIRE(many.size() == 321);
  double chord = 0, miss = 0;
  for (std::size_t k = 0; k < 17; ++k) {  // the states that the second file holds
    const auto& [x, y] = many[20 * k];
    CHECK(few[5 * k].first == Approx(x).margin(0.05));  // degrees, of 27 in all; cubics over 0.4 of the time
    miss = std::max(miss, std::abs(few[5 * k].first - x));
    const std::size_t from = k / 4 * 20, to = std::min<std::size_t>(from + 20, 80);
    const double share = static_cast<double>(k % 4) / 4;
    chord = std::max(chord, std::abs((1 - share) * few[from].first + share * few[to].first - x));
    if (k % 4 == 0) CHECK(few[5 * k].second == Approx(y).epsilon(1e-4));  // steps may differ
  }
  CHECK(chord > 10 * miss);  // what straight lines would miss
}

TEST_CASE("plots below a picture leave its views as they are and mark the time", "[figure]") {
  const Bench bench;
  const auto still = [&](const char* name, const char* time, const char* size, bool plots) {
    std::vector<std::string> words{TANKTREAD_PROGRAM,
                                   "render",
                                   bench.trajectory,
                                   "-o",
                                   (bench.folder / name).string(),
                                   "--time",
                                   time,
                                   "--size",
                                   size,
                                   "--set",
                                   "view.supersampling=1"};
    if (plots) words.insert(words.end(), {"--set", "view.plots=[\"energy\"]"});
    const support::Outcome drawn = support::run(bench.folder, words);
    INFO(drawn.err);
    REQUIRE(drawn.status == 0);
    return render::read_png(bench.folder / name).image;
  };
  const render::Image early = still("a.png", "0.1", "320x240", true), late = still("b.png", "0.2", "320x240", true),
                      alone = still("c.png", "0.2", "320x168", false);
  CHECK(std::equal(alone.pixels.begin(), alone.pixels.end(), late.pixels.begin()));
  // The mark: a dark column that one picture has and the other has not.
  const auto marked = [](const render::Image& a, const render::Image& b) {
    int last = -1;
    for (int x = 0; x < a.width; ++x) {
      int darker = 0;
      for (int y = 168; y < a.height; ++y) darker += a.at(x, y)[1] + 20 < b.at(x, y)[1];
      if (darker > 8) last = x;
    }
    return last;
  };
  CHECK(marked(early, late) > 0);
  CHECK(marked(late, early) > marked(early, late) + 50);
}
