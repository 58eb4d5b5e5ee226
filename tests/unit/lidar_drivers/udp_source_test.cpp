// The live receiver on loopback: stamps, senders, overflow, and errors that say what to do.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <limits>

#include "lidar_drivers/datagram_router.hpp"
#include "lidar_drivers/receive_clock.hpp"
#include "lidar_drivers/udp_source.hpp"

namespace hulltrack {
namespace {

using testing::HasSubstr;

LidarConfig loopback(const std::string& source = "") {
  LidarConfig config;
  config.bind = "127.0.0.1";
  config.port = 0;  // the kernel picks one
  config.source = source;
  return config;
}

/// Sends from 127.0.0.x, all of which are this host.
class Sender {
 public:
  explicit Sender(const char* address) : fd_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in local{};
    local.sin_family = AF_INET;
    inet_pton(AF_INET, address, &local.sin_addr);
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&local), sizeof local), 0);
  }
  ~Sender() { close(fd_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  void send(std::uint16_t port, const std::string& payload) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
    EXPECT_EQ(
        sendto(fd_, payload.data(), payload.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to),
        static_cast<ssize_t>(payload.size()));
  }

 private:
  int fd_;
};

/// All datagrams until `count` have been handed out or dropped.
std::vector<std::pair<std::string, Datagram>> receive(UdpSource& source, std::uint64_t count) {
  std::vector<std::pair<std::string, Datagram>> all;
  while (source.counters().received + source.counters().foreign < count) {
    pollfd waiting{source.fd(), POLLIN, 0};
    if (poll(&waiting, 1, 10'000) <= 0) break;
    const auto got = source.receive();
    EXPECT_TRUE(got.ok());
    for (const Datagram& d : *got) all.emplace_back(std::string(d.bytes.begin(), d.bytes.end()), d);
  }
  return all;
}

TEST(UdpSource, DatagramsCarryAStampBetweenSendingAndReading) {
  const LidarConfig config = loopback();
  auto source = UdpSource::open({&config, 1});
  ASSERT_TRUE(source.ok()) << source.error().message;
  const Sender sender("127.0.0.1");
  const auto before = std::chrono::steady_clock::now().time_since_epoch();
  sender.send(source->port(), "one");
  sender.send(source->port(), "two");
  const auto got = receive(*source, 2);
  const auto after = std::chrono::steady_clock::now().time_since_epoch();
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0].first, "one");
  EXPECT_EQ(got[1].first, "two");
  // The wall clock may be slewed while this runs: 1 ms for it.
  EXPECT_GE(got[0].second.received.time_since_epoch(), before - std::chrono::milliseconds(1));
  EXPECT_LE(got[1].second.received.time_since_epoch(), after);
  EXPECT_LE(got[0].second.received, got[1].second.received);
  EXPECT_EQ(got[0].second.destination_port, source->port());
  EXPECT_EQ(source->counters().unstamped, 0U);
  EXPECT_TRUE(source->receive()->empty());
}

TEST(UdpSource, ForeignSendersAreDroppedCountedAndNamed) {
  const LidarConfig config = loopback("127.0.0.2");
  auto source = UdpSource::open({&config, 1});
  ASSERT_TRUE(source.ok()) << source.error().message;
  const Sender ours("127.0.0.2");
  const Sender foreign("127.0.0.3");
  EXPECT_EQ(source->last_foreign(), "");
  foreign.send(source->port(), "spoofed");
  ours.send(source->port(), "real");
  const auto got = receive(*source, 2);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].first, "real");
  EXPECT_EQ(source->counters().foreign, 1U);
  EXPECT_THAT(source->last_foreign(), HasSubstr("127.0.0.3:"));
}

TEST(UdpSource, LidarsOfOnePortShareASocketAndTheRouterTellsThemApart) {
  std::vector<LidarConfig> lidars{loopback("127.0.0.2"), loopback("127.0.0.3")};
  auto sources = open_udp_sources(lidars);
  ASSERT_TRUE(sources.ok());
  ASSERT_EQ(sources->sources.size(), 1U);
  EXPECT_THAT(sources->data_of, ::testing::ElementsAre(0U, 0U));
  UdpSource& source = sources->sources.front();
  for (LidarConfig& lidar : lidars) lidar.port = source.port();
  const auto router = DatagramRouter::create(lidars);
  ASSERT_TRUE(router.ok());
  Sender("127.0.0.3").send(source.port(), "b");
  Sender("127.0.0.2").send(source.port(), "a");
  Sender("127.0.0.4").send(source.port(), "c");
  const auto got = receive(source, 3);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(router->lidar_of(got[0].second), 1U);
  EXPECT_EQ(router->lidar_of(got[1].second), 0U);
}

TEST(UdpSource, AFullReceiveBufferIsCounted) {
  const LidarConfig config = loopback();
  auto source = UdpSource::open({&config, 1});
  ASSERT_TRUE(source.ok());
  const int small = 4096;
  setsockopt(source->fd(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  const Sender sender("127.0.0.1");
  for (int i = 0; i < 200; ++i) sender.send(source->port(), std::string(1206, 'x'));
  while (!source->receive()->empty()) {
  }
  sender.send(source->port(), "the next one brings the count");
  receive(*source, source->counters().received + 1);
  EXPECT_EQ(source->counters().received + source->counters().kernel_overflows, 201U);
  EXPECT_GT(source->counters().kernel_overflows, 100U);
}

TEST(UdpSource, WhatAPacketFilterDropsIsNoFullBuffer) {
  const LidarConfig config = loopback();
  auto source = UdpSource::open({&config, 1});
  ASSERT_TRUE(source.ok());
  // As the unit's IPAddressDeny= does it, by length instead of address: longer than 100 bytes is dropped.
  std::array<sock_filter, 4> code{{BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0),
                                   BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, 100, 0, 1),
                                   BPF_STMT(BPF_RET | BPF_K, 0), BPF_STMT(BPF_RET | BPF_K, 0xFFFF)}};
  const sock_fprog program{code.size(), code.data()};
  ASSERT_EQ(setsockopt(source->fd(), SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program), 0);
  const Sender sender("127.0.0.1");
  for (int i = 0; i < 50; ++i) {
    sender.send(source->port(), "ours");
    sender.send(source->port(), std::string(1206, 'x'));
  }
  sender.send(source->port(), "the next one brings the count");
  EXPECT_EQ(receive(*source, 51).size(), 51U);
  EXPECT_EQ(source->counters().filtered, 50U);
  EXPECT_EQ(source->counters().kernel_overflows, 0U);
}

TEST(UdpSource, APortInUseSaysWhatToDo) {
  const LidarConfig config = loopback();
  auto first = UdpSource::open({&config, 1});
  ASSERT_TRUE(first.ok());
  LidarConfig again = config;
  again.port = first->port();
  const auto second = UdpSource::open({&again, 1});
  ASSERT_FALSE(second.ok());
  EXPECT_THAT(second.error().message, HasSubstr("UDP port " + std::to_string(first->port())));
  EXPECT_THAT(second.error().message, HasSubstr("in use by another program"));
}

TEST(UdpSource, WrongAddressesAreNamed) {
  LidarConfig config = loopback();
  config.bind = "203.0.113.7";  // a documentation address, on no host
  EXPECT_THAT(UdpSource::open({&config, 1}).error().message,
              HasSubstr("203.0.113.7 is no address of this host"));
  config = loopback("192.168.1");
  EXPECT_THAT(UdpSource::open({&config, 1}).error().message, HasSubstr("192.168.1"));
  config = loopback();
  config.multicast = "10.0.0.1";
  EXPECT_THAT(UdpSource::open({&config, 1}).error().message, HasSubstr("10.0.0.1 is no group"));
}

TEST(DatagramRouter, ASourceAddressGoesBeforeAny) {
  std::vector<LidarConfig> lidars(3);
  lidars[1].source = "10.0.0.2";
  lidars[2].port = 2369;
  const auto router = DatagramRouter::create(lidars);
  ASSERT_TRUE(router.ok());
  Datagram datagram;
  datagram.destination_port = 2368;
  datagram.source_ip = 0x0A000002;
  EXPECT_EQ(router->lidar_of(datagram), 1U);
  datagram.source_ip = 0x0A000003;
  EXPECT_EQ(router->lidar_of(datagram), 0U);
  datagram.destination_port = 2369;
  EXPECT_EQ(router->lidar_of(datagram), 2U);
  datagram.destination_port = 2370;
  EXPECT_EQ(router->lidar_of(datagram), std::nullopt);
}

TEST(Ipv4Text, ReadsBackWhatItWrites) {
  for (const char* text : {"0.0.0.0", "192.168.1.201", "255.255.255.255"}) {
    EXPECT_EQ(format_ipv4(parse_ipv4(text).value()), text);
  }
  for (const char* text : {"", "1.2.3", "1.2.3.256", "host", "1.2.3.4 "})
    EXPECT_FALSE(parse_ipv4(text).ok()) << text;
}

TEST(ReceiveClock, TheStampsAgeIsCountedBackFromMonotonicNow) {
  using std::chrono::hours;
  using std::chrono::milliseconds;
  const SteadyTime now{std::chrono::seconds(1000)};
  const WallTime wall{std::chrono::seconds(1'700'000'000)};
  const auto age_of = [&](WallTime stamp, WallTime wall_now) {
    return now.time_since_epoch() - receive_time(stamp, wall_now, now).time_since_epoch();
  };
  EXPECT_EQ(age_of(wall - milliseconds(3), wall), milliseconds(3));
  EXPECT_EQ(age_of(wall, wall), Nanoseconds::zero());
  // The wall clock was set between the kernel's stamp and our reading of it.
  EXPECT_EQ(age_of(wall, wall - hours(1)), Nanoseconds::zero());
  EXPECT_EQ(age_of(wall, wall + hours(1)), kMaxReceiveDelay);
  EXPECT_EQ(age_of(WallTime{Nanoseconds(std::numeric_limits<std::int64_t>::min())}, wall), kMaxReceiveDelay);
  EXPECT_EQ(age_of(WallTime{Nanoseconds(std::numeric_limits<std::int64_t>::max())}, wall),
            Nanoseconds::zero());
}

}  // namespace
}  // namespace hulltrack
