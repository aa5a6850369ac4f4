// EXT_meshopt_compression (Khronos Group, glTF extensions), by the library that defines it.
#include <meshoptimizer.h>

#include "io/mesh_codecs.h"

namespace vantage::internal::io {
namespace {

[[noreturn]] void fail_unpacking(const std::string& why) {
  throw CodecProblem{"its meshoptimizer data is garbled: " + why};
}

/// Undoes the filter, in place.
void unfilter(std::string& bytes, const MeshoptView& view) {
  if (view.filter.empty() || view.filter == "NONE") return;
  if (view.mode != "ATTRIBUTES") fail_unpacking("a filter of indices");
  if (view.filter == "OCTAHEDRAL" && (view.stride == 4 || view.stride == 8)) {
    meshopt_decodeFilterOct(bytes.data(), view.count, view.stride);
  } else if (view.filter == "QUATERNION" && view.stride == 8) {
    meshopt_decodeFilterQuat(bytes.data(), view.count, view.stride);
  } else if (view.filter == "EXPONENTIAL") {
    meshopt_decodeFilterExp(bytes.data(), view.count, view.stride);
  } else {
    fail_unpacking("its filter is unknown, or its stride is not for it");
  }
}

}  // namespace

std::string decode_meshopt(std::string_view data, const MeshoptView& view, const core::ReadLimits& limits) {
  const bool is_attributes = view.mode == "ATTRIBUTES", is_triangles = view.mode == "TRIANGLES";
  if (!is_attributes && !is_triangles && view.mode != "INDICES") fail_unpacking("its mode is unknown");
  // What the library demands of its callers.
  const bool fits = is_attributes ? view.stride > 0 && view.stride <= 256 && view.stride % 4 == 0
                                  : view.stride == 2 || view.stride == 4;
  if (!fits || (is_triangles && view.count % 3 != 0)) fail_unpacking("its stride or its count is wrong");
  const std::uint64_t most = limits.most_decompressed(data.size());
  if (view.count > most / view.stride) {
    throw CodecProblem{"its meshoptimizer data of " + std::to_string(data.size()) + " bytes announces " +
                       std::to_string(view.count) + " elements"};
  }
  std::string bytes(view.count * view.stride, '\0');
  const auto* const from = reinterpret_cast<const unsigned char*>(data.data());
  int fault = 0;
  if (view.count == 0) return bytes;
  if (is_attributes) {
    fault = meshopt_decodeVertexBuffer(bytes.data(), view.count, view.stride, from, data.size());
  } else if (is_triangles) {
    fault = meshopt_decodeIndexBuffer(bytes.data(), view.count, view.stride, from, data.size());
  } else {
    fault = meshopt_decodeIndexSequence(bytes.data(), view.count, view.stride, from, data.size());
  }
  if (fault != 0) fail_unpacking("fault " + std::to_string(fault));
  unfilter(bytes, view);
  return bytes;
}

}  // namespace vantage::internal::io
