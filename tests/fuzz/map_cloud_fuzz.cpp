// Any cloud as a map: it can be built and used, and what is no ship is told.
#include <cstdint>

#include "tests/support/any_cloud.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hulltrack;
  test::use_as_map(test::any_cloud({data, size}, 3000));
  return 0;
}
