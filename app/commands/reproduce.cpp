// The command reproduce: a catalogue of the paper's tables and figures.
#include "app/base/interrupt.h"
#include "app/base/message.h"
#include "app/commands/commands.h"
#include "app/reproduce/reproduce_items.h"

#include "sim/core/catalogue.h"

#include <fmt/format.h>

namespace app {

namespace {

struct Reproduction {
  std::string_view name, meaning;
  Report (*function)(const Effort&);
};

constexpr Reproduction reproductions[] = {
    {"table2", "upsampling that the mean curvature needs", reproduce_upsampling},
    {"table3", "convergence of the double layer", reproduce_double_layer},
    {"table4", "stable time steps of the schemes", reproduce_stable_steps},
    {"table5", "iterations and singular integrals", reproduce_cost},
    {"fig2", "aliasing of associated Legendre functions", reproduce_aliasing},
    {"fig3", "spectra of position and mean curvature", reproduce_spectra},
    {"fig4", "a biconcave vesicle in Poiseuille flow", reproduce_poiseuille},
    {"fig5", "error of one block iteration against distance", reproduce_block_error},
    {"fig6", "two vesicles in shear flow", reproduce_two_vesicles},
    {"tank-treading", "angle and frequency against reduced volume, beside other authors'", reproduce_tank_treading},
};

void print_catalogue() {
  for (const Reproduction& item : reproductions) fmt::print("{:<14} {}\n", item.name, item.meaning);
  fmt::print("{:<14} {}\n", "all", "all of these");
}

}  // namespace

std::vector<std::string_view> reproduction_names() {
  std::vector<std::string_view> names{"all"};
  for (const Reproduction& item : reproductions) names.push_back(item.name);
  return names;
}

int reproduce(const Options& options) {
  if (options.word.empty()) {
    print_catalogue();
    return 0;
  }
  const std::vector<std::string_view> names = reproduction_names();
  if (std::find(names.begin(), names.end(), options.word) == names.end())
    throw std::runtime_error(fmt::format("'{}' is not a table or figure to reproduce{}", options.word,
                                         sim::suggestion(options.word, names)));
  if (options.quick && options.full) throw std::runtime_error("--quick and --full exclude each other");
  const std::filesystem::path folder = options.output.empty() ? "reproduce" : options.output;
  Options here = options;
  here.output = folder;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("cannot make folder '{}': {}", folder.string(), error.message()));
  ResultFiles results({}, options.force);
  const sim::FileWriter write = results.writer_inside();
  const auto asked = [&](const Reproduction& item) { return options.word == "all" || options.word == item.name; };
  for (const Reproduction& item : reproductions)  // before hours of work
    if (asked(item))
      for (const char* extension : {".md", ".csv", ".png", ".svg", ".pdf"})
        results.require_inside(folder / (std::string(item.name) + extension));
  for (const Reproduction& item : reproductions) {
    if (!asked(item)) continue;
    const std::string name(item.name);
    Progress progress(name, options.quiet);
    try {
      const Report report = item.function({options.quick, options.full, here, results, progress});
      progress.clear();
      const std::string command = fmt::format("tanktread reproduce {}{}{}", name, options.quick ? " --quick" : "",
                                              options.full ? " --full" : "");
      const std::vector<std::filesystem::path> files = write_report(report, folder, name, command, write);
      results.settle();
      if (options.quiet) continue;
      fmt::print("{}\n", plain_text(report));
      for (const std::filesystem::path& file : files) fmt::print("{}\n", file.string());
      fmt::print("\n");
    } catch (const Interrupted& end) {
      progress.clear();
      results.settle();
      tell(fmt::format("interrupted in {}; none of its tables and figures is written{}", name,
                       end.simulated.empty()
                           ? ""
                           : fmt::format(", the simulation is in '{}' as far as it went", end.simulated.string())));
      return interrupted_status;
    }
  }
  return 0;
}

}  // namespace app
