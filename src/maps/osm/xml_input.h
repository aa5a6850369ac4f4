// The bytes of OpenStreetMap XML on their way to libosmium: unpacked here, and bounded.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vantage::internal::osm {

/// How libosmium is told to read XML through what is here, packed or not: its word for gzip, in whose place it stands.
/// The text is what makes sure that it does.
std::string bounded_xml_format();

/// gzip and bzip2 make up to some thousand and a million times of their bytes. A map that is packed has at most this
/// much text: 256 MiB, and 64 times the bytes of the file, four times what XML of maps gains.
constexpr std::uint64_t most_unpacked(std::uint64_t packed) { return (std::uint64_t{256} << 20U) + 64 * packed; }

/// The name of the first element of an XML or HTML text, "" where there is none; a DOCTYPE counts as html.
std::string_view root_element(std::string_view text);

/// What a file that is not ours looks like, for people. `root`: of its text.
std::string guess_content(std::string_view bytes, std::string_view root);

}  // namespace vantage::internal::osm
