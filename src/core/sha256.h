// SHA-256: FIPS 180-4, sections 4.1.2, 4.2.2, 5.1.1, 5.3.3 and 6.2. Our own, in a page: a library for one function
// would have to be built for every platform that the core is built for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace vantage::internal::core {

using Sha256State = std::array<std::uint32_t, 8>;

/// Takes in whole blocks of 64 bytes, in the fastest way that there is.
void sha256_blocks(Sha256State& state, const char* bytes, std::size_t blocks);
/// One block, by plain C++.
void sha256_block(Sha256State& state, const char* block);
/// By instructions that some processors have for it, four times as fast. False, and nothing is done, where they are
/// missing.
bool sha256_blocks_by_processor(Sha256State& state, const char* bytes, std::size_t blocks);

/// FIPS 180-4, section 4.2.2.
extern const std::array<std::uint32_t, 64> kSha256Constants;

class Sha256 {
 public:
  void add(std::string_view bytes);
  /// Little-endian, whatever the machine.
  void add(std::uint32_t number);
  void add(std::uint64_t number);
  /// IEEE 754 binary64, little-endian; -0 counts as 0.
  void add(double number) { add(std::span(&number, 1)); }
  void add(std::span<const double> numbers);

  /// 64 hexadecimal digits, lower case. Nothing may be added afterwards.
  std::string hex();

 private:
  Sha256State state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<char, 64> block_{};
  std::uint64_t bytes_ = 0;
};

}  // namespace vantage::internal::core
