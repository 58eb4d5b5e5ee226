// Any bytes as plc.csv and truth.csv: never a crash, every error names file and line, and what is accepted
// keeps the law of the tables: finite values, time that never runs backwards.
//
// The readers take files, so each input becomes one in memory: no disk, no name to collide.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/io/plc_csv.hpp"

namespace {

using namespace hulltrack;

void require(bool condition) {
  if (!condition) std::abort();
}

/// The bytes as a file in memory, for as long as this object lives.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : fd_(memfd_create("fuzz.csv", MFD_CLOEXEC)) {
    require(fd_ >= 0 && write(fd_, data, size) == static_cast<ssize_t>(size));
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

bool finite(const PlcCsvRow& row) {
  return std::isfinite(row.d_x) && std::isfinite(row.theta_r_deg) && std::isfinite(row.theta_p_deg);
}
bool finite(const TruthRow& row) {
  return row.xyz.allFinite() && row.rpy_deg.allFinite() && std::isfinite(row.bend);
}

template <typename Row>
void check(const Result<std::vector<Row>>& rows, const std::string& path) {
  if (!rows) {
    require(rows.error().message.starts_with(path + ":"));
    return;
  }
  require(!rows->empty());
  std::int64_t last = 0;
  for (const Row& row : *rows) {
    require(finite(row) && row.t_ns >= last);
    last = row.t_ns;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  check(read_plc_csv(file.path()), file.path());
  check(read_truth_csv(file.path()), file.path());
  return 0;
}
