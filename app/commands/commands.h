// The commands, one row each: what the command line offers, what runs, what `tanktread --help` and the README say.
#pragma once

#include "app/base/options.h"

#include <string_view>

namespace app {

/// Each returns the exit status: 0, 1 after a failure that was reported, 130 after Ctrl-C. Other errors are exceptions.
using CommandFunction = int (*)(const Options&);

int run(const Options&);
int simulate(const Options&);
int render(const Options&);
int figure(const Options&);
int info(const Options&);
int export_states(const Options&);
int compare(const Options&);  ///< 0 same, 1 different, 2 could not compare
int list(const Options&);
int reproduce(const Options&);
int converge(const Options&);
int validate(const Options&);  ///< 1 when a value misses its reference
int sweep(const Options&);

std::vector<std::string_view> reproduction_names();  ///< the items of `reproduce`
std::vector<std::string_view> validation_names();    ///< ... of `validate`

struct Command {
  std::string_view name, meaning;
  std::string_view word;   ///< name of the first positional argument; empty: only files
  std::string_view files;  ///< name of the files; empty: none
  bool many_files;
  std::string_view options;  ///< the options it takes, separated by spaces
  CommandFunction function;
  bool many_words = false;  ///< any number of that argument, in Options::words
};

inline constexpr Command commands[] = {
    {"run", "simulate a scene, then draw its frames, movie and figures into one folder", "", "SCENE", false,
     "to-folder threads set steps dry-run quiet gl shader-dir force-folder", run},
    {"simulate", "the simulation alone: writes a trajectory, or continues one with --resume", "", "SCENE", false,
     "to-trajectory threads set steps dry-run quiet resume force-trajectory", simulate},
    {"converge", "a scene at several tolerances, steps or orders: observed orders, limits and errors of its results",
     "", "SCENE", false,
     "to-study threads set variation results dry-run quiet figure-size theme font-size font text force-study",
     converge},
    {"sweep", "a scene with all combinations of the values of some keys: a folder each, one table, the phase diagram",
     "", "SCENE", false,
     "to-sweep runs set axes results shard dry-run quiet figure-size theme font-size font text force-study", sweep},
    {"render", "the pictures alone: draws a trajectory again with another view or style; several side by side", "",
     "TRAJECTORY", true,
     "to-pictures processes set-pictures quiet gl shader-dir shard style size format time force-file", render},
    {"figure", "a figure as PNG, SVG and PDF, with its numbers as CSV", "NAME", "TRAJECTORY", true,
     "to-figure set-pictures quiet gl shader-dir figure-size theme font-size font text force-file", figure},
    {"info", "what a trajectory, a scene or a frame holds", "", "FILE", false, "set", info},
    {"export",
     "saved states for other programs: a table of measures, a page for browsers, meshes for ParaView (VTK) and Blender "
     "(PLY)",
     "", "TRAJECTORY", false, "export state-time set-pictures quiet force-file", export_states},
    {"compare", "pictures against expected ones, a pair of files or of folders: status 0 same, 1 different, 2 neither",
     "EXPECTED", "ACTUAL", false, "thresholds ignore json junit html diff update quiet", compare},
    {"reproduce", "recomputes a table or figure of the method's paper; without ITEM, tells which", "ITEM", "", false,
     "to-report quiet gl quick full force-file", reproduce},
    {"validate",
     "long runs against what is known, written into a page with tables and figures; without NAME, tells which", "NAME",
     "", false, "to-page run-threads quiet force-file", validate, true},
    {"list", "the catalogues: flows, shapes, schemes, cameras, styles, figures, themes, quantities, parameters", "KIND",
     "", false, "markdown", list},
};

}  // namespace app
