#include "support/pbf_writer.h"

#include <zlib.h>

#include <stdexcept>

namespace vantage::testing {
namespace {

std::string deflated(const std::string& bytes) {
  uLongf size = ::compressBound(bytes.size());
  std::string result(size, '\0');
  if (::compress2(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                  bytes.size(), 9) != Z_OK) {
    throw std::runtime_error("zlib cannot compress");
  }
  result.resize(size);
  return result;
}

/// `content`: the fields of the blob.
std::string framed(const std::string& type, const std::string& content) {
  const std::string header = pbf_field(1, type) + pbf_field(3, content.size());
  std::string length;
  for (int shift = 24; shift >= 0; shift -= 8) length += static_cast<char>(header.size() >> shift);
  return length + header + content;
}

std::string blob(const std::string& type, const std::string& bytes) {
  return framed(type, pbf_field(2, bytes.size()) + pbf_field(3, deflated(bytes)));
}

}  // namespace

std::string pbf_varint(std::uint64_t number) {
  std::string bytes;
  for (; number > 127; number >>= 7) bytes += static_cast<char>(number | 128U);
  return bytes + static_cast<char>(number);
}

std::string pbf_packed(const std::vector<std::uint64_t>& numbers) {
  std::string bytes;
  for (const std::uint64_t number : numbers) bytes += pbf_varint(number);
  return bytes;
}

std::string pbf_packed_signed(const std::vector<std::int64_t>& numbers) {
  std::string bytes;
  for (const std::int64_t number : numbers) {
    bytes += pbf_varint(static_cast<std::uint64_t>(number) << 1U ^ (number < 0 ? ~std::uint64_t{0} : 0));
  }
  return bytes;
}

std::string pbf_field(std::uint32_t field, const std::string& bytes) {
  return pbf_varint(field << 3U | 2U) + pbf_varint(bytes.size()) + bytes;
}

std::string pbf_field(std::uint32_t field, std::uint64_t number) {
  return pbf_varint(field << 3U) + pbf_varint(number);
}

std::string pbf_raw_block(const std::string& bytes) { return framed("OSMData", pbf_field(1, bytes)); }

std::string pbf_header() {
  return blob("OSMHeader", pbf_field(4, std::string("OsmSchema-V0.6")) + pbf_field(4, std::string("DenseNodes")));
}

std::string pbf_block(const std::vector<std::string>& texts, const std::vector<std::string>& groups) {
  std::string table, bytes;
  for (const std::string& text : texts) table += pbf_field(1, text);
  bytes += pbf_field(1, table);
  for (const std::string& group : groups) bytes += pbf_field(2, group);
  return blob("OSMData", bytes);
}

}  // namespace vantage::testing
