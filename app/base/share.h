// Which share of the work is this process's, where somebody else has started several of it.
#pragma once

namespace app {

struct Share {
  int index = 0, count = 1;  ///< 0 <= index < count
};
/// From the task of a Slurm array and the rank of MPI (Open MPI, MPICH and its kin, srun), both where there are both.
/// Throws std::runtime_error where there is neither, and where the numbers of an array are not evenly spaced.
Share share_of_environment();

}  // namespace app
