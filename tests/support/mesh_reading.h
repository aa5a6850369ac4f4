// Reads meshes from strings, and expects errors.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <string>

#include "io/mesh_readers.h"
#include "support/internals.h"
#include "vantage/error.h"

namespace vantage::testing {

/// Reads `bytes` as if they were the content of a file with this name.
inline io::RawMesh read_as(const std::string& name, const std::string& bytes, const core::ReadLimits& limits = {}) {
  return io::read_any(io::MeshSource(name, bytes), {}, limits);
}

/// Runs `body`, which must throw an input Error whose problem holds `problem` and whose place holds `where`.
inline void expect_input_error(const std::function<void()>& body, const std::string& problem,
                               const std::string& where) {
  try {
    body();
    ADD_FAILURE() << "nothing was thrown; expected: " << problem;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_NE(error.problem().find(problem), std::string::npos) << error.what();
    EXPECT_NE(error.where().find(where), std::string::npos) << error.what();
    EXPECT_FALSE(error.fix().empty()) << error.what();
    EXPECT_EQ(error.problem().find('\n'), std::string::npos) << error.what();
  }
}

/// The bytes of a number, little-endian as the machine's.
template <class T>
std::string bytes_of(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

}  // namespace vantage::testing
