// Reads OpenStreetMap PBF files: their blocks are found and checked here, and decoded by libosmium.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/entity_bits.hpp>

#include "core/progress_reporter.h"

namespace vantage::internal::osm {

// In bytes of libosmium's objects. A block of a map has some 8,000 objects, and unpacks to some megabytes; files of
// maps unpack to 10 to 25 times their bytes.
constexpr std::uint64_t kMostOfBlock = std::uint64_t{256} << 20U;
constexpr std::uint64_t most_of_pbf(std::uint64_t bytes) { return (std::uint64_t{512} << 20U) + 64 * bytes; }

/// Hands over what the file holds, of the kinds asked for, in its order. No more than kMostOfBlock of it is in memory
/// at a time. Throws RefusedInput for what is beyond these bounds, what libosmium and protozero throw for what is
/// garbled, Error(cancelled), and what `handle` throws.
void read_pbf(const std::filesystem::path& path, osmium::osm_entity_bits::type kinds,
              const core::ProgressReporter& progress, const std::function<void(const osmium::memory::Buffer&)>& handle);

}  // namespace vantage::internal::osm
