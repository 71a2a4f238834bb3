// The one function that puts files of results on the disk.
#include "render/canvas.h"
#include "render/file.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>

#include <unistd.h>

namespace fs = std::filesystem;
using support::TemporaryFolder;

namespace {

std::string draft_name(const std::string& name) { return "." + name + "." + std::to_string(::getpid()) + ".tmp"; }

std::size_t count_in(const TemporaryFolder& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder.path())) ++count;
  return count;
}

}  // namespace

TEST_CASE("a link that waits under the temporary name of a file is not written through, whatever the kind of the file") {
  const TemporaryFolder folder;
  const render::Drawing drawing{10, 10, [](cairo_t*, const render::Font&) {}};
  for (const std::string name : {"a.txt", "a.svg", "a.pdf", "a.png"}) {
    INFO(name);
    support::write_file(folder / "precious", "kept");
    fs::create_symlink(folder / "precious", folder / draft_name(name));
    if (name == "a.txt") render::write_file(folder / name, "new");
    if (name == "a.svg") render::write_drawing_svg(folder / name, drawing);
    if (name == "a.pdf") render::write_drawing_pdf(folder / name, drawing);
    if (name == "a.png") render::write_drawing_png(folder / name, drawing);
    CHECK(support::read_file(folder / "precious") == "kept");
    CHECK(fs::file_size(folder / name) > 0);
    CHECK_FALSE(fs::is_symlink(folder / name));
  }
  CHECK(count_in(folder) == 5);
}

TEST_CASE("a file that is a link keeps being one, and what it points to is replaced") {
  const TemporaryFolder folder;
  support::write_file(folder / "real", "a longer old text");
  fs::create_symlink("real", folder / "link");
  render::write_file(folder / "link", "new");
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(support::read_file(folder / "real") == "new");
  CHECK(count_in(folder) == 2);
}

TEST_CASE("a device is written to as it is, and a file that cannot be written leaves the old one and nothing else") {
  const TemporaryFolder folder;
  render::write_file("/dev/null", "text");
  CHECK(fs::is_character_file("/dev/null"));
  CHECK(support::message_of([] { render::write_file("/dev/full", "text"); }) ==
        "/dev/full: cannot be written: No space left on device");
  fs::create_directory(folder / "taken");
  CHECK(support::message_of([&] { render::write_file(folder / "taken", "text"); }).ends_with("taken: cannot be written: Is a directory"));
  CHECK(support::message_of([&] { render::write_file(folder / "none/a", "text"); })
            .ends_with("none/a: cannot be written: No such file or directory"));
  CHECK(count_in(folder) == 1);
}
