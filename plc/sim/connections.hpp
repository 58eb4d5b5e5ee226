// Who is connected to the simulated PLC, who may connect, and what is still to be sent to whom?
//
// Descriptors of a poll() made before generation() changed are void: they may be closed or another's.
// Failure: the constructor throws std::runtime_error (port in use); a client that has gone is noticed by
// the next poll(). Thread rule: external locking.
#pragma once

#include <poll.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "plc/sim/listener.hpp"
#include "plc/sim/modbus_protocol.hpp"

namespace hulltrack::sim {

class Connections {
 public:
  enum class Door {
    open,
    refused,    // connection refused
    black_hole  // a SYN gets no answer, and nobody who is connected is heard
  };

  /// Port 0 = any free one. The door is open when it returns.
  Connections(const std::string& ipv4, std::uint16_t port) : listener_(ipv4, port) {}
  ~Connections();
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  [[nodiscard]] std::uint16_t port() const { return listener_.port(); }
  void set_door(Door door);

  /// Adds the listener (-1, which poll() ignores, while the door is not open) and every client to be heard.
  void add_to(std::vector<pollfd>& waiting) const;
  [[nodiscard]] std::uint64_t generation() const { return generation_; }

  void accept();
  /// A connection is taken and closed at once.
  void accept_and_close();
  void drop(int fd);
  void reset(int fd);
  void reset_all();

  void send(int fd, const Bytes& bytes);
  void send_at(SteadyTime due, int fd, Bytes bytes);
  void hold_back(int fd, Bytes bytes);
  /// Sends what was held back for this client.
  void release(int fd);
  void send_due(SteadyTime now);
  /// For poll(): -1 when nothing waits.
  [[nodiscard]] int milliseconds_to_next_due(SteadyTime now) const;

  [[nodiscard]] std::uint64_t accepted() const { return accepted_; }
  [[nodiscard]] std::size_t open() const { return clients_.size(); }
  [[nodiscard]] std::size_t most_open() const { return most_open_; }

 private:
  struct Client {
    int fd;
    Bytes held_back;
  };
  struct Outgoing {
    SteadyTime due;
    int fd;
    Bytes bytes;
  };

  [[nodiscard]] int accept_descriptor();

  Listener listener_;
  Door door_ = Door::open;
  std::vector<Client> clients_;
  std::vector<Outgoing> outgoing_;
  std::uint64_t generation_ = 0;
  std::uint64_t accepted_ = 0;
  std::size_t most_open_ = 0;
};

}  // namespace hulltrack::sim
