#include "sim/core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <optional>

namespace sim {

namespace {

thread_local bool in_loop = false;

/// Of a thread while it works on a piece of a loop.
struct InLoop {
  bool before = std::exchange(in_loop, true);
  InLoop() = default;
  InLoop(const InLoop&) = delete;
  InLoop& operator=(const InLoop&) = delete;
  ~InLoop() { in_loop = before; }
};

}  // namespace

void with_threads(int most, const std::function<void()>& f) {
  tbb::task_arena arena(most > 0 ? most : tbb::task_arena::automatic);
  std::optional<tbb::global_control> more;  // than there are processors
  if (most > tbb::this_task_arena::max_concurrency())
    more.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(most));
  arena.execute(f);
}

int thread_count() { return in_loop ? 1 : tbb::this_task_arena::max_concurrency(); }

void in_pieces(int n, int grain, void (*call)(const void* body, int first, int end), const void* body) {
  if (thread_count() == 1) return call(body, 0, n);
  tbb::parallel_for(
      tbb::blocked_range<int>(0, n, std::size_t(grain)),
      [&](const tbb::blocked_range<int>& piece) {
        const InLoop here;
        call(body, piece.begin(), piece.end());
      },
      tbb::simple_partitioner());
}

}  // namespace sim
