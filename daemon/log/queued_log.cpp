#include "daemon/log/queued_log.hpp"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <utility>

namespace hulltrack {

struct QueuedLog::Shared {
  struct Line {
    LogLevel level;
    std::string text;
  };
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Line> lines;
  std::size_t capacity = 0;
  std::size_t dropped = 0;   // since the start
  std::size_t reported = 0;  // of these, told in the log
  bool writing = false;
  bool closing = false;
  bool finished = false;
  SlowWriter writer;
};

QueuedLog::QueuedLog(SlowWriter writer, std::size_t capacity, Nanoseconds patience)
    : shared_(std::make_shared<Shared>()), patience_(patience) {
  shared_->writer = std::move(writer);
  shared_->capacity = capacity;
  thread_ = std::thread(&QueuedLog::drain, shared_);
}

QueuedLog::~QueuedLog() {
  std::unique_lock lock(shared_->mutex);
  shared_->closing = true;
  shared_->changed.notify_all();
  const bool finished = shared_->changed.wait_for(lock, patience_, [this] { return shared_->finished; });
  lock.unlock();
  if (finished) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

void QueuedLog::write(LogLevel level, std::string_view line) {
  {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->lines.size() >= shared_->capacity) {
      ++shared_->dropped;
      return;
    }
    shared_->lines.push_back({level, std::string(line)});
  }
  shared_->changed.notify_all();
}

void QueuedLog::flush() {
  std::unique_lock lock(shared_->mutex);
  shared_->changed.wait_for(lock, patience_, [this] { return shared_->lines.empty() && !shared_->writing; });
}

std::size_t QueuedLog::dropped() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->dropped;
}

void QueuedLog::drain(const std::shared_ptr<Shared>& shared) {
  std::unique_lock lock(shared->mutex);
  while (true) {
    shared->changed.wait(lock, [&] { return shared->closing || !shared->lines.empty(); });
    if (shared->lines.empty()) {
      break;
    }
    const Shared::Line line = std::move(shared->lines.front());
    shared->lines.pop_front();
    const std::size_t lost = shared->dropped - shared->reported;
    shared->reported = shared->dropped;
    shared->writing = true;
    lock.unlock();
    shared->writer(line.level, line.text);
    if (lost > 0) {
      shared->writer(
          LogLevel::warning,
          std::to_string(lost) + " log lines were dropped because the system log did not take them");
    }
    lock.lock();
    shared->writing = false;
    shared->changed.notify_all();
  }
  shared->finished = true;
  shared->changed.notify_all();
}

}  // namespace hulltrack
