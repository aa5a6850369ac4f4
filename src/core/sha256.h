// SHA-256: FIPS 180-4, sections 4.1.2, 5.1.1, 5.3.3 and 6.2. Our own, in a page: a library for one function would have
// to be built for every platform that the core is built for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace vantage::internal::core {

class Sha256 {
 public:
  void add(std::string_view bytes);
  /// Little-endian, whatever the machine.
  void add(std::uint32_t number);
  void add(std::uint64_t number);
  /// IEEE 754 binary64, little-endian; -0 counts as 0.
  void add(double number);

  /// 64 hexadecimal digits, lower case. Nothing may be added afterwards.
  std::string hex();

 private:
  void take_block(const std::uint8_t* block);

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::uint64_t bytes_ = 0;
};

}  // namespace vantage::internal::core
