#include "daemon/service/progress_log.hpp"

#include "core/base/text.hpp"

namespace hulltrack {

void ProgressLog::update(const std::vector<ThreadWatch::Overdue>& overdue, SteadyTime now) {
  for (auto& [name, thread] : threads_) {
    thread.overdue = false;
  }
  for (const ThreadWatch::Overdue& late : overdue) {
    Thread& thread = threads_.try_emplace(late.thread, ConditionLog(sink_, LogLevel::error)).first->second;
    thread.overdue = true;
    thread.silence = late.silence;
  }
  for (auto& [name, thread] : threads_) {
    thread.log.update(
        thread.overdue, now,
        [&] {
          return format_text("thread %s has made no progress for %.1f s, so the watchdog is not fed; %s",
                             name.c_str(), to_seconds(thread.silence), consequence().c_str());
        },
        [&](Nanoseconds) {
          return format_text("thread %s makes progress again after %.1f s", name.c_str(),
                             to_seconds(thread.silence));
        });
  }
}

std::string ProgressLog::consequence() const {
  if (!watchdog_timeout_) {
    return "no watchdog is set, so nobody restarts the service. Is this computer overloaded?";
  }
  return format_text(
      "if it stays so, systemd restarts the service %.1f s after the last feeding (WatchdogSec=). Is this "
      "computer overloaded?",
      to_seconds(*watchdog_timeout_));
}

}  // namespace hulltrack
