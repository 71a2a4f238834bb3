// Validations: the catalogue, one of them as a user runs it, the page that keeps what others wrote, the theories.
#include "app/base/version.h"
#include "app/scene/scene_file.h"
#include "app/validate/base_scenes.h"
#include "app/validate/theory.h"
#include "app/validate/validations.h"
#include "sim/surface/shapes.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

#include <cmath>
#include <numbers>
#include <set>

using Catch::Contains;
namespace fs = std::filesystem;

TEST_CASE("validations have names of their own, and a meaning each", "[validate]") {
  std::set<std::string_view> names{"all"};
  for (const app::ValidationRow& row : app::validations()) {
    INFO(row.name);
    CHECK(names.insert(row.name).second);
    CHECK_FALSE(row.meaning.empty());
    CHECK_FALSE(row.meaning.ends_with('.'));
    CHECK(row.seconds > 0);
    CHECK(row.measure != nullptr);
  }
}

TEST_CASE("the scenes that validations change are those of the folder scenes", "[validate]") {
  for (const app::BaseScene& base : app::base_scenes()) {
    INFO(base.name);
    if (base.in_folder)
      CHECK(support::read_file(fs::path(TANKTREAD_SCENES) / (std::string(base.name) + ".toml")) == base.text);
    CHECK_NOTHROW(app::parse_scene(base.text, std::string(base.name), "."));
  }
}

TEST_CASE("an unknown validation is refused with the nearest known one, and none at all lists them", "[validate]") {
  const support::TemporaryFolder folder;
  const support::Outcome wrong =
      support::run(folder, {TANKTREAD_PROGRAM, "validate", "faxen", "jeffrey", "-o", (folder / "v").string()});
  CHECK(wrong.status == 1);
  CHECK_THAT(wrong.err, Contains("'jeffrey'") && Contains("'jeffery'"));
  CHECK_FALSE(fs::exists(folder / "v"));
  const support::Outcome none = support::run(folder, {TANKTREAD_PROGRAM, "validate"});
  CHECK(none.status == 0);
  for (const app::ValidationRow& row : app::validations()) CHECK_THAT(none.out, Contains(std::string(row.meaning)));
}

TEST_CASE("a validation writes its section with all parts, and leaves the rest of the page", "[validate]") {
  const support::TemporaryFolder folder;
  const fs::path page = folder / "page.md";
  const std::vector<std::string> words{TANKTREAD_PROGRAM, "validate", "sedimentation", "-q", "-o", page.string()};
  support::write_file(page, "# Mine\n\n## Spheres\n\nround\n\n## The paper\n\nits items\n");
  const support::Outcome refused = support::run(folder, words);
  CHECK(refused.status == 1);
  CHECK_THAT(refused.err, Contains("page.md") && Contains("--force"));
  CHECK_THAT(support::read_file(page), !Contains("Sedimentation"));
  std::vector<std::string> forced = words;
  forced.emplace_back("--force");
  const support::Outcome outcome = support::run(folder, forced);
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.empty());
  const std::string text = support::read_file(page);
  CHECK(text.starts_with("# Mine\n\n## Spheres\n\nround\n\n## Sedimentation\n\n"));
  CHECK(text.ends_with("\n\n## The paper\n\nits items\n"));
  CHECK_THAT(text, Contains("`tanktread validate sedimentation` on 20") &&
                       Contains("with tanktread " + app::version()) &&
                       Contains("The first of its 8 runs: `tanktread simulate scenes/sedimentation.toml --set ") &&
                       Contains("| λ | R | p |") && Contains("| pass |") && !Contains("FAIL"));
}

TEST_CASE("a section replaces the one with its title and takes the place that the order gives it", "[validate]") {
  const std::vector<std::string> order{"A", "B", "C"};
  const std::string head = "# Page\n\nabout\n", paper = "## Paper\n\nx\n";
  const std::string a = "## A\n\n1\n", b = "## B\n\n2\n", c = "## C\n\n3\n";
  std::string page = head + "\n" + paper;
  for (const std::string& section : {c, a, b}) page = app::with_section(page, section, order);
  CHECK(page == head + "\n" + a + "\n" + b + "\n" + c + "\n" + paper);
  CHECK(app::with_section(page, b, order) == page);
  const std::string renewed = app::with_section(page, "## B\n\n### part\n\nnew\n", order);
  CHECK(renewed == head + "\n" + a + "\n## B\n\n### part\n\nnew\n\n" + c + "\n" + paper);
  CHECK(app::with_section("", a, order).ends_with("\n\n" + a));
}

TEST_CASE("a row beyond its tolerance fails, one at its tolerance passes, and failures are counted", "[validate]") {
  app::Section section;
  section.checks();
  section.check("inside", 1.5, 1, 0.5);
  CHECK(section.failures == 0);
  section.check("outside", 1.51, 1, 0.5);
  section.below("small", -2e-6, 1e-6);
  section.check("not a number", std::nan(""), 1, 0.5);
  section.below("nor this", std::nan(""), 1);
  CHECK(section.failures == 4);
  const auto& rows = section.tables.at(0).rows;
  CHECK(rows[0].back() == "pass");
  for (std::size_t k = 1; k < rows.size(); ++k) CHECK(rows[k].back() == "FAIL");
}

TEST_CASE("a falling angle is followed over its jumps, and the passage of a value found between states", "[validate]") {
  app::Samples samples;
  for (int k = 0; k <= 10; ++k) {  // falls by 40 degrees a unit of time
    app::Sample sample;
    sample.time = k;
    sample.inclination_deg = std::remainder(-40.0 * k, 180.0);
    samples.push_back(sample);
  }
  CHECK(app::least_angle(samples) == Approx(-400));
  CHECK(app::time_at(samples, -180) == Approx(4.5));
  CHECK(std::isnan(app::time_at(samples, -401)));
}

TEST_CASE("a spheroid of fixed shape tends to Jeffery's orbit as its inside gets viscous", "[validate]") {
  const double limit = app::jeffery_half_turn(2);
  CHECK(limit == Approx(2.5 * std::numbers::pi));
  const double far = app::keller_skalak_half_turn(2, 1e4) - limit,
               farther = app::keller_skalak_half_turn(2, 1e6) - limit;
  CHECK(far > 0);
  CHECK(far / farther == Approx(100).epsilon(0.01));
  const double border = app::keller_skalak_border(2);
  CHECK(std::isnan(app::keller_skalak_half_turn(2, 0.999 * border)));
  CHECK(app::keller_skalak_half_turn(2, 1.001 * border) > 50);
}

TEST_CASE("decaying waves keep the area, and two of them do what their exact solution says", "[validate]") {
  const auto area = [](const app::Amplitudes& a) { return 4 * a[0] * a[0] + 10 * a[1] * a[1] + 18 * a[2] * a[2]; };
  const app::Amplitudes start{1, 0.7, 0.5}, end = app::decayed_waves(start, 3, 0.1);
  CHECK(area(end) == Approx(area(start)).epsilon(1e-9));
  CHECK(end[2] < start[2]);
  CHECK(end[0] > start[0]);
  // Degree 2 alone cannot change.
  CHECK(app::decayed_waves({1, 0, 0}, 3, 0.1)[0] == Approx(1));
  // Degree 2 at equal viscosities and no tension: 24 x 6 / (2 x (32 + 23)).
  CHECK(app::wave_rate(2, 1, 0) == Approx(144.0 / 110));
}

TEST_CASE("the quasi-spherical vesicle stops treading where its angle is zero", "[validate]") {
  for (const double nu : {0.99, 0.999}) {
    const double excess = app::excess_area(nu);
    CHECK(app::quasi_spherical_cosine(app::quasi_spherical_border(excess)) * std::sqrt(excess) == Approx(1));
  }
  CHECK(app::quasi_spherical_cosine(1) == Approx(0.7082).margin(1e-4));
}
