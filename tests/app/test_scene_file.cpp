// Scene files: what is right is read, what is wrong is told with file, line, column and the nearest good word.
#include "app/pictures/frames.h"
#include "app/scene/scene_file.h"
#include "app/scene/scene_text.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using app::parse_scene;
using app::Settings;
using Catch::Contains;
using support::message_of;

namespace {

const std::string good = R"(title = "A \"quoted\" title"

[flow]
kind = "shear"
rate = 1.0

[time]
end = 2
step = 0.1

[[vesicle]]
shape = "prolate"
reduced_volume = 0.85
order = 12
)";

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = good;
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return message_of([&] { parse_scene(text, "s.toml", ".", overrides); });
}

}  // namespace

TEST_CASE("a scene is read with its defaults", "[scene]") {
  const Settings s = parse_scene(good, "s.toml", ".");
  CHECK(s.scene.title == "A \"quoted\" title");
  REQUIRE(s.scene.flows.size() == 1);
  CHECK(s.scene.flows[0].kind == "shear");
  CHECK(s.scene.time.end == 2);
  REQUIRE(s.scene.vesicles.size() == 1);
  CHECK(s.scene.vesicles[0].order == 12);
  CHECK(s.scene.vesicles[0].reduced_volume == 0.85);
  CHECK(s.scene.vesicles[0].viscosity_contrast == 1);
  CHECK(s.scene.numerics.upsampling == 0);
}

TEST_CASE("the resolved scene gives the same scene again", "[scene]") {
  for (const std::string& extra :
       {std::string(), std::string("[[flow]]\nkind = \"poiseuille\"\ncurvature = 0.1\n"),
        std::string("[numerics]\nupsampling = 3\n"),
        std::string("[[figure]]\nkind = \"cross-sections\"\ntimes = [0, 1.5]\n[view]\nsize = [160, 90]\n")}) {
    std::string scene = good;
    if (extra.starts_with("[[flow]]")) scene = replaced("[flow]", "[[flow]]");
    const Settings first = parse_scene(scene + extra, "s.toml", ".");
    const std::string resolved = app::write_scene(first);
    INFO(resolved);
    const Settings second = parse_scene(resolved, "resolved", ".");
    CHECK(app::write_scene(second) == resolved);
    CHECK(app::physics_hash(first.scene) == app::physics_hash(second.scene));
    CHECK(app::picture_hash(first) == app::picture_hash(second));
    CHECK_THAT(resolved, Contains("viscosity_contrast = 1.0"));
  }
}

TEST_CASE("numbers are written with the digits that give the same number", "[scene]") {
  for (const double value : {0.1, 1.0, 1e-10, 12.566370614359172, 1e300, -0.0, 1.0 / 3})
    CHECK(std::stod(app::toml_value(value)) == value);
  CHECK(app::toml_value(1.0) == "1.0");
  CHECK(app::toml_value(sim::unlimited) == "inf");
}

TEST_CASE("an unknown key is told with line, column and the nearest known one", "[scene]") {
  CHECK(error_of(replaced("order = 12", "oder = 12")) ==
        "s.toml:14:1: unknown key 'oder' in [vesicle] (did you mean 'order'?)");
  CHECK(error_of(replaced("[time]", "[tiem]")) == "s.toml:7:2: unknown table 'tiem' (did you mean 'time'?)");
  CHECK_THAT(error_of(good + "[view]\nstile = \"opaque\"\n"), Contains("s.toml:16:1") && Contains("'style'"));
}

TEST_CASE("values out of range are told with line, column and range", "[scene]") {
  CHECK(error_of(replaced("order = 12", "order = 1")) == "s.toml:14:9: 'order' must be at least 2, at most 64, not 1");
  CHECK(error_of(replaced("order = 12", "viscosity_contrast = -1")) ==
        "s.toml:14:22: 'viscosity_contrast' must be above 0, not -1; 0.001 is near a bubble, 1000 near a rigid body");
  CHECK(error_of(replaced("0.85", "1.2")) == "s.toml:13:18: 'reduced_volume' must be above 0, at most 1, not 1.2");
  CHECK(error_of(replaced("step = 0.1", "step = 0")) == "s.toml:9:8: 'step' must be above 0, not 0");
  CHECK_THAT(error_of(replaced("step = 0.1", "step = nan")), Contains("s.toml:9:8"));
  CHECK_THAT(error_of(replaced("rate = 1.0", "rate = inf")), Contains("s.toml:5:8") && Contains("finite"));
}

TEST_CASE("more steps or frames than anybody can wait for are refused, whichever key asks for them", "[scene]") {
  CHECK(error_of(replaced("step = 0.1", "step = 1e-10")) ==
        "s.toml:9:8: 2e+10 steps are too many; 'step' must be longer");
  CHECK(error_of(replaced("step = 0.1", "save_every = 1e-10")) ==
        "s.toml:9:14: 2e+10 steps are too many; 'save_every' must be longer");
  CHECK(error_of(good + "[movie]\ntime_per_frame = 1e-300\n") ==
        "s.toml:16:18: 2e+300 frames are too many; 'time_per_frame' must be longer");
  CHECK_THAT(error_of(good, {"movie.time_per_frame=1e-300"}), Contains("frames are too many"));
  CHECK(error_of(good + "[movie]\ntime_per_frame = 2e-7\n").empty());
  CHECK(app::frame_count(2, 2e-7) == 10000001);
  CHECK_THAT(message_of([] { app::frame_count(2, 1e-300); }), Contains("movie.time_per_frame must be longer"));
}

TEST_CASE("values of the wrong type are told with line and column", "[scene]") {
  CHECK(error_of(replaced("order = 12", "order = \"12\"")) ==
        "s.toml:14:9: 'order' must be \"auto\" or a whole number, not the text \"12\"");
  CHECK(error_of(replaced("order = 12", "order = 12.5")) ==
        "s.toml:14:9: 'order' must be \"auto\" or a whole number, not the number 12.5");
  CHECK_THAT(error_of(replaced("order = 12", "center = [1, 2]")),
             Contains("s.toml:14:10") && Contains("three numbers"));
  CHECK_THAT(error_of(replaced("order = 12", "center = [1, 2, \"x\"]")), Contains("s.toml:14:17"));
  CHECK_THAT(error_of(replaced("[time]", "[[time]]")), Contains("must be one table"));
}

TEST_CASE("unknown words are told with the nearest known one", "[scene]") {
  CHECK_THAT(error_of(replaced("prolate", "prolat")),
             Contains("s.toml:12:9") && Contains("did you mean 'prolate'?") && Contains("list shapes"));
  CHECK_THAT(error_of(replaced("shear", "sheer")), Contains("s.toml:4:8") && Contains("did you mean 'shear'?"));
}

TEST_CASE("a key of another kind is refused, a missing one is asked for", "[scene]") {
  CHECK(error_of(replaced("rate = 1.0", "curvature = 1")) ==
        "s.toml:5:1: 'curvature' is a key of flow 'poiseuille', not of 'shear'");
  CHECK(error_of(good + "\n[[placement]]\nkind = \"box\"\ncount = 2\nvolume_fraction = 0.05\n") ==
        "");  // its gap is computed
  CHECK(error_of(good + "\n[[placement]]\nkind = \"tube\"\ncount = 2\nvolume_fraction = 0.05\n") == "");
  CHECK_THAT(error_of(replaced("reduced_volume = 0.85", "")),
             Contains("s.toml:12:9") && Contains("needs the key 'reduced_volume'"));
  CHECK_THAT(error_of(replaced("prolate", "ellipsoid")),
             Contains("s.toml:13:1") && Contains("'reduced_volume' is a key of shape"));
  CHECK_THAT(error_of(replaced("rate = 1.0", "frequency = 2.0")),
             Contains("s.toml:5:13") && Contains("time_factor 'oscillating'"));
}

TEST_CASE("contradictions and reserved keys are refused", "[scene]") {
  CHECK(error_of(replaced("step = 0.1", "step = 0.1\ntolerance = 1e-4")) ==
        "s.toml:9:8: give 'step', fixed steps, or 'tolerance', steps that follow it, not both");
  CHECK_THAT(error_of(replaced("step = 0.1", "step = 0.1\nscheme = 'adaptive'")), Contains("chooses its steps"));
  CHECK_THAT(error_of(replaced("step = 0.1", "scheme = 'bdf3'")), Contains("takes fixed steps; give 'step'"));
  CHECK_THAT(error_of(replaced("step = 0.1", "tolerance = 1e-3\nscheme = 'explicit'")),
             Contains("takes fixed steps; give 'step'"));
  CHECK_THAT(error_of(replaced("step = 0.1", "tolerance = 1e-7")), Contains("'tolerance' must be at least 1e-06"));
  CHECK_THAT(error_of(good + "area = 1\nradius = 2\n"), Contains("s.toml:16:10") && Contains("not both"));
  CHECK_THAT(error_of(good + "axis = [0, 0, 0]\n"), Contains("s.toml:15:8"));
  CHECK_THAT(error_of(replaced("end = 2", "")), Contains("s.toml:7:1") && Contains("needs 'end'"));
  CHECK(error_of("title = \"x\"\n") == "s.toml: the table [[flow]] is missing");
  CHECK_THAT(error_of(replaced("step = 0.1", "step = ")), Contains("s.toml:9:"));
}

TEST_CASE("missing files are told", "[scene]") {
  const support::TemporaryFolder folder;
  CHECK_THAT(message_of([&] { app::read_scene(folder / "none.toml"); }),
             Contains("none.toml") && Contains("no such scene"));
  CHECK_THAT(message_of([&] { app::read_scene(folder.path()); }), Contains("is not a file"));
  const std::string text =
      replaced("shape = \"prolate\"\nreduced_volume = 0.85", "shape = \"file\"\nfile = \"blob.txt\"");
  support::write_file(folder / "s.toml", text);
  CHECK_THAT(message_of([&] { app::read_scene(folder / "s.toml"); }), Contains("s.toml:13:8") && Contains("blob.txt"));
}

TEST_CASE("a shape file counts by what it holds, not by where it lies", "[scene]") {
  const support::TemporaryFolder folder;
  const std::string text =
      replaced("shape = \"prolate\"\nreduced_volume = 0.85", "shape = \"file\"\nfile = \"blob.txt\"");
  const std::string sphere = "coefficients\n1 1 1 0 0\n1 -1 0 1 0\n1 0 0 0 1\n";
  support::write_file(folder / "s.toml", text);
  support::write_file(folder / "blob.txt", sphere);
  const Settings first = app::read_scene(folder / "s.toml");
  std::filesystem::create_directory(folder / "moved");
  support::write_file(folder / "moved" / "s.toml", text);
  support::write_file(folder / "moved" / "blob.txt", sphere);
  CHECK(app::physics_hash(app::read_scene(folder / "moved" / "s.toml").scene) == app::physics_hash(first.scene));
  support::write_file(folder / "blob.txt", sphere + "2 0 0.1 0 0\n");
  CHECK(app::physics_hash(app::read_scene(folder / "s.toml").scene) != app::physics_hash(first.scene));
  const std::string resolved = write_scene(first);  // says what the file held
  CHECK_THAT(message_of([&] { parse_scene(resolved, "resolved", folder.path()); }), Contains("blob.txt' has changed"));
  CHECK_THAT(error_of(good + "checksum = \"1\"\n"), Contains("s.toml:15:12") && Contains("not of 'prolate'"));
}

TEST_CASE("what two tables say together is checked before the run", "[scene]") {
  CHECK_THAT(error_of(good + "[numerics]\nsource_order = 8\n"),
             Contains("s.toml:16:16") && Contains("order 12, not 8"));
  CHECK_THAT(error_of(good + "[numerics]\nlabel_order = 1\n"), Contains("s.toml:16:15") && Contains("at least 4"));
  CHECK_THAT(error_of(good + "[placement]\nkind = \"file\"\nfile = \"c.txt\"\nseed = 3\n"),
             Contains("s.toml:18:1") && Contains("not of 'file'"));
  CHECK_THAT(error_of(good + "[placement]\nkind = \"file\"\nfile = \"c.txt\"\nsize_spread = 0.1\n"),
             Contains("s.toml:18:1") && Contains("'size_spread' is a key of placement 'lattice', 'box', 'tube'"));
}

TEST_CASE("overrides change any key, and their errors name them", "[scene]") {
  const Settings s = parse_scene(good + "[[vesicle]]\nshape = \"sphere\"\n", "s.toml", ".",
                                 {"vesicle.order=9", "vesicle.1.order=7", "time.end=5", "numerics.upsampling=2",
                                  "view.size=[160,90]", "view.style=plain", "flow.rate=2", "title=new"});
  CHECK(s.scene.vesicles[0].order == 9);
  CHECK(s.scene.vesicles[1].order == 7);
  CHECK(s.scene.time.end == 5);
  CHECK(s.scene.numerics.upsampling == 2);
  CHECK(s.view.size == std::vector<int>{160, 90});
  CHECK(s.view.style == "plain");
  CHECK(s.scene.flows[0].rate == 2);
  CHECK(s.scene.title == "new");
  CHECK(error_of(good, {"vesicle.order=1"}) == "--set vesicle.order=1: 'order' must be at least 2, at most 64, not 1");
  CHECK(error_of(good, {"vesicle.oder=3"}) ==
        "--set vesicle.oder=3: unknown key 'oder' in [vesicle] (did you mean 'order'?)");
  CHECK_THAT(error_of(good, {"vesicle.1.order=3"}), Contains("numbered from 0 to 0"));
  CHECK_THAT(error_of(good, {"time.end"}), Contains("section.key=value"));
  CHECK_THAT(error_of(good, {"viev.size=[1,2]"}), Contains("did you mean 'view'?"));
  CHECK_THAT(error_of(good, {"view.size=[1,"}), Contains("--set view.size=[1,"));
  CHECK_THAT(error_of(good, {"view.background=#12345"}), Contains("'#12345' is no known"));
  CHECK_THAT(error_of(good, {"view.background=#123456 # blue"}), Contains("expected value"));
}

TEST_CASE("a key without its table, or in another one, is told with the table it belongs to", "[scene]") {
  CHECK(error_of(good, {"viscosity_contrast=3"}) ==
        "--set viscosity_contrast=3: unknown key 'viscosity_contrast' (did you mean 'vesicle.viscosity_contrast'?)");
  CHECK_THAT(error_of(good, {"viscosity_contrst=3"}), Contains("(did you mean 'vesicle.viscosity_contrast'?)"));
  CHECK_THAT(error_of(good, {"flow.viscosity_contrast=3"}),
             Contains("unknown key 'viscosity_contrast' in [flow] (did you mean 'vesicle.viscosity_contrast'?)"));
  CHECK_THAT(error_of(good, {"step=0.1"}), Contains("(did you mean 'time.step'?)"));
  CHECK_THAT(error_of("viscosity_contrast = 3\n" + good),
             Contains("s.toml:1:1: ") && Contains("'vesicle.viscosity_contrast'"));
  CHECK_THAT(error_of(good, {"titel=x"}), Contains("(did you mean 'title'?)"));
}

TEST_CASE("numbers on the command line may lack the digit before or after their point", "[scene]") {
  CHECK(parse_scene(good, "s.toml", ".", {"time.end=.5"}).scene.time.end == 0.5);
  CHECK(parse_scene(good, "s.toml", ".", {"time.end=5."}).scene.time.end == 5);
  CHECK(parse_scene(good, "s.toml", ".", {"vesicle.center=[-.5, +.25, 1.]"}).scene.vesicles[0].center ==
        sim::Vec3(-0.5, 0.25, 1));
  CHECK(parse_scene(good, "s.toml", ".", {"time.end=.5e1"}).scene.time.end == 5);
  CHECK(parse_scene(good, "s.toml", ".", {"title=a.5"}).scene.title == "a.5");  // a text stays as it is
  CHECK(parse_scene(good, "s.toml", ".", {"title='.5'"}).scene.title == ".5");
  CHECK_THAT(error_of(good, {"time.end=.x"}), Contains("'end' must be a number"));
}

TEST_CASE("a number without a fraction is a whole number, with a point or without", "[scene]") {
  CHECK(parse_scene(replaced("order = 12", "order = 8.0"), "s.toml", ".").scene.vesicles[0].order == 8);
  CHECK(parse_scene(good, "s.toml", ".", {"view.size=[640.0, 3.6e2]"}).view.size == std::vector<int>{640, 360});
  CHECK_THAT(error_of(replaced("order = 12", "order = 8.5")),
             Contains("must be \"auto\" or a whole number, not the number 8.5"));
  CHECK_THAT(error_of(good, {"vesicle.order=inf"}), Contains("must be \"auto\" or a whole number"));
  CHECK_THAT(error_of(good, {"vesicle.order=nan"}), Contains("must be \"auto\" or a whole number"));
  CHECK_THAT(error_of(good, {"vesicle.order=1e300"}), Contains("must be \"auto\" or a whole number"));
  CHECK_THAT(error_of(good, {"vesicle.order=1e12"}), Contains("at most 64"));
}

TEST_CASE("a byte order mark at the start of a scene or a table is ignored", "[scene]") {
  const std::string mark = "\xef\xbb\xbf";
  const support::TemporaryFolder folder;
  support::write_file(folder / "blob.txt", mark + "coefficients\n1 1 1 0 0\n1 -1 0 1 0\n1 0 0 0 1\n");
  support::write_file(folder / "centres.txt", mark + "1 2 3\n4 5 6\n");
  const std::string text =
      "[[vesicle]]\nshape = \"file\"\nfile = \"blob.txt\"\norder = 4\n[time]\nend = 1\nstep = 0.1\n"
      "[placement]\nkind = \"file\"\nfile = \"centres.txt\"\n[flow]\nkind = \"none\"\n";
  support::write_file(folder / "s.toml", mark + text);
  const Settings s = app::read_scene(folder / "s.toml");
  REQUIRE(s.scene.vesicles.size() == 2);
  CHECK(s.scene.vesicles[0].center == sim::Vec3(1, 2, 3));
  support::write_file(folder / "centres.txt", "\xef\xbb");  // a broken one is no mark
  CHECK_THAT(message_of([&] { app::read_scene(folder / "s.toml"); }), Contains("is not a number"));
}

TEST_CASE("scenes of one title are told apart by the keys that differ, else by their files", "[scene]") {
  const auto scene = [](const std::vector<std::string>& changes) {
    return parse_scene(good, "s.toml", ".", changes).scene;
  };
  using Names = std::vector<std::string>;
  CHECK(app::distinct_names({scene({"vesicle.viscosity_contrast=1"}), scene({"vesicle.viscosity_contrast=3"}),
                             scene({"vesicle.viscosity_contrast=5.5"})},
                            {"a", "b", "c"}) == Names{"λ = 1", "λ = 3", "λ = 5.5"});
  CHECK(app::distinct_names({scene({"title=x"}), scene({"title=x", "flow.rate=2"}), scene({"title=y"})},
                            {"a", "b", "c"}) == Names{"x, γ̇ = 1", "x, γ̇ = 2", "y"});
  CHECK(app::distinct_names({scene({"time.end=3"}), scene({"vesicle.viscosity_contrast=3"})}, {"a", "b"}) ==
        Names{"λ = 1", "λ = 3"});
  CHECK(app::distinct_names({scene({"time.end=3"}), scene({"time.end=4"})}, {"a", "b"}) == Names{"end = 3", "end = 4"});
  CHECK(app::distinct_names({scene({}), scene({})}, {"a/t.h5", "b/t.h5"}) == Names{"a/t.h5", "b/t.h5"});
  CHECK(app::distinct_names({scene({}), scene({"vesicle.order=8"}), scene({"vesicle.order=8"})}, {"a", "b", "c"}) ==
        Names{"order = 12", "order = 8, b", "order = 8, c"});
}

TEST_CASE("a poster beyond the end of the scene is refused", "[scene]") {
  CHECK_THAT(error_of(good + "[movie]\nposter = 2.5\n"),
             Contains("s.toml:16:10: 'poster' must be at most time.end, 2, not 2.5"));
  CHECK_THAT(error_of(good + "[movie]\nposter = 2.00001\n"), Contains("at most time.end, 2, not 2.00001"));
  CHECK(parse_scene(good + "[movie]\nposter = 2\n", "s.toml", ".").movie.poster == 2.0);
}

TEST_CASE("a periodic cell takes flows that keep it one, and sets the volume fraction itself", "[scene]") {
  const std::string cell = "[cell]\nsize = [6, 5, 4.5]\n";
  CHECK(error_of(good + cell) == "");
  CHECK(*parse_scene(good + cell, "s.toml", ".").scene.cell.size == sim::Vec3(6, 5, 4.5));
  CHECK_THAT(error_of(good + "[cell]\nsize = [6, 5, 0]\n"), Contains("s.toml:16:15") && Contains("'size'"));
  CHECK_THAT(error_of(good + "[cell]\nsice = [6, 5, 4]\n"), Contains("did you mean 'size'"));
  CHECK_THAT(error_of(replaced("kind = \"shear\"\nrate = 1.0", "kind = \"extension\"") + cell),
             Contains("s.toml:4:8") && Contains("'extension' does not keep a [cell] periodic"));
  const auto streams = [](const std::string& more) {
    return replaced("kind = \"shear\"\nrate = 1.0", "kind = \"streams\"\ncentreline_velocity = 1" + more);
  };
  CHECK_THAT(error_of(streams("")), Contains("s.toml:4:8") && Contains("'streams' needs the key 'wavelength'"));
  CHECK(error_of(streams("\nwavelength = 2.7")) == "");
  CHECK(error_of(streams("\nwavelength = 2") + "[cell]\nsize = [3, 4, 6]\n") == "");
  for (const char* length : {"4", "8", "2.1"})
    CHECK_THAT(error_of(streams("\nwavelength = " + std::string(length)) + "[cell]\nsize = [3, 4, 6]\n"),
               Contains("s.toml:6:14") && Contains("along y and z must be multiples of the wavelength"));
  CHECK_THAT(error_of(good + cell + "[numerics]\nfar_field = \"direct\"\n"),
             Contains("s.toml:18:13") && Contains("leave it \"auto\""));
  CHECK(error_of(good + cell + "[placement]\nkind = \"box\"\ncount = 2\n") == "");
  CHECK_THAT(error_of(good + cell + "[placement]\nkind = \"box\"\ncount = 2\nvolume_fraction = 0.05\n"),
             Contains("s.toml:20:19") && Contains("leave 'volume_fraction' out"));
}
