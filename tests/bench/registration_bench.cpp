// How fast are search, voxel filter and ICP beside their peers, on the same clouds, with the same answers?
//
// Every peer's answers are compared before the clock starts; a difference ends the run. Times are
// process CPU time of one thread. scripts/bench runs this and prints the ratios.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>

#include "core/filter/voxel_filter.hpp"
#include "core/kdtree/kdtree.hpp"
#include "tests/bench/bench_process.hpp"
#include "tests/bench/peers.hpp"
#include "tests/support/bench_scene.hpp"

namespace hulltrack::bench {
namespace {

constexpr float kGate = 0.3F;
constexpr double kVoxel = 0.5;
constexpr std::size_t kScans = 6;
constexpr std::uint32_t kSeed = 1;

struct StartError {
  double translation;
  double angle;
};
constexpr StartError kAcquiring{0.15, radians(0.3)};
constexpr StartError kTracking{0.03, radians(0.05)};

// Built once, before anything is measured.
struct Case {
  Scene scene = make_scene(0.05, kScans, kSeed);
  KdTree tree{scene.map_H};
  double memory_mb = peak_memory_mb();
  NanoflannTree nanoflann{scene.map_H};
  std::vector<Cloud> sources;  // per scan: its voxel representatives
  std::vector<Cloud> queries;  // the same with the start error of acquiring

  Case() {
    VoxelFilter filter(kVoxel);
    for (std::size_t i = 0; i < kScans; ++i) {
      filter.filter(scene.scans[i].cloud_W, sources.emplace_back());
      Cloud& moved = queries.emplace_back();
      for (const Point& p : sources[i]) {
        moved.push_back((start(kAcquiring, i) * p.cast<double>()).cast<float>());
      }
    }
  }
  [[nodiscard]] static Pose start(const StartError& error, std::size_t scan) {
    return start_pose(error.translation, error.angle, kSeed + static_cast<std::uint32_t>(scan));
  }
};

const Case& the_case() {
  static const Case instance;
  return instance;
}
const PclTree& pcl_tree() {
  static const PclTree instance(the_case().scene.map_H);
  return instance;
}
const PclIcp& pcl_icp() {
  static const PclIcp instance(the_case().scene.map_H);
  return instance;
}

template <typename A, typename B>
void require_equal_distances(const A& a, const B& b, const char* what) {
  for (const Cloud& queries : the_case().queries) {
    std::vector<Neighbour> x(queries.size());
    std::vector<Neighbour> y(queries.size());
    a.nearest(queries, kGate, x);
    b.nearest(queries, kGate, y);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const bool found = x[i].index != Neighbour::kNone;
      require(found == (y[i].index != Neighbour::kNone), what);
      require(!found || std::abs(x[i].squared_distance - y[i].squared_distance) < 1e-6F * kGate, what);
    }
  }
}

template <typename Tree>
void time_queries(benchmark::State& state, const Tree& tree) {
  std::size_t queries = 0;
  std::vector<Neighbour> out;
  for (auto _ : state) {
    for (const Cloud& cloud : the_case().queries) {
      out.resize(cloud.size());
      tree.nearest(cloud, kGate, out);
      benchmark::DoNotOptimize(out.data());
      queries += cloud.size();
    }
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(queries));
}

void query_ours(benchmark::State& state) { time_queries(state, the_case().tree); }
void query_nanoflann(benchmark::State& state) {
  require_equal_distances(the_case().tree, the_case().nanoflann, "nanoflann finds other distances");
  time_queries(state, the_case().nanoflann);
}
void query_pcl(benchmark::State& state) {
  require_equal_distances(the_case().tree, pcl_tree(), "PCL finds other distances");
  time_queries(state, pcl_tree());
}

/// As the metrics build it for every frame.
struct ScanTree : KdTree {
  explicit ScanTree(const Cloud& cloud) : KdTree(cloud, TreeUse::one_batch) {}
};

template <typename Tree>
void time_build(benchmark::State& state, const Cloud& cloud) {
  for (auto _ : state) {
    Tree tree(cloud);
    benchmark::DoNotOptimize(&tree);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(cloud.size()));
}

template <typename Tree>
void build_map(benchmark::State& state) {
  time_build<Tree>(state, the_case().scene.map_H);
}
template <typename Tree>
void build_scan(benchmark::State& state) {
  time_build<Tree>(state, the_case().scene.scans.front().cloud_W);
}

void voxel_ours(benchmark::State& state) {
  VoxelFilter filter(kVoxel);
  for (auto _ : state) {
    benchmark::DoNotOptimize(filter.select(the_case().scene.scans.front().cloud_W).data());
  }
}
void voxel_pcl(benchmark::State& state) {
  const PclVoxelGrid grid(the_case().scene.scans.front().cloud_W);
  for (auto _ : state) {
    benchmark::DoNotOptimize(grid.filter(static_cast<float>(kVoxel)));
  }
}

// One alignment an iteration, the scans in turn.
void icp_ours(benchmark::State& state, const StartError& error) {
  PointToPointIcp icp(IcpConfig{});
  std::size_t scan = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kScans; ++i) {
      benchmark::DoNotOptimize(icp.align(the_case().sources[i], the_case().tree, Case::start(error, i)));
    }
    scan += kScans;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(scan));
}

void icp_nanoflann(benchmark::State& state, const StartError& error) {
  PointToPointIcp icp(IcpConfig{});
  for (std::size_t i = 0; i < kScans; ++i) {
    const IcpResult ours = icp.align(the_case().sources[i], the_case().tree, Case::start(error, i));
    const IcpResult theirs =
        the_case().nanoflann.align(the_case().sources[i], Case::start(error, i), IcpConfig{});
    const Pose difference = ours.T_target_source * theirs.T_target_source.inverse();
    require(ours.iterations == theirs.iterations && ours.matched == theirs.matched,
            "other iterations or matches");
    require((difference.matrix() - Pose::Identity().matrix()).norm() < 1e-9, "the ICP's results differ");
  }
  for (auto _ : state) {
    for (std::size_t i = 0; i < kScans; ++i) {
      benchmark::DoNotOptimize(
          the_case().nanoflann.align(the_case().sources[i], Case::start(error, i), IcpConfig{}));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kScans));
}

void icp_pcl(benchmark::State& state, const StartError& error) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(pcl_icp().align(the_case().sources[0], Case::start(error, 0), IcpConfig{}));
  }
  state.SetItemsProcessed(state.iterations());
}

// The same scan alone, to set beside PCL's.
void icp_ours_one_scan(benchmark::State& state, const StartError& error) {
  PointToPointIcp icp(IcpConfig{});
  for (auto _ : state) {
    benchmark::DoNotOptimize(icp.align(the_case().sources[0], the_case().tree, Case::start(error, 0)));
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK(query_ours)->Name("query/ours")->Unit(benchmark::kMillisecond);
BENCHMARK(query_nanoflann)->Name("query/nanoflann")->Unit(benchmark::kMillisecond);
BENCHMARK(query_pcl)->Name("query/pcl")->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(build_map<KdTree>)->Name("build_map/ours")->Unit(benchmark::kMillisecond);
BENCHMARK(build_map<NanoflannTree>)->Name("build_map/nanoflann")->Unit(benchmark::kMillisecond);
BENCHMARK(build_map<PclTree>)->Name("build_map/pcl")->Unit(benchmark::kMillisecond);
BENCHMARK(build_scan<ScanTree>)->Name("build_scan/ours")->Unit(benchmark::kMillisecond);
BENCHMARK(build_scan<NanoflannTree>)->Name("build_scan/nanoflann")->Unit(benchmark::kMillisecond);
BENCHMARK(build_scan<PclTree>)->Name("build_scan/pcl")->Unit(benchmark::kMillisecond);
BENCHMARK(voxel_ours)->Name("voxel/ours")->Unit(benchmark::kMillisecond);
BENCHMARK(voxel_pcl)->Name("voxel/pcl")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(icp_ours, , kTracking)->Name("icp_tracking/ours")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(icp_nanoflann, , kTracking)->Name("icp_tracking/nanoflann")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(icp_ours, , kAcquiring)->Name("icp_acquiring/ours")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(icp_nanoflann, , kAcquiring)
    ->Name("icp_acquiring/nanoflann")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(icp_ours_one_scan, , kTracking)->Name("icp_one_scan/ours")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(icp_pcl, , kTracking)
    ->Name("icp_one_scan/pcl")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

void describe_case() {
  const Case& c = the_case();
  std::size_t points = 0;
  std::size_t hull = 0;
  std::size_t voxels = 0;
  for (std::size_t i = 0; i < kScans; ++i) {
    points += c.scene.scans[i].cloud_W.size();
    hull += c.scene.scans[i].hull_points;
    voxels += c.sources[i].size();
  }
  const auto text = [](const char* format, double value) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, format, value);
    return std::string(buffer);
  };
  benchmark::AddCustomContext("map_points", std::to_string(c.scene.map_H.size()));
  benchmark::AddCustomContext("scan_points", std::to_string(points / kScans));
  benchmark::AddCustomContext("clutter_percent", text("%.0f", 100.0 - 100.0 * double(hull) / double(points)));
  benchmark::AddCustomContext("voxels", std::to_string(voxels / kScans));
  benchmark::AddCustomContext("tree_bytes_per_point",
                              text("%.1f", double(c.tree.memory()) / double(c.scene.map_H.size())));
  benchmark::AddCustomContext("peak_rss_mb_map_and_tree", text("%.0f", c.memory_mb));
}

}  // namespace
}  // namespace hulltrack::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return EXIT_FAILURE;
  }
  hulltrack::bench::describe_case();
  benchmark::RunSpecifiedBenchmarks();
}
