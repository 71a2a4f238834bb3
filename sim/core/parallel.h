// Parallel loops over independent items. Neither the result nor the exception depends on the number of threads.
#pragma once

#include <exception>
#include <vector>

namespace sim {

/// Runs body(k) for k in [0, n); of several exceptions that of the smallest k is rethrown.
template <class Body>
void parallel_for(int n, Body&& body) {
  if (n == 1) {  // its own loops get the threads
    body(0);
    return;
  }
  std::vector<std::exception_ptr> errors(n);
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < n; ++k) try {
      body(k);
    } catch (...) {
      errors[k] = std::current_exception();
    }
  for (const auto& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace sim
