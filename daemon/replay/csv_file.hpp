// A table that is written line by line.
//
// Failure: a message with the file (disk full, no permission). Thread rule: one owner.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "core/base/result.hpp"

namespace hulltrack {

class CsvFile {
 public:
  /// Creates or empties the file and writes the header; `option`: which option of the tool chose it.
  [[nodiscard]] static Result<CsvFile> create(const std::filesystem::path& file, const char* header,
                                              const char* option);
  /// `line` without a newline.
  [[nodiscard]] Result<void> write(const std::string& line);
  [[nodiscard]] Result<void> close();

 private:
  struct Closer {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };
  CsvFile(std::string name, std::FILE* stream) : name_(std::move(name)), stream_(stream) {}

  std::string name_;
  std::unique_ptr<std::FILE, Closer> stream_;
};

}  // namespace hulltrack
