// One reader per format, each from bytes in memory. Each throws Error(input) with the line or byte for anything that it
// cannot read, allocates in proportion to the bytes it is given (or to `limits`), and asks `progress` all along.
#pragma once

#include <string>
#include <string_view>

#include "io/mesh_file.h"

namespace vantage::internal::io {

/// What the content is, or else what the name says. Throws Error(input) when neither tells.
MeshFormat mesh_format(const MeshSource& source);

/// Reads a file of whichever format it is.
RawMesh read_any(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits = {},
                 const std::string& lod = {}, const std::string& crs = {});

RawMesh read_obj(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits = {});
RawMesh read_ply(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits = {});
RawMesh read_stl(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits = {});
RawMesh read_gltf(const MeshSource& source, const core::ProgressReporter& progress,
                  const core::ReadLimits& limits = {});
/// `lod`, `crs`: as in SceneReadOptions. The coordinate system says what a metre of height is in the file.
RawMesh read_cityjson(const MeshSource& source, const core::ProgressReporter& progress,
                      const core::ReadLimits& limits = {}, const std::string& lod = {}, const std::string& crs = {});

/// Whether some JSON object in the text has the type "CityJSON" or "CityJSONFeature".
bool is_cityjson(std::string_view bytes);

/// Whether the content is a binary STL: its length is the one that its facet count asks for, or up to 49 bytes more.
bool is_binary_stl(std::string_view bytes);
/// Whether the content is text that begins with "solid".
bool is_ascii_stl(std::string_view bytes);

}  // namespace vantage::internal::io
