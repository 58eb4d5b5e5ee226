// Takes lines and words off the front of a file's bytes; for text headers and text bodies of clouds.
//
// Views into the bytes given; allocates nothing, reads nothing beyond them.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.hpp"

namespace hulltrack {

/// The bytes of a file still to be read.
class HeaderLines {
 public:
  explicit HeaderLines(std::string_view bytes) : rest_(bytes) {}

  /// The next line without its end (LF or CR LF); nothing at the end of the file.
  [[nodiscard]] std::optional<std::string_view> next() {
    if (rest_.empty()) {
      return std::nullopt;
    }
    const auto end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++count_;
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    return line;
  }
  void skip() { static_cast<void>(next()); }
  /// What follows the lines taken.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  /// Lines taken; 1-based number of the last one.
  [[nodiscard]] int count() const { return count_; }
  /// "line N: message" about the line taken last.
  [[nodiscard]] Error error(const std::string& message) const {
    return Error{"line " + std::to_string(count_) + ": " + message};
  }

 private:
  std::string_view rest_;
  int count_ = 0;
};

/// Takes the next word (of anything but blanks) off `line`; empty at its end.
[[nodiscard]] inline std::string_view take_word(std::string_view& line) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

}  // namespace hulltrack
