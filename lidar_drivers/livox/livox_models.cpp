#include "lidar_drivers/livox/livox_models.hpp"

#include "lidar_drivers/livox/livox_decoder.hpp"
#include "lidar_drivers/livox/livox_format.hpp"

namespace hulltrack::livox {

std::vector<LidarModel> lidar_models() {
  std::vector<LidarModel> rows;
  for (const ModelTable& table : models()) {
    rows.push_back({.name = table.name,
                    .vendor = "Livox",
                    .title = table.title,
                    .port = table.port,
                    .range = table.range,
                    .channels = table.lines,
                    .rotates = false,
                    .clock_by = table.clock_by,
                    .make_decoder = [&table](const DecoderOptions& options, const std::filesystem::path&)
                        -> Result<std::unique_ptr<Decoder>> {
                      return std::unique_ptr<Decoder>(std::make_unique<LivoxDecoder>(table, options));
                    }});
  }
  return rows;
}

}  // namespace hulltrack::livox
