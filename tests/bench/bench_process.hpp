// What every benchmark says of its own run: that it is void, and how much memory it took.
#pragma once

#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>

namespace hulltrack::bench {

/// Ends the run unless `holds`: figures of something that went wrong are worth nothing.
inline void require(bool holds, const char* what) {
  if (!holds) {
    std::fprintf(stderr, "benchmark void: %s\n", what);
    std::exit(EXIT_FAILURE);
  }
}

/// The largest resident memory of the process so far, MB.
inline double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace hulltrack::bench
