#include "daemon/service/reload_desk.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/base/text.hpp"
#include "daemon/pipeline/live_time.hpp"

namespace hulltrack {
namespace {

constexpr const char* kName = "control";
constexpr std::size_t kMostWaiting = 16;
constexpr std::size_t kLongestAnswer = 60'000;  // bytes; fits what a socket takes without being read
constexpr char kReloaded = '0';
constexpr char kRefused = '1';

sockaddr_un address_of(const std::filesystem::path& socket) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = socket.string();
  if (name.size() >= sizeof address.sun_path) {
    throw std::system_error(ENAMETOOLONG, std::generic_category(), name);
  }
  std::memcpy(address.sun_path, name.data(), name.size());
  return address;
}

const sockaddr* generic(const sockaddr_un& address) { return reinterpret_cast<const sockaddr*>(&address); }

void send_and_close(int fd, char verdict, const std::string& text) {
  const std::string message = verdict + text.substr(0, kLongestAnswer);
  send(fd, message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  close(fd);
}

/// All that comes until the other side closes, or what has come when `until` is over.
std::optional<std::string> read_to_end(int fd, SteadyTime until) {
  std::string text;
  std::array<char, 4096> some;
  while (true) {
    const Nanoseconds left = std::max(until - steady_now(), Nanoseconds{0});
    pollfd entry{fd, POLLIN, 0};
    if (poll(&entry, 1, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(left).count())) == 0) {
      return std::nullopt;
    }
    const ssize_t got = read(fd, some.data(), some.size());
    if (got <= 0) {
      return text;
    }
    text.append(some.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace

ReloadDesk::ReloadDesk(const std::optional<std::filesystem::path>& folder) {
  if (!folder) {
    return;
  }
  const std::filesystem::path path = *folder / kName;
  const sockaddr_un address = address_of(path);
  unlink(path.c_str());
  listener_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (listener_ < 0 || bind(listener_, generic(address), sizeof address) != 0 ||
      listen(listener_, static_cast<int>(kMostWaiting)) != 0) {
    const int error = errno;
    close(listener_);
    throw std::system_error(error, std::generic_category(), path.string());
  }
}

ReloadDesk::~ReloadDesk() {
  answer(false, "the service ends\n");
  if (listener_ >= 0) {
    close(listener_);
  }
}

bool ReloadDesk::take_requests() {
  bool any = false;
  for (int fd = -1; listener_ >= 0 && (fd = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC)) >= 0;) {
    if (waiting_.size() < kMostWaiting) {
      waiting_.push_back(fd);
      any = true;
    } else {
      send_and_close(fd, kRefused, "too many wait for a reload already; ask again later\n");
    }
  }
  return any;
}

void ReloadDesk::answer(bool reloaded, const std::string& text) {
  for (const int fd : waiting_) {
    send_and_close(fd, reloaded ? kReloaded : kRefused, text);
  }
  waiting_.clear();
}

ReloadAnswer ask_for_reload(const std::filesystem::path& folder, Nanoseconds patience) {
  const std::filesystem::path path = folder / kName;
  const sockaddr_un address = address_of(path);
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0 || connect(fd, generic(address), sizeof address) != 0) {
    const int error = errno;
    close(fd);
    return {false, path.string() + ": " + std::strerror(error) +
                       ": does the service run? One that was started by hand takes SIGHUP\n"};
  }
  const auto text = read_to_end(fd, steady_now() + patience);
  close(fd);
  if (!text) {
    return {false,
            format_text("no answer for %.0f s; the log says what the service does\n", to_seconds(patience))};
  }
  if (text->empty()) {
    return {false, "the service ended before it answered; the log says why\n"};
  }
  return {text->front() == kReloaded, text->substr(1)};
}

}  // namespace hulltrack
