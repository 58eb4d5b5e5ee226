// Captures of every kind, written by hand: link types, tags, fragments, cut records, cut files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "lidar_drivers/pcap_source.hpp"
#include "lidar_drivers/pcap_writer.hpp"
#include "tests/support/capture_bytes.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

using namespace test;  // the byte writers
using testing::HasSubstr;

constexpr std::uint32_t kEthernet = 1;

struct Read {
  std::vector<std::string> payloads;
  std::vector<std::int64_t> stamps;
  PcapCounters counters;
  std::string error;    // of the file's end
  std::string nothing;  // explain_nothing_found
};

Read read_capture(const std::string& bytes, const PcapFilter& filter = {}) {
  const TempFolder folder;
  Read read;
  auto source = PcapSource::open(folder.file("c.pcap", bytes), filter);
  if (!source) {
    read.error = source.error().message;
    return read;
  }
  Datagram datagram;
  auto more = source->next(datagram);
  for (; more && *more; more = source->next(datagram)) {
    read.payloads.emplace_back(datagram.bytes.begin(), datagram.bytes.end());
    read.stamps.push_back(to_ns(datagram.received));
  }
  if (!more) read.error = more.error().message;
  read.counters = source->counters();
  read.nothing = source->explain_nothing_found();
  return read;
}

TEST(PcapSource, FindsTheDatagramBehindEveryLinkHeader) {
  const std::string packet = ipv4(udp(2368, 2368, "hello"));
  const std::pair<std::uint32_t, std::string> frames[] = {
      {1, ethernet(packet)},
      {1, ethernet(vlan_tag(0x0800) + packet, 0x8100)},
      {1, ethernet(vlan_tag(0x8100) + vlan_tag(0x0800) + packet, 0x88A8)},
      {1, ethernet(packet) + std::string(13, '\x55')},  // padding of short frames
      {1, ethernet(ipv4(udp(2368, 2368, "hello"), {.options = std::string(8, '\x01')}))},
      {113, cooked(packet)},
      {276, cooked2(packet)},
      {101, packet},
      {228, packet},
  };
  for (const auto& [link, frame] : frames) {
    const auto read = read_capture(pcap_header(link) + pcap_record(frame));
    ASSERT_THAT(read.payloads, testing::ElementsAre("hello")) << "link type " << link << ": " << read.error;
    EXPECT_EQ(read.stamps[0], 100'000'005'000);
    EXPECT_EQ(read.error, "");
  }
}

TEST(PcapSource, ReadsNanosecondCapturesAndPcapng) {
  const std::string frame = ethernet(ipv4(udp(1, 2, "x")));
  EXPECT_EQ(
      read_capture(pcap_header(kEthernet, 0xA1B23C4D) + pcap_record(frame, 100, 123'456'789)).stamps.at(0),
      100'123'456'789);
  const std::uint64_t us = 1'700'000'000'000'001;
  EXPECT_EQ(read_capture(pcapng_header(kEthernet, false) + pcapng_record(frame, us)).stamps.at(0),
            static_cast<std::int64_t>(us * 1000));
  const std::uint64_t ns = 1'700'000'000'123'456'789;
  EXPECT_EQ(read_capture(pcapng_header(kEthernet, true) + pcapng_record(frame, ns)).stamps.at(0),
            static_cast<std::int64_t>(ns));
}

TEST(PcapSource, FiltersByPortAndSourceAndNamesThePortsSeen) {
  std::string bytes = pcap_header(kEthernet);
  for (int i = 0; i < 3; ++i) bytes += pcap_record(ethernet(ipv4(udp(5, 2369, "a"))));
  bytes += pcap_record(ethernet(ipv4(udp(5, 8308, "b"), {.source = 0x0A000001})));
  EXPECT_EQ(read_capture(bytes, {.port = 2369, .source_ip = {}}).payloads.size(), 3U);
  EXPECT_THAT(read_capture(bytes, {.port = {}, .source_ip = 0x0A000001}).payloads, testing::ElementsAre("b"));
  const auto read = read_capture(bytes, {.port = 2368, .source_ip = {}});
  EXPECT_TRUE(read.payloads.empty());
  EXPECT_THAT(read.nothing, HasSubstr("no datagrams to UDP port 2368"));
  EXPECT_THAT(read.nothing, HasSubstr("2369 (3), 8308 (1)"));
}

TEST(PcapSource, PutsFragmentsTogetherInAnyOrder) {
  std::string payload(3000, '\0');
  for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<char>(i * 31);
  const std::string whole = udp(7, 2368, payload);
  const std::string parts[] = {
      ethernet(ipv4(whole.substr(0, 1480), {.offset = 0, .more = true})),
      ethernet(ipv4(whole.substr(1480, 1480), {.offset = 1480, .more = true})),
      ethernet(ipv4(whole.substr(2960), {.offset = 2960})),
  };
  std::vector<int> order{0, 1, 2};
  do {
    std::string bytes = pcap_header(kEthernet);
    for (const int i : order) bytes += pcap_record(parts[static_cast<std::size_t>(i)]);
    const auto read = read_capture(bytes);
    EXPECT_THAT(read.payloads, testing::ElementsAre(payload));
    EXPECT_EQ(read.counters.fragments, 3U);
    EXPECT_EQ(read.counters.fragments_dropped, 0U);
  } while (std::ranges::next_permutation(order).found);
}

TEST(PcapSource, FragmentsThatOverlapOrAreMissingAreDropped) {
  const std::string whole = udp(7, 2368, std::string(2000, 'p'));
  const std::string first = ethernet(ipv4(whole.substr(0, 1480), {.offset = 0, .more = true}));
  const std::string overlap = ethernet(ipv4(whole.substr(1472), {.offset = 1472}));
  const auto overlapping = read_capture(pcap_header(kEthernet) + pcap_record(first) + pcap_record(overlap));
  EXPECT_TRUE(overlapping.payloads.empty());
  EXPECT_EQ(overlapping.counters.fragments_dropped, 2U);
  const auto missing = read_capture(pcap_header(kEthernet) + pcap_record(first));
  EXPECT_TRUE(missing.payloads.empty());
  EXPECT_EQ(missing.counters.fragments_dropped, 1U);
  const std::string beyond = ethernet(ipv4(std::string(1480, 'q'), {.offset = 65'528, .more = true}));
  EXPECT_EQ(read_capture(pcap_header(kEthernet) + pcap_record(beyond)).counters.fragments_dropped, 1U);
}

TEST(PcapSource, ManyUnfinishedDatagramsStayBounded) {
  std::string bytes = pcap_header(kEthernet);
  for (unsigned id = 0; id < 1000; ++id) {
    bytes += pcap_record(
        ethernet(ipv4(std::string(1480, 'x'), {.identification = id, .offset = 0, .more = true})), id);
  }
  const std::string whole = udp(7, 2368, std::string(16, 'y'));
  bytes += pcap_record(ethernet(ipv4(whole.substr(0, 8), {.identification = 5000, .more = true})), 1000);
  bytes += pcap_record(ethernet(ipv4(whole.substr(8), {.identification = 5000, .offset = 8})), 1000);
  const auto read = read_capture(bytes);
  EXPECT_EQ(read.payloads.size(), 1U);
  EXPECT_EQ(read.counters.fragments_dropped, 1000U);
}

TEST(PcapSource, RecordsCutByTheSnapLengthAreCountedNotRead) {
  const std::string frame = ethernet(ipv4(udp(7, 2368, std::string(100, 'z'))));
  for (std::size_t cut = 1; cut <= frame.size(); ++cut) {
    const auto read = read_capture(pcap_header(kEthernet) + pcap_record(frame, 1, 0, cut));
    EXPECT_TRUE(read.payloads.empty()) << cut;
    EXPECT_EQ(read.counters.truncated, 1U) << cut;
  }
}

TEST(PcapSource, AFileCutShortGivesItsWholeRecordsAndThenAnError) {
  const std::string record = pcap_record(ethernet(ipv4(udp(7, 2368, std::string(50, 'z')))));
  const std::string bytes = pcap_header(kEthernet) + record + record;
  for (std::size_t cut = 1; cut < record.size(); ++cut) {
    const auto read = read_capture(bytes.substr(0, bytes.size() - cut));
    EXPECT_EQ(read.payloads.size(), 1U);
    EXPECT_THAT(read.error, HasSubstr("c.pcap: broken after record 1")) << cut;
  }
}

TEST(PcapSource, WhatIsNoCaptureIsRefusedInOneLine) {
  EXPECT_THAT(read_capture("").error, HasSubstr("not a capture"));
  EXPECT_THAT(read_capture("t_ns,d_x,theta_r,theta_p,heartbeat,command\n").error,
              HasSubstr("pcap or pcapng"));
  EXPECT_THAT(read_capture(pcap_header(105)).error, HasSubstr("IEEE802_11"));
  const auto missing = PcapSource::open("/nonexistent/lidar.pcap");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().message, "/nonexistent/lidar.pcap: cannot be opened: No such file or directory");
}

TEST(PcapSource, OtherTrafficIsPassedOver) {
  const std::string bytes = pcap_header(kEthernet) + pcap_record(ethernet(std::string(28, '\0'), 0x0806)) +
                            pcap_record(ethernet(ipv4(std::string(20, '\0'), {.protocol = 6}))) +
                            pcap_record(ethernet(ipv4("short"))) + pcap_record(ethernet("\x45"));
  const auto read = read_capture(bytes);
  EXPECT_TRUE(read.payloads.empty());
  EXPECT_EQ(read.counters.not_udp, 2U);
  EXPECT_EQ(read.counters.malformed, 2U);
  EXPECT_THAT(read.nothing, HasSubstr("no UDP was seen at all"));
}

TEST(PcapSource, FlippedBitsNeverCrash) {
  const std::string whole = udp(7, 2368, std::string(64, 'z'));
  const std::string clean =
      pcap_header(kEthernet) + pcap_record(ethernet(ipv4(whole))) +
      pcap_record(ethernet(ipv4(whole.substr(0, 40), {.more = true}))) +
      pcap_record(ethernet(vlan_tag(0x0800) + ipv4(whole.substr(40), {.offset = 40}), 0x8100));
  std::mt19937 random(3);
  for (int run = 0; run < 500; ++run) {
    std::string bytes = clean;
    for (int i = 0; i < 4; ++i) {
      const auto at = std::uniform_int_distribution<std::size_t>(0, bytes.size() - 1)(random);
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << std::uniform_int_distribution<int>(0, 7)(random)));
    }
    EXPECT_LE(read_capture(bytes).payloads.size(), 3U);
  }
}

TEST(PcapWriter, WhatItWritesReadsBackTheSame) {
  const TempFolder folder;
  const auto path = folder.path() / "out.pcap";
  std::vector<std::vector<std::uint8_t>> sent;
  {
    auto writer = PcapWriter::create(path);
    ASSERT_TRUE(writer.ok());
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{1206}, std::size_t{65'507}}) {
      sent.emplace_back(size, static_cast<std::uint8_t>(size));
      const auto stamp =
          measurement_time_from_ns(1'700'000'000'123'456'000 + static_cast<std::int64_t>(size));
      ASSERT_TRUE(writer->write(stamp, {0x0A000001, 11, 0x0A000002, 22}, sent.back()).ok());
    }
    EXPECT_FALSE(writer->write({}, {}, std::vector<std::uint8_t>(65'508)).ok());
    EXPECT_FALSE(writer->write(measurement_time_from_ns(-1), {}, {}).ok());
    ASSERT_TRUE(writer->close().ok());
  }
  auto source = PcapSource::open(path);
  ASSERT_TRUE(source.ok());
  Datagram datagram;
  for (const auto& payload : sent) {
    const auto more = source->next(datagram);
    ASSERT_TRUE(more.ok() && *more);
    EXPECT_TRUE(std::ranges::equal(datagram.bytes, payload));
    EXPECT_EQ(to_ns(datagram.received),
              1'700'000'000'123'456'000 + static_cast<std::int64_t>(payload.size()));
    EXPECT_EQ(datagram.source_ip, 0x0A000001U);
    EXPECT_EQ(datagram.source_port, 11);
    EXPECT_EQ(datagram.destination_port, 22);
  }
  const auto end = source->next(datagram);
  EXPECT_TRUE(end.ok() && !*end);
}

TEST(PcapWriter, AFullDiskIsReported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  auto writer = PcapWriter::create("/dev/full");
  ASSERT_TRUE(writer.ok());
  const std::vector<std::uint8_t> payload(60'000);
  bool failed = false;
  for (int i = 0; i < 10 && !failed; ++i) failed = !writer->write({}, {}, payload).ok();
  EXPECT_TRUE(failed);
  const auto closed = writer->close();
  ASSERT_FALSE(closed.ok());
  EXPECT_THAT(closed.error().message, HasSubstr("No space left on device"));
  EXPECT_FALSE(PcapWriter::create("/nonexistent/out.pcap").ok());
}

}  // namespace
}  // namespace hulltrack
