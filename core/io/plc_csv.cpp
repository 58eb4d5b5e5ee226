#include "core/io/plc_csv.hpp"

#include <cerrno>
#include <cstring>

#include "core/io/csv_lines.hpp"
#include "core/io/parse_number.hpp"

namespace hulltrack {
namespace {

/// What a row type looks like in a file: its header, how many of its columns an older file may stop after,
/// and the way from and to fields.
template <typename Row>
struct Format;

/// Takes the fields of one line in turn; remembers the first that is not what it must be.
class FieldReader {
 public:
  FieldReader(const CsvLines& lines, std::string_view header) : lines_(lines), names_(header) {}

  template <typename T>
  void take(T& value, const char* what) {
    const auto comma = names_.find(',');
    const std::string name(names_.substr(0, comma));
    names_.remove_prefix(comma == std::string_view::npos ? names_.size() : comma + 1);
    const std::string_view field = lines_.fields()[index_++];
    if (const auto number = parse_number<T>(field)) {
      value = *number;
    } else if (problem_.empty()) {
      problem_ = name + " is `" + std::string(field.substr(0, 40)) + "`, must be " + what;
    }
  }
  [[nodiscard]] bool more() const { return index_ < lines_.fields().size(); }
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  const CsvLines& lines_;
  std::string_view names_;
  std::size_t index_ = 0;
  std::string problem_;
};

constexpr const char* kFinite = "a finite number";

template <>
struct Format<PlcCsvRow> {
  static constexpr std::string_view kHeader = "t_ns,d_x,theta_r,theta_p,heartbeat,command";
  static constexpr std::size_t kLeast = 6;
  static void parse(FieldReader& in, PlcCsvRow& row) {
    in.take(row.t_ns, "whole nanoseconds");
    in.take(row.d_x, kFinite);
    in.take(row.theta_r_deg, kFinite);
    in.take(row.theta_p_deg, kFinite);
    in.take(row.heartbeat, "a whole number from 0 to 4294967295");
    in.take(row.command, "a whole number from 0 to 65535");
  }
  template <typename Put>
  static void print(const PlcCsvRow& row, Put put) {
    put(row.t_ns), put(row.d_x), put(row.theta_r_deg), put(row.theta_p_deg), put(row.heartbeat),
        put(row.command);
  }
};

template <>
struct Format<TruthRow> {
  static constexpr std::string_view kHeader = "t_ns,x,y,z,roll,pitch,yaw,bend";
  static constexpr std::size_t kLeast = 7;
  static void parse(FieldReader& in, TruthRow& row) {
    in.take(row.t_ns, "whole nanoseconds");
    for (double& value : row.xyz) {
      in.take(value, kFinite);
    }
    for (double& value : row.rpy_deg) {
      in.take(value, kFinite);
    }
    if (in.more()) {
      in.take(row.bend, kFinite);
    }
  }
  template <typename Put>
  static void print(const TruthRow& row, Put put) {
    put(row.t_ns);
    for (const double value : row.xyz) {
      put(value);
    }
    for (const double value : row.rpy_deg) {
      put(value);
    }
    put(row.bend);
  }
};

template <typename Row>
Result<std::vector<Row>> read_rows(const std::filesystem::path& file) {
  CsvLines lines(file);
  const auto columns = lines.expect_header(Format<Row>::kHeader, Format<Row>::kLeast);
  if (!columns) {
    return columns.error();
  }
  std::vector<Row> rows;
  while (true) {
    const auto more = lines.next(*columns);
    if (!more) {
      return more.error();
    }
    if (!*more) {
      break;
    }
    Row row;
    FieldReader fields(lines, Format<Row>::kHeader);
    Format<Row>::parse(fields, row);
    if (!fields.problem().empty()) {
      return lines.error(fields.problem());
    }
    if (row.t_ns < 0) {
      return lines.error("t_ns is negative, must be UTC nanoseconds since 1970");
    }
    if (!rows.empty() && row.t_ns < rows.back().t_ns) {
      return lines.error("time runs backwards: t_ns " + std::to_string(row.t_ns) + " after " +
                         std::to_string(rows.back().t_ns) + " in line " + std::to_string(lines.line() - 1) +
                         "; rows must be in order of time");
    }
    rows.push_back(row);
  }
  if (rows.empty()) {
    return Error{file.string() + ": has a header but no rows; record it again"};
  }
  return rows;
}

}  // namespace

Result<std::vector<PlcCsvRow>> read_plc_csv(const std::filesystem::path& file) {
  return read_rows<PlcCsvRow>(file);
}

Result<std::vector<TruthRow>> read_truth_csv(const std::filesystem::path& file) {
  return read_rows<TruthRow>(file);
}

template <typename Row>
Result<CsvWriter<Row>> CsvWriter<Row>::create(const std::filesystem::path& file) {
  std::FILE* stream = std::fopen(file.c_str(), "w");
  if (stream == nullptr) {
    return Error{file.string() + ": cannot be created: " + std::strerror(errno)};
  }
  CsvWriter writer(file.string(), stream);
  if (const auto done = writer.put(std::string(Format<Row>::kHeader) + '\n'); !done) {
    return done.error();
  }
  return writer;
}

template <typename Row>
Result<void> CsvWriter<Row>::write(const Row& row) {
  std::string line;
  Format<Row>::print(row, [&line](auto value) {
    std::array<char, 32> text{};
    const auto [end, failure] = std::to_chars(text.data(), text.data() + text.size(), value);
    line.append(text.data(), end).push_back(',');
  });
  line.back() = '\n';
  return put(line);
}

template <typename Row>
Result<void> CsvWriter<Row>::put(const std::string& line) {
  if (std::fwrite(line.data(), 1, line.size(), stream_.get()) != line.size()) {
    return Error{name_ + ": cannot be written: " + std::strerror(errno)};
  }
  return {};
}

template <typename Row>
Result<void> CsvWriter<Row>::close() {
  if (std::fclose(stream_.release()) != 0) {
    return Error{name_ + ": cannot be written: " + std::strerror(errno)};
  }
  return {};
}

template class CsvWriter<PlcCsvRow>;
template class CsvWriter<TruthRow>;

}  // namespace hulltrack
