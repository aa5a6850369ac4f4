// What unpacks compressed meshes inside glTF files: Draco and meshoptimizer, each by its own library, which a build may
// lack. draco_library.cpp and meshopt_library.cpp, or draco_none.cpp and meshopt_none.cpp where it does.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/read_limits.h"

namespace vantage::internal::io {

/// Why compressed data cannot be unpacked, and whether it is for want of the library.
struct CodecProblem {
  std::string text;
  bool library_missing = false;
};

/// A mesh that was compressed with Draco.
struct DracoMesh {
  std::uint64_t points = 0;
  std::vector<std::uint32_t> indices;  ///< three for each triangle, below `points`
  struct Attribute {
    int components = 0;
    std::vector<double> values;  ///< `components` for each point
  };
  std::vector<Attribute> attributes;  ///< those that were asked for, in that order
};

/// Unpacks the attributes with these unique ids. Throws CodecProblem for what cannot be unpacked, for a mesh of more
/// triangles or for so few bytes of so many points that it is no honest one, for attributes of more bytes than the
/// limits let `data` become, and where there is no Draco.
DracoMesh decode_draco(std::string_view data, const std::vector<std::uint32_t>& attributes,
                       std::uint64_t most_triangles, const core::ReadLimits& limits);

/// EXT_meshopt_compression's description of one buffer view.
struct MeshoptView {
  std::uint64_t count = 0, stride = 0;
  std::string mode, filter;
};

/// The bytes of the buffer view: `count` times `stride`. Throws CodecProblem likewise, and where these are more than
/// the limits let `data` become.
std::string decode_meshopt(std::string_view data, const MeshoptView& view, const core::ReadLimits& limits);

}  // namespace vantage::internal::io
