#include "daemon/simulator/run/site_config.hpp"

#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "daemon/simulator/berth/loader_machine.hpp"
#include "daemon/simulator/berth/quay_ground.hpp"
#include "lidar_drivers/datagram_router.hpp"

namespace hulltrack {
namespace {

/// printf into the text; a line of a configuration is short.
[[gnu::format(printf, 2, 3)]] void put(std::string& text, const char* format, ...) {
  char line[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  text += line;
}

/// { xyz = [...], rpy_deg = [...] } to 1 mm and 0.001 deg.
void put_pose(std::string& text, const char* key, const Pose& T) {
  const Eigen::Vector3d xyz = T.translation();
  const Eigen::Vector3d rpy =
      rpy_from_rotation(T.linear()).unaryExpr([](double r) { return degrees(r) + 0.0; });
  put(text, "%s = { xyz = [%.3f, %.3f, %.3f], rpy_deg = [%.3f, %.3f, %.3f] }\n", key, xyz.x(), xyz.y(),
      xyz.z(), rpy.x(), rpy.y(), rpy.z());
}

void put_plc(std::string& text, const SiteAddresses& addresses, const PlcModel& plc) {
  put(text, "[plc]\nhost = \"%s\"\nport = %u\n", addresses.plc_host.c_str(), unsigned{addresses.plc_port});
  put(text, "latency_ms = %.1f   # encoder delay %.0f ms plus half of the PLC's cycle of %.0f ms",
      plc.mean_latency() * 1e3, PlcModel::kEncoderDelay * 1e3, PlcModel::kCycle * 1e3);
  if (plc.gateway().delay > 0.0) put(text, " plus the gateway's %.1f ms", plc.gateway().delay * 1e3);
  text += "\n\n";
}

void put_machine(std::string& text) {
  const MachineConfig machine = loader_machine();
  text += "[machine]   # slewing axis 8 m behind the quay's edge; luffing axis 20.5 m above the rails\n";
  put_pose(text, "slew", machine.slew);
  put_pose(text, "luff", machine.luff);
  text += "\n";
}

void put_lidar(std::string& text, const LidarConfig& lidar, const char* remark) {
  put(text, "[[lidar]]\nname = \"%s\"\nmodel = \"%s\"\nport = %u\n", lidar.name.c_str(), lidar.model.c_str(),
      unsigned{lidar.port});
  if (lidar.information_port != 0) put(text, "information_port = %u\n", unsigned{lidar.information_port});
  if (!lidar.source.empty()) put(text, "source = \"%s\"\n", lidar.source.c_str());
  if (!lidar.calibration.empty()) put(text, "calibration = \"%s\"\n", lidar.calibration.c_str());
  text += remark;
  put_pose(text, "mount", lidar.mount);
  put(text, "min_range = %.1f\nmax_range = %.1f\n", lidar.min_range, lidar.max_range);
  text += "# Boom and chute, in slices that stay slim when turned into the LiDAR's axes.\nexclude = [\n";
  for (const auto& box : lidar.exclude)
    put(text, "  [%.1f, %.1f, %.1f, %.1f, %.1f, %.1f],\n", box[0], box[1], box[2], box[3], box[4], box[5]);
  text += "]\n\n";
}

constexpr std::array kBracketRemarks = {
    "# Beside the chute's head. The fan hangs down, askew to the ship, so that decks, coaming sides and\n"
    "# coaming ends are in view at every slew angle.\n",
    "# On the chute's other side; its fan crosses the first one's.\n"};

/// LiDAR `lidar` where `addresses` say.
LidarConfig reachable(const SimulatedBerth& berth, std::size_t lidar, const SiteAddresses& addresses) {
  LidarConfig config = berth.lidar_config(lidar);
  if (addresses.lidar_port == 0) {
    if (berth.lidars().size() > 1) config.source = format_ipv4(recorded_address(lidar));
    return config;
  }
  config.port = static_cast<std::uint16_t>(addresses.lidar_port + lidar);
  if (config.information_port != 0) config.information_port = config.port;
  return config;
}

void put_box(std::string& text, const char* key, const Box& box, const char* remark) {
  const auto m = [](float v) { return static_cast<double>(v); };
  put(text, "%s = [%.1f, %.1f, %.1f, %.1f, %.1f, %.1f]%s\n", key, m(box.min.x()), m(box.min.y()),
      m(box.min.z()), m(box.max.x()), m(box.max.y()), m(box.max.z()), remark);
}

void put_hull(std::string& text, const HullConfig& hull) {
  const Eigen::Vector3d& p = hull.reference_point;
  text += "[hull]\nmap = \"hull.pcd\"\n";
  put(text,
      "reference_point = [%.3f, %.3f, %.3f]   # hatch 2, coaming top, forward corner on the quay side\n",
      p.x(), p.y(), p.z());
  put_box(text, "region", *hull.region, "   # from the quay's edge outward");
  text +=
      "# Nobody moors her farther along the quay than half a hatch pitch from her place in the map; the "
      "fenders\n"
      "# and her lines leave her 2 m; high water lifts her by 3 m, cargo and low water sink her by 9 m.\n";
  put_box(text, "envelope", hull.envelope, "");
  text += "\n";
}

void put_quay(std::string& text, bool with_map) {
  const auto slope_deg = [](float slope) { return degrees(std::atan(static_cast<double>(slope))); };
  text += "[quay]   # what stands still: z = height + tan(slope[0]) * x + tan(slope[1]) * y is its top\n";
  put(text, "height = %.3f\n", static_cast<double>(kQuayHeight));
  put(text, "slope = [%.3f, %.3f]   # deg; falls 1 %% from the edge to the gutter 28 m behind it\n",
      slope_deg(kQuaySlopeX), slope_deg(kQuaySlopeY));
  if (with_map) text += "map = \"quay.pcd\"\n";
}

}  // namespace

std::string site_config(const SimulatedBerth& berth, const SiteAddresses& addresses) {
  std::string models;
  for (const SimulatedLidar& lidar : berth.lidars())
    models += (models.empty() ? "" : " and ") + std::string(lidar.sensor().model);
  std::string text;
  put(text, "# Simulated berth: scenario %s, %s, seed %llu.\n", std::string(berth.scenario().name).c_str(),
      models.c_str(), static_cast<unsigned long long>(berth.options().seed));
  text +=
      "# Written by `hulltrack simulate`; keys that are not here have their defaults, see "
      "hulltrackd.toml(5).\n\n";
  put_plc(text, addresses, berth.plc_model());
  put_machine(text);
  for (std::size_t i = 0; i < berth.lidars().size(); ++i)
    put_lidar(text, reachable(berth, i, addresses), kBracketRemarks[i]);
  put_hull(text, berth.hull_config());
  put_quay(text, berth.options().configure_quay_map);
  return text;
}

}  // namespace hulltrack
