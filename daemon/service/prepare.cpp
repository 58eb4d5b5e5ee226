#include "daemon/service/prepare.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <string>
#include <utility>

#include "daemon/pipeline/load_map.hpp"
#include "daemon/pipeline/quay_file.hpp"
#include "daemon/service/memory_file.hpp"
#include "lidar_drivers/model_registry.hpp"

namespace hulltrack {
namespace {

Result<std::string> read_calibration(const std::string& file) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(kMaxCalibration + 1, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (stream.bad() || (!stream && !stream.eof())) {
    return Error{file + ": cannot be read: " + std::strerror(errno) + "; is this the right file?"};
  }
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  if (bytes.size() > kMaxCalibration) {
    return Error{file + ": is larger than 16 MiB; is this the calibration?"};
  }
  return bytes;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The bytes of the calibration file of this LiDAR, from which its decoder can be made; an error says what is
/// wrong with it, or with there being none.
Result<std::string> judged_calibration(const LidarConfig& lidar) {
  const LidarModel* model = find_lidar_model(lidar.model);
  if (model == nullptr) {
    return std::string();  // told already, and nobody knows what it would need
  }
  if (lidar.calibration.empty() || model->calibration == LidarModel::Calibration::none) {
    const auto decoder = make_lidar_decoder(*model, {}, lidar.calibration);
    return decoder ? Result<std::string>(std::string()) : decoder.error();
  }
  Result<std::string> bytes = read_calibration(lidar.calibration);
  if (!bytes) {
    return bytes;
  }
  const MemoryFile copy("calibration", *bytes);  // the decoder opens a path, and this one cannot change
  const auto decoder = make_lidar_decoder(*model, {}, copy.path());
  return decoder ? std::move(bytes)
                 : Error{replaced(decoder.error().message, copy.path().string(), lidar.calibration)};
}

class FileReader {
 public:
  FileReader(const std::filesystem::path& config_file, const ConfigReading& reading, std::size_t memory_mb,
             const OnPreparationStep& begins)
      : config_file_(config_file), reading_(reading), memory_mb_(memory_mb), begins_(begins) {
    files_.problems = reading.problems;
  }

  PreparedFiles read() && {
    const Config& config = reading_.readable;
    for (std::size_t i = 0; i < config.lidars.size(); ++i) {
      const std::string key = "lidar." + std::to_string(i) + ".calibration";
      begins_(PreparationStep::calibration, i);
      within_memory(key, config.lidars[i].calibration, [&] { read_calibration_of(config.lidars[i], key); });
    }
    if (!config.quay_file.empty()) {
      within_memory("quay.map", config.quay_file.string(), [&] { read_quay(config); });
    }
    if (!config.map_file.empty()) {
      within_memory("hull.map", config.map_file.string(), [&] { read_map(config); });
    }
    if (!files_.problems.empty()) {
      files_.map_H.clear();
      files_.quay_W.clear();
    }
    sort_by_line(files_.problems);
    return std::move(files_);
  }

 private:
  void read_calibration_of(const LidarConfig& lidar, const std::string& key) {
    Result<std::string> bytes = judged_calibration(lidar);
    if (!bytes && !reading_.bad_keys.contains(key)) {
      complain(key, bytes.error().message);
    }
    files_.calibrations.push_back(bytes ? std::move(bytes).value() : std::string());
  }

  void read_map(const Config& config) {
    begins_(PreparationStep::map, 0);
    const LoadedMap loaded =
        load_map(config.map_file, config.tracker, [this] { begins_(PreparationStep::map_making, 0); });
    for (const MapFinding& finding : loaded.findings) {
      if (reading_.bad_keys.contains(finding.key)) {
        continue;  // its value here is the default, not the site's
      }
      if (finding.refused) {
        complain(finding.key, finding.message);
      } else {
        remark(to_string(reading_.problem_with(config_file_, finding.key, "warning: " + finding.message)));
      }
    }
    if (loaded.map) {
      files_.map_H = loaded.map->cloud_H();
    }
  }

  void read_quay(const Config& config) {
    begins_(PreparationStep::quay, 0);
    Result<QuayFile> quay = read_quay_file(config.quay_file);
    if (!quay) {
      complain("quay.map", quay.error().message);
      return;
    }
    remark(quay->remark);
    files_.quay_W = std::move(quay->cloud_W);
  }

  void remark(const std::string& line) {
    if (!line.empty()) {
      files_.map_remark += (files_.map_remark.empty() ? "" : "\n") + line;
    }
  }

  void within_memory(const std::string& key, const std::string& file, const std::function<void()>& work) {
    try {
      work();
    } catch (const std::bad_alloc&) {
      complain(key, file + ": needs more than the " + std::to_string(memory_mb_) +
                        " MB of memory that the service may use for it; thin it out");
    }
  }

  void complain(const std::string& key, const std::string& message) {
    files_.problems.push_back(reading_.problem_with(config_file_, key, message));
  }

  const std::filesystem::path& config_file_;
  const ConfigReading& reading_;
  std::size_t memory_mb_;
  const OnPreparationStep& begins_;
  PreparedFiles files_;
};

}  // namespace

PreparedFiles read_prepared_files(const std::filesystem::path& config_file, const ConfigReading& reading,
                                  std::size_t memory_mb, const OnPreparationStep& begins) {
  return FileReader(config_file, reading, memory_mb, begins).read();
}

}  // namespace hulltrack
