// tests/support/pymodbus_plc.py as a child process: a PLC whose code shares nothing with ours.
//
// The process listens when the constructor returns and ends with the object (its standard input closes).
// Failure: started() is false, with Python's own words on standard error. Thread rule: one thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sys/types.h>

namespace hulltrack {

class PymodbusPeer {
 public:
  /// `arguments` of the script, see its --help; the log of writes goes to read_line().
  explicit PymodbusPeer(std::vector<std::string> arguments);
  ~PymodbusPeer();
  PymodbusPeer(const PymodbusPeer&) = delete;
  PymodbusPeer& operator=(const PymodbusPeer&) = delete;

  [[nodiscard]] bool started() const { return port_ != 0; }
  [[nodiscard]] std::uint16_t port() const { return port_; }

  /// One line to the script, such as "command 2".
  void send_line(const std::string& line);
  /// The next line of its standard output; waits for it, empty when the process has ended.
  [[nodiscard]] std::string read_line();

 private:
  pid_t pid_ = -1;
  int to_child_ = -1;
  int from_child_ = -1;
  std::string buffered_;
  std::uint16_t port_ = 0;
};

}  // namespace hulltrack
