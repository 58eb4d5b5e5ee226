#include "tests/integration/service/loader_bench.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace hulltrack {

CyclingPlc::CyclingPlc(std::uint16_t port)
    : server_([port] {
        sim::PlcServerConfig config;
        config.port = port;
        return config;
      }()) {
  server_.on_write([this](const sim::PlcWriteRecord& record) {
    const std::lock_guard lock(mutex_);
    blocks_.push_back(record.block);
    written_.notify_all();
  });
  server_.set_joints(0.0, 0.0, 0.0);
  cycle_ = std::jthread([this](const std::stop_token& stop) {
    auto due = std::chrono::steady_clock::now();
    while (!stop.stop_requested()) {
      server_.set_joints(0.0, 0.0, 0.0);
      due += std::chrono::milliseconds(10);
      std::this_thread::sleep_until(due);
    }
  });
}

std::optional<WriteBlock> CyclingPlc::wait_for(const std::function<bool(const WriteBlock&)>& law) {
  return wait_for(law, blocks().size());
}

std::optional<WriteBlock> CyclingPlc::wait_for(const std::function<bool(const WriteBlock&)>& law,
                                               std::size_t seen) {
  std::unique_lock lock(mutex_);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  for (;;) {
    for (; seen < blocks_.size(); ++seen) {
      if (law(blocks_[seen])) {
        return blocks_[seen];
      }
    }
    if (written_.wait_until(lock, deadline) == std::cv_status::timeout) {
      return std::nullopt;
    }
  }
}

std::vector<WriteBlock> CyclingPlc::blocks() const {
  const std::lock_guard lock(mutex_);
  return blocks_;
}

void judge_missing_health(const CyclingPlc& plc) {
  const std::vector<WriteBlock> blocks = plc.blocks();
  ASSERT_TRUE(std::any_of(blocks.begin(), blocks.end(), [](const WriteBlock& block) {
    return (block.faults & fault::frame_dropped) != 0;
  })) << "no health within a minute";
  GTEST_SKIP() << "this machine is too slow for a live run: scans were left out";
}

Prepared room_service(std::uint16_t lidar_port, std::uint16_t plc_port) {
  Prepared prepared;
  Config& config = prepared.config;
  config.plc.host = "127.0.0.1";
  config.plc.port = plc_port;
  LidarConfig lidar;
  lidar.model = RoomLidar::kModel;
  lidar.bind = "127.0.0.1";
  lidar.port = lidar_port;
  lidar.source = "127.0.0.1";
  lidar.mount = RoomLidar::mount();
  config.lidars = {lidar};
  prepared.map = std::make_shared<const HullMap>(RoomLidar::map());
  return prepared;
}

}  // namespace hulltrack
