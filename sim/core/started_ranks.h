// The other processes that mpirun has started. mpi_ranks.cpp is compiled where MPI is asked for, single_rank.cpp
// elsewhere.
#pragma once

#include "sim/core/ranks.h"

namespace sim {

/// How many processes the environment says that mpirun, or srun with one of the interfaces of MPI, has started; 1: none
/// of them has started this one.
int announced_ranks();

/// This process among them; MPI is only set up where there are several. The program talks to the others until the last
/// copy of the value is gone. Throws std::runtime_error where they cannot work together.
Ranks started_ranks();

}  // namespace sim
