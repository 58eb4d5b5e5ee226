// Why was health 0? The reasons of a run, and how often each was given.
//
// Reasons that differ in their figures alone are of one kind; a kind is shown by the words of its first
// frame. Thread rule: a plain value. Cost: the words of each kind once.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace hulltrack {

class ReasonTable {
 public:
  /// Of a frame with health 0. Frames in their order.
  void add(std::uint32_t frame, const std::string& reason);

  /// A line a kind for the terminal, the most frequent first, with its share of all `frames` and its first
  /// one; empty if no frame was added.
  [[nodiscard]] std::string text(std::size_t frames) const;

 private:
  struct Kind {
    std::size_t count = 0;
    std::uint32_t first_frame = 0;
    std::string first_words;
  };
  std::map<std::string, Kind> kinds_;  // by the words without their figures
};

}  // namespace hulltrack
