#include "core/png_mark.h"

#include <cstddef>
#include <cstdint>

#include "vantage/version.h"

namespace vantage::internal::core {
namespace {

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t kHeaderChunk = 12 + 13;
constexpr std::string_view kKeyword("tEXtSoftware\0vantage ", 21);  // ISO 15948, 11.3.4.3

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

}  // namespace

std::string with_png_mark(std::string png) {
  const std::string text = std::string(kKeyword) + VANTAGE_VERSION;
  const std::string length = png_number(static_cast<std::uint32_t>(text.size() - 4));  // the type does not count
  return png.insert(kSignature.size() + kHeaderChunk, length + text + png_number(png_checksum(text)));
}

bool has_png_mark(std::string_view bytes) {
  constexpr std::size_t kBefore = kSignature.size() + kHeaderChunk + 4;
  return bytes.starts_with(kSignature) && bytes.size() > kBefore && bytes.substr(kBefore).starts_with(kKeyword);
}

}  // namespace vantage::internal::core
