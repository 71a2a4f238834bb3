// FFTW's planner is the one thing in it that is not thread-safe: whoever makes or destroys a plan holds this.
#pragma once

#include <mutex>

namespace sim {

inline std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace sim
