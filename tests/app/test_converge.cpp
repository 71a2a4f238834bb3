// Observed orders and limits of sequences, the results of a run, and the command converge as a user meets it.
#include "app/converge/sequence.h"
#include "app/converge/values.h"
#include "app/converge/variation.h"
#include "app/tables/results.h"
#include "desk.h"
#include "sim/surface/shapes.h"
#include "sim/trajectory/trajectory.h"
#include "tests/support/catch.h"

#include <cmath>
#include <numbers>

using app::Convergence;
using app::convergence_of;
using app::OrderVerdict;
using Catch::Contains;
using commands::Desk;
using support::Outcome;

namespace {

std::vector<double> errors_of(const std::vector<double>& h, double q, double c, double v) {
  std::vector<double> values;
  for (const double x : h) values.push_back(v + c * std::pow(x, q));
  return values;
}

/// As the program steps: three values of h that fall by one factor, by two, and of many.
const std::vector<std::vector<double>> ladders{{0.2, 0.1, 0.05},
                                               {1e-2, 1e-3, 1e-4},
                                               {0.3, 0.1, 0.08},
                                               {1, 0.5, 0.3, 0.2, 0.1},
                                               {std::exp(-6), std::exp(-8), std::exp(-10)},
                                               {std::exp(-8), std::exp(-9), std::exp(-12)}};

const std::string quick = R"(title = "quick"
[flow]
kind = "shear"
[time]
end = 0.4
[[vesicle]]
shape = "prolate"
reduced_volume = 0.9
order = 4
[numerics]
tail_warning = 1.0
)";

app::History history(double end, int n, double (*value)(double)) {
  app::History h;
  for (int k = 0; k <= n; ++k) {
    h.times.push_back(end * k / n);
    h.values.push_back(value(h.times.back()));
  }
  return h;
}

double result(const char* name, const app::History& h) {
  return std::get<app::OfQuantity>(sim::find_row(app::results(), name)->source).reduce(h);
}
double reduction(const char* name, const app::History& h) { return sim::find_row(app::reductions(), name)->reduce(h); }

sim::VesicleState ellipsoid(const sim::Vec3& axes, int order) {
  sim::VesicleParameters v;
  v.shape = "ellipsoid";
  v.axes = axes;
  v.order = order;
  sim::VesicleState state;
  state.position = sim::initial_position(v);
  state.tracers = sim::Matrix::Identity(3, 3);
  return state;
}

double distance(const char* name, const sim::VesicleState& a, const sim::VesicleState& b, double length) {
  return std::get<app::OfMembranes>(sim::find_row(app::results(), name)->source).distance(a, b, length);
}

}  // namespace

TEST_CASE("values v + C h^q have the order q and the limit v, whatever the steps between the h") {
  for (const std::vector<double>& h : ladders)
    for (const double q : {0.7, 1.0, 2.0, 3.6})
      for (const double c : {-2.0, 5.0})
        for (const double v : {0.0, 24.155}) {
          const std::vector<double> values = errors_of(h, q, c, v);
          const Convergence r = convergence_of(h, values);
          // What rounding of the values, 1e-16 of the largest, leaves in the ratio of their differences.
          const double n = values.size(), last = std::abs(values[n - 2] - values[n - 1]);
          const double rounding = 1e-15 * (std::abs(v) + std::abs(values[0])) / last;
          if (rounding > 0.01) continue;
          INFO("q = " << q << ", C = " << c << ", v = " << v << ", h = " << h[0] << ", " << h[1] << ", ...");
          if (std::pow(h[h.size() - 2] / h.back(), q) < 4.0 / 3) {  // more than three times the last difference is left
            CHECK(r.verdict == OrderVerdict::slow);
            continue;
          }
          REQUIRE(r.verdict == OrderVerdict::converges);
          CHECK(*r.order == Approx(q).epsilon(20 * rounding + 1e-12));
          CHECK(*r.limit == Approx(v).margin(20 * rounding * std::abs(last) + 1e-14 * (1 + std::abs(v))));
          for (std::size_t k = 0; k < h.size(); ++k)
            CHECK(r.errors[k] == Approx(std::abs(c) * std::pow(h[k], q)).epsilon(1e-6).margin(20 * rounding * last));
        }
}

TEST_CASE("where the h fall by one factor the limit is that of Aitken") {
  const double a = 3.1, b = 2.3, c = 2.1;
  const Convergence r = convergence_of({0.4, 0.2, 0.1}, {a, b, c});
  CHECK(*r.limit == Approx(c - (b - c) * (b - c) / ((a - b) - (b - c))).epsilon(1e-14));
  CHECK(*r.order == Approx(std::log2((a - b) / (b - c))).epsilon(1e-14));
}

TEST_CASE("a sequence that does not converge has no order and no limit, and says why") {
  const std::vector<double> h{0.4, 0.2, 0.1};
  const auto verdict = [&](std::vector<double> values, double noise = 0) {
    const Convergence r = convergence_of(h, values, noise);
    const bool limited = r.verdict == OrderVerdict::converges || r.verdict == OrderVerdict::settled;
    CHECK(r.order.has_value() == (r.verdict == OrderVerdict::converges));
    CHECK(r.limit.has_value() == limited);
    CHECK(r.errors.size() == values.size());
    return r.verdict;
  };
  CHECK(verdict({1, 2, 4}) == OrderVerdict::grows);
  CHECK(verdict({1, 2, 3}) == OrderVerdict::grows);  // no fall at all
  CHECK(verdict({1, 1, 2}) == OrderVerdict::grows);
  CHECK(verdict({1, 2, 2.9}) == OrderVerdict::slow);  // by a tenth: the rest would be nine times the last difference
  CHECK(verdict({1, 2, 0.5}) == OrderVerdict::alternates);
  CHECK(verdict({1, 2, 2}) == OrderVerdict::settled);
  CHECK(verdict({3, 3, 3}) == OrderVerdict::settled);
  CHECK(verdict({1, std::nan(""), 1}) == OrderVerdict::undefined);
  CHECK(verdict({1, INFINITY, 1}) == OrderVerdict::undefined);
  // Differences within the noise tell no order, though their ratio would.
  CHECK(verdict({1.4e-9, 1.2e-9, 1.1e-9}) == OrderVerdict::converges);
  CHECK(verdict({1.4e-9, 1.2e-9, 1.1e-9}, 1e-8) == OrderVerdict::settled);
  CHECK(convergence_of({0.2, 0.1}, {1, 2}).verdict == OrderVerdict::too_few);
  CHECK(convergence_of({0.2, 0.1}, {1, 2}).uncertainty == 1);
  CHECK_THROWS_AS(convergence_of({0.1, 0.2, 0.3}, {1, 2, 4}), std::invalid_argument);
  CHECK_THROWS_AS(convergence_of({0.1}, {1}), std::invalid_argument);
}

TEST_CASE("the limit of differences that alternate and fall lies between the last two values") {
  const Convergence r = convergence_of({0.4, 0.2, 0.1}, {1, 2, 1.9});
  CHECK(r.verdict == OrderVerdict::alternates);
  CHECK_FALSE(r.order);
  CHECK(*r.limit == 1.9);
  CHECK(r.uncertainty == Approx(0.1));
  CHECK(r.known(0));
  CHECK_FALSE(r.known(2));
}

TEST_CASE("an order beyond that of theory, or a limit that moved, does not make a limit more certain") {
  const std::vector<double> h{0.4, 0.2, 0.1};
  const double last = 0.01, before = 1;  // falls a hundredfold: an order of 6.6, as by chance
  const Convergence r = convergence_of(h, {before + last, last, 0}, 0, 2);
  CHECK(*r.order == Approx(std::log2(100)));
  CHECK(r.uncertainty == Approx(last / 3));  // as an error of order 2 would be
  const Convergence longer = convergence_of({0.8, 0.4, 0.2, 0.1}, {4, 2, 1.2, 1});
  const Convergence earlier = convergence_of({0.8, 0.4, 0.2}, {4, 2, 1.2});
  CHECK(longer.uncertainty >= std::abs(*earlier.limit - *longer.limit));
}

TEST_CASE("results of a history are those of the function that it samples") {
  constexpr double pi = std::numbers::pi;
  // Jeffery's ellipsoid of ratio 2 turns by 180 degrees in pi (r + 1/r) = 2.5 pi; the angle is continued.
  const app::History tumbling = history(20, 400, [](double t) {
    const double w = t * 2 / 5, turns = std::floor(w / pi + 0.5);
    return -(std::atan(2 * std::tan(w)) + pi * turns) * 180 / pi;
  });
  // Four points 0.05 apart interpolate to some 1e-6; h^4 of the rate of change.
  CHECK(result("half-turn", tumbling) == Approx(2.5 * pi).margin(1e-5));
  CHECK(result("period", tumbling) == Approx(5 * pi).margin(4e-5));
  CHECK(std::isnan(result("steady-angle", tumbling)));
  const app::History swinging = history(20, 400, [](double t) { return 5 + 20 * std::sin(1.3 * t); });
  CHECK(std::isnan(result("half-turn", swinging)));
  // Parabolas through three points err by h^2 of the time and h^4 of the height.
  CHECK(result("period", swinging) == Approx(2 * pi / 1.3).margin(2e-3));
  CHECK(reduction("largest", swinging) == Approx(25).margin(1e-4));
  CHECK(reduction("least", swinging) == Approx(-15).margin(1e-4));
  const app::History rising = history(3, 60, [](double t) { return t; });
  CHECK(result("steady-angle", rising) == Approx(2.5));
  CHECK(reduction("mean", rising) == Approx(1.5));
  CHECK(reduction("final", rising) == 3);
  CHECK(reduction("largest", rising) == 3);
  CHECK(reduction("least", rising) == 0);
  CHECK(std::isnan(result("period", rising)));
  for (const app::ReductionRow& row : app::reductions()) CHECK(std::isnan(row.reduce({})));
}

TEST_CASE("the distance of shapes is that of their surfaces, wherever the points lie, and that of dots is theirs") {
  const sim::VesicleState one = ellipsoid({1, 1, 1}, 8), two = ellipsoid({1.1, 1.1, 1.1}, 6);
  CHECK(distance("shape-distance", one, two, 2) == Approx(0.05).margin(1e-12));
  CHECK(distance("dot-distance", one, two, 2) == Approx(0.05).margin(1e-12));
  sim::VesicleState turned = one;  // the same sphere, its points elsewhere
  turned.position.values.col(0) = one.position.values.col(1);
  turned.position.values.col(1) = -one.position.values.col(0);
  CHECK(distance("shape-distance", one, turned, 1) == Approx(0).margin(1e-12));
  CHECK(distance("dot-distance", one, turned, 1) == Approx(std::sqrt(4.0 / 3)));  // two of three by a right angle
  sim::VesicleState moved = one;
  moved.position.values(0, 2) += 0.01 * std::sqrt(4 * std::numbers::pi);
  // A sphere moved by d: the mean square of d cos is d^2/3; the second order adds d^4.
  CHECK(distance("shape-distance", moved, one, 1) == Approx(0.01 / std::sqrt(3.0)).epsilon(1e-4));
}

TEST_CASE("every study varies three values round the scene's own, which a scene may have") {
  for (const app::VariationRow& row : app::variations()) {
    const std::vector<double> owns = row.name == "order" ? std::vector<double>{2, 3, 8, 12, 62, 64}
                                                         : std::vector<double>{1e-6, 2e-6, 1e-5, 1e-3, 0.03, 0.1};
    for (const double own : owns) {
      const std::vector<double> values = row.around(own);
      INFO(row.name << " " << own);
      REQUIRE(values.size() == 3);
      CHECK(std::count(values.begin(), values.end(), own) == 1);
      for (std::size_t k = 0; k < 3; ++k) {
        if (k > 0) CHECK(row.smallness(values[k]) < row.smallness(values[k - 1]));
        if (row.name == "tolerance") CHECK((values[k] >= 1e-6 && values[k] <= 0.1));
        if (row.name == "order") CHECK((values[k] >= 2 && values[k] <= 64));
      }
    }
  }
}

TEST_CASE("states are saved at the same times in all runs where the steps fit, else where each run's steps end") {
  CHECK(app::common_save_interval({0.2, 0.1, 0.05}, {0.2, 0.1, 0.05}) == 0.2);
  CHECK(app::common_save_interval({0.2, 0.1, 0.05}, {1, 1, 1}) == 1.0);
  CHECK(app::common_save_interval({0.2, 0.1, 0.05}, {0.1, 0.1, 0.1}) == 0.2);  // would halve the longest step
  CHECK_FALSE(app::common_save_interval({0.3, 0.2, 0.1}, {0.3, 0.2, 0.1}));
}

TEST_CASE(
    "what is asked for is a quantity, a column or a result, reduced or of one vesicle; else the nearest is named") {
  sim::Scene scene;
  scene.vesicles.resize(2);
  const auto all = app::read_results("half-turn, energy:largest,vesicle.1.area_error,gap:least", scene);
  REQUIRE(all.size() == 4);
  CHECK((all[1].name == "energy" && all[1].reduction == "largest" && !all[1].vesicle));
  CHECK((all[2].name == "area_error" && all[2].vesicle == 1));
  const auto refused = [&](const char* text, const char* said) {
    CHECK_THROWS_WITH(app::read_results(text, scene), Contains(said));
  };
  refused("inclinaton", "did you mean 'inclination'");
  refused("energy:largst", "did you mean 'largest'");
  refused("half-turn:least", "is a number already");
  refused("vesicle.2.energy", "numbered from 0 to 1");
  refused("vesicle.x.energy", "vesicle.0.NAME");
  refused("vesicle.0.gap", "belongs to no vesicle");
  refused("energy,", "there is no result ''");
}

TEST_CASE("converge runs a scene three times, tells orders and limits, and keeps what it has", "[commands]") {
  const Desk desk(quick);
  const std::vector<std::string> words{"converge", desk.file("s.toml"), "-o", desk.file("out")};
  const Outcome first = desk(words);
  INFO(first.err << first.out);
  REQUIRE(first.status == 0);
  CHECK_THAT(first.err, Contains("tolerance 0.0001: ") && Contains("order 4 leaves errors"));  // and nothing worse
  CHECK_THAT(first.out, Contains("0.001 *") && Contains("inclination") && Contains("stated"));
  for (const char* name : {"tolerance-0.01.h5", "tolerance-0.001.h5", "tolerance-0.0001.h5", "tolerance.csv",
                           "tolerance.png", "tolerance.svg", "tolerance.pdf", "tolerance.md"})
    CHECK(std::filesystem::exists(desk.path() / "out" / name));
  const std::string csv = support::read_file(desk / "out/tolerance.csv");
  CHECK_THAT(csv, Contains("# tanktread ") && Contains("# order = 4") &&
                      Contains("result,unit,tolerance,steps,stated_error,value,error,order,limit,uncertainty,verdict"));
  const Outcome again = desk(words);
  CHECK(again.status == 0);
  CHECK_THAT(again.out, Contains("kept"));
  CHECK(support::read_file(desk / "out/tolerance.csv") == csv);

  std::vector<std::string> changed = words;
  changed.insert(changed.end(), {"--set", "vesicle.viscosity_contrast=2"});
  const Outcome other = desk(changed);
  CHECK(other.status == 1);
  CHECK_THAT(other.err, Contains("belongs to another scene") && Contains("--force"));
  changed.emplace_back("--force");
  CHECK(desk(changed).status == 0);
  CHECK(support::read_file(desk / "out/tolerance.csv") != csv);

  support::write_file(desk / "out/tolerance.csv", "mine");
  const Outcome edited = desk(words);
  CHECK(edited.status == 1);
  CHECK_THAT(edited.err, Contains("changed since"));
  CHECK(support::read_file(desk / "out/tolerance.csv") == "mine");
}

TEST_CASE("the files of converge have the same bytes with one thread and with two", "[commands]") {
  const Desk desk(quick);
  for (const char* threads : {"1", "2"})
    REQUIRE(desk({"converge", desk.file("s.toml"), "-o", desk.file(threads), "-j", threads, "--set", "time.end=0.2",
                  "--vary", "order", "--values", "3,4,5", "-q"})
                .status == 0);
  for (const char* name : {"order.csv", "order.png", "order.svg", "order.pdf", "order.md"})
    CHECK(support::read_file(desk.path() / "1" / name) == support::read_file(desk.path() / "2" / name));
}

TEST_CASE("converge stops at the first signal, and the same command makes what it would have made", "[commands]") {
  const Desk desk(quick);
  const auto words = [&](const char* folder) {
    return std::vector<std::string>{TANKTREAD_PROGRAM, "converge", desk.file("s.toml"), "-o",
                                    desk.file(folder), "--set",    "time.end=3"};
  };
  const pid_t child = support::start(desk, words("a"));
  REQUIRE(support::wait_for(desk / "a/tolerance-0.001.h5"));
  kill(child, SIGINT);
  const Outcome stopped = support::finish(desk, child);
  INFO(stopped.err);
  REQUIRE(stopped.status == 130);
  CHECK(stopped.out.empty());
  CHECK_THAT(stopped.err, Contains("1 of 3 runs") && Contains("the same command continues"));
  CHECK_FALSE(std::filesystem::exists(desk / "a/tolerance.csv"));
  for (const char* folder : {"a", "b"}) REQUIRE(support::run(desk, words(folder)).status == 0);
  for (const char* name : {"tolerance.csv", "tolerance.png", "tolerance.md", "tolerance-0.001.h5"})
    CHECK(support::read_file(desk.path() / "a" / name) == support::read_file(desk.path() / "b" / name));
}

TEST_CASE("fixed steps are varied by their length, without one that is shortened to meet a saved state", "[commands]") {
  const Desk desk(quick);
  const Outcome said = desk({"converge", desk.file("s.toml"), "-o", desk.file("out"), "--set", "time.step=0.1", "--set",
                             "time.save_every=0.1", "--quantities", "inclination"});
  INFO(said.err << said.out);
  REQUIRE(said.status == 0);
  for (const double step : {0.2, 0.1, 0.05}) {
    const sim::TrajectoryReader run(desk.file("out/step-" + app::value_text(step) + ".h5"));
    CHECK(run.count() == 3);
    CHECK(run.time(1) == Approx(0.2));
    CHECK(run.steps().back().dt == Approx(step));  // not the interval that the scene saves at
  }
}

TEST_CASE("what converge cannot vary or does not know ends with one sentence and nothing written", "[commands]") {
  const Desk desk(quick);
  const auto refused = [&](std::vector<std::string> words, const char* said) {
    words.insert(words.begin(), {"converge", desk.file("s.toml"), "-o", desk.file("x")});
    const Outcome outcome = desk(words);
    INFO(outcome.err);
    CHECK(outcome.status == 1);
    CHECK(outcome.out.empty());
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK_THAT(outcome.err, Contains(said));
    CHECK(desk.names().empty());
  };
  refused({"--vary", "step"}, "take --vary tolerance");
  refused({"--vary", "ordr"}, "did you mean 'order'");
  refused({"--vary", "tolerance", "--set", "time.step=0.1"}, "take --vary step");
  refused({"--values", "1e-3,1e-4,1e-7"}, "--values 1e-7: 'tolerance' must be at least 1e-06");
  refused({"--values", "1e-3,x"}, "'x' is not a positive number");
  refused({"--values", "1e-3"}, "two values at least");
  refused({"--values", "1e-3,1e-3"}, "given twice");
  refused({"--vary", "order", "--values", "4,6.5,8"}, "not a whole number");
  refused({"--vary", "order", "--values", "1,4,6"}, "--values 1: 'order' must be at least 2");
  refused({"--quantities", "enrgy"}, "did you mean 'energy'");
  refused({"--set", "vesicle.oder=3"}, "oder");
}
