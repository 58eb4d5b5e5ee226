#include "core/io/csv_lines.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/base/text.hpp"

namespace hulltrack {

CsvLines::CsvLines(const std::filesystem::path& file) : name_(file.string()) {
  errno = 0;
  if (!std::filesystem::is_directory(file)) {
    stream_.open(file);
  } else {
    errno = EISDIR;
    stream_.setstate(std::ios::failbit);
  }
}

Error CsvLines::error(const std::string& message) const {
  return Error{name_ + ':' + std::to_string(line_) + ": " + message};
}

Result<bool> CsvLines::read_line() {
  stream_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  const auto count = static_cast<std::size_t>(stream_.gcount());
  if (stream_.bad()) {
    return Error{name_ + ": cannot be read: " + std::strerror(errno)};
  }
  if (count == 0 && stream_.eof()) {
    return false;
  }
  ++line_;
  if (stream_.fail()) {
    return error("the line is longer than " + std::to_string(kMaxLine - 2) +
                 " characters; is this the right file?");
  }
  // gcount() includes the newline that was taken off, which only the last line can lack.
  text_ = std::string_view(buffer_.data(), stream_.eof() ? count : count - 1);
  if (text_.ends_with('\r')) {
    text_.remove_suffix(1);
  }
  return true;
}

Result<std::size_t> CsvLines::expect_header(std::string_view header, std::size_t least) {
  if (!stream_) {
    return Error{name_ + ": cannot be opened: " + std::strerror(errno)};
  }
  const auto more = read_line();
  if (!more) {
    return more.error();
  }
  if (!*more) {
    return Error{name_ + ": is empty; its first line must be `" + std::string(header) + "`"};
  }
  const auto names = 1 + static_cast<std::size_t>(std::count(text_.begin(), text_.end(), ','));
  const bool begins = header.starts_with(text_) &&
                      (text_.size() == header.size() || header.substr(text_.size()).starts_with(','));
  if (names < least || !begins) {
    return error("the first line must be `" + std::string(header) + "`, it is `" +
                 std::string(text_.substr(0, 80)) + "`");
  }
  return names;
}

Result<bool> CsvLines::next(std::size_t field_count) {
  auto more = read_line();
  const int first = line_;
  while (more && *more && text_.empty()) {
    more = read_line();
  }
  if (!more || !*more) {
    return more;
  }
  if (line_ > first) {
    line_ = first;
    return error("is blank, with more lines after it; was something lost here?");
  }
  fields_.clear();
  std::string_view rest = text_;
  while (true) {
    const auto comma = rest.find(',');
    fields_.push_back(rest.substr(0, comma));
    if (comma == std::string_view::npos) {
      break;
    }
    rest.remove_prefix(comma + 1);
  }
  if (fields_.size() != field_count) {
    return error("has " + counted(fields_.size(), "field") + ", must have " + std::to_string(field_count) +
                 (stream_.eof() ? "; is the file cut short?" : ""));
  }
  return true;
}

}  // namespace hulltrack
