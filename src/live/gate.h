// Who may ask: a token that only the person at this machine is told, and the right names of host and origin.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vantage::live {

/// 128 bits from the system's source of randomness, as 32 hexadecimal digits.
std::string random_token();

class Gate {
 public:
  Gate(std::string token, std::uint16_t port) : token_(std::move(token)), port_(port) {}

  const std::string& token() const { return token_; }

  /// Whether a target "/path?token=..." has this path and the token. Takes the same time wherever a wrong token
  /// differs.
  bool opens(std::string_view target, std::string_view path) const;

  /// Whether a header Host names this machine itself. Another name may be one that its owner has led here (DNS
  /// rebinding).
  bool is_own_host(std::string_view host) const;

  /// Whether a header Origin is that of the page: any page may open a WebSocket to any address.
  bool is_own_origin(std::string_view origin) const;

 private:
  std::string token_;
  std::uint16_t port_;
};

}  // namespace vantage::live
