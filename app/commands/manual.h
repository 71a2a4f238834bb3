// The manual page and the shell completion, generated from the tables of commands, options, parameters and kinds.
#pragma once

#include <string>
#include <vector>

namespace app {

/// One option or one word of a command, as the command line declares it.
struct ManualEntry {
  std::string names;    ///< "-o,--output"; "SCENE" for a positional argument, "[KIND]" for an optional one
  std::string value;    ///< name of its value: "FILE"; empty: a flag, or a positional argument
  std::string meaning;  ///< no full stop
  bool is_option = true;
  bool many = false;  ///< may be repeated
};

struct ManualCommand {
  std::string name, meaning;  ///< empty name: options of the program itself
  std::vector<ManualEntry> entries;
};

/// tanktread.1 in man(7) format.
std::string manual_page(const std::vector<ManualCommand>& offered);
/// Commands, options and the words of the catalogues, for bash.
std::string bash_completion(const std::vector<ManualCommand>& offered);

}  // namespace app
