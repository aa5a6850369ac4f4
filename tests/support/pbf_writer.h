// OpenStreetMap PBF written byte by byte: right ones, and such as no program writes.
// https://wiki.openstreetmap.org/wiki/PBF_Format
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vantage::testing {

std::string pbf_varint(std::uint64_t number);
/// Numbers in one field, as signed ones (zigzag) or as they are.
std::string pbf_packed(const std::vector<std::uint64_t>& numbers);
std::string pbf_packed_signed(const std::vector<std::int64_t>& numbers);
std::string pbf_field(std::uint32_t field, const std::string& bytes);
std::string pbf_field(std::uint32_t field, std::uint64_t number);

/// The beginning of every file.
std::string pbf_header();
/// A block compressed with zlib.
std::string pbf_block(const std::vector<std::string>& texts, const std::vector<std::string>& groups);

/// A block that is given whole, and not compressed.
std::string pbf_raw_block(const std::string& bytes);

}  // namespace vantage::testing
