// A block of an OpenStreetMap PBF before libosmium unpacks it: what in it would lead libosmium beyond its memory.
#pragma once

#include <cstdint>
#include <string_view>

namespace vantage::internal::osm {

/// How many bytes libosmium's objects of a block will have, to within a few for each object. `block`: a PrimitiveBlock.
///
/// Throws RefusedInput for a NUL byte in a text: libosmium keeps tags as texts that end with NUL, and with one too many
/// reads on behind the last. (XML holds none: Expat refuses it.) Throws protozero::exception and std::exception where
/// the block is garbled.
std::uint64_t unpacked_size(std::string_view block);

}  // namespace vantage::internal::osm
