// Time as the benchmarks take it: of the clock on the wall, and of this thread's share of a processor.
//
// On a machine that does other things as well the second is the one that says something about the code.
#pragma once

#include <ctime>
#include <utility>

namespace hulltrack::bench {

struct Milliseconds {
  double cpu = 0.0;
  double wall = 0.0;

  Milliseconds& operator+=(const Milliseconds& other) {
    cpu += other.cpu;
    wall += other.wall;
    return *this;
  }
};

/// Time since the last lap.
class Stopwatch {
 public:
  Milliseconds lap() {
    const Milliseconds last = std::exchange(last_, now());
    return {last_.cpu - last.cpu, last_.wall - last.wall};
  }

 private:
  static double read(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  }
  static Milliseconds now() { return {read(CLOCK_THREAD_CPUTIME_ID), read(CLOCK_MONOTONIC)}; }

  Milliseconds last_ = now();
};

}  // namespace hulltrack::bench
