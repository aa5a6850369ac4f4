// ZIP, PKWARE's APPNOTE 6.3.
#include "io/write_zip.h"

#include <zlib.h>

#include <cstdint>
#include <new>
#include <stdexcept>
#include <string_view>

namespace vantage::internal::io {
namespace {

constexpr std::uint32_t kVersion = 20, kUtf8Name = 1U << 11, kDeflated = 8, kMidnight = 0, kNewYear1980 = 1U << 5 | 1;

void append(std::string& bytes, std::uint32_t number, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xFF);
}

/// Without a header.
std::string deflated(const std::string& bytes) {
  z_stream stream = {};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();
  }
  std::string packed(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int status = deflate(&stream, Z_FINISH);
  packed.resize(packed.size() - stream.avail_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw std::bad_alloc();
  return packed;
}

/// What the header of a file and its entry in the directory share.
std::string description(const ZippedFile& file, const std::string& packed) {
  std::string bytes;
  append(bytes, kVersion, 2);
  append(bytes, kUtf8Name, 2);
  append(bytes, kDeflated, 2);
  append(bytes, kMidnight, 2);
  append(bytes, kNewYear1980, 2);
  append(bytes,
         static_cast<std::uint32_t>(
             crc32(0, reinterpret_cast<const Bytef*>(file.bytes.data()), static_cast<uInt>(file.bytes.size()))),
         4);
  append(bytes, static_cast<std::uint32_t>(packed.size()), 4);
  append(bytes, static_cast<std::uint32_t>(file.bytes.size()), 4);
  append(bytes, static_cast<std::uint32_t>(file.name.size()), 2);
  append(bytes, 0, 2);  // no extra fields
  return bytes;
}

}  // namespace

std::string zipped(const std::vector<ZippedFile>& files) {
  constexpr std::size_t kMostBytes = 0xFFFFFFF0, kMostFiles = 0xFFFF, kLongestName = 0xFFFF;
  if (files.size() > kMostFiles) throw std::length_error("zip: too many files");
  std::string archive, directory;
  for (const ZippedFile& file : files) {
    if (file.bytes.size() > kMostBytes || file.name.size() > kLongestName) throw std::length_error("zip: too large");
    const std::string packed = deflated(file.bytes), about = description(file, packed);
    const std::size_t offset = archive.size();
    archive.append("PK\3\4").append(about).append(file.name).append(packed);
    directory.append("PK\1\2");
    append(directory, kVersion, 2);
    directory.append(about);
    append(directory, 0, 2);  // no remark
    append(directory, 0, 2);  // the first disk
    append(directory, 0, 2);  // of no special kind
    append(directory, 0, 4);
    append(directory, static_cast<std::uint32_t>(offset), 4);
    directory.append(file.name);
    if (archive.size() + directory.size() > kMostBytes) throw std::length_error("zip: too large");
  }
  const std::size_t begin = archive.size();
  archive.append(directory).append("PK\5\6");
  append(archive, 0, 2);
  append(archive, 0, 2);
  append(archive, static_cast<std::uint32_t>(files.size()), 2);
  append(archive, static_cast<std::uint32_t>(files.size()), 2);
  append(archive, static_cast<std::uint32_t>(directory.size()), 4);
  append(archive, static_cast<std::uint32_t>(begin), 4);
  append(archive, 0, 2);
  return archive;
}

}  // namespace vantage::internal::io
