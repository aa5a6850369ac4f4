// Objects of OpenStreetMap's text formats: XML, and the JSON of Overpass and of the editing API.
#pragma once

#include <filesystem>
#include <functional>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/entity_bits.hpp>
#include <string>

#include "core/progress_reporter.h"

namespace vantage::internal::osm {

/// Hands over what the file holds, of the kinds asked for, in its order. What JOSM has marked as deleted is not
/// visible.
///
/// Overpass writes the positions of nodes into ways and, for ways that are members, into relations ("out geom"). A node
/// of these that has no id gets one by its position. Where only relations are asked for, the ways that a relation has
/// the positions of come after it: with version 0 and without tags.
///
/// Returns what Overpass remarks on an error that ended its answer early; empty where there was none. Throws
/// RefusedInput for what is no map, garbled or beyond XmlBounds (in JSON likewise for an element), what libosmium
/// throws for wrong ids and positions, Error(cancelled), and what `handle` throws.
std::string read_text(const std::filesystem::path& path, osmium::osm_entity_bits::type kinds,
                      const core::ProgressReporter& progress,
                      const std::function<void(const osmium::memory::Buffer&)>& handle);

}  // namespace vantage::internal::osm
