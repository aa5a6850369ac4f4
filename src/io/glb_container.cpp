#include "io/glb_container.h"

#include <limits>
#include <string>

#include "io/writers.h"

namespace vantage::internal::io {
namespace {

// Values of the glTF 2.0 specification.
constexpr std::uint32_t kMagic = 0x46546C67, kContainerVersion = 2, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8, kAlignment = 4;

std::size_t padded(std::size_t size) { return (size + kAlignment - 1) / kAlignment * kAlignment; }

void write_chunk(AtomicFile& file, std::uint32_t type, std::string_view content, char padding) {
  std::string header;
  append_little_endian(header, static_cast<std::uint32_t>(padded(content.size())));
  append_little_endian(header, type);
  file.write(header);
  file.write(content);
  file.write(std::string(padded(content.size()) - content.size(), padding));
}

}  // namespace

void write_glb_container(std::string_view json, std::string_view buffer, AtomicFile& file) {
  std::size_t size = kHeaderBytes + kChunkHeaderBytes + padded(json.size());
  if (!buffer.empty()) size += kChunkHeaderBytes + padded(buffer.size());
  check_count(size, std::numeric_limits<std::uint32_t>::max(), "bytes", "GLB");

  std::string header;
  append_little_endian(header, kMagic);
  append_little_endian(header, kContainerVersion);
  append_little_endian(header, static_cast<std::uint32_t>(size));
  file.write(header);
  write_chunk(file, kJsonChunk, json, ' ');
  if (!buffer.empty()) write_chunk(file, kBinChunk, buffer, '\0');
}

}  // namespace vantage::internal::io
