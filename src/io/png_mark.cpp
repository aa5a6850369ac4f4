#include "io/png_mark.h"

#include <zlib.h>

#include <cstddef>

#include "vantage/version.h"

namespace vantage::internal::io {
namespace {

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t kHeaderChunk = 12 + 13;
constexpr std::string_view kKeyword("tEXtSoftware\0vantage ", 21);  // ISO 15948, 11.3.4.3

std::string png_number(unsigned long number) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(number >> shift & 0xFF);
  return bytes;
}

}  // namespace

std::string with_png_mark(std::string png) {
  const std::string text = std::string(kKeyword) + VANTAGE_VERSION;
  const unsigned long checksum =
      ::crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size()));
  const std::string length = png_number(text.size() - 4);  // the type does not count
  return png.insert(kSignature.size() + kHeaderChunk, length + text + png_number(checksum));
}

bool has_png_mark(std::string_view bytes) {
  constexpr std::size_t kBefore = kSignature.size() + kHeaderChunk + 4;
  return bytes.starts_with(kSignature) && bytes.size() > kBefore && bytes.substr(kBefore).starts_with(kKeyword);
}

}  // namespace vantage::internal::io
