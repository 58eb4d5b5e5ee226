#include "daemon/service/restart_record.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>

namespace hulltrack {
namespace {

constexpr const char* kCountFile = "failures";
constexpr const char* kLastEndFile = "last-end";  // written by ExecStopPost= of the unit
constexpr int kWithoutPause = 3;
constexpr int kMost = 1'000'000;

/// The first line, as far as it is fit for a log; nothing if there is no file.
std::optional<std::string> first_line(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line(80, '\0');
  stream.read(line.data(), static_cast<std::streamsize>(line.size()));
  if (stream.gcount() == 0 && !stream.is_open()) {
    return std::nullopt;
  }
  line.resize(static_cast<std::size_t>(stream.gcount()));
  line.erase(std::find_if_not(line.begin(), line.end(), [](unsigned char c) { return std::isprint(c) != 0; }),
             line.end());
  return line;
}

}  // namespace

Nanoseconds restart_pause(int failures) {
  Nanoseconds pause{0};
  for (int i = kWithoutPause; i < failures && pause < kLongestPause; ++i) {
    pause = std::max(2 * pause, Nanoseconds(std::chrono::seconds(1)));
  }
  return std::min(pause, kLongestPause);
}

RestartRecord::Verdict RestartRecord::begin() {
  Verdict verdict;
  if (!folder_) {
    return verdict;
  }
  if (const auto kept = first_line(*folder_ / kCountFile)) {
    int before = 0;
    std::from_chars(kept->data(), kept->data() + kept->size(), before);
    verdict.failures = std::clamp(before, 0, kMost) + 1;
    verdict.pause = restart_pause(verdict.failures);
  }
  verdict.last_end = first_line(*folder_ / kLastEndFile).value_or("");
  keep(verdict.failures);
  return verdict;
}

void RestartRecord::forget() { keep(0); }

void RestartRecord::end() {
  if (folder_) {
    std::error_code ignored;
    std::filesystem::remove(*folder_ / kCountFile, ignored);
  }
}

void RestartRecord::keep(int failures) const {
  if (folder_) {
    std::ofstream(*folder_ / kCountFile, std::ios::trunc) << failures << '\n';
  }
}

}  // namespace hulltrack
