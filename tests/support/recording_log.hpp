// A log sink that keeps its lines, for tests of what the log says. Any thread may write.
#pragma once

#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "daemon/log/log.hpp"

namespace hulltrack {

class RecordingLog final : public LogSink {
 public:
  struct Line {
    LogLevel level;
    std::string text;
  };

  void write(LogLevel level, std::string_view line) override {
    const std::lock_guard lock(mutex_);
    if (std::exchange(fail_next_, false)) {
      throw std::runtime_error("the log failed");
    }
    lines.push_back({level, std::string(line)});
  }

  /// The next line throws: an exception in the middle of whoever logs.
  void fail_next() {
    const std::lock_guard lock(mutex_);
    fail_next_ = true;
  }

  /// The newest line, or "".
  [[nodiscard]] std::string last() const {
    const std::lock_guard lock(mutex_);
    return lines.empty() ? "" : lines.back().text;
  }

  /// How many lines contain `part`.
  [[nodiscard]] std::size_t count(const std::string& part) const {
    const std::lock_guard lock(mutex_);
    std::size_t found = 0;
    for (const Line& line : lines) {
      found += line.text.find(part) != std::string::npos ? 1 : 0;
    }
    return found;
  }

  std::vector<Line> lines;  // read it while nobody writes

 private:
  mutable std::mutex mutex_;
  bool fail_next_ = false;
};

}  // namespace hulltrack
