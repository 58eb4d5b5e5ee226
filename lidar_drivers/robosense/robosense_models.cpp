#include "lidar_drivers/robosense/robosense_models.hpp"

#include <array>
#include <fstream>
#include <string>
#include <utility>

#include "lidar_drivers/robosense/robosense_decoder.hpp"
#include "lidar_drivers/robosense/robosense_format.hpp"

namespace hulltrack::robosense {

namespace {

Result<std::unique_ptr<Decoder>> make_decoder(const ModelTable& table, const DecoderOptions& options,
                                              const std::filesystem::path& calibration) {
  auto decoder = std::make_unique<RobosenseDecoder>(table, options);
  if (calibration.empty()) return std::unique_ptr<Decoder>(std::move(decoder));

  const std::string name = calibration.string();
  std::ifstream file(calibration, std::ios::binary);
  std::array<char, kPacketBytes + 1> content{};  // one more: is it longer?
  file.read(content.data(), content.size());
  if (file.bad() || (!file && !file.eof())) return Error{name + " cannot be read"};
  const Bytes bytes(reinterpret_cast<const std::uint8_t*>(content.data()),
                    static_cast<std::size_t>(file.gcount()));
  if (bytes.size() > kPacketBytes) return Error{name + " has more than the 1248 bytes of a DIFOP packet"};
  auto difop = read_difop(bytes, table);
  if (!difop) return Error{name + " " + difop.error().message};
  difop->clock_reference = ClockReference::unknown;  // it is long ago that the file was taken
  decoder->inform(*difop);
  if (!fits(*difop, table)) {
    return Error{name + ": " + std::string(table.name) + ": " +
                 decoder->explain({.status = DecodeStatus::wrong_product})};
  }
  return std::unique_ptr<Decoder>(std::move(decoder));
}

}  // namespace

std::vector<LidarModel> lidar_models() {
  std::vector<LidarModel> rows;
  for (const ModelTable& table : models()) {
    rows.push_back(
        {.name = table.name,
         .vendor = "RoboSense",
         .title = table.title,
         .port = 6699,
         .range = table.range,
         .channels = static_cast<int>(table.lasers),
         .calibration = LidarModel::Calibration::optional,
         .calibration_file = "DIFOP packet",
         .information_port = 7788,
         .clock_by = table.clock_by,
         .make_decoder = [&table](const DecoderOptions& options, const std::filesystem::path& calibration) {
           return make_decoder(table, options, calibration);
         }});
  }
  return rows;
}

}  // namespace hulltrack::robosense
