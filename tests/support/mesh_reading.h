// Reads meshes from strings.
#pragma once

#include <gtest/gtest.h>

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

}  // namespace vantage::testing
