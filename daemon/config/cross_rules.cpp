#include "daemon/config/cross_rules.hpp"

#include <algorithm>
#include <utility>

#include "daemon/config/value_text.hpp"
#include "plc/register_rules.hpp"

namespace hulltrack {
namespace {

using Broken = std::vector<BrokenRule>;

void check_joint(const std::string& section, const JointRegister& joint, Broken& broken) {
  if (joint.min >= joint.max) {
    broken.push_back({{section + ".min", section + ".max"},
                      "is " + number_text(joint.min) + ", not below max = " + number_text(joint.max) +
                          "; min must be less than max"});
  }
}

void check_plc(const PlcConfig& plc, Broken& broken) {
  for (BrokenRule& rule : check_registers(plc)) {
    broken.push_back(std::move(rule));
  }
  check_joint("plc.read.travel", plc.read.travel, broken);
  check_joint("plc.read.slew", plc.read.slew, broken);
  check_joint("plc.read.luff", plc.read.luff, broken);
  if (plc.heartbeat_timeout > Nanoseconds{0} && plc.heartbeat_timeout <= plc.poll_period) {
    broken.push_back(
        {{"plc.heartbeat_timeout_ms", "plc.poll_period_ms"},
         "is not longer than poll_period_ms, so that every poll would find the data stale; make it "
         "several poll periods, or 0 for a PLC without a heartbeat"});
  }
}

/// A port that both listen on, for data or information; 0 = none.
std::uint16_t common_port(const LidarConfig& a, const LidarConfig& b) {
  const bool on_data_port = a.port == b.port || a.port == b.information_port;
  if (on_data_port) {
    return a.port;
  }
  const bool on_information_port = a.information_port == b.port || a.information_port == b.information_port;
  return on_information_port ? a.information_port : std::uint16_t{0};
}

/// LiDARs of one bind and port share a socket: whose datagram is it?
bool share_datagrams(const LidarConfig& a, const LidarConfig& b) {
  const bool same_source = a.source == b.source || a.source.empty() || b.source.empty();
  return common_port(a, b) != 0 && a.bind == b.bind && same_source;
}

/// A group does not arrive at a bound address, so that its socket has to be open for every address.
bool listens_everywhere(const LidarConfig& lidar) {
  return lidar.bind == "0.0.0.0" || !lidar.multicast.empty();
}

/// Two sockets of which the second cannot be opened.
bool exclude_each_other(const LidarConfig& a, const LidarConfig& b) {
  return common_port(a, b) != 0 && a.bind != b.bind && (listens_everywhere(a) || listens_everywhere(b));
}

void check_lidars(const std::vector<LidarConfig>& lidars, Broken& broken) {
  for (std::size_t i = 0; i < lidars.size(); ++i) {
    const std::string section = "lidar." + std::to_string(i);
    const LidarConfig& lidar = lidars[i];
    if (lidar.min_range >= lidar.max_range) {
      broken.push_back({{section + ".min_range", section + ".max_range"},
                        "is " + number_text(lidar.min_range) + ", not below max_range = " +
                            number_text(lidar.max_range) + "; min_range must be less than max_range"});
    }
    for (std::size_t j = 0; j < i; ++j) {
      const std::string other = "lidar." + std::to_string(j);
      if (lidar.name == lidars[j].name) {
        broken.push_back(
            {{section + ".name", other + ".name"},
             "is \"" + lidar.name + "\", the name of another LiDAR too; give each a name of its own"});
      }
      const std::vector<std::string> keys{
          section + ".port", section,         section + ".source",    section + ".bind",   other + ".port",
          other + ".source", other + ".bind", section + ".multicast", other + ".multicast"};
      const std::string taken = "is " + std::to_string(common_port(lidar, lidars[j])) + ", where LiDAR \"" +
                                lidars[j].name + "\" listens too";
      if (share_datagrams(lidar, lidars[j])) {
        broken.push_back({keys, taken + "; give each a port of its own, or a `source` to each of them"});
      }
      if (exclude_each_other(lidar, lidars[j])) {
        broken.push_back({keys, taken + ", and one of them needs it on every address (`bind` 0.0.0.0 or "
                                        "`multicast`); give each a port of its own, or the same `bind` and a "
                                        "`source` to each of them"});
      }
    }
  }
}

/// What a model cannot do.
void check_models(const Config& config, std::span<const LidarModel> models, Broken& broken) {
  for (std::size_t i = 0; i < config.lidars.size(); ++i) {
    const LidarConfig& lidar = config.lidars[i];
    const auto model = std::ranges::find(models, lidar.model, &LidarModel::name);
    if (model == models.end()) {
      continue;
    }
    const std::string section = "lidar." + std::to_string(i);
    if (i == 0 && !model->rotates && config.framing.framing == Framing::revolution) {
      broken.push_back({{"tracking.framing", section + ".model"},
                        "is \"revolution\", but the first LiDAR, a " + lidar.model +
                            ", does not rotate; it must be \"period\""});
    }
    if (model->information_port == 0 && lidar.information_port != 0) {
      broken.push_back({{section + ".information_port", section + ".model"},
                        "is " + std::to_string(lidar.information_port) + ", but a " + lidar.model +
                            " tells nothing about itself; leave it out"});
    }
  }
}

void check_health(const HealthConfig& health, Broken& broken) {
  const auto check = [&](const std::string& healthy, double most, const std::string& lost, double above) {
    if (most > above) {
      broken.push_back({{"health." + healthy, "health." + lost},
                        "is " + number_text(most) + ", above " + lost + " = " + number_text(above) +
                            "; it must be at most " + lost});
    }
  };
  check("q1_ratio_healthy", health.q1_ratio_healthy, "q1_ratio_lost", health.q1_ratio_lost);
  if (health.q1_healthy && health.q1_lost) {
    check("q1_healthy", *health.q1_healthy, "q1_lost", *health.q1_lost);
  }
}

}  // namespace

std::vector<BrokenRule> check_cross_rules(const Config& config, std::span<const LidarModel> models) {
  Broken broken;
  check_plc(config.plc, broken);
  check_lidars(config.lidars, broken);
  check_models(config, models, broken);
  check_health(config.tracker.health, broken);
  return broken;
}

}  // namespace hulltrack
