// A progress line on a terminal; nothing in a pipe.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace app {

class Progress {
 public:
  /// `what`: "simulating", "rendering". Silent when quiet or when standard error is not a terminal.
  Progress(std::string what, bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// share: fraction done, 0..1; `detail`: "step 12, t = 1.2". Time left is estimated from this process's own work.
  void show(double share, std::string_view detail);
  /// Clears the line, so that something else can be printed.
  void clear();

 private:
  std::string what_;
  bool visible_;
  bool drawn_ = false;
  double first_share_ = -1;
  std::chrono::steady_clock::time_point start_, last_;
};

/// "4 s", "2:05", "1:02:05".
std::string duration_text(double seconds);

}  // namespace app
