// How does one LiDAR stand? Judges the drivers' counters: faults for the registers, words for the log.
//
// Each condition has one line when it begins and one when it ends, in words that say what it means and
// what to do. Thread rule: one owner (rx). `now` is handed in. Cost: a few comparisons.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>

#include "core/base/status.hpp"
#include "daemon/log/condition_log.hpp"
#include "lidar_drivers/lidar_config.hpp"
#include "lidar_drivers/scan_builder.hpp"

namespace hulltrack {

/// What the drivers know of one LiDAR now. Counters run from the start.
struct LidarCounters {
  LidarStatus status;
  std::string last_rejection;          // as ScanBuilder::last_rejection()
  std::string two_senders;             // as ScanBuilder::two_senders()
  std::uint64_t foreign = 0;           // datagrams of the socket from unknown senders
  std::string last_foreign;            // "10.0.0.7:5000"
  std::uint64_t kernel_overflows = 0;  // of the socket
  std::uint64_t filtered = 0;          // datagrams that a packet filter kept from the socket
};

class LidarWatch {
 public:
  /// `expected_rpm`: what a rotor that makes one turn a frame does. `log` must outlive this object.
  LidarWatch(const LidarConfig& config, double expected_rpm, LogSink& log, SteadyTime start);

  /// Standing faults: lidar_silent, clock, foreign_packets while nobody can say which of two sensors is
  /// meant. Call it some times a second.
  Faults update(const LidarCounters& counters, SteadyTime now);

  [[nodiscard]] bool silent() const { return silent_; }

 private:
  /// An entry and an exit line of `log`, both in this LiDAR's name.
  template <std::invocable Entry>
  void tell(ConditionLog& log, bool active, SteadyTime now, Entry&& entry, const char* end);

  void update_silence(const LidarCounters& counters, SteadyTime now);
  void update_refused(const LidarCounters& counters, SteadyTime now);
  void update_quality(const LidarCounters& counters, SteadyTime now);

  LidarConfig config_;
  std::string name_;  // "LiDAR boom"
  double expected_rpm_;
  SteadyTime start_;
  bool silent_ = false;
  RecentGrowth foreign_grows_, rejected_grows_, held_back_grows_, overflow_grows_, mode_changes_,
      another_grows_, filtered_grows_;
  ConditionLog silence_log_, foreign_log_, rejected_log_, held_back_log_, overflow_log_, loss_log_, rate_log_,
      mode_log_, sector_log_, clock_log_, another_log_, filtered_log_;
};

}  // namespace hulltrack
