#include "core/png_mark.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/version_text.h"
#include "vantage/version.h"

namespace vantage::internal::core {
namespace {

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t kHeaderChunk = 12 + 13;
constexpr std::string_view kKeyword("tEXtSoftware\0vantage ", 21);  // ISO 15948, 11.3.4.3
constexpr std::size_t kLongestVersion = 30;

std::string png_number(std::uint32_t number) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(number >> shift & 0xFF);
  return bytes;
}

/// ISO 15948, annex D.
std::uint32_t png_checksum(std::string_view bytes) {
  std::uint32_t checksum = 0xFFFFFFFF;
  for (const char byte : bytes) {
    checksum ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) checksum = (checksum & 1) != 0 ? checksum >> 1 ^ 0xEDB88320 : checksum >> 1;
  }
  return ~checksum;
}

/// With its length and its checksum. `text` begins with the type.
std::string png_chunk(std::string_view text) {
  const std::string length = png_number(static_cast<std::uint32_t>(text.size() - 4));  // the type does not count
  return length + std::string(text) + png_number(png_checksum(text));
}

}  // namespace

std::string with_png_mark(std::string png) {
  return png.insert(kSignature.size() + kHeaderChunk, png_chunk(std::string(kKeyword) + VANTAGE_VERSION));
}

bool has_png_mark(std::string_view bytes) {
  if (!bytes.starts_with(kSignature) || bytes.size() < kSignature.size() + kHeaderChunk + 4) return false;
  const std::string_view chunk = bytes.substr(kSignature.size() + kHeaderChunk);
  const std::string_view text = chunk.substr(4);
  if (!text.starts_with(kKeyword)) return false;
  for (std::size_t size = kKeyword.size(); size <= std::min(text.size(), kKeyword.size() + kLongestVersion); ++size) {
    const std::string_view whole = text.substr(0, size);
    if (is_version(whole.substr(kKeyword.size())) && chunk.starts_with(png_chunk(whole))) return true;
  }
  return false;
}

}  // namespace vantage::internal::core
