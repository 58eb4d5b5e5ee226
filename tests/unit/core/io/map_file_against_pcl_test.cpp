// Point Cloud Library writes, we read; we write, it reads: two implementations that share no code.
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <random>

#include "core/io/map_file.hpp"
#include "core/io/pcd_writer.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZI>;

/// A smooth surface plus noise: LZF finds both repetitions and literals in it.
PclCloud make_cloud(std::size_t points) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  PclCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    pcl::PointXYZI p;
    p.x = static_cast<float>(i % 100) * 0.05F;
    p.y = static_cast<float>(i / 100) * 0.05F;
    p.z = i % 3 == 0 ? noise(random) : 0.0F;
    p.intensity = static_cast<float>(i % 256);
    cloud.push_back(p);
  }
  return cloud;
}

void expect_equal(const Cloud& ours, const PclCloud& theirs, float tolerance) {
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    ASSERT_NEAR(ours[i].x(), theirs[i].x, tolerance) << i;
    ASSERT_NEAR(ours[i].y(), theirs[i].y, tolerance) << i;
    ASSERT_NEAR(ours[i].z(), theirs[i].z, tolerance) << i;
  }
}

TEST(MapFileAgainstPcl, ReadsEveryPcdThatPclWrites) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "a.pcd").string();
  for (const std::size_t points : {1U, 2U, 100U, 20'000U}) {
    const PclCloud cloud = make_cloud(points);
    pcl::PCDWriter writer;
    ASSERT_EQ(writer.writeBinary(file, cloud), 0);
    expect_equal(read_map_file(file)->cloud, cloud, 0.0F);
    ASSERT_EQ(writer.writeBinaryCompressed(file, cloud), 0);
    expect_equal(read_map_file(file)->cloud, cloud, 0.0F);
    ASSERT_EQ(writer.writeASCII(file, cloud, 9), 0);
    expect_equal(read_map_file(file)->cloud, cloud, 0.0F);
  }
}

TEST(MapFileAgainstPcl, ReadsEveryPlyThatPclWrites) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "a.ply").string();
  const PclCloud cloud = make_cloud(1000);
  ASSERT_EQ(pcl::io::savePLYFileBinary(file, cloud), 0);
  expect_equal(read_map_file(file)->cloud, cloud, 0.0F);
  ASSERT_EQ(pcl::io::savePLYFileASCII(file, cloud), 0);
  expect_equal(read_map_file(file)->cloud, cloud, 1e-5F);  // PCL writes 8 significant digits
}

TEST(MapFileAgainstPcl, PclReadsWhatWeWrite) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "a.pcd").string();
  const Cloud cloud = {{1.5F, -2.25F, 3.0F}, {0.1F, 100.0F, -7.5F}};
  const std::vector<float> intensity = {17.0F, 255.0F};
  ASSERT_TRUE(write_pcd(file, cloud, intensity));
  PclCloud theirs;
  ASSERT_EQ(pcl::io::loadPCDFile(file, theirs), 0);
  expect_equal(cloud, theirs, 0.0F);
  EXPECT_EQ(theirs[1].intensity, 255.0F);
}

}  // namespace
}  // namespace hulltrack
