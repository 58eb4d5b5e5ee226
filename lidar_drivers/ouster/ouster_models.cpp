#include "lidar_drivers/ouster/ouster_models.hpp"

#include "lidar_drivers/ouster/ouster_decoder.hpp"

namespace hulltrack::ouster {

namespace {

Result<std::unique_ptr<Decoder>> make(const DecoderOptions& options, const std::filesystem::path& file) {
  const Result<Metadata> metadata = read_metadata(file);
  if (!metadata) return metadata.error();
  return std::unique_ptr<Decoder>(std::make_unique<OusterDecoder>(*metadata, options));
}

}  // namespace

/// One row: which of the family it is, the metadata says. Range: the OS-2's, the longest.
std::vector<LidarModel> lidar_models() {
  return {{.name = "ouster_os",
           .vendor = "Ouster",
           .title = "OS-0/1/2",
           .port = 7502,
           .range = 240.0,
           .channels = 128,
           .calibration = LidarModel::Calibration::required,
           .calibration_file = "metadata JSON",
           .make_decoder = make}};
}

}  // namespace hulltrack::ouster
