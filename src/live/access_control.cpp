#include "live/access_control.h"

#include <algorithm>
#include <cstdint>
#include <random>

namespace vantage::live {

std::string random_token() {
  std::random_device source;
  std::string token;
  for (int word = 0; word < 4; ++word) {
    std::uint32_t bits = source();
    for (int digit = 0; digit < 8; ++digit, bits >>= 4) token += "0123456789abcdef"[bits & 15];
  }
  return token;
}

bool AccessControl::allows(std::string_view target, std::string_view path) const {
  const std::string start = std::string(path) + "?token=";
  if (target.size() != start.size() + token_.size() || target.substr(0, start.size()) != start) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < token_.size(); ++i)
    difference |= static_cast<unsigned char>(target[start.size() + i] ^ token_[i]);
  return difference == 0;
}

bool AccessControl::is_own_host(std::string_view host) {
  const std::string_view port = host.substr(std::min(host.find(':'), host.size()));
  const std::string_view name = host.substr(0, host.size() - port.size());
  const bool is_number = port.empty() || (port.size() > 1 && port.size() <= 6 &&
                                          port.find_first_not_of("0123456789", 1) == std::string_view::npos);
  return is_number && (name == "127.0.0.1" || name == "localhost");
}

bool AccessControl::is_own_origin(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return is_own_host(host) && origin.substr(0, kScheme.size()) == kScheme && origin.substr(kScheme.size()) == host;
}

}  // namespace vantage::live
