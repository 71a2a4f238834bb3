#include "sim/core/started_ranks.h"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <limits>

namespace sim {

namespace {

/// MPI counts in int: long messages go in pieces.
constexpr std::size_t most_at_once = std::size_t(1) << 27;  // 1 GB of a rank

std::vector<std::vector<double>> gathered_by_mpi(std::span<const double> mine) {
  int count = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  std::vector<long long> sizes(static_cast<std::size_t>(count));
  const auto size = static_cast<long long>(mine.size());
  MPI_Allgather(&size, 1, MPI_LONG_LONG, sizes.data(), 1, MPI_LONG_LONG, MPI_COMM_WORLD);
  std::vector<std::vector<double>> all;
  for (const long long n : sizes) all.emplace_back(static_cast<std::size_t>(n));
  const auto longest = static_cast<std::size_t>(*std::max_element(sizes.begin(), sizes.end()));
  const std::size_t piece = most_at_once / static_cast<std::size_t>(count);
  for (std::size_t first = 0; first < longest; first += piece) {
    std::vector<int> lengths, places;
    int total = 0;
    for (const auto& one : all) {
      lengths.push_back(static_cast<int>(first < one.size() ? std::min(piece, one.size() - first) : 0));
      places.push_back(total);
      total += lengths.back();
    }
    std::vector<double> together(static_cast<std::size_t>(total));
    const std::size_t start = std::min(first, mine.size());
    MPI_Allgatherv(mine.data() + start, static_cast<int>(std::min(piece, mine.size() - start)), MPI_DOUBLE,
                   together.data(), lengths.data(), places.data(), MPI_DOUBLE, MPI_COMM_WORLD);
    for (std::size_t r = 0; r < all.size(); ++r)
      std::copy_n(together.begin() + places[r], lengths[r],
                  all[r].begin() + std::ptrdiff_t(std::min(first, all[r].size())));
  }
  return all;
}

std::vector<std::vector<double>> exchanged_by_mpi(std::span<const std::vector<double>> given) {
  const auto count = static_cast<int>(given.size());
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::vector<long long> sizes, theirs(given.size());
  for (const auto& one : given) sizes.push_back(static_cast<long long>(one.size()));
  MPI_Alltoall(sizes.data(), 1, MPI_LONG_LONG, theirs.data(), 1, MPI_LONG_LONG, MPI_COMM_WORLD);
  std::vector<std::vector<double>> got;
  for (const long long n : theirs) got.emplace_back(static_cast<std::size_t>(n));
  std::vector<MPI_Request> requests;
  const auto in_pieces = [](std::size_t size, auto&& transfer) {
    for (std::size_t first = 0; first < size; first += most_at_once)
      transfer(first, static_cast<int>(std::min(most_at_once, size - first)));
  };
  constexpr int tag = 1;
  for (int r = 0; r < count; ++r) {
    auto& one = got[static_cast<std::size_t>(r)];
    if (r == rank) {
      one = given[static_cast<std::size_t>(r)];
      continue;
    }
    in_pieces(one.size(), [&](std::size_t first, int size) {
      MPI_Irecv(one.data() + first, size, MPI_DOUBLE, r, tag, MPI_COMM_WORLD, &requests.emplace_back());
    });
  }
  for (int r = 0; r < count; ++r) {
    const auto& one = given[static_cast<std::size_t>(r)];
    if (r == rank) continue;
    in_pieces(one.size(), [&](std::size_t first, int size) {
      MPI_Isend(one.data() + first, size, MPI_DOUBLE, r, tag, MPI_COMM_WORLD, &requests.emplace_back());
    });
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  return got;
}

}  // namespace

Ranks started_ranks() {
  const int announced = announced_ranks();
  if (announced == 1) return {};
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  Ranks ranks;
  ranks.session = std::shared_ptr<void>(nullptr, [](void*) { MPI_Finalize(); });
  MPI_Comm_size(MPI_COMM_WORLD, &ranks.count);
  MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank);
  if (ranks.count == 1)
    throw std::runtime_error(
        fmt::format("{} processes were started, but they do not find each other; start them with "
                    "the mpirun of the MPI that the program was built with",
                    announced));
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &ranks.neighbours);
  MPI_Comm_free(&machine);
  ranks.gathered = gathered_by_mpi;
  ranks.exchanged = exchanged_by_mpi;
  ranks.end_all = [](int status) { MPI_Abort(MPI_COMM_WORLD, status); };
  return ranks;
}

}  // namespace sim
