// Any bytes as a map file: never a crash, never more memory than the file can stand for.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/io/pcd_reader.hpp"
#include "core/io/ply_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hulltrack;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const auto& cloud : {parse_pcd(bytes), parse_ply(bytes)}) {
    if (cloud && (cloud->empty() || cloud->size() > size * 100)) {
      std::abort();
    }
  }
  return 0;
}
