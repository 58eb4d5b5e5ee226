// The signals that steer the service, as values that the main loop reads.
//
// Blocks SIGTERM, SIGINT and SIGHUP in the calling thread and all threads started later, and ignores
// SIGPIPE (a PLC that resets the link is an error code, not a death). Construct before any thread.
// Thread rule: the main thread. Throws std::system_error at construction if the kernel refuses.
#pragma once

namespace hulltrack {

enum class ServiceSignal { none, stop, reload };

class Signals {
 public:
  Signals();
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// Readable when a signal is pending: for poll(2).
  [[nodiscard]] int fd() const { return fd_; }
  /// The next pending signal, or none. Does not wait.
  [[nodiscard]] ServiceSignal next();

 private:
  int fd_;
};

}  // namespace hulltrack
