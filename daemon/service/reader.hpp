// The process that reads configuration, calibrations and map for the service.
//
// The same program, started with kReaderFlag by ReaderProcess (reader_process.hpp). It bounds itself before
// it touches a file: memory, processor time, no core file, beside a session a low priority, first in line
// when the kernel runs out of memory, and it dies with its parent. It writes the configuration's bytes into
// one file in memory and all else into another (prepared_files.hpp), and each step into a pipe as it begins.
// Failure: a file that is no good is a problem in what it hands over; a file that kills it is for the parent
// to tell.
#pragma once

#include <cstdint>
#include <string_view>

namespace hulltrack {

inline constexpr std::string_view kReaderFlag = "--read-files-for";

/// The descriptors that the parent leaves it, besides standard error.
inline constexpr int kReaderConfigurationFd = 3;  // file in memory: the configuration as read
inline constexpr int kReaderFilesFd = 4;          // file in memory: PreparedFiles
inline constexpr int kReaderStepsFd = 5;          // pipe: ReaderStep

/// One message in the pipe.
struct ReaderStep {
  std::uint8_t step = 0;   // a PreparationStep
  std::uint8_t lidar = 0;  // with PreparationStep::calibration
};

/// `arguments` after the program's name: kReaderFlag, the parent's process id, MB of memory, seconds of
/// processor time, priority ("own" or "low"), the configuration file. Returns the exit code.
int run_reader(int count, const char* const* arguments);

}  // namespace hulltrack
