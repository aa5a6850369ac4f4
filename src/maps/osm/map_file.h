// Opens OpenStreetMap files for libosmium, and turns what goes wrong into one clear Error.
#pragma once

#include <filesystem>
#include <functional>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/entity_bits.hpp>
#include <string>

#include "core/progress_reporter.h"

namespace vantage::internal::osm {

enum class MapFormat { text, pbf };  ///< text: XML or JSON, may be packed by gzip or bzip2

/// A file that looks like one that can be read, by its first bytes; its name does not matter.
struct MapFile {
  std::filesystem::path path;  ///< as given
  MapFormat format = MapFormat::text;
};

/// Throws Error(input) for a missing or unreadable file, a folder, a pipe or device, an empty file, and one that is no
/// OpenStreetMap file of these formats (says what it looks like).
MapFile open_map_file(const std::filesystem::path& path);

/// Reads the file from its beginning to its end and hands over what it holds, of the kinds asked for, in its order: of
/// texts see read_text. Returns what the file says of an error that ended it early; empty where it says nothing. Throws
/// Error(input) where the content is garbled or cut off (line, where there are lines), Error(cancelled), and what
/// `handle` throws.
std::string read_objects(const MapFile& file, osmium::osm_entity_bits::type kinds,
                         const core::ProgressReporter& progress,
                         const std::function<void(const osmium::memory::Buffer&)>& handle);

}  // namespace vantage::internal::osm
