// Files are read by a process of their own: what they do to it, and what this process has of them.
#include "daemon/service/preparer.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <system_error>

#include "core/io/pcd_writer.hpp"
#include "daemon/pipeline/live_time.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "tests/support/room_lidar.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// Of a PandarXT-32: what its factory wrote into it.
std::string angle_correction() {
  std::string csv = "Channel,Elevation,Azimuth\n";
  for (int channel = 1; channel <= 32; ++channel) {
    csv += std::to_string(channel) + "," + std::to_string(16 - channel) + ".0,0.0\n";
  }
  return csv;
}

class PreparerTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(write_pcd(folder.path() / "room.pcd", RoomLidar::map())); }

  std::filesystem::path config(const std::string& lidar = "model = \"velodyne_vlp16\"\n") const {
    return folder.file("a.toml",
                       "[plc]\nhost = \"127.0.0.1\"\n[[lidar]]\n" + lidar + "[hull]\nmap = \"room.pcd\"\n");
  }
  /// A configuration whose calibration is a pipe: the reader waits until somebody writes.
  std::filesystem::path config_with_a_pipe() const {
    EXPECT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
    return config("model = \"hesai_xt32\"\ncalibration = \"pipe\"\n");
  }
  /// Once the reader has opened the pipe.
  [[nodiscard]] int open_pipe() const { return open((folder.path() / "pipe").c_str(), O_WRONLY); }

  static Preparation finish(Preparer& preparer) {
    while (!preparer.result()) {
      pollfd entry{preparer.fd(), POLLIN, 0};
      poll(&entry, 1, 100);
      preparer.step(steady_now());
    }
    return *std::move(preparer.result());
  }
  static std::string only_problem(const Preparation& preparation) {
    EXPECT_FALSE(preparation.prepared);
    EXPECT_EQ(preparation.problems.size(), 1U);
    return preparation.problems.empty() ? "" : to_string(preparation.problems.front());
  }
  static pid_t reader() {
    pid_t pid = 0;
    std::ifstream("/proc/thread-self/children") >> pid;
    return pid;
  }
  /// What comes of it when the reader, with the calibration open, gets this signal.
  Preparation after_signal(int number) {
    Preparer preparer(config_with_a_pipe(), setup, Preparer::Goal::run, steady_now());
    const int pipe = open_pipe();
    EXPECT_EQ(kill(reader(), number), 0);
    Preparation preparation = finish(preparer);
    close(pipe);
    return preparation;
  }

  test::TempFolder folder;
  ReaderSetup setup{.program = HULLTRACKD_PROGRAM};
};

TEST_F(PreparerTest, AGoodConfigurationComesWithItsMap) {
  for (const auto goal : {Preparer::Goal::run, Preparer::Goal::check}) {
    Preparer preparer(config(), setup, goal, steady_now());
    const Preparation preparation = finish(preparer);
    ASSERT_TRUE(preparation.prepared) << only_problem(preparation);
    EXPECT_EQ(preparation.prepared->map_points, RoomLidar::map().size());
    ASSERT_EQ(preparation.prepared->map != nullptr, goal == Preparer::Goal::run);
    if (preparation.prepared->map) {
      EXPECT_EQ(preparation.prepared->map->cloud_H(), RoomLidar::map());
    }
  }
}

TEST_F(PreparerTest, EachFileIsReadOnceAndNeverByThisProcess) {
  Preparer preparer(config_with_a_pipe(), setup, Preparer::Goal::run, steady_now());
  const int pipe = open_pipe();
  const std::string csv = angle_correction();
  ASSERT_EQ(write(pipe, csv.data(), csv.size()), static_cast<ssize_t>(csv.size()));
  std::filesystem::remove(folder.path() / "a.toml");  // it has been read: the calibration is next
  std::filesystem::remove(folder.path() / "pipe");
  close(pipe);
  const Preparation preparation = finish(preparer);
  ASSERT_TRUE(preparation.prepared) << only_problem(preparation);
  std::filesystem::remove(folder.path() / "room.pcd");
  const std::string& calibration = preparation.prepared->config.lidars.at(0).calibration;
  EXPECT_EQ(test::read_text(calibration), csv);
  EXPECT_TRUE(make_lidar_decoder(*find_lidar_model("hesai_xt32"), {}, calibration));
}

TEST_F(PreparerTest, ThePlcIsKnownWhileACalibrationIsBeingRead) {
  Preparer preparer(config_with_a_pipe(), setup, Preparer::Goal::run, steady_now());
  while (!preparer.configuration()) {
    ASSERT_FALSE(preparer.result());
    pollfd entry{preparer.fd(), POLLIN, 0};
    poll(&entry, 1, -1);
    preparer.step(steady_now());
  }
  ASSERT_TRUE(preparer.configuration()->plc);
  EXPECT_EQ(preparer.configuration()->plc->host, "127.0.0.1");
}

TEST_F(PreparerTest, AFileThatKillsItsReaderIsAProblemAtItsLine) {
  const Preparation preparation = after_signal(SIGSEGV);
  EXPECT_THAT(only_problem(preparation),
              AllOf(StartsWith((folder.path() / "a.toml:5: lidar.calibration: ").string()),
                    HasSubstr("pipe: reading it ended the reader with signal SEGV (Segmentation fault)")));
  EXPECT_FALSE(preparation.may_pass);
}

TEST_F(PreparerTest, AReaderThatTakesTooMuchProcessorTimeIsEnded) {
  EXPECT_THAT(only_problem(after_signal(SIGXCPU)), HasSubstr("took more than 60 s of processor time"));
}

TEST_F(PreparerTest, AReaderThatWasKilledFromOutsideMayPass) {
  const Preparation preparation = after_signal(SIGKILL);
  EXPECT_THAT(only_problem(preparation), HasSubstr("as the kernel does when memory runs out"));
  EXPECT_TRUE(preparation.may_pass);
}

TEST_F(PreparerTest, AReaderThatIsNotDoneInTimeIsEnded) {
  setup.wall = std::chrono::seconds(0);
  Preparer preparer(config_with_a_pipe(), setup, Preparer::Goal::run, steady_now());
  EXPECT_THAT(only_problem(finish(preparer)), HasSubstr("was not done after 0 s and was given up"));
}

TEST_F(PreparerTest, AMapBeyondTheMemoryIsAProblemAtItsLine) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the reader of a sanitized build has no limit";
#endif
  ASSERT_TRUE(write_pcd(folder.path() / "room.pcd", Cloud(3'000'000, Point(1, 2, 3))));
  setup.memory_mb = 30;
  Preparer preparer(config(), setup, Preparer::Goal::run, steady_now());
  EXPECT_THAT(only_problem(finish(preparer)),
              AllOf(StartsWith((folder.path() / "a.toml:6: hull.map: ").string()),
                    HasSubstr("needs more than the 30 MB of memory")));
}

TEST_F(PreparerTest, ThatGoesAwayTakesItsReaderAlong) {
  pid_t pid = 0;
  {
    const Preparer preparer(config_with_a_pipe(), setup, Preparer::Goal::run, steady_now());
    pid = reader();
    ASSERT_GT(pid, 0);
  }
  int status = 0;
  const pid_t left = waitpid(pid, &status, 0);  // else it would wait at the pipe for ever
  EXPECT_TRUE(left == -1 || (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL));
}

TEST_F(PreparerTest, AReaderThatCannotBeStartedIsAnError) {
  setup.program = folder.path() / "nothing";
  EXPECT_THROW(Preparer(config(), setup, Preparer::Goal::run, steady_now()), std::system_error);
}

TEST_F(PreparerTest, AConfigurationThatCannotBeReadIsOneProblem) {
  Preparer preparer(folder.path() / "none.toml", setup, Preparer::Goal::run, steady_now());
  EXPECT_THAT(only_problem(finish(preparer)), HasSubstr("none.toml: cannot be read: No such file"));
}

}  // namespace
}  // namespace hulltrack
