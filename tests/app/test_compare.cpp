// `tanktread compare` as a project's CI meets it.
#include "app/base/printable.h"
#include "render/image/difference.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

#include <sys/stat.h>

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

bool valid_utf8(const std::string& text) {
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t length = app::first_character(rest).length;
    if (length == 0) return false;
    rest.remove_prefix(length);
  }
  return true;
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
  CHECK_THAT(o.out, Contains("missing    c.png  expected, but not made") &&
                        Contains("new        d.png  made, but nothing is expected") &&
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
  CHECK(desk.compare({"--pixels", "25", "--largest", "128", "--rmse", "50"}).status == 0);
  CHECK(desk.compare({"--share", "0.03", "--largest", "128", "--rmse", "50"}).status == 0);
  CHECK(desk.compare({"--channel", "128", "--largest", "128", "--rmse", "50"}).status == 0);
  CHECK(desk.compare({"--pixels", "25", "--largest", "128", "--rmse", "5"}).status == 1);
  CHECK(desk.compare({"--pixels", "25", "--largest", "127", "--rmse", "50"}).status == 1);
  CHECK(desk.compare({"--pixels", "inf", "--largest", "inf", "--rmse", "inf"}).status == 0);  // lifted
  CHECK(desk.compare({"--preset", "perceptual"}).status == 1);
  CHECK(desk.compare({"--preset", "perceptual", "--flip-mean", "1", "--flip-max", "1", "--flip-spot", "1"}).status ==
        0);
  CHECK_THAT(desk.compare({"--preset", "perceptual"}).out, Contains("FLIP mean"));
}

TEST_CASE("compare refuses a threshold under which everything would pass", "[compare]") {
  const Desk desk;
  desk.put("actual/a.png", with_square(3, 3));
  for (const char* name :
       {"--channel", "--pixels", "--share", "--largest", "--rmse", "--flip-mean", "--flip-max", "--flip-spot", "--ppd"})
    for (const char* value : {"nan", "-1", "-inf", "x", "1e999"}) {
      const Outcome o = desk.compare({name, value});
      INFO(name << " " << value << ": " << o.err);
      CHECK(o.status == 2);
      CHECK_THAT(o.err, Contains(name));
    }
  for (const char* ppd : {"0", "1", "1e9", "inf"})
    CHECK(desk.compare({"--preset", "perceptual", "--ppd", ppd}).status == 2);
}

TEST_CASE("masks and rectangles leave regions out", "[compare]") {
  const Desk desk;
  desk.put("actual/a.png", with_square(8, 9));
  CHECK(desk.compare({"--ignore", "8,9,5x5"}).status == 0);
  CHECK(desk.compare({"--ignore", "8,9,4x5", "--rmse", "5", "--largest", "inf"}).status ==
        0);  // five pixels are left, and ten may differ
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
  CHECK_THAT(o.out,
             Contains("unreadable a.png  the mask leaves nothing to compare") && Contains("1 picture: 1 unreadable"));
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
  const Outcome o =
      desk.compare({"--json", "--junit", desk.file("j.xml"), "--html", desk.file("page"), "--diff", desk.file("d")});
  CHECK(o.status == 2);
  CHECK_THAT(o.out, Contains("\"status\": 2") &&
                        Contains("\"name\": \"deep/<b>&\\\"quoted\\\".png\", \"verdict\": \"different\"") &&
                        Contains("\"above\": 25") && Contains("\"box\": [10, 12, 15, 17]"));
  CHECK_THAT(support::read_file(desk / "j.xml"), Contains("tests=\"3\" failures=\"1\" errors=\"1\"") &&
                                                     Contains("name=\"deep/&lt;b&gt;&amp;&quot;quoted&quot;.png\"") &&
                                                     Contains("<failure type=\"different\"") &&
                                                     Contains("<error type=\"missing\""));
  const std::string page = support::read_file(desk / "page/index.html");
  CHECK_THAT(page, Contains("deep/&lt;b&gt;&amp;") && Contains("data:image/png;base64,") && !Contains("{{"));
  CHECK(page.find("different</b>") < page.find("missing</b>"));
  CHECK(render::read_png(desk / ("d/" + odd)).image == render::difference_image(picture(), with_square(10, 12)));
}

TEST_CASE("the verdict of compare survives a closed pipe", "[compare]") {
  const Desk desk;
  desk.put("actual/a.png", with_square(20, 20));
  const std::string command =
      std::string(TANKTREAD_PROGRAM) + " compare " + desk.file("expected") + " " + desk.file("actual");
  CHECK(support::run(desk, {"/bin/bash", "-c", "trap '' PIPE; " + command + " | true; exit ${PIPESTATUS[0]}"}).status ==
        1);
  CHECK(support::run(desk, {"/bin/bash", "-c", command + " >&-"}).status == 2);
}

TEST_CASE("compare passes over no picture without a word", "[compare]") {
  const Desk desk;
  desk.put("expected/x.PNG", picture());
  desk.put("actual/x.PNG", with_square(3, 3));
  Outcome o = desk.compare();
  CHECK(o.status == 1);
  CHECK_THAT(o.out, Contains("different  x.PNG") && Contains("2 pictures:"));
  support::write_file(desk / "actual/b.JPG", "\xff\xd8\xff\xe0");
  CHECK_THAT(desk.compare().err,
             Contains("only PNG pictures are compared: 1 of another format was passed over, such as 'b.JPG'"));
  support::write_file(desk / "actual/a.png", "\xff\xd8\xff\xe0 and so on");
  o = desk.compare();
  CHECK(o.status == 2);
  CHECK_THAT(o.out, Contains("is not a PNG file but a JPEG picture"));
}

TEST_CASE("a picture whose name looks like a mask or a further baseline is a picture where it is made, too",
          "[compare]") {
  const Desk desk;
  for (const char* name : {"a.altitude.png", "a.alt1.png", "a.mask.png"}) {
    desk.put(std::string("expected/") + name, with_square(20, 20));
    desk.put(std::string("actual/") + name, with_square(20, 20));
  }
  CHECK_THAT(desk.compare().out, Contains("4 pictures: 4 same"));
  desk.put("actual/a.png", with_square(20, 20));  // what the others look like
  CHECK(desk.compare().status == 1);
  CHECK(desk.pair("expected/a.png", "actual/a.png").status == 1);
  desk.put("actual/a.png", picture());
  desk.put("actual/b.altitude.png", picture());
  desk.put("actual/b.mask.png", picture());
  CHECK(desk.compare({"--update"}).status == 0);
  CHECK_THAT(desk.compare().out, Contains("6 pictures: 6 same"));
  // Expected only: a further baseline needs a number, a mask a picture.
  fs::remove(desk / "actual/b.altitude.png");
  fs::remove(desk / "actual/b.mask.png");
  CHECK_THAT(desk.compare().out, Contains("missing    b.altitude.png") && Contains("missing    b.mask.png"));
}

TEST_CASE("compare --update takes nothing that is no picture", "[compare]") {
  const Desk desk;
  support::write_file(desk / "actual/new.png", "no picture");
  const Outcome o = desk.compare({"--update"});
  CHECK(o.status == 2);
  CHECK_THAT(o.out, Contains("unreadable new.png") && Contains("is not a PNG file"));
  CHECK_FALSE(fs::exists(desk / "expected/new.png"));
}

TEST_CASE("compare --update writes neither through links nor beyond the folder", "[compare]") {
  const Desk desk;
  fs::create_directory(desk / "elsewhere");
  desk.put("elsewhere/a.png", picture());
  const std::string before = support::read_file(desk / "elsewhere/a.png");
  fs::remove(desk / "expected/a.png");
  fs::create_symlink("../elsewhere/a.png", desk / "expected/a.png");
  fs::create_directory_symlink("../elsewhere", desk / "expected/out");
  fs::create_directory(desk / "actual/out");
  desk.put("actual/a.png", with_square(20, 20));
  desk.put("actual/out/a.png", with_square(20, 20));
  desk.put("actual/out/new.png", picture());
  const Outcome o = desk.compare({"--update"});
  CHECK(o.status == 2);
  CHECK_THAT(o.err, Contains("a.png is not accepted: a link leads from") && Contains("out/a.png is not accepted") &&
                        Contains("out/new.png is not accepted"));
  CHECK(support::read_file(desk / "elsewhere/a.png") == before);
  CHECK_FALSE(fs::exists(desk / "elsewhere/new.png"));
  CHECK(fs::is_symlink(desk / "expected/a.png"));
}

TEST_CASE("reports of compare replace neither what is compared nor what compare did not write", "[compare]") {
  const Desk desk;
  desk.put("actual/a.png", with_square(20, 20));
  const std::string expected = support::read_file(desk / "expected/a.png"),
                    actual = support::read_file(desk / "actual/a.png");
  for (const char* folder : {"expected", "actual", "expected/deep", "actual/new/er"}) {
    const Outcome o = desk.compare({"--diff", desk.file(folder), "--update"});
    CHECK(o.status == 2);
    CHECK_THAT(o.err, Contains("whose pictures are compared"));
  }
  CHECK(desk.pair("expected/a.png", "actual/a.png", {"--diff", desk.file("actual")}).status == 2);
  CHECK(desk.compare({"--junit", desk.file("expected/a.png")}).status == 2);
  support::write_file(desk / "mine.xml", "<mine/>");
  CHECK_THAT(desk.compare({"--junit", desk.file("mine.xml")}).err, Contains("mine.xml' was not written by compare"));
  fs::create_directory(desk / "page");
  support::write_file(desk / "page/index.html", "<p>mine</p>");
  CHECK(desk.compare({"--html", desk.file("page")}).status == 2);
  fs::create_directory(desk / "d");
  support::write_file(desk / "precious", "precious");
  fs::create_symlink("../precious", desk / "d/a.png");
  CHECK_THAT(desk.compare({"--diff", desk.file("d")}).err, Contains("a link leads from"));
  CHECK(support::read_file(desk / "expected/a.png") == expected);
  CHECK(support::read_file(desk / "actual/a.png") == actual);
  CHECK(support::read_file(desk / "mine.xml") == "<mine/>");
  CHECK(support::read_file(desk / "page/index.html") == "<p>mine</p>");
  CHECK(support::read_file(desk / "precious") == "precious");
  // Its own are renewed.
  for (int turn = 0; turn < 2; ++turn)
    CHECK(desk.compare({"--junit", desk.file("j.xml"), "--html", desk.file("h"), "--diff", desk.file("diff")}).status ==
          1);
}

TEST_CASE("no name of a file breaks a line or a report of compare", "[compare]") {
  const Desk desk;
  for (const char* name : {"new\nline::error::x.png", "esc\x1b[31m.png", "sur\xed\xa0\x80.png", "over\xe0\x80\x80.png",
                           "big\xf4\x90\x80\x80.png", "non\xef\xbf\xbe.png",
                           "c1\xc2\x9b"
                           "31m.png",
                           "bidi\u202egnp.png", "{{equal}}.png"}) {
    desk.put(std::string("expected/") + name, picture());
    desk.put(std::string("actual/") + name, with_square(20, 20));
  }
  const Outcome lines = desk.compare({"--junit", desk.file("j.xml"), "--html", desk.file("page")});
  const Outcome json = desk.compare({"--json"});
  CHECK_THAT(lines.out, Contains("new?line::error::x.png") && Contains("esc?[31m.png") && Contains("sur???.png") &&
                            Contains("over???.png") && Contains("big????.png") && Contains("non???.png") &&
                            Contains("c1?31m.png") && Contains("bidi?gnp.png") && !Contains("\n::") &&
                            !Contains("\x1b"));
  CHECK_THAT(json.out,
             Contains("new\\u000aline::error::x.png") && Contains("sur???.png") && Contains("bidi\\u202egnp.png"));
  const std::string page = support::read_file(desk / "page/index.html");
  CHECK_THAT(page, Contains("{{equal}}.png") && Contains("sur???.png"));
  for (const std::string& text : {json.out, support::read_file(desk / "j.xml"), page}) CHECK(valid_utf8(text));
}

TEST_CASE("pipes and loops of links do not hold compare up", "[compare]") {
  const Desk desk;
  REQUIRE(mkfifo((desk / "actual/pipe.png").c_str(), 0600) == 0);
  desk.put("expected/pipe.png", picture());
  const Outcome o = desk.compare();
  CHECK(o.status == 2);
  CHECK_THAT(o.out, Contains("unreadable pipe.png") && Contains("is a pipe or a device"));
  fs::remove(desk / "actual/pipe.png");
  fs::remove(desk / "expected/pipe.png");
  for (const char* side : {"expected", "actual"})
    for (const char* link : {"p", "q", "deep/up"})
      fs::create_directory_symlink(std::string(link) == "deep/up" ? ".." : ".", desk / side / link);
  CHECK_THAT(desk.compare().out, Contains("1 picture: 1 same"));
}

TEST_CASE("compare obeys the first signal", "[compare]") {
  const Desk desk;
  // Two pictures that take many seconds: every tile differs.
  render::Image large(6000, 6000, 3);
  desk.put("expected/large.png", large);
  for (std::uint8_t& v : large.pixels) v = 40;
  desk.put("actual/large.png", large);
  const std::string command = std::string(TANKTREAD_PROGRAM) + " compare --preset perceptual " +
                              desk.file("expected/large.png") + " " + desk.file("actual/large.png");
  const Outcome o = support::run(desk, {"/bin/bash", "-c", command + " & sleep 1.5; kill -TERM $!; wait $!"});
  CHECK(o.status == 130);
  CHECK_THAT(o.err, Contains("interrupted"));
}

#if defined(__SANITIZE_ADDRESS__)
#define TANKTREAD_SHADOW_MEMORY  // terabytes of addresses
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TANKTREAD_SHADOW_MEMORY
#endif
#endif
#ifndef TANKTREAD_SHADOW_MEMORY
TEST_CASE("two small files that unpack to many pixels are compared piece by piece", "[compare]") {
  const Desk desk;
  render::Image large(4000, 4000, 3);
  desk.put("expected/large.png", large);
  large.at(2000, 2000)[0] = 255;
  desk.put("actual/large.png", large);
  // Two pictures of 48 MB, a few of their rows and the program itself; at once FLIP took some 80 bytes a pixel and
  // picture.
  const std::string command = "ulimit -v 700000; " + std::string(TANKTREAD_PROGRAM) + " compare --preset perceptual " +
                              desk.file("expected/large.png") + " " + desk.file("actual/large.png");
  const Outcome o = support::run(desk, {"/bin/bash", "-c", command});
  CHECK(o.status == 1);
  CHECK_THAT(o.out, Contains("different  large.png") && Contains("at x 2000 to 2000, y 2000 to 2000"));
}
#endif
