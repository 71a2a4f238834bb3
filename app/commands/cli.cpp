#include "app/commands/cli.h"

#include "app/base/interrupt.h"
#include "app/base/message.h"
#include "app/base/share.h"
#include "app/base/version.h"
#include "app/commands/commands.h"
#include "app/commands/manual.h"

#include "render/gl/context.h"
#include "render/image/difference.h"
#include "sim/core/catalogue.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cerrno>
#include <charconv>
#include <clocale>
#include <cstdio>
#include <system_error>

namespace app {

namespace {

/// One option of any command: how it is written and what it means.
struct OptionRow {
  std::string_view name;
  void (*add)(CLI::App&, Options&);
};

/// Is the whole word one number?
template <class Number>
bool read_number(std::string_view word, Number& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

/// "A/B" or "AxB", whole numbers.
bool read_two(std::string_view text, char between, int& first, int& second) {
  const std::size_t at = text.find(between);
  return at != std::string_view::npos && read_number(text.substr(0, at), first) &&
         read_number(text.substr(at + 1), second);
}

void parse_shard(Options& options, const std::string& text) {
  if (text == "auto") {
    try {
      const Share share = share_of_environment();
      options.shard = share.index;
      options.shards = share.count;
    } catch (const std::runtime_error& error) {
      throw CLI::ValidationError("--shard", error.what());
    }
    return;
  }
  if (read_two(text, '/', options.shard, options.shards) && 0 <= options.shard && options.shard < options.shards)
    return;
  throw CLI::ValidationError("--shard", fmt::format("'{}' is not i/n with 0 <= i < n", text));
}

void parse_size(Options& options, const std::string& text) {
  int width = 0, height = 0;
  if (!read_two(text, 'x', width, height))
    throw CLI::ValidationError("--size", fmt::format("'{}' is not WIDTHxHEIGHT, such as 1920x1080", text));
  options.set.push_back(fmt::format("view.size=[{}, {}]", width, height));
}

/// A threshold of `compare`.
void parse_limit(Options& options, const char* name, const std::string& text) {
  double value = 0;
  if (!read_number(text, value))
    throw CLI::ValidationError(std::string("--") + name, fmt::format("'{}' is not a number", text));
  try {
    render::check_limit(name, value);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError(std::string("--") + name, error.what());
  }
  options.limits.emplace_back(name, value);
}

/// "180mm", "180x120mm", "1200x800px".
void parse_figure_size(Options& options, const std::string& text) {
  const std::string unit = text.size() > 2 ? text.substr(text.size() - 2) : "";
  const std::string numbers = text.substr(0, text.size() - unit.size());
  const std::size_t cross = numbers.find('x');
  double width = 0, height = 0;
  const auto read = [](std::string_view word, double& value) { return read_number(word, value) && value > 0; };
  const bool known = unit == "mm" || unit == "px";
  if (!known || !read(std::string_view(numbers).substr(0, cross), width) ||
      (cross != std::string::npos && !read(std::string_view(numbers).substr(cross + 1), height)))
    throw CLI::ValidationError(
        "--size", fmt::format("'{}' is no size of a figure, such as 180mm, 180x120mm or 1200x800px", text));
  options.set.push_back(cross == std::string::npos ? fmt::format("figure.size=[{}]", width)
                                                   : fmt::format("figure.size=[{}, {}]", width, height));
  options.set.push_back("figure.unit=" + unit);
}

constexpr OptionRow option_rows[] = {
    {"to-folder",
     [](CLI::App& app, Options& o) {
       app.add_option("-o,--output", o.output, "the folder of the results (default: out/ and the scene's name)");
     }},
    {"to-trajectory",
     [](CLI::App& app, Options& o) {
       app.add_option("-o,--output", o.output, "the trajectory (default: the scene's name, with .h5)");
     }},
    {"to-pictures",
     [](CLI::App& app, Options& o) {
       app.add_option("-o,--output", o.output,
                      "the folder of frames and movie, or the PNG file of --time (default: beside the trajectory)");
     }},
    {"to-figure",
     [](CLI::App& app, Options& o) {
       app.add_option("-o,--output", o.output,
                      "the files, without .png, .svg, .pdf, .csv (default: NAME beside the trajectory)");
     }},
    {"to-report",
     [](CLI::App& app, Options& o) {
       app.add_option("-o,--output", o.output, "the folder of the results (default: reproduce)");
     }},
    {"to-study",
     [](CLI::App& app, Options& o) {
       app.add_option("-o,--output", o.output, "the folder of the results (default: converge/ and the scene's name)");
     }},
    {"to-page",
     [](CLI::App& app, Options& o) {
       app.add_option("-o,--output", o.output,
                      "the page, NAME.md, whose other sections stay, or its folder (default: validate)");
     }},
    {"run-threads",
     [](CLI::App& app, Options& o) {
       app.add_option("-j,--jobs", o.jobs, "threads of each run (default: 1)")->check(CLI::Range(1, 1024));
     }},
    {"to-sweep",
     [](CLI::App& app, Options& o) {
       app.add_option("-o,--output", o.output, "the folder of the results (default: sweep/ and the scene's name)");
     }},
    {"runs",
     [](CLI::App& app, Options& o) {
       app.add_option("-j,--jobs", o.jobs, "runs at a time, each in one thread (default: one, in all threads)")
           ->check(CLI::Range(1, 1024));
     }},
    {"axes",
     [](CLI::App& app, Options& o) {
       app.add_option(
              "--vary", o.axes,
              "a key and its values: A,B,... or ranges FIRST:LAST:STEP, FIRST:LAST:*FACTOR (any number of times)")
           ->required()
           ->allow_extra_args(false)
           ->type_name("KEY=VALUES");
     }},
    {"threads",
     [](CLI::App& app, Options& o) {
       app.add_option("-j,--jobs", o.jobs, "threads (default: numerics.threads of the scene)")
           ->check(CLI::Range(1, 1024));
     }},
    {"processes",
     [](CLI::App& app, Options& o) {
       app.add_option("-j,--jobs", o.jobs, "processes that draw the frames (default: 1); with --time, threads")
           ->check(CLI::Range(1, 1024));
     }},
    {"set",
     [](CLI::App& app, Options& o) {
       app.add_option("--set", o.set, "change a key of the scene: --set time.end=5 (any number of times)")
           ->allow_extra_args(false)
           ->type_name("KEY=VALUE");
     }},
    {"set-pictures",
     [](CLI::App& app, Options& o) {
       app.add_option(
              "--set", o.set,
              "change a key of view, key_frame, movie or figure: --set view.style=outline (any number of times)")
           ->allow_extra_args(false)
           ->type_name("KEY=VALUE");
     }},
    {"variation",
     [](CLI::App& app, Options& o) {
       app.add_option("--vary", o.vary, "tolerance, step or order (default: what the scene's steps follow)")
           ->type_name("NAME");
       app.add_option("--values", o.values, "of it, two at least (default: three, one of them the scene's own)")
           ->type_name("A,B,C");
     }},
    {"results",
     [](CLI::App& app, Options& o) {
       app.add_option("--quantities", o.quantities,
                      "what is compared: quantities, columns of export --csv and results, of one vesicle as "
                      "vesicle.0.NAME, reduced as NAME:largest (see tanktread list)")
           ->type_name("A,B,...");
     }},
    {"steps",
     [](CLI::App& app, Options& o) {
       app.add_option("--steps", o.steps, "stop after so many steps; 0: the initial state only")
           ->check(CLI::Range(std::int64_t{0}, std::int64_t{1'000'000'000}));
     }},
    {"dry-run",
     [](CLI::App& app, Options& o) { app.add_flag("--dry-run", o.dry_run, "print the resolved scene, do nothing"); }},
    {"quiet", [](CLI::App& app, Options& o) { app.add_flag("-q,--quiet", o.quiet, "say nothing but errors"); }},
    {"resume",
     [](CLI::App& app, Options& o) {
       app.add_flag("--resume", o.resume, "continue the trajectory that is there, also to a later time.end");
     }},
    {"force-folder",
     [](CLI::App& app, Options& o) {
       app.add_flag("--force", o.force, "give up results of another scene that this program left in the folder");
     }},
    {"force-study",
     [](CLI::App& app, Options& o) {
       app.add_flag("--force", o.force, "replace trajectories of another scene and files that are there");
     }},
    {"force-file",
     [](CLI::App& app, Options& o) {
       app.add_flag("--force", o.force, "replace a file that is there, also somebody else's");
     }},
    {"force-trajectory",
     [](CLI::App& app, Options& o) { app.add_flag("--force", o.force, "replace a trajectory that is there"); }},
    {"gl",
     [](CLI::App& app, Options& o) {
       app.add_option("--gl", o.gl, "OpenGL by auto, osmesa, egl, egl:N or software")->capture_default_str();
     }},
    {"shader-dir",
     [](CLI::App& app, Options& o) {
       app.add_option("--shader-dir", o.shader_dir, "take shaders from this folder")->check(CLI::ExistingDirectory);
     }},
    {"shard",
     [](CLI::App& app, Options& o) {
       app.add_option_function<std::string>(
              "--shard", [&o](const std::string& text) { parse_shard(o, text); },
              "i/n: only every n-th piece of the work, from number i on; auto: as the rank of MPI or the task of a "
              "Slurm "
              "array tells")
           ->type_name("I/N");
     }},
    {"style",
     [](CLI::App& app, Options& o) {
       app.add_option_function<std::string>(
              "--style", [&o](const std::string& s) { o.set.push_back("view.style=" + s); },
              "short for --set view.style=NAME")
           ->type_name("NAME");
     }},
    {"size",
     [](CLI::App& app, Options& o) {
       app.add_option_function<std::string>(
              "--size", [&o](const std::string& text) { parse_size(o, text); }, "short for --set view.size=[W, H]")
           ->type_name("WxH");
     }},
    {"format",
     [](CLI::App& app, Options& o) {
       app.add_option_function<std::string>(
              "--format", [&o](const std::string& s) { o.set.push_back("movie.format=" + s); },
              "short for --set movie.format=NAME")
           ->type_name("NAME");
     }},
    {"time",
     [](CLI::App& app, Options& o) {
       app.add_option("--time", o.time, "one still of this time instead of a movie; -o names the PNG file");
     }},
    {"state-time",
     [](CLI::App& app, Options& o) { app.add_option("--time", o.time, "only the saved state nearest to this time"); }},
    {"figure-size",
     [](CLI::App& app, Options& o) {
       app.add_option_function<std::string>(
              "--size", [&o](const std::string& text) { parse_figure_size(o, text); },
              "of the page: 180mm, 180x120mm or 1200x800px")
           ->type_name("SIZE");
     }},
    {"theme",
     [](CLI::App& app, Options& o) {
       app.add_option_function<std::string>(
              "--theme", [&o](const std::string& s) { o.set.push_back("figure.theme=" + s); },
              "short for --set figure.theme=NAME: paper, slides, ...")
           ->type_name("NAME");
     }},
    {"font-size",
     [](CLI::App& app, Options& o) {
       app.add_option_function<double>(
              "--font-size", [&o](double s) { o.set.push_back(fmt::format("figure.font_size={}", s)); },
              "of numbers and legends, points")
           ->type_name("PT");
     }},
    {"font",
     [](CLI::App& app, Options& o) {
       app.add_option_function<std::string>(
              "--font", [&o](const std::string& s) { o.set.push_back("figure.font=" + s); }, "sans or serif")
           ->type_name("NAME");
     }},
    {"text",
     [](CLI::App& app, Options& o) {
       app.add_option_function<std::string>(
              "--text", [&o](const std::string& s) { o.set.push_back("figure.text=" + s); },
              "of PDF and SVG: text, which can be searched and edited, or paths, its outlines")
           ->type_name("AS");
     }},
    {"export",
     [](CLI::App& app, Options& o) {
       app.add_option("--csv", o.csv, "write a row per saved state and vesicle; - is standard output")
           ->type_name("FILE");
       app.add_option("--motion", o.motion,
                      "write a row per vesicle: its motion in shear, the period, means over it; - is standard output")
           ->type_name("FILE");
       app.add_option("--suspension", o.suspension,
                      "write a row per saved state: all vesicles together, their stress in a periodic cell; - is "
                      "standard output")
           ->type_name("FILE");
       app.add_option("--pairs", o.pairs,
                      "write how many pairs of vesicles a periodic cell holds at each distance, over those at random; "
                      "- is standard output")
           ->type_name("FILE");
       app.add_option("--html", o.html, "write a page that shows the trajectory in a browser, to turn and to play")
           ->type_name("FILE");
       app.add_option("--vtk", o.vtk, "write XML PolyData and a .pvd series")->type_name("DIR");
       app.add_option("--ply", o.ply, "write a PLY mesh per saved state and vesicle")->type_name("DIR");
       app.add_option("--latitudes", o.latitudes, "of the meshes; twice as many longitudes")
           ->check(CLI::Range(4, 512))
           ->capture_default_str();
     }},
    {"quick", [](CLI::App& app,
                 Options& o) { app.add_flag("--quick", o.quick, "low orders and short times: does it run at all"); }},
    {"full", [](CLI::App& app, Options& o) { app.add_flag("--full", o.full, "also the orders that take hours"); }},
    {"thresholds",
     [](CLI::App& app, Options& o) {
       app.add_option("--preset", o.preset, "exact, default or perceptual; the options below change its thresholds")
           ->capture_default_str();
       const render::CompareRule rule;
       render::visit(rule, [&](const char* name, const char* meaning, const double&) {
         app.add_option_function<std::string>(
                std::string("--") + name, [&o, name](const std::string& text) { parse_limit(o, name, text); }, meaning)
             ->type_name("NUMBER");
       });
     }},
    {"ignore",
     [](CLI::App& app, Options& o) {
       app.add_option("--mask", o.mask, "a picture of the same size: what is white in it does not count")
           ->check(CLI::ExistingFile);
       app.add_option("--ignore", o.ignore, "a rectangle that does not count (any number of times)")
           ->allow_extra_args(false)
           ->type_name("X,Y,WxH");
     }},
    {"json",
     [](CLI::App& app, Options& o) { app.add_flag("--json", o.json, "print one JSON document instead of lines"); }},
    {"junit",
     [](CLI::App& app, Options& o) { app.add_option("--junit", o.junit, "write JUnit XML")->type_name("FILE"); }},
    {"html",
     [](CLI::App& app, Options& o) {
       app.add_option("--html", o.html, "write a page to look at the differences")->type_name("DIR");
     }},
    {"diff", [](CLI::App& app,
                Options& o) { app.add_option("--diff", o.diff, "write difference pictures, x 16")->type_name("DIR"); }},
    {"update",
     [](CLI::App& app, Options& o) {
       app.add_flag("--update", o.update, "accept: put what differs or is new in the place of the expected");
     }},
    {"markdown",
     [](CLI::App& app, Options& o) { app.add_flag("--markdown", o.markdown, "with parameters: docs/reference.md"); }},
};

bool takes(const Command& command, std::string_view option) {
  return fmt::format(" {} ", command.options).find(fmt::format(" {} ", option)) != std::string::npos;
}

void add_command(CLI::App& program, const Command& command, Options& options) {
  CLI::App* sub = program.add_subcommand(std::string(command.name), std::string(command.meaning));
  if (!command.word.empty()) {
    CLI::Option* word = command.many_words ? sub->add_option(std::string(command.word), options.words)
                                           : sub->add_option(std::string(command.word), options.word);
    if (!command.files.empty()) word->required();
  }
  if (!command.files.empty()) {
    CLI::Option* files = sub->add_option(std::string(command.files), options.inputs)->required();
    if (!command.many_files) files->expected(1);
  }
  for (const OptionRow& row : option_rows)
    if (takes(command, row.name)) row.add(*sub, options);
}

/// What a command line offers, for the manual page and for completion.
ManualCommand described(const CLI::App& app, std::string name) {
  ManualCommand command{std::move(name), app.get_description(), {}};
  for (const CLI::Option* option : app.get_options()) {
    ManualEntry entry;
    entry.is_option = !option->get_positional();
    entry.names = entry.is_option          ? option->get_name(false, true)
                  : option->get_required() ? option->get_name(true)
                                           : "[" + option->get_name(true) + "]";
    const std::string value = option->get_items_expected_max() > 0 ? option->get_type_name() : "";
    entry.value = value.substr(0, value.find_first_of(": "));  // without the range that is checked
    entry.meaning = option->get_description();
    entry.many = option->get_items_expected_max() > 1;
    command.entries.push_back(std::move(entry));
  }
  return command;
}

std::vector<ManualCommand> described(const CLI::App& program) {
  std::vector<ManualCommand> all{described(program, "")};
  for (const Command& row : commands) {
    const std::string name(row.name);
    all.push_back(described(*program.get_subcommand(name), name));
  }
  return all;
}

/// A page that is printed instead of doing anything, as --help is.
void add_page(CLI::App& program, const char* name, const char* meaning,
              std::string (*page)(const std::vector<ManualCommand>&)) {
  program
      .add_flag_callback(
          name,
          [&program, page] {
            fmt::print("{}", page(described(program)));
            throw CLI::Success();
          },
          meaning)
      ->trigger_on_parse();  // before a command is found missing
}

/// A first word that is no command gets a suggestion, which CLI11 does not give.
void check_command_word(int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string_view> names;
  for (const Command& command : commands) names.push_back(command.name);
  if (std::find(names.begin(), names.end(), argv[1]) == names.end())
    throw std::runtime_error(fmt::format("'{}' is not a command{}", argv[1], sim::suggestion(argv[1], names)));
}

/// Where a standard stream is closed, the next file opened would take its number, and with it what is meant for the
/// stream.
void occupy_standard_streams() {
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd)
    if (::fcntl(fd, F_GETFD) < 0 && ::open("/dev/null", O_RDONLY) != fd) return;  // writing there stays an error
}

/// A full disk behind stdout is an error like any other.
void require_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot write to standard output");
}

}  // namespace

int main(int argc, char** argv) {
  occupy_standard_streams();
  std::setlocale(LC_ALL, "C");  // whatever a library has set: a decimal comma would end every number
  try {
    check_command_word(argc, argv);
    Options options;
    CLI::App program("Tanktread simulates lipid vesicles in Stokes flow and makes movies and figures.", "tanktread");
    program.set_version_flag("--version", "tanktread " + version() + " (" + build() + ")");
    add_page(program, "--manual", "print the manual page, for man(1)", manual_page);
    add_page(program, "--bash-completion", "print the completion for bash", bash_completion);
    program.require_subcommand(1);
    for (const Command& command : commands) add_command(program, command, options);
    try {
      program.parse(argc, argv);
    } catch (const CLI::Success& success) {
      const int status = program.exit(success);
      require_output();
      return status;
    } catch (const CLI::ParseError& error) {
      tell(error.what());
      return 2;
    }
    render::parse_gl_choice(options.gl);
    watch_signals();
    for (const Command& command : commands)
      if (program.got_subcommand(std::string(command.name))) {
        options.command = command.name;
        const int status = command.function(options);
        require_output();
        return status;
      }
    return 2;
  } catch (const Interrupted&) {
    tell("interrupted");
    return interrupted_status;
  } catch (const std::bad_alloc&) {
    tell("there is not enough memory");
  } catch (const std::system_error& error) {
    // The reader of a pipe has seen enough, as `head` does: nothing to complain of.
    if (error.code() == std::errc::broken_pipe) return 0;
    if (error.code() == std::errc::interrupted) {
      tell("interrupted");
      return interrupted_status;
    }
    tell(error.what());
  } catch (const std::exception& error) {
    tell(error.what());
  }
  return 1;
}

}  // namespace app
