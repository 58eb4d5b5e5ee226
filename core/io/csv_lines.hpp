// Lines and fields of a small strict CSV: no quotes, no spaces, a fixed header.
//
// Used by the readers of this folder. Bounded: a line longer than kMaxLine is an error.
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"

namespace hulltrack {

class CsvLines {
 public:
  static constexpr std::size_t kMaxLine = 1024;

  explicit CsvLines(const std::filesystem::path& file);
  /// Reads the first line, which has to be `header`, or a beginning of it with at least `least` names.
  /// Answers how many names it has.
  [[nodiscard]] Result<std::size_t> expect_header(std::string_view header, std::size_t least);
  /// Reads the next line into fields(); false at the end of the file, which blank lines may precede.
  [[nodiscard]] Result<bool> next(std::size_t field_count);
  [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }
  [[nodiscard]] int line() const { return line_; }
  /// "FILE:LINE: message" about the line read last.
  [[nodiscard]] Error error(const std::string& message) const;

 private:
  [[nodiscard]] Result<bool> read_line();

  std::string name_;
  std::ifstream stream_;
  std::array<char, kMaxLine> buffer_{};
  std::string_view text_;  // the line, without its end
  std::vector<std::string_view> fields_;
  int line_ = 0;
};

}  // namespace hulltrack
