// tanktread: lipid vesicles in Stokes flow, from a scene to a movie.
#include "cli.h"

int main(int argc, char** argv) { return app::main(argc, argv); }
