#include "daemon/config/key_table.hpp"

#include "daemon/config/key_factories.hpp"
#include "daemon/config/net_names.hpp"
#include "daemon/config/words.hpp"
#include "daemon/log/log_config.hpp"

namespace hulltrack {
namespace {

using namespace keys;

constexpr std::int64_t kLastOffset = 124;  // one FC 03 request carries at most 125 registers
constexpr double kMaxValue = 1e6;
constexpr std::size_t kMaxExclude = 64;

Key required(Key key) {
  key.required = true;
  return key;
}

Key suggesting(Key key, std::vector<std::string> words) {
  key.words = std::move(words);
  return key;
}

/// As `key`, but with a rule of its own on whole numbers.
Key restricted(Key key, std::string allowed, bool (*legal)(std::int64_t)) {
  key.allowed = std::move(allowed);
  key.legal = [legal](const ConfigValue& value) { return legal(std::get<std::int64_t>(value)); };
  return key;
}

bool is_ident(const std::string& text) {
  return !text.empty() && text.size() <= 32 && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  });
}
constexpr const char* kIdentAllowed = "1 to 32 letters, digits, dots, hyphens or underscores";

/// For people: any text that fits into a log line. Bytes above 127 are UTF-8, which the reader checked.
bool is_label(const std::string& text) {
  return !text.empty() && text.size() <= 32 && std::all_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) >= 0x20 && c != 0x7F;
  });
}

bool is_file_name(const std::string& text) {
  return text.size() < 4096 && text.find('\0') == std::string::npos;
}

Section plc_section(PlcConfig& plc) {
  return {"plc",
          {required(text("host", plc.host, "an IP address or a host name", is_host)),
           whole("port", plc.port, 1, 65535),
           restricted(whole("unit_id", plc.unit_id, 0, 255), "a whole number from 0 to 247, or 255",
                      [](std::int64_t id) { return (id >= 0 && id <= 247) || id == 255; }),
           milliseconds("poll_period_ms", plc.poll_period, 1, 200),
           milliseconds("write_period_ms", plc.write_period, 10, 10'000),
           milliseconds("response_timeout_ms", plc.response_timeout, 10, 5'000),
           milliseconds("heartbeat_timeout_ms", plc.heartbeat_timeout, 0, 60'000),
           Key{.name = "latency_ms",
               .allowed = "a number from 0.0 to 1000.0 (ms)",
               .legal =
                   [](const ConfigValue& value) {
                     return std::get<double>(value) >= 0.0 && std::get<double>(value) <= 1000.0;
                   },
               .get = [&plc] { return to_milliseconds(plc.latency); },
               .set =
                   [&plc](const ConfigValue& value) {
                     plc.latency = nanoseconds_from_ms(std::get<double>(value));
                   }}}};
}

Section joint_section(std::string name, JointRegister& joint) {
  return {std::move(name),
          {whole("offset", joint.offset, 0, kLastOffset), choice("type", joint.type, kRegisterTypeWords),
           Key{.name = "scale",
               .allowed = "a number from -1000000.0 to 1000000.0 except 0",
               .legal =
                   [](const ConfigValue& value) {
                     const double scale = std::get<double>(value);
                     return scale != 0.0 && std::abs(scale) <= kMaxValue;
                   },
               .get = [&joint] { return joint.scale; },
               .set = [&joint](const ConfigValue& value) { joint.scale = std::get<double>(value); }},
           number("bias", joint.bias, -kMaxValue, kMaxValue),
           restricted(whole("sign", joint.sign, -1, 1), "1 or -1",
                      [](std::int64_t sign) { return sign == 1 || sign == -1; }),
           number("min", joint.min, -kMaxValue, kMaxValue), number("max", joint.max, -kMaxValue, kMaxValue),
           number("max_rate", joint.max_rate, 0.001, 1000.0)}};
}

Section hull_section(Config& config) {
  HullConfig& hull = config.tracker.hull;
  return {
      "hull",
      {required(Key{
           .name = "map",
           .allowed = "the name of a PCD or PLY file",
           .legal =
               [](const ConfigValue& value) {
                 const auto& name = std::get<std::string>(value);
                 return !name.empty() && is_file_name(name);
               },
           .get = [&config] { return config.map_file.string(); },
           .set = [&config](const ConfigValue& value) { config.map_file = std::get<std::string>(value); }}),
       vector3(
           "reference_point", 10'000.0, "m", [&hull] { return hull.reference_point; },
           [&hull](const Eigen::Vector3d& p) { hull.reference_point = p; }),
       optional_box("region", hull.region), box("envelope", hull.envelope),
       number("max_speed", hull.max_speed, 0.001, 10.0, "m/s"), angle("max_heel", hull.max_heel, 0.1, 45.0),
       angle("max_trim", hull.max_trim, 0.1, 45.0), angle("max_yaw", hull.max_yaw, 0.1, 45.0)}};
}

constexpr const char* kLearn = "learn";
constexpr const char* kOff = "off";

Key quay_height(QuayConfig& quay) {
  constexpr double kMost = 100.0;  // m
  return {.name = "height",
          .allowed = "\"learn\", \"off\" or a number from -100.0 to 100.0 (m)",
          .legal =
              [](const ConfigValue& value) {
                const auto* word = std::get_if<std::string>(&value);
                return word != nullptr ? *word == kLearn || *word == kOff
                                       : std::abs(std::get<double>(value)) <= kMost;
              },
          .get = [&quay]() -> ConfigValue {
            if (quay.height) {
              return *quay.height;
            }
            return std::string(quay.top_is_witness ? kLearn : kOff);
          },
          .set =
              [&quay](const ConfigValue& value) {
                const auto* word = std::get_if<std::string>(&value);
                quay.top_is_witness = word == nullptr || *word != kOff;
                quay.height = word == nullptr ? std::optional(std::get<double>(value)) : std::nullopt;
              },
          .words = {kLearn, kOff},
          .others = {0.0}};
}

Key quay_slope(QuayConfig& quay) {
  constexpr double kMost = 5.0;  // deg: nobody could load on a quay that is steeper
  return {.name = "slope",
          .allowed = "\"learn\" or two numbers [x, y] from -5.0 to 5.0 (deg)",
          .legal =
              [](const ConfigValue& value) {
                const auto* numbers = std::get_if<Numbers>(&value);
                return numbers == nullptr ? std::get<std::string>(value) == kLearn
                                          : numbers->size() == 2 && std::abs((*numbers)[0]) <= kMost &&
                                                std::abs((*numbers)[1]) <= kMost;
              },
          .get = [&quay]() -> ConfigValue {
            if (quay.slope) {
              return Numbers{tidy_degrees(quay.slope->x()), tidy_degrees(quay.slope->y())};
            }
            return std::string(kLearn);
          },
          .set =
              [&quay](const ConfigValue& value) {
                const auto* numbers = std::get_if<Numbers>(&value);
                quay.slope =
                    numbers == nullptr
                        ? std::nullopt
                        : std::optional(Eigen::Vector2d(radians((*numbers)[0]), radians((*numbers)[1])));
              },
          .words = {kLearn},
          .others = {Numbers{}}};
}

Section quay_section(Config& config) {
  return {
      "quay",
      {quay_height(config.tracker.quay), quay_slope(config.tracker.quay),
       Key{.name = "map",
           .allowed = "the name of a PCD or PLY file, or \"\" for none",
           .legal = [](const ConfigValue& value) { return is_file_name(std::get<std::string>(value)); },
           .get = [&config] { return config.quay_file.string(); },
           .set = [&config](const ConfigValue& value) { config.quay_file = std::get<std::string>(value); }}}};
}

Section tracking_section(Config& config) {
  RegistrationConfig& registration = config.tracker.registration;
  return {"tracking",
          {choice("framing", config.framing.framing, kFramingWords),
           number("frame_rate_hz", config.framing.frame_rate_hz, 1.0, 50.0, "Hz"),
           number("voxel_size", registration.voxel_size, 0.01, 10.0, "m"),
           number("max_correspondence_distance", registration.max_correspondence_distance, 0.01, 10.0, "m"),
           whole("max_iterations", registration.max_iterations, 1, 1000),
           number("translation_epsilon", registration.translation_epsilon, 1e-6, 1.0, "m"),
           angle("rotation_epsilon_deg", registration.rotation_epsilon, 1e-6, 10.0),
           choice("method", registration.method, kMethodWords)}};
}

Section health_section(HealthConfig& health) {
  return {"health",
          {number("q1_ratio_healthy", health.q1_ratio_healthy, 1.0, 100.0),
           number("q1_ratio_lost", health.q1_ratio_lost, 1.0, 100.0),
           optional_number("q1_healthy", health.q1_healthy, 0.001, 10.0, "m"),
           optional_number("q1_lost", health.q1_lost, 0.001, 10.0, "m"),
           number("metric_range", health.metric_range, 1.0, 1000.0, "m"),
           whole("min_matched", health.min_matched, 3, 1'000'000),
           whole("recover_frames", health.recover_frames, 1, 1000),
           milliseconds("max_age_ms", health.max_age, 1, 60'000)}};
}

/// LogConfig::facility is the word itself.
Key facility_key(LogConfig& log) {
  Key key =
      text("facility", log.facility, "one of " + list_text(kFacilityWords), [](const std::string& word) {
        return std::find(kFacilityWords.begin(), kFacilityWords.end(), word) != kFacilityWords.end();
      });
  return suggesting(std::move(key), {kFacilityWords.begin(), kFacilityWords.end()});
}

}  // namespace

std::vector<Section> config_sections(Config& config) {
  PlcReadConfig& read = config.plc.read;
  PlcWriteConfig& write = config.plc.write;
  return {plc_section(config.plc),
          {"plc.read",
           {whole("base", read.base, 0, 65535), choice("word_order", read.word_order, kWordOrderWords),
            whole("heartbeat", read.heartbeat, 0, kLastOffset),
            whole("heartbeat_tail", read.heartbeat_tail, -1, kLastOffset),
            whole("command", read.command, -1, kLastOffset)}},
          joint_section("plc.read.travel", read.travel),
          joint_section("plc.read.slew", read.slew),
          joint_section("plc.read.luff", read.luff),
          {"plc.write",
           {whole("base", write.base, 0, 65535), choice("word_order", write.word_order, kWordOrderWords),
            choice("encoding", write.encoding, kWriteEncodingWords)}},
          {"machine.slew", pose(config.machine.slew)},
          {"machine.luff", pose(config.machine.luff)},
          hull_section(config),
          quay_section(config),
          tracking_section(config),
          health_section(config.tracker.health),
          {"log",
           {text("ident", config.log.ident, kIdentAllowed, is_ident), facility_key(config.log),
            choice("level", config.log.level, kLogLevelWords)}}};
}

std::vector<Section> lidar_sections(LidarConfig& lidar, std::span<const LidarModel> models) {
  std::vector<std::string> names;
  for (const LidarModel& model : models) {
    names.emplace_back(model.name);
  }
  const auto is_model = [names](const std::string& name) {
    return names.empty() ? !name.empty() : std::find(names.begin(), names.end(), name) != names.end();
  };
  const std::string model_allowed =
      names.empty() ? "a model that `hulltrack models` lists" : "one of " + list_text(names);
  const auto address_or_none = [](const std::string& text) { return text.empty() || is_ipv4(text); };
  const auto group_or_none = [](const std::string& text) { return text.empty() || is_ipv4_multicast(text); };
  return {
      {kLidarSection,
       {text("name", lidar.name, "1 to 32 printable characters", is_label),
        required(suggesting(text("model", lidar.model, model_allowed, is_model), names)),
        text("bind", lidar.bind, "an IPv4 address of this computer, \"0.0.0.0\" = all of them", is_ipv4),
        whole("port", lidar.port, 1, 65535), whole("information_port", lidar.information_port, 0, 65535),
        text("source", lidar.source, "the LiDAR's IPv4 address, or \"\" for any", address_or_none),
        text("multicast", lidar.multicast,
             "an IPv4 address from 224.0.0.0 to 239.255.255.255, or \"\" for none", group_or_none),
        text("calibration", lidar.calibration, "the name of a file, or \"\" for none", is_file_name),
        number("min_range", lidar.min_range, 0.0, 1000.0, "m"),
        number("max_range", lidar.max_range, 0.1, 1000.0, "m"),
        milliseconds("timeout_ms", lidar.timeout, 10, 60'000),
        choice("time_source", lidar.time_source, kTimeSourceWords),
        flag("firing_correction", lidar.firing_correction), boxes("exclude", lidar.exclude, kMaxExclude)}},
      {kLidarMountSection, pose(lidar.mount)}};
}

}  // namespace hulltrack
