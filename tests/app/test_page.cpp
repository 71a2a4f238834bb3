// The page of `export --html`: its packed numbers, its size, and texts that try to be markup.
#include "app/base/markup.h"
#include "app/export/page.h"
#include "app/export/page_series.h"
#include "sim/sphere/basis.h"
#include "tests/app/desk.h"
#include "tests/support/catch.h"

#include <zlib.h>

#include <cmath>
#include <random>

namespace {

using commands::Desk;

/// As page_series.h describes it: `rows` x `frames`.
sim::Matrix unpacked(std::string_view bytes, std::size_t rows, std::size_t frames, double quantum) {
  sim::Matrix values(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(frames));
  std::size_t at = 0;
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    const int differences = bytes.at(at++);
    double last = 0, before = 0;
    for (Eigen::Index k = 0; k < values.cols(); ++k) {
      double number = 0, weight = 1;
      for (bool more = true; more; weight *= 128) {
        const auto byte = static_cast<unsigned char>(bytes.at(at++));
        number += weight * (byte & 127U);
        more = byte >= 128;
      }
      const bool negative = std::fmod(number, 2) == 1;
      const double residual = negative ? -(number + 1) / 2 : number / 2;
      const double now = residual + (differences == 2 ? 2 * last - before : differences == 1 ? last : 0);
      values(row, k) = quantum * now;
      before = last;
      last = now;
    }
  }
  CHECK(at == bytes.size());
  return values;
}

std::string between(const std::string& text, const std::string& before, const std::string& after) {
  const std::size_t from = text.find(before);
  REQUIRE(from != std::string::npos);
  const std::size_t to = text.find(after, from + before.size());
  REQUIRE(to != std::string::npos);
  return text.substr(from + before.size(), to - from - before.size());
}

std::string from_base64(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned value = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    value = value << 6 | static_cast<unsigned>(letters.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(value >> bits & 255U);
  }
  return bytes;
}

std::string inflated(const std::string& packed, std::size_t most) {
  std::string bytes(most, '\0');
  uLongf size = most;
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                     packed.size()) == Z_OK);
  bytes.resize(size);
  return bytes;
}

TEST_CASE("numbers of a page come back to half a quantum, whatever their history", "[page]") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> even(-1, 1);
  constexpr double quantum = 1e-4;
  app::PageSeries series(quantum);
  constexpr std::size_t frames = 40;
  sim::Matrix expected = sim::Matrix::Zero(7, frames);
  for (std::size_t k = 0; k < frames; ++k) {
    const double t = static_cast<double>(k) / frames;
    // smooth, jumping, still, far away, small, late; the row after these is always 0
    std::vector<double> numbers{std::sin(6 * t), even(random), -3.25, 1e7 + t, quantum * even(random)};
    if (k >= 25) numbers.push_back(t);
    for (std::size_t row = 0; row < numbers.size(); ++row)
      expected(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(k)) = numbers[row];
    if (k >= 25) numbers.push_back(0);
    series.add(numbers);
  }
  REQUIRE(series.rows() == 6);
  const sim::Matrix found = unpacked(series.bytes(), series.rows(), frames, quantum);
  const sim::Matrix wanted = expected.topRows(6);
  CHECK((found - wanted).cwiseAbs().maxCoeff() <= 0.5 * quantum * (1 + 1e-4));  // 1e7 has its own rounding
}

TEST_CASE("a page refuses numbers that it cannot hold", "[page]") {
  app::PageSeries series(1e-4);
  CHECK_THROWS_AS(series.add(std::vector{std::nan("")}), std::invalid_argument);
  CHECK_THROWS_AS(series.add(std::vector{1e30}), std::invalid_argument);
}

TEST_CASE("coefficients rounded to the quantum of a page leave the error that it is made for", "[page]") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> even(-0.5, 0.5);
  for (const int order : {4, 12, 24}) {
    constexpr double error = 5e-5;
    const double quantum = app::page_quantum(error, order);
    sim::Coefficients rounding{order, sim::Matrix(sim::coefficient_count(order), 3)};
    for (double& value : rounding.values.reshaped()) value = quantum * even(random);
    const sim::Basis basis(order, order);
    const sim::Matrix values = basis.synthesize(rounding).values;
    const double mean = (basis.weights().transpose() * values.cwiseAbs2()).mean() / (4 * std::numbers::pi);
    CHECK(std::sqrt(mean) == Approx(error).epsilon(0.25));  // a sum of (p + 1)^2 random numbers
  }
}

TEST_CASE("a page holds the trajectory's positions to the precision that it states", "[page]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(desk({"export", desk.file("t.h5"), "--html", desk.file("p.html"), "--set", "view.follow=never", "--set",
                "view.target=[0,0,0]", "-q"})
              .status == 0);
  const std::string page = support::read_file(desk.file("p.html"));
  const sim::TrajectoryReader trajectory(desk.file("t.h5"));
  const std::string bytes = inflated(from_base64(between(page, "\"bytes\":\"", "\"")), 1 << 22);
  const std::string head = between(page, "\"position\":[", "]");
  const auto rows = static_cast<std::size_t>(std::stoi(head));
  const double quantum = std::stod(head.substr(head.find(',') + 1));
  const auto frames = static_cast<std::size_t>(trajectory.count());
  // The positions of the first vesicle come first: read their rows alone.
  std::size_t end = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    ++end;
    for (std::size_t k = 0; k < frames; ++k)
      while (static_cast<unsigned char>(bytes.at(end++)) >= 128) {
      }
  }
  const sim::Matrix found = unpacked(std::string_view(bytes).substr(0, end), rows, frames, quantum);
  for (std::size_t k = 0; k < frames; ++k) {
    const sim::State state = trajectory.state(static_cast<std::int64_t>(k));
    const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> expected = state.vesicles[0].position.values;
    for (std::size_t row = 0; row < static_cast<std::size_t>(expected.size()); ++row) {
      const double value = row < rows ? found(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(k)) : 0;
      // of an area radius, which is 1
      CHECK(std::abs(value - expected.data()[row]) <= 0.51 * quantum);
    }
  }
  CHECK(quantum <= app::page_quantum(app::page_position_error, 6) * 1.0001);
}

TEST_CASE("a page of two vesicles and two hundred frames, with all that it can show, is below a megabyte", "[page]") {
  // Two that pass each other: nothing repeats, and frames are as far apart as in a movie.
  const Desk desk(R"(title = "an encounter"
[flow]
kind = "shear"
[time]
end = 20
save_every = 0.1
[[vesicle]]
shape = "prolate"
reduced_volume = 0.85
center = [-4, 0, 0.25]
order = 8
[[vesicle]]
shape = "prolate"
reduced_volume = 0.85
center = [4, 0, -0.25]
order = 8
[view]
field = "tension"
inset = true
flow_profile = true
cut = "common"
)");
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(sim::TrajectoryReader(desk.file("t.h5")).count() == 201);
  REQUIRE(desk({"export", desk.file("t.h5"), "--html", desk.file("p.html"), "-q"}).status == 0);
  CHECK(std::filesystem::file_size(desk.file("p.html")) < 1000000);
  CHECK(support::read_file(desk.file("p.html")).find("\"frames\":201,") != std::string::npos);
}

TEST_CASE("titles cannot leave their place in a page", "[page]") {
  std::string text = commands::scene;
  const std::string hostile = "</script><script>alert(1)</script><!-- {{data}} & \\\"' ";
  text.replace(text.find("small"), 5, hostile);
  const Desk desk(text);
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(desk({"export", desk.file("t.h5"), "--html", desk.file("p.html"), "-q"}).status == 0);
  const std::string page = support::read_file(desk.file("p.html"));
  CHECK(page.find("alert(1)</script>") == std::string::npos);
  CHECK(page.find("<script>alert") == std::string::npos);
  CHECK(page.find("<!--") == std::string::npos);
  const auto count = [&](const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = page.find(word); at != std::string::npos; at = page.find(word, at + 1)) ++found;
    return found;
  };
  CHECK(count("</script>") == 2);  // of the data and of the program
  CHECK(count("\"bytes\":") == 1);
  CHECK(page.find("http://") == std::string::npos);  // needs nothing but itself
  CHECK(page.find("https://") == std::string::npos);
}

TEST_CASE("texts of a page are filled in once, and not again", "[page]") {
  CHECK(app::filled("a {{x}} {{y}} {{z}} {", {{"x", "{{y}}"}, {"y", "1"}}) == "a {{y}} 1 {{z}} {");
}

TEST_CASE("the same trajectory makes the same page, and --set goes with a page alone", "[page]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(desk({"export", desk.file("t.h5"), "--html", desk.file("a.html"), "-q"}).status == 0);
  REQUIRE(desk({"export", desk.file("t.h5"), "--html", desk.file("b.html"), "-q"}).status == 0);
  CHECK(support::read_file(desk.file("a.html")) == support::read_file(desk.file("b.html")));
  const support::Outcome refused =
      desk({"export", desk.file("t.h5"), "--csv", desk.file("t.csv"), "--set", "view.style=ghost"});
  CHECK(refused.status == 1);
  CHECK_FALSE(std::filesystem::exists(desk.file("t.csv")));
  const support::Outcome unknown =
      desk({"export", desk.file("t.h5"), "--html", desk.file("c.html"), "--set", "view.style=goost"});
  CHECK(unknown.status == 1);
  CHECK(unknown.err.find("ghost") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(desk.file("c.html")));
}

}  // namespace
