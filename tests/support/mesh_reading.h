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

/// The bytes of a number, little-endian as the machine's.
template <class T>
std::string bytes_of(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

}  // namespace vantage::testing
