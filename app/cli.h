// The command line: words become Options, and the command they name is called.
#pragma once

namespace app {

/// The exit status of the program.
int main(int argc, char** argv);

}  // namespace app
