#include "core/sha256.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace vantage::internal::core {

const std::array<std::uint32_t, 64> kSha256Constants = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

namespace {

template <typename Number>
std::array<char, sizeof(Number)> little_endian(Number number) {
  std::array<char, sizeof(Number)> bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(number >> (8 * i) & 0xff);
  return bytes;
}

}  // namespace

void sha256_block(Sha256State& state, const char* block) {
  std::array<std::uint32_t, 64> w;
  for (std::size_t i = 0; i < 16; ++i) {
    w[i] = 0;
    for (std::size_t k = 0; k < 4; ++k) w[i] = w[i] << 8 | static_cast<std::uint8_t>(block[4 * i + k]);
  }
  for (std::size_t i = 16; i < 64; ++i) {
    const std::uint32_t s0 = std::rotr(w[i - 15], 7) ^ std::rotr(w[i - 15], 18) ^ w[i - 15] >> 3;
    const std::uint32_t s1 = std::rotr(w[i - 2], 17) ^ std::rotr(w[i - 2], 19) ^ w[i - 2] >> 10;
    w[i] = w[i - 16] + s0 + w[i - 7] + s1;
  }
  auto [a, b, c, d, e, f, g, h] = state;
  for (std::size_t i = 0; i < 64; ++i) {
    const std::uint32_t s1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
    const std::uint32_t t1 = h + s1 + ((e & f) ^ (~e & g)) + kSha256Constants[i] + w[i];
    const std::uint32_t s0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
    const std::uint32_t t2 = s0 + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + t1;
    d = c;
    c = b;
    b = a;
    a = t1 + t2;
  }
  const Sha256State add = {a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < state.size(); ++i) state[i] += add[i];
}

void Sha256::add(std::string_view bytes) {
  const std::size_t used = bytes_ % block_.size();
  bytes_ += bytes.size();
  if (used > 0) {
    const std::size_t taken = std::min(bytes.size(), block_.size() - used);
    std::memcpy(block_.data() + used, bytes.data(), taken);
    if (used + taken < block_.size()) return;
    sha256_blocks(state_, block_.data(), 1);
    bytes.remove_prefix(taken);
  }
  const std::size_t blocks = bytes.size() / block_.size();
  sha256_blocks(state_, bytes.data(), blocks);
  bytes.remove_prefix(blocks * block_.size());
  std::copy(bytes.begin(), bytes.end(), block_.begin());
}

void Sha256::add(std::uint32_t number) {
  const auto bytes = little_endian(number);
  add(std::string_view(bytes.data(), bytes.size()));
}

void Sha256::add(std::uint64_t number) {
  const auto bytes = little_endian(number);
  add(std::string_view(bytes.data(), bytes.size()));
}

void Sha256::add(std::span<const double> numbers) {
  std::array<std::array<char, sizeof(double)>, 64> bytes;
  while (!numbers.empty()) {
    const std::span<const double> some = numbers.first(std::min(numbers.size(), bytes.size()));
    for (std::size_t i = 0; i < some.size(); ++i) bytes[i] = little_endian(std::bit_cast<std::uint64_t>(some[i] + 0.0));
    add(std::string_view(bytes[0].data(), some.size_bytes()));
    numbers = numbers.subspan(some.size());
  }
}

std::string Sha256::hex() {
  const std::uint64_t bits = 8 * bytes_;
  constexpr std::size_t kLengthAt = 56;  // the length takes the last 8 bytes of a block
  add(std::string_view("\x80", 1));
  while (bytes_ % block_.size() != kLengthAt) add(std::string_view("\0", 1));
  std::array<char, 8> length;
  for (std::size_t i = 0; i < length.size(); ++i) length[i] = static_cast<char>(bits >> (56 - 8 * i) & 0xff);
  add(std::string_view(length.data(), length.size()));

  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const std::uint32_t word : state_) {
    for (int shift = 28; shift >= 0; shift -= 4) text += kDigits[word >> shift & 0xf];
  }
  return text;
}

void sha256_blocks(Sha256State& state, const char* bytes, std::size_t blocks) {
  if (sha256_blocks_by_processor(state, bytes, blocks)) return;
  for (std::size_t i = 0; i < blocks; ++i) sha256_block(state, bytes + 64 * i);
}

}  // namespace vantage::internal::core
