#include "daemon/simulator/run/packets_ahead.hpp"

#include <utility>

namespace hulltrack {

PacketsAhead::PacketsAhead(const SimulatedBerth& berth)
    : berth_(&berth), thread_([this](const std::stop_token& stop) { cast_all(stop); }) {}

void PacketsAhead::cast_all(const std::stop_token& stop) {
  std::exception_ptr failure;
  try {
    Departures departures(*berth_);
    while (const auto departure = departures.next()) {
      Ready packet{*departure, bytes_of(*berth_, *departure)};
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [&] { return ready_.size() < kReady; })) return;
      ready_.push_back(std::move(packet));
      changed_.notify_all();
    }
  } catch (...) {
    failure = std::current_exception();
  }
  const std::scoped_lock lock(mutex_);
  failure_ = failure;
  finished_ = true;
  changed_.notify_all();
}

void PacketsAhead::wait_ready(std::size_t count) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return finished_ || ready_.size() >= count; });
}

std::optional<PacketsAhead::Ready> PacketsAhead::take() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return finished_ || !ready_.empty(); });
  if (ready_.empty()) {
    if (failure_) std::rethrow_exception(failure_);
    return std::nullopt;
  }
  Ready packet = std::move(ready_.front());
  ready_.pop_front();
  changed_.notify_all();
  return packet;
}

}  // namespace hulltrack
