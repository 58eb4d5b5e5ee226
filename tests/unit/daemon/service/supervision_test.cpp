#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <future>
#include <stdexcept>
#include <string>

#include "daemon/service/notifier.hpp"
#include "daemon/service/signals.hpp"
#include "daemon/threads/doorbell.hpp"
#include "daemon/threads/guarded_thread.hpp"
#include "daemon/threads/thread_watch.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;

SteadyTime at(milliseconds t) { return SteadyTime{} + t; }

TEST(ThreadWatch, NamesTheThreadThatStoppedBeating) {
  ThreadWatch watch;
  Pulse& rx = watch.add("rx", milliseconds(500), at(milliseconds(0)));
  Pulse& track = watch.add("track", milliseconds(500), at(milliseconds(0)));
  rx.beat(at(milliseconds(400)));
  track.beat(at(milliseconds(400)));
  EXPECT_TRUE(watch.overdue(at(milliseconds(900))).empty());
  rx.beat(at(milliseconds(900)));
  const auto overdue = watch.overdue(at(milliseconds(901)));
  ASSERT_EQ(overdue.size(), 1U);
  EXPECT_EQ(overdue[0].thread, "track");
  EXPECT_EQ(overdue[0].silence, milliseconds(501));
}

TEST(ThreadWatch, BelievesAThreadAgainOnceItBeats) {
  ThreadWatch watch;
  Pulse& rx = watch.add("rx", milliseconds(100), at(milliseconds(0)));
  ASSERT_FALSE(watch.overdue(at(milliseconds(200))).empty());
  rx.beat(at(milliseconds(200)));
  EXPECT_TRUE(watch.overdue(at(milliseconds(300))).empty());
}

TEST(ThreadWatch, EveryThreadHasItsOwnLimit) {
  ThreadWatch watch;
  watch.add("slow", milliseconds(1000), at(milliseconds(0)));
  watch.add("fast", milliseconds(10), at(milliseconds(0)));
  const auto overdue = watch.overdue(at(milliseconds(20)));
  ASSERT_EQ(overdue.size(), 1U);
  EXPECT_EQ(overdue[0].thread, "fast");
  EXPECT_EQ(watch.overdue(at(milliseconds(1001))).size(), 2U);
}

TEST(GuardedThread, TellsWhatWasThrownInsteadOfTerminating) {
  std::promise<std::string> told;
  GuardedThread thread(
      "track", [](std::stop_token) { throw std::runtime_error("out of luck"); },
      [&](const std::string& name, const std::string& what) { told.set_value(name + ": " + what); });
  EXPECT_EQ(told.get_future().get(), "track: out of luck");
}

TEST(GuardedThread, CatchesThingsThatAreNoExceptions) {
  std::promise<std::string> told;
  GuardedThread thread(
      "track", [](std::stop_token) { throw 42; },
      [&](const std::string&, const std::string& what) { told.set_value(what); });
  EXPECT_EQ(told.get_future().get(), "an exception of unknown type");
}

TEST(GuardedThread, DestructionWakesAndJoinsAWaitingBody) {
  Doorbell bell;
  bool returned = false;
  {
    GuardedThread thread(
        "rx",
        [&](std::stop_token stop) {
          while (!stop.stop_requested()) {
            bell.wait_until(std::chrono::steady_clock::now() + std::chrono::hours(1));
          }
          returned = true;
        },
        [](const std::string&, const std::string&) {}, [&] { bell.ring(); });
  }
  EXPECT_TRUE(returned);
}

/// A service manager's end of the notification socket.
class NotifySocket {
 public:
  NotifySocket() : fd_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = "hulltrackd-test-" + std::to_string(getpid());
    name.copy(address.sun_path + 1, name.size());  // leading NUL: the abstract name space
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    EXPECT_EQ(bind(fd_, static_cast<sockaddr*>(static_cast<void*>(&address)), length), 0);
    setenv("NOTIFY_SOCKET", ("@" + name).c_str(), 1);
  }
  ~NotifySocket() {
    unsetenv("NOTIFY_SOCKET");
    close(fd_);
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// The next message, or "" if none is there.
  std::string next() {
    char text[512];
    const ssize_t size = recv(fd_, text, sizeof text, MSG_DONTWAIT);
    return size > 0 ? std::string(text, static_cast<std::size_t>(size)) : "";
  }

 private:
  int fd_;
};

TEST(Notifier, SpeaksTheProtocolOfTheServiceManager) {
  NotifySocket manager;
  Notifier notifier;
  notifier.ready();
  EXPECT_EQ(manager.next(), "READY=1");
  notifier.status("tracking 10.0 Hz");
  EXPECT_EQ(manager.next(), "STATUS=tracking 10.0 Hz");
  notifier.status("tracking 10.0 Hz");
  EXPECT_EQ(manager.next(), "") << "an unchanged status is not repeated";
  notifier.reloading();
  EXPECT_EQ(manager.next().rfind("RELOADING=1\nMONOTONIC_USEC=", 0), 0U);
  notifier.stopping();
  EXPECT_EQ(manager.next(), "STOPPING=1\nSTATUS=stopping");
}

TEST(Notifier, FeedsThreeTimesAWatchdogPeriodHoweverOftenItIsCalled) {
  NotifySocket manager;
  setenv("WATCHDOG_USEC", "900000", 1);
  unsetenv("WATCHDOG_PID");
  Notifier notifier;
  int fed = 0;
  for (int call = 0; call < 90; ++call) {  // nine seconds in steps of 100 ms
    notifier.watchdog(at(milliseconds(100) * call));
    fed += manager.next() == "WATCHDOG=1" ? 1 : 0;
  }
  EXPECT_EQ(fed, 30);
  unsetenv("WATCHDOG_USEC");
  Notifier unwatched;
  unwatched.watchdog(at(milliseconds(0)));
  EXPECT_EQ(manager.next(), "");
}

TEST(Signals, BecomeValuesAndABrokenPipeIsIgnored) {
  Signals signals;
  EXPECT_EQ(signals.next(), ServiceSignal::none);
  ASSERT_EQ(kill(getpid(), SIGHUP), 0);
  EXPECT_EQ(signals.next(), ServiceSignal::reload);
  ASSERT_EQ(kill(getpid(), SIGTERM), 0);
  EXPECT_EQ(signals.next(), ServiceSignal::stop);
  ASSERT_EQ(raise(SIGPIPE), 0);
  EXPECT_EQ(signals.next(), ServiceSignal::none);
}

}  // namespace
}  // namespace hulltrack
