// Any bytes as datagrams of every Hesai model, and as an angle correction file: that where the first byte
// ends in 0xF (a letter o), the second one then names the model.
#include <iterator>
#include <string_view>

#include "lidar_drivers/hesai/hesai_angles.hpp"
#include "lidar_drivers/hesai/hesai_format.hpp"
#include "tests/fuzz/datagram_fuzz.hpp"

using namespace hulltrack;

namespace {

void repair(std::vector<std::uint8_t>& packet, const hesai::ModelTable& model) {
  const hesai::HeaderLayout& header = model.header;
  if (header.bytes > 0) {
    write_le16(packet, 0, hesai::kHeaderFlag);
    if (model.protocol != 0) packet[header.protocol] = model.protocol;
    packet[header.lasers] = static_cast<std::uint8_t>(model.lasers);
    packet[header.blocks] = static_cast<std::uint8_t>(model.blocks);
    packet[header.distance_unit] = static_cast<std::uint8_t>(4 + packet[header.distance_unit] % 3);
  }
  if (model.has_flags()) packet[header.flags] = hesai::kSequenceBit;
  for (std::size_t block = 0; block < model.blocks && model.block_flag_bytes() > 0; ++block)
    write_le16(packet, model.block_offset(block), hesai::kBlockFlag);
  std::uint8_t& mode = packet[model.tail_offset() + model.tail.return_mode];
  constexpr std::uint8_t kModes[] = {0x33, 0x37, 0x38, 0x39, 0x3B, 0x3C, 0x3D};
  mode = kModes[mode % std::size(kModes)];
}

void read_angles(const std::uint8_t* data, std::size_t size, const hesai::ModelTable& model) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto angles = hesai::parse_angles(text, "fuzz.csv", model);
  if (!angles) {
    fuzz::require(angles.error().message.starts_with("fuzz.csv:"));
    return;
  }
  fuzz::require(angles->size() == model.lasers);
  for (std::size_t k = 0; k < model.lasers; ++k) {
    const double off = (*angles)[k].elevation_deg - model.nominal[k].elevation_deg;
    fuzz::require(off >= -2.0 && off <= 2.0);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto models = hesai::models();
  if ((data[0] & 0x0F) == 0x0F) {
    read_angles(data + 2, size - 2, models[data[1] % models.size()]);
    return 0;
  }
  const hesai::ModelTable& model = models[(data[0] & 0x0F) % models.size()];
  fuzz::run_datagrams({data, size}, model.name, model.bytes() + hesai::kSequenceBytes,
                      [&](std::vector<std::uint8_t>& packet) { repair(packet, model); });
  return 0;
}
