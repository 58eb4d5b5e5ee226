// Builds and uses the maps of N clouds that are no ships: map_clouds [N [MOST [SEED]]].
//
// Clouds of 50 to MOST points (default 300 clouds of 3000, seed 1), each from a seed of its own, which is
// printed with a cloud that cannot be used. Meant for a build with sanitizers: scripts/map-clouds. Exit 0
// or 1.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tests/support/any_cloud.hpp"

namespace {

using hulltrack::Cloud;

/// Of `most` points at most, and 50 at least.
Cloud cloud_of(unsigned seed, std::size_t most) {
  std::mt19937 random(seed);
  const std::size_t points = 50 + random() % (most - 49);
  Cloud cloud;
  while (cloud.size() < points) {
    for (const hulltrack::Point& p : hulltrack::test::any_cloud(
             hulltrack::test::any_bytes(random, 1 + random() % 8), points - cloud.size())) {
      cloud.push_back(p);
    }
  }
  return cloud;
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int i, unsigned long otherwise) {
    return argc > i ? std::strtoul(argv[i], nullptr, 10) : otherwise;
  };
  const unsigned long clouds = number(1, 300);
  const unsigned long most = number(2, 3000);
  const auto first = static_cast<unsigned>(number(3, 1));
  if (most < 50) {
    std::fprintf(stderr, "map_clouds: a cloud has 50 points or more\n");
    return 2;
  }
  const auto start = std::chrono::steady_clock::now();
  auto told = start;
  double points = 0.0;
  for (unsigned long i = 0; i < clouds; ++i) {
    const unsigned seed = first + static_cast<unsigned>(i);
    try {
      Cloud cloud = cloud_of(seed, most);
      points += static_cast<double>(cloud.size());
      hulltrack::test::use_as_map(std::move(cloud));
    } catch (const std::exception& error) {
      std::fprintf(stderr, "map_clouds: seed %u: %s\n", seed, error.what());
      return 1;
    }
    const auto now = std::chrono::steady_clock::now();
    if (now - told > std::chrono::seconds(10) || i + 1 == clouds) {
      told = now;
      std::printf("%lu clouds, %.0f points, seeds %u to %u, %.0f s\n", i + 1, points, first, seed,
                  std::chrono::duration<double>(now - start).count());
      std::fflush(stdout);
    }
  }
  return 0;
}
