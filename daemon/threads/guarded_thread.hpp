// A thread whose exceptions end the service in order instead of ending the process.
//
// The body runs until its stop token asks it to return. An exception that escapes it is caught and told
// to `on_failure` in that thread; the destructor asks to stop and joins. Whoever owns the thread must
// wake it (a Doorbell) if it may be waiting: `on_stop` is called for that.
// Thread rule: owned and destroyed by one thread.
#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <thread>

namespace hulltrack {

class GuardedThread {
 public:
  using Body = std::function<void(std::stop_token)>;
  /// Told the thread's name and what was thrown. Must not throw.
  using OnFailure = std::function<void(const std::string& thread, const std::string& what)>;

  /// `name`: at most 15 characters, as the kernel shows it.
  GuardedThread(std::string name, Body body, OnFailure on_failure, std::function<void()> on_stop = {});
  ~GuardedThread();
  GuardedThread(const GuardedThread&) = delete;
  GuardedThread& operator=(const GuardedThread&) = delete;

  /// Asks the body to return and waits until it has. May be called more than once.
  void stop();

 private:
  std::function<void()> on_stop_;
  std::jthread thread_;
};

}  // namespace hulltrack
