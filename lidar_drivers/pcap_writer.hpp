// UDP datagrams to a capture file that any capture tool opens: pcap with nanosecond stamps,
// Ethernet/IPv4/UDP.
//
// Buffered; every failure (disk full, say) is reported by the call that met it, and again by every later
// call. Thread rule: one owner. Cost: one copy of the datagram.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>

#include "core/base/result.hpp"
#include "core/base/time.hpp"

namespace hulltrack {

/// Addresses in host byte order.
struct UdpEndpoints {
  std::uint32_t source_ip = 0;
  std::uint16_t source_port = 0;
  std::uint32_t destination_ip = 0;
  std::uint16_t destination_port = 0;
};

class PcapWriter {
 public:
  /// Replaces a file of that name.
  [[nodiscard]] static Result<PcapWriter> create(const std::filesystem::path& path);

  /// One record. `payload` up to 65,507 bytes, `stamp` (UTC) from 1970 to 2106; anything else is an error.
  [[nodiscard]] Result<void> write(MeasurementTime stamp, const UdpEndpoints& endpoints,
                                   std::span<const std::uint8_t> payload);

  /// Everything to the file system. Call it: the destructor closes too, but cannot say that it failed.
  [[nodiscard]] Result<void> close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  PcapWriter(std::unique_ptr<std::FILE, Close> file, std::filesystem::path path)
      : file_(std::move(file)), path_(std::move(path)) {}
  [[nodiscard]] Error failure();

  std::unique_ptr<std::FILE, Close> file_;
  std::filesystem::path path_;
  int error_ = 0;  // errno of the first failure
};

}  // namespace hulltrack
