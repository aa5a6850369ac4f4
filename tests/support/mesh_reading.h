// Reads meshes from strings.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <string>

#include "io/mesh_readers.h"
#include "support/internals.h"
#include "support/wording.h"

namespace vantage::testing {

/// Reads `bytes` as if they were the content of a file with this name.
inline io::RawMesh read_as(const std::string& name, const std::string& bytes, const core::ReadLimits& limits = {}) {
  return io::read_any(io::MeshSource(name, bytes), {}, limits);
}

/// Fails unless `bytes`, as a file with this name, are refused with this code, and the error's place holds `where`.
inline void expect_unreadable(const std::string& name, const std::string& bytes, ErrorCode code,
                              const std::string& where) {
  expect_error([&] { read_as(name, bytes); }, code, where);
}

/// The bytes of a number, little-endian as the machine's.
template <class T>
std::string bytes_of(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

/// Compressed as a file of the program gzip.
inline std::string gzip(const std::string& bytes) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&stream, bytes.size()) + 32, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  return out;
}

}  // namespace vantage::testing
