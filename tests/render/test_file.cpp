// The one function that puts files of results on the disk.
#include "render/figures/canvas.h"
#include "sim/core/result_file.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

#include <unistd.h>
#include <set>
#include <system_error>

namespace fs = std::filesystem;
using support::TemporaryFolder;

namespace {

std::string draft_name(int number) {
  return ".tanktread-" + std::to_string(::getpid()) + "-" + std::to_string(number) + ".tmp";
}

std::size_t count_in(const TemporaryFolder& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder.path())) ++count;
  return count;
}

}  // namespace

TEST_CASE(
    "a link that waits under the temporary name of a file is not written through, whatever the kind of the file") {
  const TemporaryFolder folder;
  const render::Drawing drawing{10, 10, [](cairo_t*, const render::Font&) {}};
  constexpr int waiting = 1000;  // more than this process has written so far
  for (int k = 0; k < waiting; ++k) fs::create_symlink(folder / "precious", folder / draft_name(k));
  for (const std::string name : {"a.txt", "a.svg", "a.pdf", "a.png"}) {
    INFO(name);
    support::write_file(folder / "precious", "kept");
    if (name == "a.txt") sim::write_file(folder / name, "new");
    if (name == "a.svg") render::write_drawing_svg(folder / name, drawing);
    if (name == "a.pdf") render::write_drawing_pdf(folder / name, drawing);
    if (name == "a.png") render::write_drawing_png(folder / name, drawing);
    CHECK(support::read_file(folder / "precious") == "kept");
    CHECK(fs::file_size(folder / name) > 0);
    CHECK_FALSE(fs::is_symlink(folder / name));
  }
  CHECK(count_in(folder) == waiting + 5);
}

TEST_CASE("a file that is a link keeps being one, and what it points to is replaced") {
  const TemporaryFolder folder;
  support::write_file(folder / "real", "a longer old text");
  fs::create_symlink("real", folder / "link");
  sim::write_file(folder / "link", "new");
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(support::read_file(folder / "real") == "new");
  CHECK(count_in(folder) == 2);
}

TEST_CASE("a link to a file that is not there yet is written through, and a ring of links is refused") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "disk");
  fs::create_symlink("disk/first", folder / "link");
  fs::create_symlink("second", folder / "disk/first");
  sim::write_file(folder / "link", "new");
  CHECK(support::read_file(folder / "disk/second") == "new");
  CHECK(fs::is_symlink(folder / "link"));
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  CHECK(support::message_of([&] {
          sim::write_file(folder / "a", "new");
        }).ends_with("Too many levels of symbolic links"));
}

TEST_CASE("drafts of processes that were killed are removed; those of living ones, and what only looks alike, stay") {
  const TemporaryFolder folder;
  sim::Draft alive(folder / "target");
  alive.write("half");
  std::set<std::string> staying{alive.path().filename().string(),
                                "u.h5.tmp",
                                ".notes.txt.17.tmp",
                                ".tanktread-17.tmp",
                                ".tanktread-17-x.tmp",
                                ".tanktread-17-3.tmp~",
                                "tanktread-17-3.tmp",
                                ".tanktread-8-0.tmp"};
  for (const std::string& name : staying)
    if (name != alive.path().filename() && name != ".tanktread-8-0.tmp")
      support::write_file(folder / name, "somebody's");
  fs::create_symlink("u.h5.tmp", folder / ".tanktread-8-0.tmp");
  support::write_file(folder / ".tanktread-17-3.tmp", "left by a kill");
  sim::remove_dead_drafts(folder.path());
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path())) names.insert(entry.path().filename().string());
  CHECK(names == staying);
  alive.publish(folder / "target");
  CHECK(support::read_file(folder / "target") == "half");
  sim::Draft second(folder / "target");
  CHECK_THROWS_AS(second.publish(folder / "target", true), std::system_error);  // somebody was faster
  CHECK(support::read_file(folder / "target") == "half");
}

TEST_CASE("a device is written to as it is, and a file that cannot be written leaves the old one and nothing else") {
  const TemporaryFolder folder;
  sim::write_file("/dev/null", "text");
  CHECK(fs::is_character_file("/dev/null"));
  CHECK(support::message_of([] { sim::write_file("/dev/full", "text"); }) ==
        "/dev/full: cannot be written: No space left on device");
  fs::create_directory(folder / "taken");
  CHECK(support::message_of([&] {
          sim::write_file(folder / "taken", "text");
        }).ends_with("taken: cannot be written: Is a directory"));
  CHECK(support::message_of([&] {
          sim::write_file(folder / "none/a", "text");
        }).ends_with("none/a: cannot be written: No such file or directory"));
  CHECK(count_in(folder) == 1);
}
