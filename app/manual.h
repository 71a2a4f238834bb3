// The manual page and the completion of the shell, generated from the tables of commands, options, parameters and kinds.
#pragma once

#include <string>
#include <vector>

namespace app {

/// One option or one word of a command, as the command line declares it.
struct ManualEntry {
  std::string names;    ///< "-o,--output"; "SCENE" of a word, "[KIND]" of one that may be left out
  std::string value;    ///< what follows: "FILE"; empty: nothing does, or it is a word
  std::string meaning;  ///< no full stop
  bool is_option = true;
  bool many = false;    ///< may be given again
};

struct ManualCommand {
  std::string name, meaning;  ///< no name: options of the program itself
  std::vector<ManualEntry> entries;
};

/// tanktread.1 in the language of man(7).
std::string manual_page(const std::vector<ManualCommand>& offered);
/// Commands, options and the words of the catalogues, for bash.
std::string bash_completion(const std::vector<ManualCommand>& offered);

}  // namespace app
