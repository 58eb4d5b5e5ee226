// Is this text an address or a host's name? Syntax only: nothing is looked up.
#pragma once

#include <string>

namespace hulltrack {

/// Dotted quad.
[[nodiscard]] bool is_ipv4(const std::string& text);
/// Dotted quad from 224.0.0.0 to 239.255.255.255.
[[nodiscard]] bool is_ipv4_multicast(const std::string& text);
/// IPv4 or IPv6 address, or a host name (letters, digits, hyphens, dots). Text of digits and dots only
/// must be a whole IPv4 address.
[[nodiscard]] bool is_host(const std::string& text);

}  // namespace hulltrack
