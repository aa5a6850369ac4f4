// The container of binary glTF (GLB): a document and its one buffer in one file.
#pragma once

#include <string_view>

#include "common/atomic_file.h"

namespace vantage::internal::io {

// Values of the glTF 2.0 specification.
constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementArrayBuffer = 34963;

/// Writes both as chunks behind GLB's header. Throws Error(output) when they take 4 GiB or more.
void write_glb_container(std::string_view json, std::string_view buffer, AtomicFile& file);

}  // namespace vantage::internal::io
