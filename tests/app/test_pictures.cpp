// `tanktread render` and what `run` draws: frames, movies, stills and what stands on them.
#include "app/base/folder_lock.h"
#include "app/pictures/captions.h"
#include "app/pictures/pictures.h"
#include "app/scene/scene_file.h"
#include "desk.h"
#include "render/image/image.h"
#include "render/scene/section.h"
#include "sim/stepping/simulate.h"
#include "sim/trajectory/trajectory.h"
#include "tests/support/catch.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#include <set>
#include <thread>

using Catch::Contains;
using commands::Desk;
using commands::scene;
using support::Outcome;
namespace fs = std::filesystem;

TEST_CASE("render draws shards that together make the whole, and changes pictures only", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("a")}).status == 0);
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("b"), "--shard", "0/2"}).status == 0);
  CHECK_FALSE(fs::exists(desk / "b/frames/000001.png"));
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("b"), "--shard", "1/2"}).status == 0);
  CHECK(support::read_file(desk / "a/frames/000001.png") == support::read_file(desk / "b/frames/000001.png"));
  const Outcome physics = desk({"render", desk.file("t.h5"), "-o", desk.file("c"), "--set", "flow.rate=3"});
  CHECK(physics.status == 1);
  CHECK_THAT(physics.err, Contains("has been simulated already"));
  CHECK(desk({"render", desk.file("t.h5"), "-o", desk.file("c"), "--shard", "2/2"}).status == 2);
}

TEST_CASE("frames between saved states are interpolated", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "--set", "movie.time_per_frame=0.04"}).status == 0);
  CHECK(fs::exists(desk / "out/frames/000012.png"));
  CHECK_FALSE(fs::exists(desk / "out/frames/000013.png"));
}

TEST_CASE("a movie is kept when it was made of the same frames at the same rate, and made anew otherwise",
          "[commands]") {
  const Desk desk;
  const auto run = [&] { REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "-q"}).status == 0); };
  const auto render = [&](const std::string& rate) {
    REQUIRE(desk({"render", desk.file("out/trajectory.h5"), "-q", "--set", "movie.frame_rate=" + rate}).status == 0);
  };
  const fs::path movie = desk / "out/movie.mp4";
  run();
  const std::string made = support::read_file(movie);
  const auto written = fs::last_write_time(movie);
  run();
  render("30");
  CHECK(fs::last_write_time(movie) == written);  // by neither
  render("10");
  CHECK(support::read_file(movie) != made);
  run();  // the scene says 30
  CHECK(support::read_file(movie) == made);
  support::write_file(movie, made + "x");  // somebody else's now
  CHECK_THAT(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "-q"}).err, Contains("has been changed since"));
  CHECK(support::read_file(movie) == made + "x");
  fs::remove(movie);
  run();
  CHECK(support::read_file(movie) == made);
}

TEST_CASE("damaged or incomplete frames are drawn again", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"run", desk.file("s.toml"), "-o", desk.file("out"), "-q"}).status == 0);
  const std::string whole = support::read_file(desk / "out/frames/000002.png");
  support::write_file(desk / "out/frames/000002.png", whole.substr(0, whole.size() / 2));
  fs::remove(desk / "out/frames/000004.png");
  const Outcome again = desk({"run", desk.file("s.toml"), "-o", desk.file("out")});
  CHECK_THAT(again.out, Contains("2 frames drawn, 4 kept"));
  CHECK(support::read_file(desk / "out/frames/000002.png") == whole);
}

TEST_CASE("without ffmpeg, or with a broken one, the frames are kept and a sentence says why there is no movie",
          "[commands]") {
  const Desk desk;
  fs::create_directory(desk / "bin");
  const auto run_with_path = [&](const std::string& path, const std::string& out) {
    return support::run(
        desk, {"/usr/bin/env", "PATH=" + path, TANKTREAD_PROGRAM, "run", desk.file("s.toml"), "-o", desk.file(out)});
  };
  const Outcome missing = run_with_path(desk.file("bin"), "a");
  CHECK(missing.status == 0);
  CHECK_THAT(missing.err, Contains("apt-get install ffmpeg"));
  CHECK(fs::exists(desk / "a/frames/000005.png"));
  CHECK_FALSE(fs::exists(desk / "a/movie.mp4"));

  support::write_file(desk / "bin/ffmpeg", "#!/bin/sh\nexit 3\n");
  fs::permissions(desk / "bin/ffmpeg", fs::perms::owner_all);
  const Outcome broken = run_with_path(desk.file("bin") + ":/bin", "b");
  CHECK(broken.status == 1);
  CHECK_THAT(broken.err, Contains("ffmpeg"));
  CHECK(fs::exists(desk / "b/frames/000005.png"));
  CHECK_FALSE(fs::exists(desk / "b/movie.mp4"));
  CHECK_FALSE(fs::exists(desk / "b/movie.mp4.tmp"));
}

TEST_CASE("a shard waits for another that is just letting go of the folder, but not for a writer of the whole",
          "[commands]") {
  const support::TemporaryFolder folder;
  const std::string file = (folder.path() / ".tanktread.lock").string();
  const int held = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);  // what a shard does at its end
  REQUIRE(held >= 0);
  REQUIRE(::flock(held, LOCK_EX | LOCK_NB) == 0);
  std::thread last([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ::unlink(file.c_str());
    ::close(held);
  });
  CHECK_NOTHROW(app::FolderLock(folder.path(), 1, 2));
  last.join();
  const app::FolderLock whole(folder.path());
  CHECK_THROWS_WITH(app::FolderLock(folder.path(), 1, 2), Contains("another process is writing"));
}

TEST_CASE("processes draw the very frames and movie that one draws alone", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("a"), "--style", "ghost", "-j", "1"}).status == 0);
  const Outcome three = desk({"render", desk.file("t.h5"), "-o", desk.file("b"), "--style", "ghost", "-j", "3"});
  INFO(three.err);
  REQUIRE(three.status == 0);
  for (const char* name : {"frames/000000.png", "frames/000004.png", "frames/000005.png", "movie.mp4"})
    CHECK(support::read_file(desk / "a" / name) == support::read_file(desk / "b" / name));
}

TEST_CASE("every movie format is written from the same frames, with a poster where asked for", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  for (const char* format : {"mp4", "mkv", "gif", "webp", "webm", "mov", "apng"}) {
    INFO(format);
    const Outcome outcome =
        desk({"render", desk.file("t.h5"), "-o", desk.file("a"), "--format", format, "--set", "movie.poster=0.3"});
    CHECK(outcome.status == 0);
    CHECK(fs::file_size(desk / (std::string("a/movie.") + format)) > 100);
    if (std::string(format) != "mp4") CHECK_THAT(outcome.out, Contains("0 frames drawn, 6 kept"));
  }
  CHECK(support::read_file(desk / "a/poster.png") == support::read_file(desk / "a/frames/000003.png"));
  CHECK_THAT(desk({"render", desk.file("t.h5"), "--format", "mp5"}).err, Contains("did you mean 'mp4'?"));
}

TEST_CASE("a movie without a ground is written where the format has transparency, and refused elsewhere",
          "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const auto draw = [&](const char* format) {
    return desk({"render", desk.file("t.h5"), "-o", desk.file("a"), "--format", format, "--set",
                 "view.background=transparent"});
  };
  for (const char* format : {"mp4", "gif"}) {
    const Outcome refused = draw(format);
    CHECK(refused.status == 1);
    CHECK_THAT(refused.err, Contains("has no transparency") && Contains("webm"));
    CHECK_FALSE(fs::exists(desk / "a"));
  }
  // Alphas of the first frame as a player finds them; FFmpeg's own decoder of VP9 knows none, and none decodes moving
  // WebP.
  const auto alphas_in = [&](const std::string& format) {
    std::vector<std::string> words{"ffmpeg", "-v", "error", "-y"};
    if (format == "webm") words.insert(words.end(), {"-c:v", "libvpx-vp9"});
    words.insert(words.end(), {"-i", desk.file("a/movie." + format), "-frames:v", "1", "-f", "rawvideo", "-pix_fmt",
                               "rgba", desk.file("raw")});
    REQUIRE(support::run(desk, words).status == 0);
    return support::read_file(desk / "raw");
  };
  for (const char* format : {"webm", "mov", "apng", "mkv", "webp"}) {
    const Outcome outcome = draw(format);
    INFO(format << ": " << outcome.err);
    CHECK(outcome.status == 0);
    CHECK(fs::file_size(desk / (std::string("a/movie.") + format)) > 100);
    if (format == std::string("webp")) continue;
    const render::Image frame = render::read_png(desk / "a/frames/000000.png").image;
    REQUIRE(frame.channels == 4);
    const std::string raw = alphas_in(format);
    REQUIRE(raw.size() == frame.pixels.size());
    const bool lossless = format == std::string("apng") || format == std::string("mkv");
    int worst = 0, there = 0, nothing = 0;
    for (std::size_t k = 3; k < raw.size(); k += 4) {
      const int alpha = static_cast<unsigned char>(raw[k]);
      worst = std::max(worst, std::abs(alpha - frame.pixels[k]));
      there += frame.pixels[k] == 255;
      nothing += frame.pixels[k] == 0;
    }
    CHECK(worst <= (lossless ? 0 : 24));  // of codecs with losses, at contours
    CHECK(static_cast<unsigned char>(raw[3]) <= (lossless ? 0 : 2));
    CHECK(static_cast<unsigned char>(raw[4 * (24 * 64 + 32) + 3]) >= (lossless ? 255 : 253));  // on the vesicle
    CHECK(there > 100);
    CHECK(nothing > 500);
  }
  CHECK_THAT(desk({"render", desk.file("t.h5"), "--set", "view.background=drak"}).err,
             Contains("did you mean 'dark'?"));
}

TEST_CASE("an odd size is refused for H.264 before anything is drawn, and drawn for other formats", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const Outcome odd = desk({"render", desk.file("t.h5"), "-o", desk.file("a"), "--size", "65x48"});
  CHECK(odd.status == 1);
  CHECK_THAT(odd.err, Contains("even width and height, not 65 x 48") && Contains("66x48"));
  CHECK_FALSE(fs::exists(desk / "a"));
  CHECK(desk({"render", desk.file("t.h5"), "-o", desk.file("a"), "--size", "65x48", "--format", "mkv"}).status == 0);
  CHECK(desk({"run", desk.file("s.toml"), "-o", desk.file("r"), "--set", "view.size=[65, 48]"}).status == 1);
  CHECK_FALSE(fs::exists(desk / "r/trajectory.h5"));
}

TEST_CASE("a still is chosen by time, in any style, field and view", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const auto still = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"render", desk.file("t.h5"), "--time", "0.25", "-o", desk.file("still.png")};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = desk(words);
    INFO(outcome.err);
    CHECK(outcome.status == 0);
    return support::read_file(desk / "still.png");
  };
  std::set<std::string> pictures;
  for (const char* style : {"opaque", "ghost", "cutaway", "checker"}) pictures.insert(still({"--style", style}));
  for (const char* field : {"tension", "mean-curvature", "gaussian-curvature", "bending-force", "tension-force",
                            "normal-velocity", "membrane-speed"})
    pictures.insert(still({"--style", "field", "--set", std::string("view.field=") + field}));
  pictures.insert(still({"--set", "view.views=[\"flow-gradient\", \"three-quarter\"]"}));
  pictures.insert(still({"--set", "view.colours=[\"#336699\"]"}));
  pictures.insert(still({"--set", "view.colour_by=viscosity_contrast"}));
  pictures.insert(still({"--set", "view.inset=true", "--set", "view.triad=true", "--set", "view.flow_profile=true"}));
  pictures.insert(still({"--set", "view.orbit=90"}));
  pictures.insert(still({"--set", "view.eye=[2, -6, 3]"}));
  CHECK(pictures.size() == 17);
  CHECK_FALSE(fs::exists(desk / "frames"));
  CHECK_THAT(desk({"render", desk.file("t.h5"), "--time", "0.6"}).err, Contains("to t = 0.5"));
  CHECK_THAT(desk({"render", desk.file("t.h5"), "--style", "field", "--set", "view.field=neighbour-distance"}).err,
             Contains("two vesicles"));
  CHECK_THAT(desk({"render", desk.file("t.h5"), "--set", "view.field=tention"}).err,
             Contains("did you mean 'tension'?"));
  CHECK_THAT(desk({"render", desk.file("t.h5"), "--set", "view.eye=[0, 0.1, 0]"}).err, Contains("inside vesicle 0"));
}

TEST_CASE("the inset cuts what the camera follows or aims at, not the middle between the vesicles", "[commands]") {
  // Between these two, in the plane of their common centroid, there is only fluid.
  std::string text = scene;
  text.replace(text.find("order = 6\n"), 10,
               "order = 6\ncenter = [0, -3, 0]\n[[vesicle]]\nshape = \"sphere\"\norder = 6\ncenter = [0, 3, 0]\n");
  const Desk desk(text + "inset = true\n");
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q", "--steps", "0"}).status == 0);
  const auto coloured = [&](std::vector<std::string> words) {
    words.insert(words.begin(),
                 {"render", desk.file("t.h5"), "--time", "0", "-o", desk.file("still.png"), "--size", "320x240"});
    const Outcome outcome = desk(words);
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const render::Image image = render::read_png(desk / "still.png").image;
    int count = 0;
    for (int y = 10; y < 50; ++y)  // within the box
      for (int x = 255; x < 300; ++x)
        count += image.at(x, y)[2] > image.at(x, y)[0] + 20 || image.at(x, y)[0] > image.at(x, y)[2] + 20;
    return count;
  };
  CHECK(coloured({"--set", "view.target=[0, 0, 0]"}) == 0);
  CHECK(coloured({"--set", "view.target=[0, 3, 0]"}) > 100);
  CHECK(coloured({"--set", "view.follow=vesicle", "--set", "view.follow_vesicle=1"}) > 100);
  CHECK(coloured({"--set", "view.follow=vesicle", "--set", "view.follow_vesicle=0"}) > 100);
}

TEST_CASE("a common cut opens all vesicles at one plane, others each through its own centre", "[commands]") {
  // Unit spheres 0.6 before the common centre, at it, and 0.6 behind it: their shadows are discs, and what a common
  // plane leaves of the first is a cap of radius sqrt(1 - 0.36).
  std::string text = scene.substr(0, scene.find("[[vesicle]]"));
  for (const char* centre : {"[-3, -0.6, 0]", "[0, 0, 0]", "[3, 0.6, 0]"})
    text += std::string("[[vesicle]]\nshape = \"sphere\"\norder = 6\ncenter = ") + centre + "\n";
  const Desk desk(text + "[view]\nsize = [640, 160]\nprojection = \"orthographic\"\nbackground = \"white\"\n");
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q", "--steps", "0"}).status == 0);
  const auto widths = [&](const char* cut) {
    std::vector<std::string> words{"render",
                                   desk.file("t.h5"),
                                   "--time",
                                   "0",
                                   "-o",
                                   desk.file("still.png"),
                                   "--force",
                                   "--style",
                                   "cutaway",
                                   "--set",
                                   std::string("view.cut=") + cut};
    for (const char* off : {"flow_arrows", "time_stamp", "caption", "scale_bar"})
      words.insert(words.end(), {"--set", std::string("view.") + off + "=false"});
    const Outcome outcome = desk(words);
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const render::Image image = render::read_png(desk / "still.png").image;
    std::vector<double> found;  // of the pieces of ink along the middle
    bool inside = false;
    for (int x = 0; x < image.width; ++x) {
      const bool ink = image.at(x, 80)[0] + image.at(x, 80)[1] + image.at(x, 80)[2] < 720;
      if (ink && !inside) found.push_back(0);
      inside = ink;
      if (ink) ++found.back();
    }
    return found;
  };
  const std::vector<double> each = widths("each"), common = widths("common");
  REQUIRE(each.size() == 3);
  REQUIRE(common.size() == 3);
  constexpr double rim = 4;  // px: of the rim's two lines
  for (const double width : each) CHECK(width == Approx(each[1]).margin(1.5));
  CHECK(common[1] == Approx(each[1]).margin(1.5));
  CHECK(common[2] == Approx(each[1]).margin(rim));  // its equator is behind the plane and seen whole
  CHECK(common[0] == Approx(0.8 * (each[1] - rim) + rim).margin(2));
}

TEST_CASE("a cell with its copies looks like a cell of as many cells, also while it leans", "[commands]") {
  const std::string head = "[flow]\nkind = \"shear\"\n[time]\nend = 0.4\nstep = 0.2\n";
  const std::string tail =
      "[view]\nsize = [640, 480]\neye = [3, -50, 9]\ntarget = [0, 0, 0]\nzoom = 1.1\ncolours = [\"#d02020\", "
      "\"#2040d0\"]\nbackground = \"white\"\nflow_arrows = false\ncolour_bar = false\nfield = "
      "\"mean-curvature\"\nfield_range = [0.5, "
      "1.5]\n";
  const auto scene_of = [&](double cells) {
    std::string text = head + fmt::format("[cell]\nsize = [{}, 4, {}]\n", 5 * cells, 4.5 * cells);
    const int most = cells > 1 ? 1 : 0;
    for (int c = -most; c <= most; ++c)
      for (int a = -most; a <= most; ++a)
        for (const int k : {0, 1})
          text += fmt::format(
              "[[vesicle]]\nshape = \"prolate\"\nreduced_volume = 0.9\nradius = {}\norder = 4\naxis = {}\ncenter = "
              "[{}, "
              "{}, {}]\n",
              k == 0 ? 1 : 0.8, k == 0 ? "[1, 0, 0.2]" : "[0, 1, 1]", 5 * a + (k == 0 ? -1.3 : 1.4),
              k == 0 ? 0.3 : -1.9, 4.5 * c + (k == 0 ? 1.7 : -0.6));
    return text + tail;
  };
  const Desk one(scene_of(1)), nine(scene_of(3));
  for (const Desk* desk : {&one, &nine})
    REQUIRE((*desk)({"simulate", desk->file("s.toml"), "-o", desk->file("t.h5"), "-q"}).status == 0);
  const auto picture = [](const Desk& desk, const char* time, const char* style, const char* copies) {
    const Outcome outcome = desk({"render", desk.file("t.h5"), "--time", time, "-o", desk.file("still.png"), "--force",
                                  "--style", style, "--set", std::string("view.copies=") + copies});
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return render::read_png(desk / "still.png").image;
  };
  // Lines of the box, captions and ground are grey.
  const auto colour = [](const unsigned char* pixel) {
    return *std::max_element(pixel, pixel + 3) - *std::min_element(pixel, pixel + 3);
  };
  for (const char* style : {"opaque", "field"})
    for (const char* time : {"0", "0.4"}) {
      INFO(style << " at " << time);
      const render::Image copied = picture(one, time, style, "[1, 0, 1]"),
                          whole = picture(nine, time, style, "[0, 0, 0]"),
                          alone = picture(one, time, style, "[0, 0, 0]");
      int coloured = 0, different = 0, single = 0;
      for (int y = 0; y < whole.height; ++y)
        for (int x = 0; x < whole.width; ++x) {
          constexpr int painted = 40;
          if (x > 520 && y > 400) continue;  // the scale bar is of another vesicle
          single += colour(alone.at(x, y)) > painted;
          if (colour(copied.at(x, y)) <= painted && colour(whole.at(x, y)) <= painted) continue;
          ++coloured;
          for (int c = 0; c < 3; ++c)
            if (std::abs(copied.at(x, y)[c] - whole.at(x, y)[c]) > 12) {
              ++different;
              break;
            }
        }
      CHECK(coloured > 7 * single);
      CHECK(single > 1000);
      // Single precision moves edges by hundredths of a pixel.
      CHECK(different < 0.003 * coloured);
    }
  const auto refused = [](const Desk& desk, const char* copies) {
    return desk({"render", desk.file("t.h5"), "--time", "0", "--set", std::string("view.copies=") + copies}).err;
  };
  CHECK_THAT(refused(one, "1"), Contains("'copies' must be a list, [..., ...]: how many copies of a periodic cell"));
  CHECK_THAT(refused(one, "[1, 1]"), Contains("'copies' must be three whole numbers"));
  CHECK_THAT(refused(nine, "[10, 10, 10]"), Contains("166698 vesicles and copies are too many"));
  const Desk open;
  REQUIRE(open({"simulate", open.file("s.toml"), "-o", open.file("t.h5"), "-q", "--steps", "0"}).status == 0);
  CHECK_THAT(refused(open, "[1, 0, 0]"), Contains("only a periodic [cell] has copies"));
}

TEST_CASE("two trajectories stand side by side, the shorter one at rest at its end", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("a.h5"), "-q"}).status == 0);
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("b.h5"), "-q", "--set", "time.end=0.3"}).status == 0);
  const Outcome outcome =
      desk({"render", desk.file("a.h5"), desk.file("b.h5"), "-o", desk.file("both"), "--size", "128x48"});
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  CHECK(fs::exists(desk / "both/frames/000005.png"));
}

TEST_CASE("a full disk ends with one sentence; frames made before are kept, none is half written", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  REQUIRE(desk({"render", desk.file("t.h5"), "-o", desk.file("a"), "--size", "320x240", "--shard", "0/3"}).status == 0);
  const std::string before = support::read_file(desk / "a/frames/000000.png");
  // A limit on the size of files stands for the disk.
  const Outcome full =
      support::run(desk, {"/bin/sh", "-c", "trap '' XFSZ; ulimit -f 4; exec \"$@\"", "sh", TANKTREAD_PROGRAM, "render",
                          desk.file("t.h5"), "-o", desk.file("a"), "--size", "320x240", "--format", "mkv"});
  CHECK(full.status == 1);
  CHECK_THAT(full.err, Contains("File too large") && Contains("complete in") && Contains("continues"));
  CHECK(support::read_file(desk / "a/frames/000000.png") == before);
  CHECK_FALSE(fs::exists(desk / "a/frames/000001.png"));
  for (const auto& entry : fs::directory_iterator(desk / "a/frames")) CHECK(entry.path().extension() == ".png");
}

TEST_CASE("before and after material lines are laid anew the pictures say so", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const sim::TrajectoryReader reader(desk.file("t.h5"));
  const auto changed = [&](std::int64_t k) {
    sim::State state = reader.state(k);
    if (state.time > 0.29) {
      state.vesicles[0].labels_laid = 1;
      state.vesicles[0].labels_laid_time = 0.3;
    }
    return state;
  };
  {
    sim::TrajectoryWriter writer = sim::TrajectoryWriter::create(desk.file("u.h5"), reader.layout(), reader.header(),
                                                                 changed(0), reader.resume_payload());
    for (std::int64_t k = 1; k < reader.count(); ++k) writer.append(changed(k));
  }
  // 1.2 seconds at half a frame a second and 0.1 a frame: 0.06 before and after.
  for (const auto& [time, told] :
       {std::pair{"0.1", false}, std::pair{"0.26", true}, std::pair{"0.34", true}, std::pair{"0.42", false}}) {
    INFO(time);
    for (const char* name : {"t", "u"})
      REQUIRE(desk({"render", desk.file(std::string(name) + ".h5"), "--time", time, "-o",
                    desk.file(std::string(name) + ".png"), "--size", "320x180", "--set", "movie.frame_rate=0.5"})
                  .status == 0);
    CHECK((desk({"compare", desk.file("t.png"), desk.file("u.png")}).status != 0) == told);
  }
}

TEST_CASE("processes that draw frames take any file name, and their frames count as drawn", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("-t.h5"), "-q"}).status == 0);
  const fs::path before = fs::current_path();
  fs::current_path(desk / "");
  const Outcome first = desk({"render", "-j", "2", "-o", desk.file("a"), "--", "-t.h5"});
  const Outcome again = desk({"render", "-j", "2", "-o", desk.file("a"), "--", "-t.h5"});
  fs::current_path(before);
  CHECK(first.status == 0);
  CHECK_THAT(first.out, Contains("6 frames drawn, 0 kept"));
  CHECK_THAT(again.out, Contains("0 frames drawn, 6 kept"));
}

TEST_CASE("a still of no time of the trajectory is refused", "[commands]") {
  const Desk desk;
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  for (const char* time : {"nan", "-nan", "inf", "-1", "1e9"}) {
    const Outcome outcome =
        desk({"render", desk.file("t.h5"), "-o", desk.file("a.png"), std::string("--time=") + time});
    CHECK(outcome.status == 1);
    CHECK_THAT(outcome.err, Contains("the trajectory goes from t = 0"));
    CHECK_FALSE(fs::exists(desk / "a.png"));
  }
}

TEST_CASE("the inset holds the cross-sections of all vesicles at every instant", "[commands]") {
  const support::TemporaryFolder folder;
  for (const char* camera : {"flow-gradient", "along-flow", "three-quarter"}) {
    const app::Settings settings = app::parse_scene(std::string(R"([flow]
kind = "shear"
[time]
end = 0.2
step = 0.1
[[vesicle]]
shape = "prolate"
reduced_volume = 0.85
order = 4
center = [-1.8, 0, 0.4]
[[vesicle]]
shape = "prolate"
reduced_volume = 0.85
order = 4
center = [4.8, 0, -0.4]
[view]
camera = ")") + camera + "\"\n",
                                                    "s.toml", ".");
    const std::string file = (folder / (std::string(camera) + ".h5")).string();
    sim::SimulationOptions options;
    options.trajectory = file;
    sim::simulate(settings.scene, options, {});
    const sim::TrajectoryReader reader(file);
    const app::Production production = app::prepare_pictures({{reader, settings}});
    const app::ViewPanel& panel = production.panels.front();
    for (std::int64_t k = 0; k < reader.count(); ++k)
      for (const sim::VesicleState& vesicle : reader.state(k).vesicles)
        for (const render::ClosedCurve& curve : render::cut(vesicle.position, {}))
          for (Eigen::Index i = 0; i < curve.points.rows(); ++i) {
            CHECK(std::abs(curve.points(i, 0) - panel.inset_centre.x) < panel.inset_half.x);
            CHECK(std::abs(curve.points(i, 1) - panel.inset_centre.y) < panel.inset_half.y);
          }
  }
}

TEST_CASE("the caption of errors adds up what the steps up to a time leave, and a share of the step that contains it") {
  std::vector<sim::StepRecord> steps(2);
  steps[0].time = 1;
  steps[0].dt = 1;
  steps[0].error = 1e-3;
  steps[1].time = 3;
  steps[1].dt = 2;
  steps[1].error = 4e-3;
  CHECK(app::error_caption(steps, 0).empty());
  CHECK(app::error_caption({}, 1).empty());
  CHECK(app::error_caption(steps, 1) == "error of position 1.0·10^{−3} R_{0}");
  CHECK(app::error_caption(steps, 2) == "error of position 3.0·10^{−3} R_{0}");
  CHECK(app::error_caption(steps, 3) == "error of position 5.0·10^{−3} R_{0}");
  CHECK(app::error_caption(steps, 9) == "error of position 5.0·10^{−3} R_{0}");
}

TEST_CASE("errors are written where asked for, and nothing else of the picture changes", "[commands]") {
  const Desk desk;
  const auto still = [&](const char* name, std::vector<std::string> more) {
    std::vector<std::string> words{"render", desk.file("t.h5"), "--time", "0.5",
                                   "-o",     desk.file(name),   "--set",  "view.size=[640, 360]"};
    words.insert(words.end(), more.begin(), more.end());
    REQUIRE(desk(words).status == 0);
    return render::read_png(desk.file(name)).image;
  };
  REQUIRE(desk({"simulate", desk.file("s.toml"), "-o", desk.file("t.h5"), "-q"}).status == 0);
  const render::Image without = still("a.png", {}), with = still("b.png", {"--set", "view.errors=true"});
  int inside = 0, outside = 0;
  for (int y = 0; y < 360; ++y)
    for (int x = 0; x < 640; ++x)
      if (!std::equal(with.at(x, y), with.at(x, y) + 3, without.at(x, y)))
        ++(x < 0.25 * 640 && y > 0.08 * 360 && y < 0.15 * 360 ? inside : outside);  // below time and parameters
  CHECK(inside > 100);
  CHECK(outside == 0);
}

TEST_CASE("times of a movie are written so that its frames differ, in any unit") {
  sim::Scene any;
  CHECK(app::time_caption(any, 12.5, app::time_format(any, 0.1, 20)) == "t = 12.50");
  CHECK(app::time_caption(any, 0.125, app::time_format(any, 0.005, 1)) == "t = 0.125");
  CHECK(app::time_caption(any, 1.25e-6, app::time_format(any, 1e-8, 4e-6)) == "t = 1.25·10^{−6}");
  CHECK(app::time_caption(any, 2.5e6, app::time_format(any, 1e4, 9e6)) == "t = 2.50·10^{6}");
}

TEST_CASE("the caption gives each vesicle the capillary number of its own size", "[pictures]") {
  sim::Scene s;
  s.flows = {{}};
  s.flows[0].kind = "shear";
  s.flows[0].rate = 2;
  s.vesicles.resize(2);
  for (sim::VesicleParameters& v : s.vesicles) v.bending_modulus = 0.5;
  CHECK(app::parameter_caption(s, std::vector{1.0, 1.0}, 0.9) == "Ca = 4   λ = 1   ν = 0.9");
  CHECK(app::parameter_caption(s, std::vector{2.0, 0.5}, 0.9) == "Ca = 0.5, 32   λ = 1   ν = 0.9");
}
