// `room_lidar PORT`: a LiDAR in a room as a process, until standard input closes. `room_lidar --map FILE`
// writes the map of the room. Commands on standard input: mute, unmute, from A.B.C.D
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include "core/io/pcd_writer.hpp"
#include "lidar_drivers/datagram_router.hpp"
#include "tests/support/room_lidar.hpp"

int main(int argc, char** argv) {
  using namespace hulltrack;
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "--map" && argc == 3) {
    const auto written = write_pcd(argv[2], RoomLidar::map());
    return written ? 0 : 1;
  }
  RoomLidar lidar(static_cast<std::uint16_t>(std::atoi(first.c_str())));
  for (std::string line; std::getline(std::cin, line);) {
    if (line == "mute" || line == "unmute") {
      lidar.mute(line == "mute");
    } else if (const auto ip = parse_ipv4(line.substr(line.find(' ') + 1))) {
      lidar.send_from(*ip);
    }
  }
  return 0;
}
