// Parallel loops over independent items. Neither the result nor the exception depends on the number of threads.
//
// The calling thread works on its own loop and waits for no thread that has not begun: where other programs keep the
// processors busy, a loop takes as long as without help. Loops inside of loops stay in their thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <type_traits>
#include <utility>

namespace sim {

/// f() with at most so many threads in its loops, the calling one included; of 0: one for each processor that this
/// process may use, which is also the number outside of such a call.
void with_threads(int most, const std::function<void()>& f);

/// Threads that a loop begun here would have; 1 inside of a loop.
int thread_count();

/// body(first, end) for pieces of [0, n) of at most `grain` items. The body throws nothing.
void in_pieces(int n, int grain, void (*call)(const void* body, int first, int end), const void* body);

/// body(k) for k in [0, n); of several exceptions that of the smallest k is rethrown.
template <class Body>
void parallel_for(int n, Body&& body) {
  if (n == 1) {  // its own loops get the threads
    body(0);
    return;
  }
  struct Loop {
    std::remove_reference_t<Body>& body;
    mutable std::mutex mutex;
    mutable int failed = std::numeric_limits<int>::max();
    mutable std::exception_ptr error;
  };
  const Loop loop{body, {}, std::numeric_limits<int>::max(), {}};
  const auto call = [](const void* of, int first, int end) {
    const auto& in = *static_cast<const Loop*>(of);
    for (int k = first; k < end; ++k) try {
        in.body(k);
      } catch (...) {
        const std::scoped_lock lock(in.mutex);
        if (k < in.failed) in.failed = k, in.error = std::current_exception();
      }
  };
  in_pieces(n, 1, call, &loop);
  if (loop.error) std::rethrow_exception(loop.error);
}

/// body(scratch, k) for k in [0, n), with one scratch = make() a thread.
template <class Make, class Body>
void parallel_for_with(int n, Make&& make, Body&& body) {
  std::atomic<int> next = 0;
  parallel_for(std::min(n, thread_count()), [&](int) {
    int k = next++;
    if (k >= n) return;
    auto scratch = make();
    for (; k < n; k = next++) body(scratch, k);
  });
}

/// body(k) for k in [0, n), for one of the small loops of which a time step has hundreds: shared among the threads in
/// pieces that are worth it. Nothing is thrown.
template <class Body>
void shared_for(int n, double multiplications, const Body& body) {
  constexpr double worthwhile = 2.5e4;  // some 4 us; to share costs one or two
  const double pieces = std::min(multiplications / worthwhile, 4.0 * n);
  const int threads = pieces < 2 ? 1 : thread_count();
  if (threads == 1) {
    for (int k = 0; k < n; ++k) body(k);
    return;
  }
  const int count = std::min(int(pieces), 2 * threads);
  const auto call = [](const void* of, int first, int end) {
    for (int k = first; k < end; ++k) (*static_cast<const Body*>(of))(k);
  };
  in_pieces(n, (n + count - 1) / count, call, &body);
}

}  // namespace sim
