// Builds and uses the maps of N clouds that are no ships: map_clouds [N [MOST [SEED [FEWEST]]]].
//
// Clouds of FEWEST to MOST points, as many of any size as of twice that size (default 300 clouds of 50 to
// 3000, seed 1), each from a seed of its own, which is printed with a cloud that cannot be used. Meant for a
// build with sanitizers: scripts/map-clouds. Exit 0 or 1.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tests/support/any_cloud.hpp"

namespace {

using hulltrack::Cloud;

Cloud cloud_of(unsigned seed, double fewest, double most) {
  std::mt19937 random(seed);
  const double share = static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  const auto points = static_cast<std::size_t>(std::lround(fewest * std::pow(most / fewest, share)));
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
  const unsigned long fewest = number(4, 50);
  if (fewest < 1 || most < fewest) {
    std::fprintf(stderr, "map_clouds: MOST is below FEWEST, or that below 1\n");
    return 2;
  }
  const auto start = std::chrono::steady_clock::now();
  auto told = start;
  double points = 0.0;
  for (unsigned long i = 0; i < clouds; ++i) {
    const unsigned seed = first + static_cast<unsigned>(i);
    try {
      Cloud cloud = cloud_of(seed, static_cast<double>(fewest), static_cast<double>(most));
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
