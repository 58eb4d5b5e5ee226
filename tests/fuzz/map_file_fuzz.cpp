// Any bytes as a map file: never a crash, never more memory than the file can stand for; what is read makes a
// map.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "core/io/map_file.hpp"
#include "core/io/pcd_reader.hpp"
#include "core/io/ply_reader.hpp"
#include "tests/support/any_cloud.hpp"

namespace {

void use(hulltrack::Cloud cloud, std::size_t bytes) {
  if (cloud.empty() || cloud.size() > bytes * 100) {
    std::abort();
  }
  std::erase_if(cloud, [](const hulltrack::Point& p) {
    return !(p.array().abs() <= hulltrack::kMaxMapCoordinate).all();
  });
  cloud.resize(std::min<std::size_t>(cloud.size(), 3000));
  if (!cloud.empty()) {
    hulltrack::test::use_as_map(std::move(cloud));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hulltrack;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (auto pcd = parse_pcd(bytes)) {
    use(std::move(pcd->points), size);
  }
  if (auto ply = parse_ply(bytes)) {
    use(std::move(ply).value(), size);
  }
  return 0;
}
