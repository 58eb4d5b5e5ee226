#include "daemon/simulator/run/recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "core/io/map_file.hpp"
#include "daemon/config/read_config.hpp"
#include "daemon/simulator/run/site_config.hpp"
#include "lidar_drivers/datagram_router.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/pcap_source.hpp"
#include "lidar_drivers/scan_builder.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

namespace fs = std::filesystem;

const char* const kFiles[] = {"lidar.pcap", "plc.csv",  "truth.csv",
                              "hull.pcd",   "quay.pcd", "hulltrackd.toml"};

class Recording : public testing::Test {
 protected:
  static std::unique_ptr<SimulatedBerth> berth(std::uint64_t seed, int frames) {
    return std::move(SimulatedBerth::create({.seed = seed, .frames = frames})).value();
  }
  static bool on(double) { return true; }

  const test::TempFolder temp_;
  const fs::path& folder_ = temp_.path();
};

TEST_F(Recording, SameSeedSameBytesAndItsReplayHasItsFrames) {
  constexpr int kFrames = 6;
  const fs::path one = folder_ / "one";
  const fs::path two = folder_ / "two";
  ASSERT_TRUE(write_recording(*berth(21, kFrames), one, false, on).ok());
  ASSERT_TRUE(write_recording(*berth(21, kFrames), two, false, on).ok());
  for (const char* name : kFiles) {
    EXPECT_FALSE(test::read_text(one / name).empty()) << name;
    EXPECT_TRUE(test::read_text(one / name) == test::read_text(two / name)) << name << " differs";
  }

  const ConfigReading reading = read_config(one / "hulltrackd.toml", lidar_models());
  ASSERT_TRUE(reading.problems.empty()) << reading.problems.front().message;
  const Config& config = *reading.config;
  EXPECT_TRUE(read_map_file(config.map_file).ok());
  ASSERT_TRUE(read_plc_csv(one / "plc.csv").ok());

  auto source = PcapSource::open(one / "lidar.pcap");
  ASSERT_TRUE(source.ok()) << source.error().message;
  auto builder = ScanBuilder::create(config.lidars, config.framing);
  ASSERT_TRUE(builder.ok());
  std::vector<std::uint32_t> frames;
  Scan scan;
  const auto collect = [&] {
    while (builder->take(scan)) frames.push_back(scan.frame_number);
  };
  Datagram datagram;
  for (auto more = source->next(datagram); more.ok() && *more; more = source->next(datagram)) {
    builder->add(0, datagram);
    collect();
  }
  builder->finish();
  collect();
  EXPECT_EQ(frames, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
}

TEST_F(Recording, ConfigurationSaysWhatTheSimulationIs) {
  for (const SensorTraits& sensor : simulated_sensors()) {
    const auto simulated =
        std::move(SimulatedBerth::create({.lidar_models = {std::string(sensor.model)}, .frames = 1})).value();
    const std::string text =
        site_config(*simulated, {.plc_host = "127.0.0.1", .plc_port = 1234, .lidar_port = 2999});
    const ConfigReading reading = parse_config(text, folder_ / "hulltrackd.toml", lidar_models());
    ASSERT_TRUE(reading.problems.empty()) << reading.problems.front().message;
    const Config& config = *reading.config;
    EXPECT_EQ(config.plc.port, 1234);
    EXPECT_NEAR(to_seconds(config.plc.latency), simulated->plc_model().mean_latency(), 1e-9);
    ASSERT_EQ(config.lidars.size(), 1U);
    EXPECT_EQ(config.lidars[0].port, 2999);
    EXPECT_TRUE(config.lidars[0].mount.isApprox(simulated->lidars()[0].mount(), 1e-9));
    EXPECT_EQ(config.lidars[0].exclude, simulated->lidar_config(0).exclude);
    EXPECT_TRUE(
        config.tracker.hull.reference_point.isApprox(simulated->hull_config().reference_point, 1e-12));
    EXPECT_EQ(config.tracker.hull.envelope.min, simulated->hull_config().envelope.min);
    EXPECT_EQ(config.tracker.hull.envelope.max, simulated->hull_config().envelope.max);
    EXPECT_EQ(config.tracker.registration.method, RegistrationConfig{}.method);
  }
}

TEST_F(Recording, ConfigurationSaysWhatIsKnownOfTheQuay) {
  const auto text_of = [](bool with_map) {
    return site_config(
        *std::move(SimulatedBerth::create({.frames = 1, .configure_quay_map = with_map})).value(), {});
  };
  for (const char* line : {"[quay]", "height = -0.150\n", "slope = [0.029, 0.573]"}) {
    EXPECT_NE(text_of(true).find(line), std::string::npos) << line;
    EXPECT_NE(text_of(false).find(line), std::string::npos) << line;
  }
  EXPECT_NE(text_of(true).find("map = \"quay.pcd\"\n"), std::string::npos);
  EXPECT_EQ(text_of(false).find("quay.pcd"), std::string::npos);
}

/// Two sensors as delivered send to the same port; only their addresses tell them apart.
TEST_F(Recording, TwoLidarsOfOneModelAreToldApart) {
  const auto simulated =
      std::move(SimulatedBerth::create({.lidar_models = {"ouster_os", "ouster_os"}, .frames = 1})).value();
  ASSERT_TRUE(write_recording(*simulated, folder_ / "rec", false, [](double) { return true; }));
  const ConfigReading reading = read_config(folder_ / "rec" / "hulltrackd.toml", lidar_models());
  ASSERT_TRUE(reading.problems.empty()) << reading.problems.front().message;
  const std::vector<LidarConfig>& lidars = reading.config->lidars;
  ASSERT_EQ(lidars.size(), 2U);
  EXPECT_NE(lidars[0].calibration, lidars[1].calibration);
  const auto router = DatagramRouter::create(lidars);
  ASSERT_TRUE(router.ok());
  auto source = PcapSource::open(folder_ / "rec" / "lidar.pcap");
  ASSERT_TRUE(source.ok());
  std::array<std::uint64_t, 2> packets{};
  Datagram datagram;
  for (auto more = source->next(datagram); more.ok() && *more; more = source->next(datagram)) {
    const auto lidar = router->lidar_of(datagram);
    ASSERT_TRUE(lidar);
    EXPECT_EQ(simulated->lidars()[*lidar].packet(packets[*lidar]),
              SimulatedBerth::Packet(datagram.bytes.begin(), datagram.bytes.end()));
    ++packets[*lidar];
  }
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(packets[i], simulated->lidars()[i].packets());
}

TEST_F(Recording, TruthRowsHoldEveryFrameMiddle) {
  const auto simulated = berth(3, 20);
  const std::vector<TruthRow> rows = recorded_truth(*simulated);
  for (int frame = 0; frame < 20; ++frame) {
    const Nanoseconds middle = frame * SimulatedBerth::kFramePeriod + SimulatedBerth::kFramePeriod / 2;
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const TruthRow& r) {
      return r.t_ns == to_ns(SimulatedBerth::kEpoch + middle);
    });
    ASSERT_NE(row, rows.end());
    EXPECT_EQ(row->xyz, simulated->truth(middle).displacement);
  }
}

TEST_F(Recording, InterruptedRunLeavesNothing) {
  const fs::path out = folder_ / "out";
  const auto done = write_recording(*berth(1, 60), out, false, [](double share) { return share < 0.1; });
  EXPECT_FALSE(done.ok());
  EXPECT_TRUE(fs::is_empty(out));
}

TEST_F(Recording, AFolderThatHoldsSomethingIsKept) {
  temp_.file("precious.txt", "keep");
  const auto done = write_recording(*berth(1, 1), folder_, false, on);
  ASSERT_FALSE(done.ok());
  EXPECT_NE(done.error().message.find("--force"), std::string::npos);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

}  // namespace
}  // namespace hulltrack
