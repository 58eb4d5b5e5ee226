// The tables of a recording folder: plc.csv (what the PLC presented) and truth.csv (simulations only).
//
// Units as in the files: nanoseconds of UTC, metres, degrees. plc.latency_ms is not subtracted in a file.
// Reading is strict: the exact header (truth.csv with or without its last column), every field a finite
// number, time never running backwards (equal times are allowed); CR LF and a missing last newline are
// accepted. An error names FILE:LINE. Writing keeps every bit (shortest text that reads back equal) and
// reports a full disk. Thread rule: plain functions; a writer has one owner.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.hpp"

namespace hulltrack {

/// Header `t_ns,d_x,theta_r,theta_p,heartbeat,command`.
struct PlcCsvRow {
  std::int64_t t_ns = 0;  // when the PLC presented the values; >= 0
  double d_x = 0.0;       // m
  double theta_r_deg = 0.0;
  double theta_p_deg = 0.0;
  std::uint32_t heartbeat = 0;
  std::uint16_t command = 0;
};

/// Header `t_ns,x,y,z,roll,pitch,yaw,bend`: the hull pose as the registers define it, and how much the hull
/// has bent since the map was made; a file without the last column has a stiff hull.
struct TruthRow {
  std::int64_t t_ns = 0;
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();  // displacement of the reference point, m
  Eigen::Vector3d rpy_deg = Eigen::Vector3d::Zero();
  double bend = 0.0;  // m that the middle lies below the chord through the ends: > 0 a sag, < 0 a hog
};

/// All rows of a file, or the first thing wrong with it. A file without rows is an error.
[[nodiscard]] Result<std::vector<PlcCsvRow>> read_plc_csv(const std::filesystem::path& file);
[[nodiscard]] Result<std::vector<TruthRow>> read_truth_csv(const std::filesystem::path& file);

/// A CSV file being written, header first. Buffered: errors show at the latest in close().
/// Without close() the file is closed on destruction and its errors are lost.
template <typename Row>
class CsvWriter {
 public:
  /// Creates or empties the file and writes the header.
  [[nodiscard]] static Result<CsvWriter> create(const std::filesystem::path& file);
  [[nodiscard]] Result<void> write(const Row& row);
  [[nodiscard]] Result<void> close();

 private:
  struct Closer {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };
  CsvWriter(std::string name, std::FILE* stream) : name_(std::move(name)), stream_(stream) {}
  [[nodiscard]] Result<void> put(const std::string& line);

  std::string name_;
  std::unique_ptr<std::FILE, Closer> stream_;
};

using PlcCsvWriter = CsvWriter<PlcCsvRow>;
using TruthCsvWriter = CsvWriter<TruthRow>;

}  // namespace hulltrack
