#include "daemon/log/syslog_sink.hpp"

#include <gtest/gtest.h>
#include <syslog.h>

namespace hulltrack {
namespace {

TEST(SyslogSink, CopiesLinesOfItsLevelToStandardErrorWithTheLevelsName) {
  ::testing::internal::CaptureStderr();
  {
    SyslogSink sink({.ident = "hulltrack-test", .facility = "local7", .level = LogLevel::notice}, true);
    sink.write(LogLevel::info, "left out");
    sink.write(LogLevel::warning, "a warning of 100 %");
    sink.apply({.ident = "hulltrack-test", .facility = "local7", .level = LogLevel::debug});
    sink.write(LogLevel::debug, "now wanted");
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "warning: a warning of 100 %\ndebug: now wanted\n");
}

TEST(SyslogSink, FacilitiesAndPrioritiesAreThoseOfSyslog) {
  EXPECT_EQ(syslog_facility("daemon"), LOG_DAEMON);
  EXPECT_EQ(syslog_facility("local0"), LOG_LOCAL0);
  EXPECT_EQ(syslog_facility("local7"), LOG_LOCAL7);
  EXPECT_EQ(syslog_priority(LogLevel::error), LOG_ERR);
  EXPECT_EQ(syslog_priority(LogLevel::debug), LOG_DEBUG);
}

}  // namespace
}  // namespace hulltrack
