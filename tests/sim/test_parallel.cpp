#include "sim/core/parallel.h"
#include "tests/support/catch.h"

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

using namespace sim;

TEST_CASE("every item of a loop is done once, for any number of threads and of items") {
  for (const int threads : {1, 2, 5})
    with_threads(threads, [] {
      for (const int n : {0, 1, 2, 7, 1000}) {
        std::vector<int> done(std::size_t(n), 0);
        parallel_for(n, [&](int k) { ++done[std::size_t(k)]; });
        shared_for(n, 1e9, [&](int k) { ++done[std::size_t(k)]; });
        parallel_for_with(
            n, [] { return 1; }, [&](int one, int k) { done[std::size_t(k)] += one; });
        CHECK(done == std::vector<int>(std::size_t(n), 3));
      }
    });
}

TEST_CASE("loops have the threads that they are given, more than there are processors too, and one inside of a loop") {
  const int usual = thread_count();
  for (const int threads : {1, 3, 64})
    with_threads(threads, [&] {
      CHECK(thread_count() == threads);
      std::vector<int> inside(20);
      parallel_for(20, [&](int k) { inside[std::size_t(k)] = thread_count(); });
      CHECK(inside == std::vector<int>(20, 1));
      parallel_for(1, [&](int) { CHECK(thread_count() == threads); });
    });
  with_threads(0, [&] { CHECK(thread_count() == usual); });
  CHECK(thread_count() == usual);
}

TEST_CASE("of several exceptions in a loop that of the first item comes out, whatever else is done") {
  for (const int threads : {1, 4})
    with_threads(threads, [] {
      std::vector<int> done(100);
      const auto body = [&](int k) {
        ++done[std::size_t(k)];
        if (k % 10 == 3) throw std::runtime_error("item " + std::to_string(k));
      };
      CHECK_THROWS_WITH(parallel_for(100, body), "item 3");
      CHECK(done == std::vector<int>(100, 1));
    });
}

TEST_CASE("a loop makes no more scratch than it has threads, and none that nobody uses") {
  for (const int threads : {1, 3})
    with_threads(threads, [&] {
      std::atomic<int> made = 0;
      parallel_for_with(
          50, [&] { return ++made; }, [](int, int) {});
      CHECK(made >= 1);
      CHECK(made <= threads);
    });
}
