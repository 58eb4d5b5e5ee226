#include "lidar_drivers/ouster/ouster_models.hpp"

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/ouster/ouster_decoder.hpp"

namespace hulltrack::ouster {

namespace {

Result<std::unique_ptr<Decoder>> make(const DecoderOptions& options, const std::filesystem::path& file) {
  const Result<Metadata> metadata = read_metadata(file);
  if (!metadata) return metadata.error();
  return std::unique_ptr<Decoder>(std::make_unique<OusterDecoder>(*metadata, options));
}

/// The size is that of some profile, number of beams and columns, and the header says so where there is one.
bool looks_like(std::span<const std::uint8_t> payload) {
  for (const Layout& layout : kLayouts) {
    for (const std::size_t beams : {16U, 32U, 64U, 128U}) {
      for (const std::size_t columns : {8U, 16U, 32U}) {
        const bool told =
            layout.packet_header == 0 || (payload.size() >= 2 && read_le16(payload, 0) == kLidarPacket);
        if (payload.size() == layout.packet_bytes(columns, beams) && told) return true;
      }
    }
  }
  return false;
}

}  // namespace

/// One row: which of the family it is, the metadata says. Range: the OS-2's, the longest, at 80 % of
/// reflectivity; of OS-1 120 m (data sheet), of OS-0 50 m. Those of OS-0 and OS-2 are from users' tables, the
/// maker's sheets of them were not to be had; later revisions may reach farther. From beyond
/// it the scan builder takes no point.
std::vector<LidarModel> lidar_models() {
  return {{.name = "ouster_os",
           .vendor = "Ouster",
           .title = "OS-0/1/2",
           .port = 7502,
           .range = 240.0,
           .channels = 128,
           .calibration = LidarModel::Calibration::required,
           .calibration_file = "metadata JSON",
           .clock_by = "PTP, GPS",
           .make_decoder = make,
           .looks_like = looks_like}};
}

}  // namespace hulltrack::ouster
