// What is wrong with something a site wrote: a configuration line, a map, a calibration file.
//
// Readers collect every Problem they can find, so that a person repairs a file in one go.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace hulltrack {

struct Problem {
  std::string file;
  int line = 0;         // 1-based; 0 = the file as a whole
  std::string message;  // what is wrong; what is allowed or what to do
};

/// `FILE:LINE: message`, or `FILE: message` where no line is to blame.
[[nodiscard]] inline std::string to_string(const Problem& problem) {
  const std::string place =
      problem.line > 0 ? problem.file + ':' + std::to_string(problem.line) : problem.file;
  return place + ": " + problem.message;
}

/// The order in which a person mends them.
inline void sort_by_line(std::vector<Problem>& problems) {
  std::stable_sort(problems.begin(), problems.end(),
                   [](const Problem& a, const Problem& b) { return a.line < b.line; });
}

}  // namespace hulltrack
