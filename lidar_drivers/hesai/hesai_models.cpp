#include "lidar_drivers/hesai/hesai_models.hpp"

#include "lidar_drivers/hesai/hesai_angles.hpp"
#include "lidar_drivers/hesai/hesai_decoder.hpp"
#include "lidar_drivers/hesai/hesai_format.hpp"

namespace hulltrack::hesai {

std::vector<LidarModel> lidar_models() {
  std::vector<LidarModel> rows;
  for (const ModelTable& table : models()) {
    rows.push_back(
        {.name = table.name,
         .vendor = "Hesai",
         .title = table.title,
         .port = 2368,
         .range = table.range,
         .channels = static_cast<int>(table.lasers),
         .calibration = LidarModel::Calibration::optional,
         .calibration_file = "angle correction CSV",
         .clock_by = "PTP, GPS",
         .make_decoder = [&table](const DecoderOptions& options,
                                  const std::filesystem::path& file) -> Result<std::unique_ptr<Decoder>> {
           const auto angles = load_angles(file, table);
           if (!angles) return angles.error();
           return std::unique_ptr<Decoder>(std::make_unique<HesaiDecoder>(table, *angles, options));
         }});
  }
  return rows;
}

}  // namespace hulltrack::hesai
