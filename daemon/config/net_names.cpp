#include "daemon/config/net_names.hpp"

#include <arpa/inet.h>

#include <algorithm>

namespace hulltrack {
namespace {

bool is_label_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

/// Labels of 1 to 63 characters that neither begin nor end with a hyphen (RFC 1123, 2.1).
bool is_host_name(const std::string& text) {
  if (text.empty() || text.size() > 253) {
    return false;
  }
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find('.', begin), text.size());
    const std::string label = text.substr(begin, end - begin);
    if (label.empty() || label.size() > 63 || label.front() == '-' || label.back() == '-' ||
        !std::all_of(label.begin(), label.end(), is_label_character)) {
      return false;
    }
    begin = end + 1;
  }
  return true;
}

}  // namespace

bool is_ipv4(const std::string& text) {
  in_addr address{};
  return text.find('\0') == std::string::npos && ::inet_pton(AF_INET, text.c_str(), &address) == 1;
}

bool is_ipv4_multicast(const std::string& text) {
  in_addr address{};
  return is_ipv4(text) && ::inet_pton(AF_INET, text.c_str(), &address) == 1 &&
         IN_MULTICAST(ntohl(address.s_addr));
}

bool is_host(const std::string& text) {
  in6_addr address{};
  if (is_ipv4(text) ||
      (text.find('\0') == std::string::npos && ::inet_pton(AF_INET6, text.c_str(), &address) == 1)) {
    return true;
  }
  const bool numeric = text.find_first_not_of("0123456789.") == std::string::npos;
  return !numeric && is_host_name(text);
}

}  // namespace hulltrack
