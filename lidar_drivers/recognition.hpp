// Which LiDAR sends these datagrams? For the person with a sensor and no configuration.
//
// Every model of the registry that needs no file tries to decode what one sender sends; a model that needs
// one tells by the datagrams' shape (LidarModel::looks_like). What no decoder takes is of no known model.
// Bytes are untrusted. Thread rule: one owner. Memory: a scan builder a model, some MB; cost: a few
// microseconds a datagram, since most models refuse it by its size.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lidar_drivers/datagram.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/scan_builder.hpp"

namespace hulltrack {

/// What is known of one sender. Feed it all of its datagrams, of whatever port, in order of their stamps.
class Recognition {
 public:
  Recognition();

  void add(const Datagram& datagram);

  /// A model that fits, and what its decoder made of the datagrams.
  struct Candidate {
    const LidarModel* model = nullptr;
    std::uint64_t taken = 0;   // decoded, held back, or of its shape
    bool shape_alone = false;  // not decoded: a file is needed for that
    LidarStatus status;
  };
  /// Those that took the most datagrams, at least half of the busiest port's; more than one where the
  /// datagrams of several models are alike. Empty: none of the registry.
  [[nodiscard]] std::vector<Candidate> candidates() const;

  /// What went to one port.
  struct Traffic {
    std::uint16_t port = 0;
    std::uint64_t datagrams = 0;
    std::map<std::size_t, std::uint64_t> sizes;  // bytes -> datagrams, the first 16 sizes
  };
  [[nodiscard]] std::vector<Traffic> traffic() const;  // the most datagrams first

 private:
  struct Trial {
    const LidarModel* model;
    ScanBuilder builder;
    std::uint64_t taken = 0;
  };
  struct Shape {
    const LidarModel* model;
    std::uint64_t taken = 0;
  };
  std::vector<Trial> trials_;
  std::vector<Shape> shapes_;
  std::map<std::uint16_t, Traffic> ports_;
  Scan scan_;  // scratch
};

}  // namespace hulltrack
