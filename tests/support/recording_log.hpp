// A log sink that keeps its lines, for tests of what the log says.
#pragma once

#include <string>
#include <vector>

#include "core/base/log.hpp"

namespace hulltrack {

class RecordingLog final : public LogSink {
 public:
  struct Line {
    LogLevel level;
    std::string text;
  };

  void write(LogLevel level, std::string_view line) override { lines.push_back({level, std::string(line)}); }

  /// The newest line, or "".
  [[nodiscard]] std::string last() const { return lines.empty() ? "" : lines.back().text; }

  std::vector<Line> lines;
};

}  // namespace hulltrack
