#include "lidar_drivers/velodyne/velodyne_models.hpp"

#include "lidar_drivers/velodyne/velodyne_decoder.hpp"
#include "lidar_drivers/velodyne/velodyne_format.hpp"

namespace hulltrack::velodyne {

std::vector<LidarModel> lidar_models() {
  std::vector<LidarModel> rows;
  for (const ModelTable& table : models()) {
    rows.push_back({.name = table.name,
                    .vendor = "Velodyne",
                    .title = table.title,
                    .port = 2368,
                    .range = table.range,
                    .channels = table.channels,
                    .clock_by = "GPS",
                    .make_decoder = [&table](const DecoderOptions& options, const std::filesystem::path&)
                        -> Result<std::unique_ptr<Decoder>> {
                      return std::unique_ptr<Decoder>(std::make_unique<VelodyneDecoder>(table, options));
                    }});
  }
  return rows;
}

}  // namespace hulltrack::velodyne
