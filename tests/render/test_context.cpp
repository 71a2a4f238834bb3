// OpenGL without a window.
#include "render/core/style.h"
#include "render/draw/draw.h"
#include "render/gl/context.h"
#include "render/gl/context_back_ends.h"

#include "surfaces.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <optional>

namespace {

std::optional<render::Renderer>& opened(std::optional<render::Renderer>& slot, const char* choice) {
  try {
    slot.emplace(render::parse_gl_choice(choice));
  } catch (const std::runtime_error&) {
    slot.reset();
  }
  return slot;
}

render::Frame scene() {
  render::ViewParameters view;
  view.size = {320, 200};
  const sim::State state =
      surfaces::state_of({surfaces::disc(surfaces::turn(50, {1, 1, 0}), {-1.4, 0, 0}),
                          surfaces::ellipsoid({1.3, 0.8, 0.8}, surfaces::turn(-25, {0, 1, 0}), {1.4, 0, 0})});
  return surfaces::painted(surfaces::frame_of(state, view), state);
}

}  // namespace

TEST_CASE("a missing OpenGL library names packages that every Debian has, or the back end that serves instead") {
  const std::string osmesa = support::message_of([] { render::open_osmesa({"libNoSuchOSMesa.so.8"}); });
  CHECK_THAT(osmesa, Catch::Contains("--gl egl") && !Catch::Contains("libosmesa"));
  const std::string egl =
      support::message_of([] { render::open_egl(render::EglDevices::any, -1, {"libNoSuchEGL.so.1"}); });
  CHECK_THAT(egl, Catch::Contains("libegl1") && Catch::Contains("libgl1-mesa-dri"));
}

TEST_CASE("the words of --gl are understood and others are refused with the known ones") {
  CHECK(render::parse_gl_choice("auto").kind == "auto");
  CHECK(render::parse_gl_choice("software").kind == "software");
  CHECK(render::parse_gl_choice("egl:3").device == 3);
  for (const char* wrong : {"glx", "egl:", "egl:x", "egl:-1", "", "egl:1x"})
    CHECK_THAT(support::message_of([&] { render::parse_gl_choice(wrong); }),
               Catch::Contains("osmesa, egl, egl:N, software"));
  CHECK_THAT(support::message_of([] { render::GlContext(render::GlChoice{"egl", 99}); }), Catch::Contains("99"));
}

TEST_CASE("a context says what it is") {
  const render::GlContext context(render::parse_gl_choice("software"));
  CHECK(context.information().software);
  CHECK_FALSE(context.information().renderer.empty());
  CHECK_FALSE(context.information().version.empty());
  CHECK_FALSE(context.information().back_end.empty());
}

TEST_CASE("OSMesa and EGL draw the same pixels") {
  std::optional<render::Renderer> osmesa, egl;
  if (!opened(osmesa, "osmesa") || !opened(egl, "egl") || !egl->information().software) {
    WARN("only one software back end here: nothing to compare");
    return;
  }
  for (const render::StyleRow& style : render::styles()) {
    INFO(style.name);
    render::Frame frame = scene();
    frame.view.style = style.name;
    const render::Image a = render::draw_frame(*osmesa, frame), b = render::draw_frame(*egl, frame);
    CHECK(a == b);
    CHECK(render::draw_frame(*osmesa, frame) == a);  // and each still draws in its own context
  }
}

TEST_CASE("two renderers and two runs of one renderer give the same bytes") {
  const render::Frame frame = scene();
  render::Renderer first(render::parse_gl_choice("software"));
  const render::Image a = render::draw_frame(first, frame);
  {
    render::Renderer second(render::parse_gl_choice("software"));
    CHECK(render::draw_frame(second, frame) == a);
  }
  render::Frame other = frame;  // another size and style in between leaves no trace
  other.view.size = {160, 120};
  other.view.style = "checker";
  CHECK(render::draw_frame(first, other).width == 160);
  CHECK(render::draw_frame(first, frame) == a);
}

// Mesa reads its number of threads once a process: the test starts itself again.
TEST_CASE("draws the scene into the file named by TANKTREAD_TEST_PICTURE", "[.][child]") {
  const char* path = std::getenv("TANKTREAD_TEST_PICTURE");
  REQUIRE(path != nullptr);
  render::Renderer renderer(render::parse_gl_choice("software"));
  render::write_png(path, render::draw_frame(renderer, scene()));
}

TEST_CASE("the number of Mesa's threads does not change a pixel") {
  const support::TemporaryFolder folder;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  std::vector<std::string> bytes;
  for (const char* threads : {"0", "1", "2"}) {
    const std::filesystem::path picture = folder / (std::string("threads") + threads + ".png");
    const std::string command = std::string("LP_NUM_THREADS=") + threads + " TANKTREAD_TEST_PICTURE='" +
                                picture.string() + "' '" + self.string() + "' '[child]' > /dev/null";
    REQUIRE(std::system(command.c_str()) == 0);
    bytes.push_back(support::read_file(picture));
  }
  CHECK_FALSE(bytes[0].empty());
  CHECK(bytes[0] == bytes[1]);
  CHECK(bytes[0] == bytes[2]);
}

TEST_CASE("shaders can be taken from a folder, and a fault in one is told with its name") {
  const support::TemporaryFolder folder;
  for (const auto& entry : std::filesystem::directory_iterator(TANKTREAD_SHADERS))
    std::filesystem::copy(entry.path(), folder / entry.path().filename().string());
  const render::Frame frame = scene();
  render::Renderer embedded(render::parse_gl_choice("software"));
  render::Renderer edited(render::parse_gl_choice("software"), folder.path());
  CHECK(render::draw_frame(edited, frame) == render::draw_frame(embedded, frame));
  support::write_file(folder / "body.frag", "void main() { nonsense }\n");
  render::Renderer broken(render::parse_gl_choice("software"), folder.path());
  CHECK_THAT(support::message_of([&] { render::draw_frame(broken, frame); }),
             Catch::Contains("body.frag does not compile"));
}
