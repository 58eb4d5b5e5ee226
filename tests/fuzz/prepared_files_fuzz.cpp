// Any bytes as what the reader hands over: never a crash, never more memory than they can stand for.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "daemon/service/prepared_files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hulltrack;
  const auto files = parse_prepared_files({reinterpret_cast<const char*>(data), size});
  if (!files) {
    return 0;
  }
  std::size_t stands_for = files->map_remark.size() + files->map_H.size() * sizeof(Point);
  for (const Problem& problem : files->problems) {
    stands_for += problem.file.size() + problem.message.size();
  }
  for (const std::string& calibration : files->calibrations) {
    stands_for += calibration.size();
  }
  if (stands_for > size || files->map_H.empty() == files->problems.empty()) {
    std::abort();
  }
  return 0;
}
