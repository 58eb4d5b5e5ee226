// From a configuration file to everything that a session runs on, without ever waiting.
//
// The reader (reader_process.hpp) reads and judges the files; this side takes the very bytes that were
// judged, never the files, and makes the map of them in a thread of its own. [plc] is known long before the
// map. Whatever the files do to the reader is a problem at the line that names them. Thread rule: the main
// thread; see ReaderProcess. A map in the making cannot be interrupted: when this object goes, its thread is
// left to itself, and the process must then end without destroying what the thread uses
// (maps_in_the_making()). Failure: the constructor throws when no reader can be started; else problems.
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/map/hull_map.hpp"
#include "core/quay/quay_map.hpp"
#include "daemon/config/read_config.hpp"
#include "daemon/service/reader_process.hpp"

namespace hulltrack {

/// What a configuration file comes to, ready to run.
struct Prepared {
  Config config;
  std::shared_ptr<const HullMap> map;
  std::shared_ptr<const QuayMap> quay;  // nullptr = none is configured
  std::string map_remark;      // what to know of a map that can be used all the same; empty = nothing
  std::size_t map_points = 0;  // as read
  /// What `calibration` of the LiDARs names; they live as long as this.
  std::vector<std::shared_ptr<const MemoryFile>> calibrations = {};
};

struct Preparation {
  std::optional<Prepared> prepared;  // present if and only if problems is empty
  std::vector<Problem> problems;     // of the configuration, the calibrations and the map
  bool may_pass = false;             // another try may succeed with the same files
};

class Preparer {
 public:
  enum class Goal {
    check,  // without the map: it has been made once already, by the reader
    run,
  };

  Preparer(std::filesystem::path config_file, const ReaderSetup& setup, Goal goal, SteadyTime now);

  /// Readable when step() can go on; -1 while only time helps.
  [[nodiscard]] int fd() const { return reader_ ? reader_->fd() : -1; }
  /// Call it some times a second.
  void step(SteadyTime now);

  /// As soon as the configuration has been read, whatever problems it has.
  [[nodiscard]] const std::optional<ConfigReading>& configuration() const { return configuration_; }
  /// Once all is done.
  [[nodiscard]] std::optional<Preparation>& result() { return result_; }

  /// Threads in this process that make a map, for whomever.
  [[nodiscard]] static int maps_in_the_making();

 private:
  void read_configuration();
  void reader_ended();
  [[nodiscard]] Problem problem_of_reader() const;
  void refuse(Problem problem, bool may_pass = false);

  std::filesystem::path config_file_;
  Goal goal_;
  std::optional<ReaderProcess> reader_;
  std::optional<ConfigReading> configuration_;
  std::future<Preparation> making_;
  std::optional<Preparation> result_;
};

}  // namespace hulltrack
