// Independent items on all threads. The result does not depend on the number of threads, nor does the exception.
#pragma once

#include <exception>
#include <vector>

namespace sim {

/// Runs body(k) for k in [0, n); of several exceptions the one of the smallest k is thrown on.
template <class Body>
void parallel_for(int n, Body&& body) {
  std::vector<std::exception_ptr> errors(n);
#pragma omp parallel for schedule(dynamic) if (n > 1)
  for (int k = 0; k < n; ++k) try {
      body(k);
    } catch (...) {
      errors[k] = std::current_exception();
    }
  for (const auto& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace sim
