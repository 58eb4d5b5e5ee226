// One Hesai datagram through the decoder that the model registry makes, angles as designed.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "lidar_drivers/model_registry.hpp"
#include "tests/support/hesai_bytes.hpp"

namespace hulltrack::test {

inline std::unique_ptr<Decoder> hesai_decoder(const HesaiModel& model, const DecoderOptions& options = {}) {
  return std::move(make_lidar_decoder(*find_lidar_model(model.name), options, {})).value();
}

inline DecodedPacket decode(const HesaiModel& model, const HesaiBytes& bytes,
                            const DecoderOptions& options = {}) {
  DecodedPacket packet;
  const auto decoder = hesai_decoder(model, options);
  EXPECT_EQ(decoder->explain(decoder->decode(bytes, packet)), "ok");
  return packet;
}

/// What the log says of it; "ok" if it was decoded.
inline std::string refusal(const HesaiModel& model, const HesaiBytes& bytes) {
  DecodedPacket packet;
  const auto decoder = hesai_decoder(model);
  return decoder->explain(decoder->decode(bytes, packet));
}

}  // namespace hulltrack::test
