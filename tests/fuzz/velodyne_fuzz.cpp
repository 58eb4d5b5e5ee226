// Any bytes as datagrams of every Velodyne model.
#include "lidar_drivers/velodyne/velodyne_format.hpp"
#include "tests/fuzz/datagram_fuzz.hpp"

using namespace hulltrack;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const velodyne::ModelTable& model = velodyne::models()[data[0] % velodyne::models().size()];
  fuzz::run_datagrams({data, size}, model.name, velodyne::kPacketBytes,
                      [&](std::vector<std::uint8_t>& packet) {
                        for (std::size_t block = 0; block < velodyne::kBlocks; ++block) {
                          write_le16(packet, block * velodyne::kBlockBytes, velodyne::kBlockFlag);
                        }
                        packet[velodyne::kProductOffset] = model.product;
                      });
  return 0;
}
