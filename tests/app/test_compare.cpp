// `tanktread compare` as a project's CI meets it.
#include "render/compare.h"
#include "tests/support/program.h"

#include <catch2/catch.hpp>

using Catch::Contains;
using support::Outcome;
using support::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

render::Image picture(int width = 40, int height = 30) {
  render::Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<std::uint8_t>(100 + 3 * x + 2 * y + 20 * c);
  return image;
}

/// With a bright square of 5 x 5 pixels at (x, y).
render::Image with_square(int x, int y) {
  render::Image image = picture();
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i) image.at(x + i, y + j)[0] ^= 0x80;
  return image;
}

/// Folders `expected` and `actual` with the same picture a.png in both.
struct Desk : TemporaryFolder {
  Desk() {
    fs::create_directories(path() / "expected/deep");
    fs::create_directories(path() / "actual/deep");
    put("expected/a.png", picture());
    put("actual/a.png", picture());
  }
  void put(const std::string& name, const render::Image& image) const { render::write_png(path() / name, image); }
  std::string file(const std::string& name) const { return (path() / name).string(); }
  Outcome compare(std::vector<std::string> words = {}) const { return pair("expected", "actual", std::move(words)); }
  Outcome pair(const std::string& a, const std::string& b, std::vector<std::string> words = {}) const {
    std::vector<std::string> all{TANKTREAD_PROGRAM, "compare", file(a), file(b)};
    all.insert(all.end(), words.begin(), words.end());
    return support::run(*this, all);
  }
};

}  // namespace

TEST_CASE("compare answers 0 for the same, 1 for different, 2 for what cannot be compared", "[compare]") {
  const Desk desk;
  Outcome o = desk.compare();
  CHECK(o.status == 0);
  CHECK_THAT(o.out, Contains("same       a.png") && Contains("1 picture: 1 same"));
  CHECK(o.err.empty());
  desk.put("expected/deep/b.png", picture());
  desk.put("actual/deep/b.png", with_square(10, 12));
  o = desk.compare();
  CHECK(o.status == 1);
  CHECK_THAT(o.out, Contains("different  deep/b.png  25 pixels differ by more than 2 (allowed: 10)") &&
                        Contains("at x 10 to 14, y 12 to 16") && Contains("2 pictures: 1 same, 1 different"));
  desk.put("expected/c.png", picture());
  desk.put("actual/d.png", picture());
  desk.put("expected/e.png", picture());
  desk.put("actual/e.png", picture(41, 30));
  desk.put("expected/f.png", picture());
  support::write_file(desk / "actual/f.png", "not a picture");
  o = desk.compare();
  CHECK(o.status == 2);
  CHECK_THAT(o.out, Contains("missing    c.png  expected, but not made") && Contains("new        d.png  made, but nothing is expected") &&
                        Contains("size       e.png  40 x 30 expected, 41 x 30 made") && Contains("unreadable f.png") &&
                        Contains("is not a PNG file"));
  CHECK(desk.pair("expected/a.png", "actual/deep/b.png").status == 1);
  CHECK(desk.pair("expected/a.png", "actual").status == 2);
  CHECK_THAT(desk.pair("expected/a.png", "actual/none.png").err, Contains("there is no file or folder"));
  fs::create_directory(desk / "empty");
  CHECK(desk.pair("empty", "empty").status == 2);
  CHECK(desk.compare({"--preset", "exakt"}).status == 2);
  CHECK_THAT(desk.compare({"--preset", "exakt"}).err, Contains("did you mean 'exact'?"));
  CHECK(desk.compare({"--rmse", "-1"}).status == 2);
}

TEST_CASE("every threshold of compare can be changed", "[compare]") {
  const Desk desk;
  desk.put("actual/a.png", with_square(3, 3));
  CHECK(desk.compare().status == 1);
  CHECK(desk.compare({"--pixels", "25", "--rmse", "50"}).status == 0);
  CHECK(desk.compare({"--share", "0.03", "--rmse", "50"}).status == 0);
  CHECK(desk.compare({"--channel", "128", "--rmse", "50"}).status == 0);
  CHECK(desk.compare({"--pixels", "25", "--rmse", "5"}).status == 1);
  CHECK(desk.compare({"--preset", "perceptual"}).status == 1);
  CHECK(desk.compare({"--preset", "perceptual", "--flip-mean", "1", "--flip-max", "1"}).status == 0);
  CHECK_THAT(desk.compare({"--preset", "perceptual"}).out, Contains("FLIP mean"));
}

TEST_CASE("masks and rectangles leave regions out", "[compare]") {
  const Desk desk;
  desk.put("actual/a.png", with_square(8, 9));
  CHECK(desk.compare({"--ignore", "8,9,5x5"}).status == 0);
  CHECK(desk.compare({"--ignore", "8,9,4x5", "--rmse", "5"}).status == 0);  // five pixels are left, and ten may differ
  CHECK(desk.compare({"--ignore", "8,9,2x5"}).status == 1);
  CHECK(desk.compare({"--ignore", "8,9,5"}).status == 2);
  render::Image mask(40, 30, 3);
  for (int y = 9; y < 14; ++y)
    for (int x = 8; x < 13; ++x) mask.at(x, y)[0] = mask.at(x, y)[1] = mask.at(x, y)[2] = 255;
  desk.put("mask.png", mask);
  CHECK(desk.compare({"--mask", desk.file("mask.png")}).status == 0);
  CHECK(desk.compare().status == 1);
  desk.put("expected/a.mask.png", mask);
  const Outcome own = desk.compare();
  CHECK(own.status == 0);
  CHECK_THAT(own.out, Contains("1 picture:"));
  desk.put("expected/a.mask.png", render::Image(10, 10, 3));
  CHECK_THAT(desk.compare().out, Contains("unreadable") && Contains("is 10 x 10, the picture 40 x 30"));
}

TEST_CASE("a comparison of nothing is not a comparison", "[compare]") {
  const Desk desk;
  render::Image all(40, 30, 3);
  all.pixels.assign(all.pixels.size(), 255);
  desk.put("all.png", all);
  Outcome o = desk.compare({"--ignore", "0,0,40x30"});
  CHECK(o.status == 2);
  CHECK_THAT(o.out, Contains("unreadable a.png  the mask leaves nothing to compare") && Contains("1 picture: 1 unreadable"));
  CHECK(desk.compare({"--mask", desk.file("all.png")}).status == 2);
  CHECK(desk.compare({"--ignore", "0,0,40x29"}).status == 0);
  desk.put("expected/a.mask.png", all);
  CHECK(desk.compare().status == 2);
  CHECK(desk.compare({"--preset", "perceptual"}).status == 2);
  CHECK(desk.compare({"--update"}).status == 2);
}

TEST_CASE("a picture may have several accepted baselines", "[compare]") {
  const Desk desk;
  desk.put("actual/a.png", with_square(20, 20));
  desk.put("expected/a.alt1.png", with_square(2, 2));
  Outcome o = desk.compare();
  CHECK(o.status == 1);
  desk.put("expected/a.alt2.png", with_square(20, 20));
  o = desk.compare();
  CHECK(o.status == 0);
  CHECK_THAT(o.out, Contains("as a.alt2.png") && Contains("1 picture: 1 same"));
  CHECK(desk.pair("expected/a.png", "actual/a.png").status == 0);
}

TEST_CASE("compare --update puts new pictures in the place of old ones and says so", "[compare]") {
  const Desk desk;
  desk.put("actual/a.png", with_square(20, 20));
  desk.put("actual/deep/new.png", picture());
  const Outcome o = desk.compare({"--update"});
  CHECK(o.status == 0);
  CHECK_THAT(o.out, Contains("expected/a.png replaced: 25 pixels differ") && Contains("expected/deep/new.png added"));
  CHECK(support::read_file(desk / "expected/a.png") == support::read_file(desk / "actual/a.png"));
  CHECK(desk.compare({"--preset", "exact"}).status == 0);
  fs::remove(desk / "actual/a.png");
  CHECK(desk.compare({"--update"}).status == 2);  // nothing is removed unasked
  CHECK(fs::exists(desk / "expected/a.png"));
}

TEST_CASE("the reports of compare name every picture and escape their names", "[compare]") {
  const Desk desk;
  const std::string odd = "deep/<b>&\"quoted\".png";
  desk.put("expected/" + odd, picture());
  desk.put("actual/" + odd, with_square(10, 12));
  desk.put("expected/c.png", picture());
  const Outcome o = desk.compare({"--json", "--junit", desk.file("j.xml"), "--html", desk.file("page"), "--diff", desk.file("d")});
  CHECK(o.status == 2);
  CHECK_THAT(o.out, Contains("\"status\": 2") && Contains("\"name\": \"deep/<b>&\\\"quoted\\\".png\", \"verdict\": \"different\"") &&
                        Contains("\"above\": 25") && Contains("\"box\": [10, 12, 15, 17]"));
  CHECK_THAT(support::read_file(desk / "j.xml"),
             Contains("tests=\"3\" failures=\"1\" errors=\"1\"") && Contains("name=\"deep/&lt;b&gt;&amp;&quot;quoted&quot;.png\"") &&
                 Contains("<failure type=\"different\"") && Contains("<error type=\"missing\""));
  const std::string page = support::read_file(desk / "page/index.html");
  CHECK_THAT(page, Contains("deep/&lt;b&gt;&amp;") && Contains("data:image/png;base64,") && !Contains("{{"));
  CHECK(page.find("different</b>") < page.find("missing</b>"));
  CHECK(render::read_png(desk / ("d/" + odd)).image == render::difference_image(picture(), with_square(10, 12)));
}

TEST_CASE("the verdict of compare survives a closed pipe", "[compare]") {
  const Desk desk;
  desk.put("actual/a.png", with_square(20, 20));
  const std::string command = std::string(TANKTREAD_PROGRAM) + " compare " + desk.file("expected") + " " + desk.file("actual");
  CHECK(support::run(desk, {"/bin/bash", "-c", "trap '' PIPE; " + command + " | true; exit ${PIPESTATUS[0]}"}).status == 1);
  CHECK(support::run(desk, {"/bin/bash", "-c", command + " >&-"}).status == 2);
}
