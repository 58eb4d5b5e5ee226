// Clouds that nobody would call a ship, from bytes: what a map file may hold, all of it legal.
//
// The bytes are a list of things to add: single points of any bits, decks, lines, open boxes and boxes within
// boxes, lattices in whole centimetres, points kilometres away, the same point again and again, all so far
// once more beside. The same bytes give the same cloud. Never empty; points finite and within 10 km, as io
// lets them through. Metres.
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "core/geometry/cloud.hpp"

namespace hulltrack::test {

/// At most `most` points (> 0).
[[nodiscard]] Cloud any_cloud(std::span<const std::uint8_t> bytes, std::size_t most);

/// Bytes for any_cloud() that mean some `things` things.
[[nodiscard]] std::vector<std::uint8_t> any_bytes(std::mt19937& random, std::size_t things);

/// Builds the map of a cloud as a service does, stray points left out and both judges asked, and asks once
/// all that a tracker asks. Throws std::logic_error where an answer is no answer.
void use_as_map(Cloud cloud);

}  // namespace hulltrack::test
