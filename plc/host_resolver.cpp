#include "plc/host_resolver.hpp"

#include <netdb.h>

#include <condition_variable>
#include <cstring>
#include <mutex>
#include <system_error>
#include <thread>

namespace hulltrack {
namespace {

struct Answer {
  std::vector<SocketAddress> addresses;
  std::string error;
};

Answer look_up(const std::string& host, std::uint16_t port, int flags) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags | AI_NUMERICSERV;
  addrinfo* list = nullptr;
  Answer answer;
  if (const int rc = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list); rc != 0) {
    answer.error = gai_strerror(rc);
    return answer;
  }
  for (const addrinfo* entry = list; entry != nullptr; entry = entry->ai_next) {
    SocketAddress address;
    std::memcpy(&address.storage, entry->ai_addr, entry->ai_addrlen);
    address.length = entry->ai_addrlen;
    answer.addresses.push_back(address);
  }
  freeaddrinfo(list);
  return answer;
}

}  // namespace

struct HostResolver::Lookup {
  std::mutex mutex;
  std::condition_variable finished;
  bool done = false;
  Answer answer;
};

HostResolver::HostResolver(std::string host, std::uint16_t port) : host_(std::move(host)), port_(port) {
  addresses_ = look_up(host_, port_, AI_NUMERICHOST).addresses;
  literal_ = !addresses_.empty();
}

Result<SocketAddress> HostResolver::next(Nanoseconds limit) {
  if (current_ < addresses_.size()) return addresses_[current_];
  if (!lookup_) {
    lookup_ = std::make_shared<Lookup>();
    try {
      std::thread([lookup = lookup_, host = host_, port = port_] {
        Answer answer = look_up(host, port, 0);
        const std::lock_guard lock(lookup->mutex);
        lookup->answer = std::move(answer);
        lookup->done = true;
        lookup->finished.notify_one();
      }).detach();
    } catch (const std::system_error& e) {
      lookup_.reset();
      return Error{"cannot look up the host name " + host_ + ": " + e.what()};
    }
  }
  std::unique_lock lock(lookup_->mutex);
  if (!lookup_->finished.wait_for(lock, limit, [this] { return lookup_->done; })) {
    return Error{"the name server has not answered for " + host_ + " yet; an address in plc.host needs none"};
  }
  const Answer answer = std::move(lookup_->answer);
  lock.unlock();
  lookup_.reset();
  if (answer.addresses.empty()) return Error{"cannot look up the host name " + host_ + ": " + answer.error};
  addresses_ = answer.addresses;
  current_ = 0;
  return addresses_.front();
}

void HostResolver::failed() {
  ++current_;
  if (current_ < addresses_.size()) return;
  current_ = 0;
  if (!literal_) addresses_.clear();
}

}  // namespace hulltrack
