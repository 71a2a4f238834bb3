// The command line: parses the arguments into Options and calls the command.
#pragma once

namespace app {

/// The exit status of the program.
int main(int argc, char** argv);

}  // namespace app
