// Which requests are answered: those with the token that the program printed, and the right names of host and origin.
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace vantage::live {

/// 128 bits from the system's source of randomness, as 32 hexadecimal digits.
std::string random_token();

class AccessControl {
 public:
  explicit AccessControl(std::string token) : token_(std::move(token)) {}

  const std::string& token() const { return token_; }

  /// Whether a target "/path?token=..." has this path and the token. Takes the same time wherever a wrong token
  /// differs.
  bool allows(std::string_view target, std::string_view path) const;

  /// Whether a header Host names this machine itself. Another name may be one that its owner has led here (DNS
  /// rebinding). The port may be that of a tunnel.
  static bool is_own_host(std::string_view host);

  /// Whether a header Origin is that of the page at `host`: any page may open a WebSocket to any address.
  static bool is_own_origin(std::string_view origin, std::string_view host);

 private:
  std::string token_;
};

}  // namespace vantage::live
