// The manual page and the completion of the shell tell all that the command line takes.
#include "app/commands/commands.h"
#include "app/export/reference.h"
#include "app/scene/catalogues.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

#include <fstream>
#include <sstream>

using Catch::Contains;
using support::Outcome;

namespace {

/// What bash offers after these words, the last of which is being typed.
std::vector<std::string> offered(const std::vector<std::string>& words) {
  const support::TemporaryFolder folder;
  const Outcome script = support::run(folder, {TANKTREAD_PROGRAM, "--bash-completion"});
  REQUIRE(script.status == 0);
  std::string line = "compopt() { :; }\n" + script.out + "COMP_WORDS=(tanktread";
  for (const std::string& word : words) line += " '" + word + "'";
  line += ")\nCOMP_CWORD=" + std::to_string(words.size()) + "\n_tanktread\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
  std::ofstream((folder / "complete.sh").string()) << line;
  const Outcome said = support::run(folder, {"bash", "-eu", (folder / "complete.sh").string()});
  INFO(said.err);
  REQUIRE(said.status == 0);
  REQUIRE(said.err.empty());
  std::vector<std::string> result;
  std::istringstream lines(said.out);
  for (std::string word; std::getline(lines, word);)
    if (!word.empty()) result.push_back(word);
  return result;
}

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("the manual page names every command, every option, every key and every kind") {
  const support::TemporaryFolder folder;
  const Outcome page = support::run(folder, {TANKTREAD_PROGRAM, "--manual"});
  REQUIRE(page.status == 0);
  std::string plain;  // hyphens as they are typed
  for (std::size_t k = 0; k < page.out.size(); ++k)
    if (page.out[k] != '\\' || page.out[k + 1] != '-') plain += page.out[k];
  for (const app::Command& command : app::commands) {
    CHECK_THAT(plain, Contains("\n.SS \"tanktread " + std::string(command.name) + "\""));
    const Outcome help = support::run(folder, {TANKTREAD_PROGRAM, std::string(command.name), "--help"});
    REQUIRE(help.status == 0);
    for (std::size_t at = 0; (at = help.out.find(" --", at)) != std::string::npos;) {
      const std::size_t end = help.out.find_first_of(" ,\n:", at + 1);
      CHECK_THAT(plain, Contains(help.out.substr(at + 1, end - at - 1)));
      at = end;
    }
  }
  for (const app::ReferenceKey& key : app::reference_keys())
    CHECK_THAT(plain, Contains("\n\\fB" + key.name + "\\fR\n"));
  for (const app::Catalogue& catalogue : app::catalogues())
    for (const auto& row : catalogue.rows) CHECK_THAT(plain, Contains("\n\\fB" + std::string(row.name) + "\\fR\n"));
}

TEST_CASE("bash completes commands, their options, and the words of the catalogues") {
  CHECK(offered({"ru"}) == Words{"run"});
  CHECK(offered({"render", "t.h5", "--sty"}) == Words{"--style"});
  CHECK(offered({"info", "t.h5", "--sty"}).empty());
  CHECK(offered({"render", "t.h5", "--gl", "os"}) == Words{"osmesa"});
  CHECK(offered({"figure", "tank"}) == Words{"tank-treading"});
  CHECK(offered({"list", "para"}) == Words{"parameters"});
  CHECK(offered({"sweep", "s.toml", "--vary", "vesicle.visc"}) == Words{"vesicle.viscosity_contrast="});
  CHECK(offered({"converge", "s.toml", "--vary", ""}) == Words{"tolerance", "step", "order"});
  CHECK(offered({"converge", "s.toml", "--quantities", "half"}) == Words{"half-turn"});
  CHECK(offered({"reproduce", "table2"}) == Words{"table2"});
  CHECK(offered({"validate", "jef"}) == Words{"jeffery"});
  CHECK(offered({"run", "s.toml", "--set", "vesicle.ord"}) == Words{"vesicle.order="});
  CHECK(offered({"run", "sce"}).empty());  // a file: bash's own completion takes over
  const Words styles = offered({"render", "t.h5", "--style", ""});
  for (const app::Catalogue& catalogue : app::catalogues())
    if (catalogue.name == "styles") CHECK(styles.size() == catalogue.rows.size());
}
