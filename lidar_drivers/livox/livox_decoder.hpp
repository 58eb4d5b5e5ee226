// Livox Mid-360, HAP and Avia: one point datagram -> points in L.
//
// L is the device's own Cartesian frame: x forward, y left, z up. Nothing turns; nothing is known of a shot's
// angle but where its return lies. (0, 0, 0) is a shot without a return, or one that the sensor's own field
// of view leaves out. Shots are spread evenly from the header's time stamp on. Generation 2 gives the time
// from the first to the last shot (Mid-360: 475.0 us for 96 shots 5 us apart); generation 1 gives none, its
// rate is the model's. Shot i is fired by laser i mod the number of lasers. Tags, bits 0-1, by a return's
// place: 1 high, 2 moderate, 3 low confidence level of noise (HAP user manual, "Point Cloud Data"; Avia by
// the manuals of its generation). HAP and Avia: 1 is dropped. Weaker doubt, and the doubt for a weak return
// (bits 2-3), which wet or dark steel has too, is not acted on: kept. The Mid-360's manual grades how far a
// point is to be trusted and calls none noise for sure: all are kept. Of several echoes the farthest, be it
// beyond the sensor's range, is the last one, echo 0. Single return may be set to the strongest or the first,
// which the datagram does not tell: ReturnMode::unknown. Cost: some microseconds a datagram of 96 points.
#pragma once

#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/livox/livox_format.hpp"
#include "lidar_drivers/livox/livox_records.hpp"

namespace hulltrack::livox {

class LivoxDecoder final : public Decoder {
 public:
  /// `model` from models(): it must outlive the decoder.
  LivoxDecoder(const ModelTable& model, const DecoderOptions& options) : model_(model), options_(options) {}

  /// wrong_product: the protocol's version is another (expected, seen: first byte); wrong_layout: a data type
  /// that has no points here (seen: the type); bad_azimuth: an angle that cannot be (seen: 0.01 deg).
  [[nodiscard]] DecodeOutcome decode(std::span<const std::uint8_t> payload,
                                     DecodedPacket& out) const override;
  /// The IMU's datagrams, 200 a second from the factory, where a site gives points and IMU one port.
  bool inform(std::span<const std::uint8_t> payload) override;
  [[nodiscard]] std::string explain(const DecodeOutcome& outcome) const override;
  [[nodiscard]] Nanoseconds clock_wrap() const override { return Nanoseconds::zero(); }

 private:
  struct Header {
    const RecordKind* kind = nullptr;
    std::size_t records = 0;  // > 0
    Nanoseconds duration{};   // first to last shot
    std::uint64_t stamp = 0;  // ns, first shot
  };

  [[nodiscard]] DecodeOutcome read_header(std::span<const std::uint8_t> payload, Header& header) const;
  void tell_times(std::span<const std::uint8_t> payload, const Header& header, DecodedPacket& out) const;
  void emit(Echoes& echoes, const Header& header, std::size_t shot, DecodedPacket& out) const;

  const ModelTable& model_;
  DecoderOptions options_;
};

}  // namespace hulltrack::livox
